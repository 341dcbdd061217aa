"""Ground commands of Event Services, its housekeeping packet and its files."""

from __future__ import annotations

from pathlib import Path

import pytest

from cfepy.evs import DEBUG, ERROR, INFORMATION
from cfepy.evs import packets as pk
from cfepy.fs import read_header
from cfepy.msg import Layout
from cfepy.osal import Volume
from tests.declared import assert_as_recorded, assert_complete
from tests.evs.conftest import APP_ID, EVS_ID, World
from tests.layouts import assert_same

DATA = Path(__file__).parent.parent / "data"


@pytest.fixture
def loud(world: World) -> World:
    """EVS with its own DEBUG events, which confirm commands, enabled."""
    world.evs.apps[EVS_ID].types = 0x0F
    return world


def name(app: str = "HK") -> bytes:
    return app.encode().ljust(20, b"\0")


def u16(*values: int) -> bytes:
    return b"".join(value.to_bytes(2, "little") for value in values)


def test_declarations_are_complete_and_as_recorded() -> None:
    assert_complete(pk)
    assert_as_recorded(pk, 6)


@pytest.mark.parametrize(
    ("layout", "c_name"),
    [
        (pk.PACKET_ID, "CFE_EVS_PacketID_t"),
        (pk.LONG_EVENT, "CFE_EVS_LongEventTlm_Payload_t"),
        (pk.APP_TLM, "CFE_EVS_AppTlmData_t"),
        (pk.HOUSEKEEPING, "CFE_EVS_HousekeepingTlm_Payload_t"),
        (pk.APP_DATA_RECORD, "CFE_EVS_AppDataFile_t"),
    ],
)
def test_layouts_match_nasas_structures(layout: Layout, c_name: str) -> None:
    assert_same(layout, c_name)


OK_COMMANDS = [
    (0, b"", 0, INFORMATION, "No-op Cmd Rcvd: CFE_EVS v7.0.1+dev0 (Draco) v7.0.1 Official Release, EDS disabled"),
    (2, b"\1\0", 20, DEBUG, "Enable Event Type Command Received with Event Type Bit Mask = 0x01"),
    (3, b"\2\0", 21, DEBUG, "Disable Event Type Command Received with Event Type Bit Mask = 0x02"),
    (4, b"\1\0", 22, DEBUG, "Set Event Format Mode Command Received with Mode = 0x01"),
    (
        5,
        name() + b"\1\0",
        23,
        DEBUG,
        "Enable App Event Type Command Received with AppName = HK, EventType Bit Mask = 0x01",
    ),
    (
        6,
        name() + b"\2\0",
        24,
        DEBUG,
        "Disable App Event Type Command Received with AppName = HK, EventType Bit Mask = 0x02",
    ),
    (7, name(), 25, DEBUG, "Enable App Events Command Received with AppName = HK"),
    (8, name(), 26, DEBUG, "Disable App Events Command Received with AppName = HK"),
    (9, name(), 27, DEBUG, "Reset Event Counter Command Received with AppName = HK"),
    (
        10,
        name() + u16(5, 1),
        17,
        DEBUG,
        "Set Filter Mask Command Received with AppName=HK, EventID=0x00000005, Mask=0x0001",
    ),
    (11, b"\2\0", 18, DEBUG, "Enable Ports Command Received with Port Bit Mask = 0x02"),
    (12, b"\2\0", 19, DEBUG, "Disable Ports Command Received with Port Bit Mask = 0x02"),
    (13, name() + u16(5), 28, DEBUG, "Reset Filter Command Received with AppName = HK, EventID = 0x00000005"),
    (14, name(), 29, DEBUG, "Reset All Filters Command Received with AppName = HK"),
    (
        15,
        name() + u16(6, 3),
        30,
        DEBUG,
        "Add Filter Command Received with AppName = HK, EventID = 0x00000006, Mask = 0x0003",
    ),
    (16, name() + u16(5), 31, DEBUG, "Delete Filter Command Received with AppName = HK, EventID = 0x00000005"),
    (17, bytes(64), 32, DEBUG, "Write App Data Command: 2 application data entries written to /ram/cfe_evs_app.dat"),
    (18, bytes(64), 33, DEBUG, "Write Log File Command: 1 event log entries written to /ram/cfe_evs.log"),
    (19, b"\0\0", 38, DEBUG, "Set Log Mode Command: Log Mode = 0"),
]


