"""SCH_LAB: its shipped table, its schedule of commands, and its log when it cannot start."""

from __future__ import annotations

from types import SimpleNamespace

import pytest

from apps.sch_lab import TABLES, SCH_LAB_AppMain, schedule
from apps.sch_lab.tables import sch_lab_table
from cfepy.es import APP_ERROR, APP_EXIT
from cfepy.msg import Layout, get_fcn_code, get_msg_id
from cfepy.status import CFE_SB_BAD_ARGUMENT, OS_ERR_INCORRECT_OBJ_STATE, OS_ERR_NAME_NOT_FOUND, OsalError, UsageError
from cfepy.tbl import build
from tests.apps.conftest import APPS, AppBench, cmd
from tests.layouts import DATA, assert_same

ONE_HZ = cmd(0x1811)


class SchBench(AppBench):
    """A handle with a timer whose every tick is one step of the script."""

    def __init__(self) -> None:
        super().__init__("SCH_LAB")
        self.timer_set: tuple[int, int] | None = None
        self.timebase_missing = False
        self.cfe.os = SimpleNamespace(
            count_sem_create=lambda name, value: 1,
            count_sem_take=lambda semaphore: None,
            time_base_get_id_by_name=self._timebase,
            timer_add=lambda name, timebase, callback: 2,
            timer_set=lambda timer, start, interval: setattr(self, "timer_set", (start, interval)),
            printf=self.printed.append,
        )

    def _timebase(self, name: str) -> int:
        if self.timebase_missing:
            raise OsalError(OS_ERR_NAME_NOT_FOUND, name)
        return 3

    def use(self, tick_rate: int, *rows: tuple[int, int, int, bytes]) -> None:
        """Put another table in place."""
        self.files["/cf/sch_lab_table.tbl"] = build(schedule.image(tick_rate, list(rows)))


@pytest.fixture
def sch() -> SchBench:
    return SchBench()


def test_shipped_table_is_nasas_byte_for_byte() -> None:
    shipped = (APPS / "sch_lab/tables/sch_lab_table.tbl").read_bytes()
    assert shipped == build(sch_lab_table.image()) == (DATA / "sch_lab_table.tbl").read_bytes()


@pytest.mark.parametrize(
    ("layout", "struct"),
    [(schedule.ENTRY, "SCH_LAB_ScheduleTableEntry_t"), (schedule.TABLE, "SCH_LAB_ScheduleTable_t")],
    ids=["entry", "table"],
)
def test_layouts_match_nasas_structures(layout: Layout, struct: str) -> None:
    assert_same(layout, struct)


def test_start(sch: SchBench) -> None:
    sch.run(SCH_LAB_AppMain)
    assert sch.printed == [
        "SCH Lab Initialized.SCH Lab equuleus-rc1+dev29 (Equuleus) v2.3.0 Official Release, EDS disabled\n"
    ]
    assert sch.timer_set == (1_000_000, 10_000)
    assert sch.subscriptions == {0x1811}
    assert sch.exit_status == APP_EXIT


def test_nothing_goes_out_before_the_first_second(sch: SchBench) -> None:
    sch.use(100, (0x1882, 1, 0, b""))
    sch.run(SCH_LAB_AppMain, None, None, ONE_HZ, None)
    assert len(sch.sent) == 2


def test_each_entry_has_its_own_period(sch: SchBench) -> None:
    sch.use(100, (0x1882, 2, 3, b"abc"), (0x1808, 3, 0, b""))
    sch.run(SCH_LAB_AppMain, ONE_HZ, *[None] * 5)
    assert [get_msg_id(packet) for packet in sch.sent] == [0x1882, 0x1808, 0x1882, 0x1882, 0x1808]
    packet = sch.sent[0]
    assert (get_fcn_code(packet), packet[8:], len(packet)) == (3, b"abc", 11)


def test_invalid_entries_are_sent_as_by_nasas_app(sch: SchBench) -> None:
    """The headers are those that NASA's SCH_LAB sent on Linux, without sequence count, time and checksum."""
    text = b"".join(bytes([number]) for number in range(64))
    rows = [
        (0, 1, 1, 2, "0800 C000 0000 00"),
        (0x2000, 1, 1, 2, "0800 C000 0000 00"),
        (0x11880, 1, 1, 2, "0800 C000 0000 00"),
        (0x0890, 1, 5, 2, "0890 C000 0003 0000 0001"),
        (0x1090, 1, 5, 2, "1090 C000 0003 0000 0001"),
        (0x0090, 1, 5, 2, "0090 C000 0003 0000 0001"),
        (0x1891, 1, 128, 2, "1891 C000 0003 0000 0001"),
        (0x1FFF, 1, 127, 2, "1FFF C000 0003 7F00 0001"),
        (0x1892, 1, 1, 77, f"1892 C000 004E 0100 {text.hex()} 4D000000 01000000 00000000 00"),
        (0x1893, 1, 1, 0xFFFF, "1893 C000 0000 00"),
    ]
    config = [
        {"MessageID": mid, "PacketRate": rate, "FcnCode": code, "PayloadLength": length, "MessageBuffer": text}
        for mid, rate, code, length, _ in rows
    ]
    sch.files["/cf/sch_lab_table.tbl"] = build(schedule.SCHEDULE_TABLE.image({"TickRate": 100, "Config": config}))
    sch.run(SCH_LAB_AppMain, ONE_HZ)
    assert [packet.hex() for packet in sch.sent] == [bytes.fromhex(header).hex() for *_, header in rows]
    assert sch.exit_status == APP_EXIT


