"""Table commands in release 7.0.0 of cFE, where texts or behaviour differ from 7.0.1.

Every text and number here was observed on NASA's cFE 7.0.0.
"""

from __future__ import annotations

import pytest

from cfepy.ids import TBL_VALRESULTID_BASE, make
from cfepy.msg import Command, get_fcn_code, get_size
from cfepy.status import CFE_TBL_INFO_UPDATED, CfeError
from cfepy.tbl import OPT_DBL_BUFFER, OPT_DUMP_ONLY, packets
from tests.tbl.conftest import Bench

NAME = "APP.T"
BAD = 0xFF


def make_bench(version: str) -> tuple[Bench, int]:
    """Return a bench with a table that was loaded twice, so that it can be dumped, and a good file for it."""
    bench = Bench(cfe_version=version)
    handle = bench.tbl.register("T", 4, 0, lambda image: -5 if image[0] == BAD else 0)
    for _ in range(2):
        bench.tbl.load(handle, b"old.")
    bench.put("/cf/t.tbl", NAME, b"new.")
    bench.take_events()
    return bench, handle


def texts(bench: Bench) -> list[tuple[int, str]]:
    return [(event_id, text) for event_id, _, text in bench.take_events()]


def dump(bench: Bench, which: int, name: str = NAME) -> None:
    bench.ground(packets.DUMP, ActiveTableFlag=which, TableName=name, DumpFilename="/ram/t.tbl")


def validate(bench: Bench, which: int, name: str = NAME) -> None:
    bench.ground(packets.VALIDATE, ActiveTableFlag=which, TableName=name)


def test_load_from_the_ground_is_refused_in_7_0_0() -> None:
    bench, _ = make_bench("7.0.0")
    bench.ground(packets.LOAD, LoadFilename="/cf/t.tbl")
    assert texts(bench) == [
        (60, "LoadFile,app=CFE_TBL,tbl=APP.T:No working buffers available, stat=0xffffffffcc00000f")
    ]
    bench.put("/cf/x.tbl", "NO.SUCH", b"1234")
    bench.ground(packets.LOAD, LoadFilename="/cf/x.tbl")
    assert texts(bench) == [(57, "LoadFile,app=CFE_TBL,tbl=NO.SUCH:Unable to locate in Table Registry")]
    assert bench.send_hk()["CommandErrorCounter"] == 2


def test_load_that_waits_for_a_lock_accepts_a_file_from_the_ground() -> None:
    bench, handle = make_bench("7.0.0")
    bench.tbl.get_address(handle)
    bench.tbl.load(handle, b"wait")
    bench.take_events()
    bench.ground(packets.LOAD, LoadFilename="/cf/t.tbl")
    where = "LoadFile,app=CFE_TBL,file=/cf/t.tbl,tbl=APP.T"
    assert texts(bench) == [(12, f"{where}:Successful load into 'APP.T' working buffer")]
    validate(bench, packets.INACTIVE_BUFFER)
    bench.tbl.release_address(handle)
    assert bench.tbl.manage(handle) == CFE_TBL_INFO_UPDATED, "an image that was validated needs no activation"
    assert bytes(bench.tbl.get_address(handle)[0]) == b"new."


def test_dumps() -> None:
    bench, _ = make_bench("7.0.0")
    dump(bench, packets.ACTIVE_BUFFER)
    bench.send_hk()
    dump(bench, 7)
    assert texts(bench) == [
        (14, "dump,table=[unknown],app=,file=(null):Successfully dumped table"),
        (80, "Cmd for Table 'APP.T' had illegal buffer parameter (0x00000007)"),
        (80, "dump,table=APP.T,app=,file=(null):Cmd had illegal buffer parameter (0x00000007)"),
    ]


def test_validations() -> None:
    bench, handle = make_bench("7.0.0")
    validate(bench, packets.ACTIVE_BUFFER)
    bench.tbl.register("N", 4, OPT_DUMP_ONLY)
    validate(bench, packets.ACTIVE_BUFFER, "APP.N")
    validate(bench, 9)
    bench.tbl.register("D", 4, OPT_DBL_BUFFER)
    validate(bench, packets.INACTIVE_BUFFER, "APP.D")
    assert texts(bench) == [
        (16, "Tbl Services issued validation request for 'APP.T'"),
        (23, "Tbl Services assumes 'APP.N' is valid. No Validation Function has been registered"),
        (80, "Cmd for Table 'APP.T' had illegal buffer parameter (0x00000009)"),
        (66, "No Buffer for Table 'APP.T' present"),
        (66, "No Buffer for Table 'APP.D' present"),
    ]
    assert bench.send_hk()["LastValTableName"] == "APP.N"
    bench.tbl.get_address(handle)[0][0] = BAD
    bench.tbl.validate(handle)
    assert texts(bench) == [(96, "APP validation failed for APP.T 'active', Status=0x00000000")]


def test_replaced_request_is_never_answered() -> None:
    bench, handle = make_bench("7.0.0")
    for _ in range(10):
        validate(bench, packets.ACTIVE_BUFFER)
    bench.take_events()
    validate(bench, packets.ACTIVE_BUFFER)
    assert texts(bench) == [(67, "Too many Table Validations have been requested")]
    bench.tbl.manage(handle)
    assert [bench.send_hk()["ValidationCounter"] for _ in range(2)] == [1, 1]