@pytest.mark.parametrize(("code", "payload", "event_id", "event_type", "text"), OK_COMMANDS)
def test_valid_command_is_executed_counted_and_confirmed(
    loud: World, code: int, payload: bytes, event_id: int, event_type: int, text: str
) -> None:
    loud.call(lambda: loud.evs.register([(5, 0xFFFF)]))
    loud.command(code, payload)
    assert loud.sent() == [("CFE_EVS", event_id, event_type, text)]
    assert (loud.evs.commands.count, loud.evs.commands.errors) == (1, 0)


BAD_COMMANDS = [
    (2, b"\0\0", 40, "Bit Mask = 0x00000000 out of range: CC = 2"),
    (3, b"\x10\0", 40, "Bit Mask = 0x00000010 out of range: CC = 3"),
    (4, b"\2\0", 10, "Set Event Format Mode Command: Invalid Event Format Mode = 0x02"),
    (5, name() + b"\0\0", 40, "Bit Mask = 0x00000000 out of range: CC = 5"),
    (6, name() + b"\xff\0", 40, "Bit Mask = 0x000000ff out of range: CC = 6"),
    (7, name("MUTE"), 7, "MUTE not registered with EVS: CC = 7"),
    (6, name("MUTE") + b"\1\0", 7, "MUTE not registered with EVS,: CC = 6"),
    (7, name("NOBODY"), 9, "Unable to retrieve application ID for NOBODY: CC = 7"),
    (8, name("NOBODY"), 9, "Disable App Events Command: Unable to retrieve application ID for NOBODY: CC = 8"),
    (9, name("NOBODY"), 9, "Reset Event Counter Command: Unable to retrieve application ID for NOBODY: CC = 9"),
    (10, name() + u16(6, 1), 6, "HK Event ID 6 not registered for filtering: CC = 10 "),
    (11, b"\0\0", 40, "Bit Mask = 0x00000000 out of range: CC = 11"),
    (12, b"\x20\0", 40, "Bit Mask = 0x00000020 out of range: CC = 12"),
    (13, name() + u16(6), 6, "HK Event ID 6 not registered for filtering: CC = 13"),
    (
        15,
        name() + u16(5, 1),
        37,
        "Add Filter Command:AppName = HK, EventID = 0x00000005 is already registered for filtering",
    ),
    (
        15,
        name() + u16(0xFFFF, 1),
        37,
        "Add Filter Command:AppName = HK, EventID = 0x0000ffff is already registered for filtering",
    ),
    (16, name() + u16(6), 6, "HK Event ID 6 not registered for filtering: CC = 16"),
    (19, b"\2\0", 39, "Set Log Mode Command Error: Log Mode = 2"),
    (21, b"", 15, "Invalid command code -- ID = 0x00001801, CC = 21"),
    (0, b"xx", 43, "Invalid msg length: ID = 0x1801,  CC = 0, Len = 10, Expected = 8"),
]


@pytest.mark.parametrize(("code", "payload", "event_id", "text"), BAD_COMMANDS)
def test_invalid_command_is_refused_counted_and_reported(
    world: World, code: int, payload: bytes, event_id: int, text: str
) -> None:
    world.call(lambda: world.evs.register([(5, 0xFFFF)]))
    world.command(code, payload)
    assert world.sent() == [("CFE_EVS", event_id, ERROR, text)]
    assert (world.evs.commands.count, world.evs.commands.errors) == (0, 1)


def test_a_strange_message_is_refused(world: World) -> None:
    world.command(0, msg_id=0x1899)
    assert world.sent() == [("CFE_EVS", 5, ERROR, "Invalid command packet, Message ID = 0x00001899")]