@pytest.mark.parametrize(
    ("tick_rate", "interval", "log"),
    [
        (0, 1_000_000, ["SCH_LAB_AppInit: Using default tick rate of 1 second"]),
        (3, 333_333, ["SCH_LAB_AppInit: WARNING: tick rate of 3 is not an integer number of microseconds"]),
        (50, 20_000, []),
    ],
)
def test_tick_rates(sch: SchBench, tick_rate: int, interval: int, log: list[str]) -> None:
    sch.use(tick_rate)
    sch.run(SCH_LAB_AppMain)
    assert sch.timer_set == (1_000_000, interval)
    assert sch.log == log


def test_app_of_another_name_gets_the_recorded_log() -> None:
    sch = SchBench()
    sch.kernel.current.owner.name = "SCH"
    sch.run(SCH_LAB_AppMain)
    assert sch.log == [
        "SCH_LAB: Error Loading Table ScheduleTable, RC = 0xFFFFFFFFCC000020",
        "SCH_LAB: Error Initializing RC = 0xFFFFFFFFCC000020",
    ]
    assert sch.exit_status == APP_ERROR


def test_no_timebase_no_schedule(sch: SchBench) -> None:
    sch.timebase_missing = True
    sch.run(SCH_LAB_AppMain)
    assert sch.log[0] == "SCH_LAB_AppInit: OS_TimeBaseGetIdByName failed:RC=-17"
    assert sch.exit_status == APP_ERROR


def test_image_refuses_too_many_entries_and_too_long_payloads() -> None:
    with pytest.raises(UsageError):
        schedule.image(100, [(0x1882, 1, 0, b"")] * 33)
    with pytest.raises(UsageError):
        schedule.image(100, [(0x1882, 1, 0, bytes(65))])


@pytest.mark.parametrize(
    ("function", "texts"),
    [
        ("sb.create_pipe", ["SCH Error creating pipe!\n", "SCH Error subscribing to 1hz!\n"]),
        ("sb.subscribe", ["SCH Error subscribing to 1hz!\n"]),
    ],
)
def test_app_without_the_1hz_pipe_ticks_and_sends_nothing(sch: SchBench, function: str, texts: list[str]) -> None:
    sch.use(100, (0x1882, 1, 0, b""))
    sch.refuse[function] = CFE_SB_BAD_ARGUMENT
    sch.run(SCH_LAB_AppMain, None, None)
    assert sch.printed[:-1] == texts
    assert sch.printed[-1].startswith("SCH Lab Initialized.")
    assert (sch.timer_set, sch.sent, sch.log, sch.exit_status) == ((1_000_000, 10_000), [], [], APP_EXIT)


def test_message_refused_by_the_bus_is_skipped(sch: SchBench) -> None:
    sch.use(100, (0x1882, 1, 0, b""))
    sch.run(SCH_LAB_AppMain, ONE_HZ, lambda: sch.refuse.update({"sb.transmit_msg": CFE_SB_BAD_ARGUMENT}), None)
    assert (len(sch.sent), sch.exit_status) == (1, APP_EXIT)


def test_a_timer_that_cannot_be_set_is_logged(sch: SchBench) -> None:
    def refused(timer: int, start: int, interval: int) -> None:
        raise OsalError(OS_ERR_INCORRECT_OBJ_STATE, "the test says so")

    sch.cfe.os.timer_set = refused
    sch.run(SCH_LAB_AppMain)
    assert sch.log == ["SCH_LAB_AppInit: OS_TimerSet failed:RC=-35"]
    assert (len(sch.printed), sch.exit_status) == (1, APP_EXIT)


def test_declarations() -> None:
    (kind,) = TABLES
    assert (kind.name, kind.size, kind.file) == ("SCH_LAB.ScheduleTable", 2436, "/cf/sch_lab_table.tbl")
    assert kind.pack(kind.unpack(sch_lab_table.image().data)[0]) == sch_lab_table.image().data