def test_repeated_request_is_reported_in_7_0_1() -> None:
    bench, _ = make_bench("7.0.1")
    for _ in range(2):
        validate(bench, packets.ACTIVE_BUFFER)
    number = make(TBL_VALRESULTID_BASE, 1)
    assert texts(bench) == [(104, f"Validate,app=,tbl=APP.T:Validation already in progress, id={number:x}")]
    values = bench.send_hk()
    assert (values["CommandCounter"], values["CommandErrorCounter"]) == (2, 0)


def test_activations() -> None:
    bench, handle = make_bench("7.0.0")
    bench.named(packets.ACTIVATE, NAME)
    bench.tbl.register("D", 4, OPT_DUMP_ONLY)
    bench.named(packets.ACTIVATE, "APP.D")
    bench.tbl.get_address(handle)
    bench.tbl.load(handle, b"wait")
    bench.take_events()
    bench.ground(packets.LOAD, LoadFilename="/cf/t.tbl")
    bench.take_events()
    bench.named(packets.ACTIVATE, NAME)
    validate(bench, packets.INACTIVE_BUFFER)
    bench.tbl.validate(handle)
    bench.take_events()
    bench.named(packets.ACTIVATE, NAME)
    assert texts(bench) == [(17, "Tbl Services notifying App that 'APP.T' has a load pending")]


@pytest.mark.parametrize(
    ("version", "event_id", "text"),
    [
        ("7.0.0", 70, "Cannot activate table 'APP.T'. No Inactive image available"),
        ("7.0.0", 78, "Illegal attempt to activate dump-only table 'APP.D'"),
        ("7.0.0", 81, "Cannot activate table 'APP.T'. Inactive image not Validated"),
        ("7.0.1", 70, "Activate,app=,tbl=APP.T:Cannot activate table, No Inactive image available"),
        ("7.0.1", 78, "Activate,app=,tbl=APP.D:Illegal attempt to activate dump-only table"),
        ("7.0.1", 81, "Activate,app=,tbl=APP.T:Cannot activate table, Inactive image not Validated"),
    ],
)
def test_invalid_activation_is_refused(version: str, event_id: int, text: str) -> None:
    bench, handle = make_bench(version)
    bench.tbl.register("D", 4, OPT_DUMP_ONLY)
    if event_id == 81:
        bench.tbl.get_address(handle)
        if version == "7.0.0":
            bench.tbl.load(handle, b"wait")
        bench.ground(packets.LOAD, LoadFilename="/cf/t.tbl")
        bench.take_events()
    bench.named(packets.ACTIVATE, "APP.D" if event_id == 78 else NAME)
    assert texts(bench) == [(event_id, text)]


@pytest.mark.parametrize(
    "wish", [packets.ACTIVATE, packets.VALIDATE, packets.DUMP, packets.SEND_REGISTRY], ids=lambda wish: wish.name
)
def test_unknown_tables(wish: Command) -> None:
    bench, _ = make_bench("7.0.0")
    bench.named(wish, "NO.SUCH")
    assert texts(bench) == [(57, "Unable to locate 'NO.SUCH' in Table Registry")]


@pytest.mark.parametrize(("version", "size"), [("7.0.0", 7), ("7.0.1", 12)])
def test_the_notification_of_an_owner(version: str, size: int) -> None:
    bench, handle = make_bench(version)
    bench.tbl.notify_by_message(handle, 0x1882, 5, 0xCAFE)
    validate(bench, packets.ACTIVE_BUFFER)
    packet = bench.sent[-1]
    assert (len(packet), get_size(packet), get_fcn_code(packet.ljust(8, b"\0"))) == (size, size, 5)


def test_invalid_handle_causes_no_event_in_7_0_0() -> None:
    bench, _ = make_bench("7.0.0")
    with pytest.raises(CfeError):
        bench.tbl.load(99, b"data")
    assert texts(bench) == []
    assert bench.tbl.registry.accesses.find(99) is None


@pytest.mark.parametrize(("version", "event_id"), [("7.0.0", 75), ("7.0.1", 72)])
def test_an_end_beyond_32_bits(version: str, event_id: int) -> None:
    bench, handle = make_bench(version)
    data = bytearray(bench.files["/cf/t.tbl"])
    data[68:72] = (0xFFFFFFFE).to_bytes(4, "big")
    bench.files["/cf/t.tbl"] = bytes(data)
    with pytest.raises(CfeError):
        bench.tbl.load(handle, "/cf/t.tbl")
    assert [each for each, _ in texts(bench)] == [event_id]


@pytest.mark.parametrize(("version", "told"), [("7.0.0", []), ("7.0.1", [101])])
def test_too_long_path_is_reported_only_in_7_0_1(version: str, told: list[int]) -> None:
    bench, handle = make_bench(version)
    bench.too_long = "/cf/" + "x" * 80
    with pytest.raises(CfeError):
        bench.tbl.load(handle, bench.too_long)
    assert [each for each, _ in texts(bench)] == told