def test_event_types_are_switched_for_all_apps_and_for_one(world: World) -> None:
    world.command(pk.ENABLE_EVENT_TYPE_CC, b"\1\0")
    assert {app.types for app in world.evs.apps.values()} == {0x0F}
    world.command(pk.DISABLE_EVENT_TYPE_CC, b"\2\0")
    assert {app.types for app in world.evs.apps.values()} == {0x0D}
    world.command(pk.DISABLE_APP_EVENT_TYPE_CC, name() + b"\x0c\0")
    assert world.evs.apps[APP_ID].types == 0x01
    world.command(pk.ENABLE_APP_EVENT_TYPE_CC, name() + b"\2\0")
    assert world.evs.apps[APP_ID].types == 0x03


def test_an_app_is_silenced_as_a_whole(world: World) -> None:
    world.command(pk.DISABLE_APP_EVENTS_CC, name())
    world.send(1, ERROR)
    assert world.sent() == []
    world.command(pk.ENABLE_APP_EVENTS_CC, name())
    world.send(1, ERROR)
    assert len(world.sent()) == 1


def test_filters_are_added_changed_and_deleted(world: World) -> None:
    world.command(pk.ADD_EVENT_FILTER_CC, name() + u16(5, 0xFFFF))
    world.send(5)
    world.send(5)
    assert len(world.sent()) == 1
    world.command(pk.SET_FILTER_CC, name() + u16(5, 0))
    world.send(5)
    assert len(world.sent()) == 2
    world.command(pk.DELETE_EVENT_FILTER_CC, name() + u16(5))
    assert world.evs.apps[APP_ID].filters.find(5) is None


def test_number_of_filters_is_limited(world: World) -> None:
    for event_id in range(9):
        world.command(pk.ADD_EVENT_FILTER_CC, name() + u16(event_id, 1))
    text = "Add Filter Command: number of registered filters has reached max = 8"
    assert world.sent() == [("CFE_EVS", 11, ERROR, text)]


def test_the_log_keeps_the_first_or_the_last_events(world: World) -> None:
    world.command(pk.CLEAR_LOG_CC)
    for number in range(25):
        world.send(1, text=str(number))
    assert [entry[48:50] for entry in world.evs.log.entries()] == [str(n).encode().ljust(2, b"\0") for n in range(20)]
    assert world.housekeeping()["LogOverflowCounter"] == 5
    world.command(pk.SET_LOG_MODE_CC, b"\0\0")
    for number in range(25, 30):
        world.send(1, text=str(number))
    numbers = [int(entry[48:50].strip(b"\0")) for entry in world.evs.log.entries()]
    assert numbers == [*range(5, 20), *range(25, 30)]
    world.command(pk.CLEAR_LOG_CC)
    assert world.evs.log.entries() == []
    assert world.evs.log.mode == 0


def test_a_log_survives_a_processor_reset(world: World) -> None:
    world.send(1)
    after = World()
    after.evs.early_init(world.kept)
    assert after.log == ["CFE_EVS_EarlyInit: Event Log restored, n=2, c=2, f=0, m=1, o=0"]
    assert after.evs.log is world.evs.log
    world.evs.log.mode = 7
    third = World()
    third.evs.early_init(world.kept)
    assert third.log == ["CFE_EVS_EarlyInit: Event Log cleared, n=2, c=2, f=0, m=7, o=0"]
    assert world.kept["EVS"] is third.evs.log is not world.evs.log


def test_housekeeping(world: World) -> None:
    world.send(1)
    world.command(0)
    world.command(99)
    fields = world.housekeeping()
    assert {key: value for key, value in fields.items() if key != "AppData"} == {
        "CommandCounter": 1,
        "CommandErrorCounter": 1,
        "MessageFormatMode": 1,
        "MessageTruncCounter": 0,
        "UnregisteredAppCounter": 0,
        "OutputPort": 1,
        "LogFullFlag": 0,
        "LogMode": 1,
        "MessageSendCounter": 4,
        "LogOverflowCounter": 0,
        "LogEnabled": 1,
        "Spare1": 0,
        "Spare2": 0,
        "Spare3": 0,
    }
    apps = fields["AppData"]
    assert [(app["AppID"], app["AppMessageSentCounter"], app["AppEnableStatus"]) for app in apps[:3]] == [  # type: ignore[index]
        (EVS_ID, 3, 1),
        (APP_ID, 1, 1),
        (0, 0, 0),
    ]


def test_reset_counters_command_is_not_counted(loud: World) -> None:
    loud.command(0)
    loud.command(pk.RESET_COUNTERS_CC)
    fields = loud.housekeeping()
    assert (fields["CommandCounter"], fields["MessageSendCounter"]) == (0, 1)
    assert loud.sent()[-1].text == "Reset Counters Command Received"


def test_log_file_matches_nasas_log_file(world: World) -> None:
    """Same header but for application and time, same record length, same first record but for its time."""
    real = (DATA / "cfe_evs.log").read_bytes()
    world.command(pk.WRITE_LOG_DATA_FILE_CC, bytes(64))
    ours = world.files.read_file("/ram/cfe_evs.log")
    assert ours[:20] == real[:20]
    assert read_header(ours).description == "cFE EVS Log File"
    assert len(ours) == 64 + 172
    assert ours[64:70] == real[64:70]
    assert ours[76:236] == real[76:236].replace(b"v7.0.0", b"v7.0.1")


def test_app_data_file_matches_nasas_app_data_file(world: World) -> None:
    """Same header except for the time. The records of EVS and SB, which registers NASA's filters, are the real ones."""
    real = (DATA / "cfe_evs_app.dat").read_bytes()
    world.evs.apps.clear()
    world.call(lambda: world.evs.register(), EVS_ID)
    world.evs.apps[EVS_ID].sent = 2
    world.call(lambda: world.evs.register([(14, 0xFFFC), (7, 0xFFFC), (17, 0xFFF0), (25, 0xFFF0)]), APP_ID)
    app = world.evs.apps[APP_ID]
    app.name, app.sent, app.filters.slots[0].count = "CFE_SB", 6, 0x16
    world.command(pk.WRITE_APP_DATA_FILE_CC, bytes(64))
    ours = world.files.read_file("/ram/cfe_evs_app.dat")
    assert len(real) == 64 + 9 * pk.APP_DATA_RECORD.size
    assert ours[:24] == real[:24]
    assert ours[32:] == real[32 : 64 + 2 * 92]


def test_file_that_cannot_be_opened_causes_an_event(world: World) -> None:
    world.command(pk.WRITE_LOG_DATA_FILE_CC, pk.LOG_FILE_COMMAND.pack(LogFilename="/ram/none/x"))
    world.command(pk.WRITE_APP_DATA_FILE_CC, pk.APP_DATA_COMMAND.pack(AppDataFilename="/ram/none/x"))
    world.command(pk.WRITE_APP_DATA_FILE_CC, pk.APP_DATA_COMMAND.pack(AppDataFilename="/ram/.dat"))
    assert [(event.event_id, event.text) for event in world.sent()] == [
        (3, "Write Log File Command Error: OS_OpenCreate = -1, filename = /ram/none/x"),
        (13, "Write App Data Command Error: OS_OpenCreate = -1, filename = /ram/none/x"),
        (13, "Write App Data Command Error: CFE_FS_ParseInputFileNameEx() = 0xC6000002"),
    ]
    assert world.evs.commands.errors == 3


@pytest.mark.parametrize(
    ("room", "events"),
    [
        (60, [(14, "Write File Header to Log File Error: WriteHdr RC: 60, Expected: 64, filename = /ram/x")]),
        (
            64 + 2 * 172 - 1,
            [
                (2, "Write Log File Command Error: OS_write = 171, filename = /ram/x"),
                (12, "Write App Data Command Error: At entry = 1, OS_write = -1, filename = /ram/x"),
            ],
        ),
    ],
)
def test_full_disk_is_reported(world: World, room: int, events: list[tuple[int, str]]) -> None:
    world.send(1)
    for number in range(2):
        disk = Volume(capacity=room if number == 0 else min(room, 64 + 92))
        world.files.unmount("/ram")
        world.files.mount("/ram", disk)
        payload = (pk.LOG_FILE_COMMAND.pack(LogFilename="x"), pk.APP_DATA_COMMAND.pack(AppDataFilename="x"))[number]
        world.command((pk.WRITE_LOG_DATA_FILE_CC, pk.WRITE_APP_DATA_FILE_CC)[number], payload)
    told = [(event.event_id, event.text) for event in world.sent() if event.app == "CFE_EVS"]
    assert told == events
    assert world.evs.commands.errors == 2
