"""Event Services, requirement by requirement: effects of commands, contents of telemetry and files (cEVS3000 to
3020)."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest

from cfepy.evs import CRITICAL, DEBUG, ERROR, INFORMATION
from cfepy.evs import packets as pk
from cfepy.fs import read_header
from cfepy.msg import Command
from cfepy.status import CfeError
from tests.requirements.covers import covers
from tests.requirements.flight import Event, Flight

Fly = Callable[..., Flight]
VERSION = "CFE_EVS v7.0.0+dev0 (Draco) v7.0.0 Official Release, EDS disabled"
NAME = {"AppName": "PROBE"}


@pytest.fixture
def flight(fly: Fly) -> Flight:
    return fly(pk.HK_TLM_MID, pk.SHORT_EVENT_MSG_MID)


def housekeeping(flight: Flight) -> dict[str, Any]:
    return flight.ask(pk.SEND_HK, pk.HK_TLM)


def of_app(flight: Flight, app: str = "PROBE") -> dict[str, Any]:
    """Return the housekeeping entry of an application."""
    app_id = flight.cfe.es.get_app_id_by_name(app)
    rows: list[dict[str, Any]] = housekeeping(flight)["AppData"]
    return next(row for row in rows if row["AppID"] == app_id)


def say(flight: Flight, event_type: int = INFORMATION, event_id: int = 5, text: str = "hello") -> list[Event]:
    """Let PROBE send an event. Returns the resulting events."""
    flight.packets.clear()
    flight.call(lambda: flight.cfe.evs.send_event(event_id, event_type, text))
    return flight.events()


def probe_types(flight: Flight) -> list[int]:
    """Return the event types of PROBE that pass."""
    return [event.event_type for kind in (DEBUG, INFORMATION, ERROR, CRITICAL) for event in say(flight, kind)]


def register(flight: Flight, *filters: tuple[int, int]) -> None:
    flight.call(lambda: flight.cfe.evs.register(filters))


@covers("cEVS3000", "cEVS3102")
def test_cEVS3000_types_of_all_applications(flight: Flight) -> None:
    assert probe_types(flight) == [INFORMATION, ERROR, CRITICAL]
    flight.send(pk.ENABLE_EVENT_TYPE, BitMask=0x01)
    assert probe_types(flight) == [DEBUG, INFORMATION, ERROR, CRITICAL]
    flight.send(pk.DISABLE_EVENT_TYPE, BitMask=0x0C)
    assert probe_types(flight) == [DEBUG, INFORMATION]
    assert flight.send(pk.SET_LOG_MODE, LogMode=9) == []  # EVS's own errors are held back as well


@covers("cEVS3001", "cEVS3103.5")
def test_cEVS3001_format_mode(flight: Flight) -> None:
    flight.send(pk.SET_EVENT_FORMAT_MODE, MsgFormat=pk.FORMAT_SHORT)
    assert housekeeping(flight)["MessageFormatMode"] == pk.FORMAT_SHORT
    assert say(flight, ERROR, 77) == []
    (short,) = flight.all(pk.SHORT_EVENT_MSG)
    identity = {"AppName": "PROBE", "EventID": 77, "EventType": ERROR, "SpacecraftID": 66, "ProcessorID": 1}
    assert short == {"PacketID": identity}
    packet = flight.packets[-1]
    assert (len(packet), int.from_bytes(packet[6:10], "big")) == (48, flight.cfe.time.get_time().seconds)
    flight.send(pk.SET_EVENT_FORMAT_MODE, MsgFormat=pk.FORMAT_LONG)
    assert say(flight) == [("PROBE", 5, INFORMATION, "hello")]


def test_cEVS3002_noop(flight: Flight) -> None:
    assert flight.send(pk.NOOP) == [("CFE_EVS", 0, INFORMATION, f"No-op Cmd Rcvd: {VERSION}")]


def test_cEVS3003_counters_are_set_to_zero(flight: Flight) -> None:
    counters = (
        "CommandCounter",
        "CommandErrorCounter",
        "MessageSendCounter",
        "MessageTruncCounter",
        "UnregisteredAppCounter",
    )
    flight.send(pk.NOOP)
    flight.send(pk.SET_LOG_MODE, LogMode=9)
    say(flight, text="x" * 200)
    with pytest.raises(Exception, match="CFE_EVS_APP_NOT_REGISTERED"):
        flight.call(lambda: flight.cfe.evs.send_info(1, "x"), app="MUTE")
    before = housekeeping(flight)
    assert all(before[name] for name in counters)
    flight.send(pk.RESET_COUNTERS)
    after = housekeeping(flight)
    assert [after[name] for name in counters] == [0] * 5


@covers("cEVS3004", "cEVS3004.1")
def test_cEVS3004_application_data_file(flight: Flight) -> None:
    register(flight, (5, 0x0001), (6, 0xFFFF))
    for _ in range(3):
        say(flight)
    flight.send(pk.DISABLE_APP_EVENT_TYPE, BitMask=0x04, **NAME)
    flight.send(pk.DISABLE_APP_EVENTS, **NAME)
    paths = {"": "/ram/cfe_evs_app.dat", "/ram/other.dat": "/ram/other.dat"}
    for name, path in paths.items():
        flight.send(pk.WRITE_APP_DATA_FILE, AppDataFilename=name)
        data = flight.mission.files.read_file(path)
        header = read_header(data)
        assert (header.description, header.subtype) == ("EVS Application Data File", 15)
        assert header.application_id == 0x110001
        size = pk.APP_DATA_RECORD.size
        records = [pk.APP_DATA_RECORD.unpack(data, at) for at in range(64, len(data), size)]
        core = [f"CFE_{service}" for service in ("EVS", "SB", "ES", "TIME", "TBL")]
        assert [record["AppName"] for record in records] == [*core, "PROBE"]
        probe = records[-1]
        assert (probe["EventCount"], probe["ActiveFlag"], probe["EventTypesActiveFlag"]) == (2, 0, 0x0A)
        slots = [(slot["EventID"], slot["Mask"], slot["Count"]) for slot in probe["Filters"]]
        assert slots == [(5, 1, 3), (6, 0xFFFF, 0)] + [(0xFFFF, 0, 0)] * 6


VALID: list[tuple[Command, dict[str, Any]]] = [
    (pk.NOOP, {}),
    (pk.ENABLE_EVENT_TYPE, {"BitMask": 2}),
    (pk.DISABLE_EVENT_TYPE, {"BitMask": 1}),
    (pk.SET_EVENT_FORMAT_MODE, {"MsgFormat": pk.FORMAT_LONG}),
    (pk.ENABLE_APP_EVENT_TYPE, {"BitMask": 2, **NAME}),
    (pk.DISABLE_APP_EVENT_TYPE, {"BitMask": 1, **NAME}),
    (pk.ENABLE_APP_EVENTS, NAME),
    (pk.DISABLE_APP_EVENTS, NAME),
    (pk.RESET_APP_COUNTER, NAME),
    (pk.ADD_EVENT_FILTER, {"EventID": 5, **NAME}),
    (pk.SET_FILTER, {"EventID": 5, **NAME}),
    (pk.RESET_FILTER, {"EventID": 5, **NAME}),
    (pk.DELETE_EVENT_FILTER, {"EventID": 5, **NAME}),
    (pk.RESET_ALL_FILTERS, NAME),
    (pk.ENABLE_PORTS, {"BitMask": 2}),
    (pk.DISABLE_PORTS, {"BitMask": 2}),
    (pk.WRITE_APP_DATA_FILE, {}),
    (pk.WRITE_LOG_DATA_FILE, {}),
    (pk.SET_LOG_MODE, {"LogMode": 0}),
    (pk.CLEAR_LOG, {}),
]


def test_cEVS3005_every_valid_command_is_counted(flight: Flight) -> None:
    for count, (command, fields) in enumerate(VALID, 1):
        flight.send(command, **fields)
        values = housekeeping(flight)
        assert (values["CommandCounter"], values["CommandErrorCounter"]) == (count, 0), command.name
    uncounted = {pk.RESET_COUNTERS.name, pk.SEND_HK.name}
    assert {command.name for command, _ in VALID} | uncounted == {command.name for command in pk.COMMANDS}


INVALID: list[tuple[Command, dict[str, Any], int]] = [
    (pk.ENABLE_EVENT_TYPE, {"BitMask": 0x10}, 40),
    (pk.DISABLE_EVENT_TYPE, {"BitMask": 0}, 40),
    (pk.SET_EVENT_FORMAT_MODE, {"MsgFormat": 3}, 10),
    (pk.ENABLE_APP_EVENT_TYPE, {"BitMask": 0, **NAME}, 40),
    (pk.DISABLE_APP_EVENT_TYPE, {"BitMask": 0x10, **NAME}, 40),
    (pk.ENABLE_APP_EVENTS, {"AppName": "NOBODY"}, 9),
    (pk.DISABLE_APP_EVENTS, {"AppName": "MUTE"}, 7),
    (pk.RESET_APP_COUNTER, {"AppName": "NOBODY"}, 9),
    (pk.SET_FILTER, {"EventID": 5, **NAME}, 6),
    (pk.RESET_FILTER, {"EventID": 5, **NAME}, 6),
    (pk.RESET_ALL_FILTERS, {"AppName": "MUTE"}, 7),
    (pk.ADD_EVENT_FILTER, {"EventID": 5, "AppName": "NOBODY"}, 9),
    (pk.DELETE_EVENT_FILTER, {"EventID": 5, **NAME}, 6),
    (pk.ENABLE_PORTS, {"BitMask": 0}, 40),
    (pk.DISABLE_PORTS, {"BitMask": 0x10}, 40),
    (pk.WRITE_APP_DATA_FILE, {"AppDataFilename": "/nowhere/x"}, 13),
    (pk.WRITE_LOG_DATA_FILE, {"LogFilename": "/nowhere/x"}, 3),
    (pk.SET_LOG_MODE, {"LogMode": 2}, 39),
]


def test_cEVS3006_each_invalid_command_is_counted_and_reported(flight: Flight) -> None:
    for count, (command, fields, event) in enumerate(INVALID, 1):
        told = [(each.app, each.event_id, each.event_type) for each in flight.send(command, **fields)]
        assert told == [("CFE_EVS", event, ERROR)], command.name
        values = housekeeping(flight)
        assert (values["CommandCounter"], values["CommandErrorCounter"]) == (0, count), command.name


def test_cEVS3006_malformed_commands_are_counted_and_reported(flight: Flight) -> None:
    assert flight.send(Command("unknown", pk.CMD_MID, 99)) == [
        ("CFE_EVS", 15, ERROR, "Invalid command code -- ID = 0x00001801, CC = 99")
    ]
    assert flight.send(Command("too long", pk.CMD_MID, pk.NOOP_CC, pk.TYPES_COMMAND)) == [
        ("CFE_EVS", 43, ERROR, "Invalid msg length: ID = 0x1801,  CC = 0, Len = 10, Expected = 8")
    ]
    assert flight.send(pk.ENABLE_PORTS, BitMask=0x10) == [
        ("CFE_EVS", 40, ERROR, "Bit Mask = 0x00000010 out of range: CC = 11")
    ]
    values = housekeeping(flight)
    assert (values["CommandCounter"], values["CommandErrorCounter"]) == (0, 3)


def test_cEVS3007_types_of_one_application(flight: Flight) -> None:
    flight.send(pk.ENABLE_APP_EVENT_TYPE, BitMask=0x01, **NAME)
    assert probe_types(flight) == [DEBUG, INFORMATION, ERROR, CRITICAL]
    flight.send(pk.DISABLE_APP_EVENT_TYPE, BitMask=0x0E, **NAME)
    assert probe_types(flight) == [DEBUG]
    assert flight.send(pk.NOOP)[0].app == "CFE_EVS"


def test_cEVS3008_events_of_one_application(flight: Flight) -> None:
    flight.send(pk.DISABLE_APP_EVENTS, **NAME)
    assert probe_types(flight) == []
    assert of_app(flight)["AppEnableStatus"] == 0
    flight.send(pk.ENABLE_APP_EVENTS, **NAME)
    assert probe_types(flight) == [INFORMATION, ERROR, CRITICAL]
    assert of_app(flight)["AppEnableStatus"] == 1


def test_cEVS3009_sent_counter_of_an_application_is_set_to_zero(flight: Flight) -> None:
    say(flight)
    assert of_app(flight)["AppMessageSentCounter"] == 1
    flight.send(pk.RESET_APP_COUNTER, **NAME)
    assert of_app(flight)["AppMessageSentCounter"] == 0


def test_cEVS3010_a_filter_counts_from_zero_again(flight: Flight) -> None:
    register(flight, (5, 0xFFFF), (6, 0xFFFF))
    for event_id in (5, 6):
        assert [len(say(flight, event_id=event_id)) for _ in range(2)] == [1, 0]
    flight.send(pk.RESET_FILTER, EventID=5, **NAME)
    assert (len(say(flight, event_id=5)), len(say(flight, event_id=6))) == (1, 0)


def test_cEVS3011_all_filters_count_from_zero_again(flight: Flight) -> None:
    register(flight, (5, 0xFFFF), (6, 0xFFFF))
    for event_id in (5, 6):
        assert [len(say(flight, event_id=event_id)) for _ in range(2)] == [1, 0]
    flight.send(pk.RESET_ALL_FILTERS, **NAME)
    assert (len(say(flight, event_id=5)), len(say(flight, event_id=6))) == (1, 1)


def test_cEVS3012_filter_mask(flight: Flight) -> None:
    register(flight, (5, 0xFFFF))
    flight.send(pk.SET_FILTER, EventID=5, Mask=0x0001, **NAME)
    assert [len(say(flight)) for _ in range(4)] == [1, 0, 1, 0]
    error = ("CFE_EVS", 6, ERROR, "PROBE Event ID 9 not registered for filtering: CC = 10 ")
    assert flight.send(pk.SET_FILTER, EventID=9, Mask=1, **NAME) == [error]


def test_cEVS3017_ports(flight: Flight) -> None:
    lines = flight.mission.console.lines
    flight.send(pk.ENABLE_PORTS, BitMask=0x0A)
    flight.send(pk.DISABLE_PORTS, BitMask=0x03)
    say(flight, text="where")
    assert [line.split()[1] for line in lines if line.endswith("where")] == ["Port4"]
    assert housekeeping(flight)["OutputPort"] == 0x08


def test_cEVS3018_housekeeping(flight: Flight) -> None:
    flight.send(pk.CLEAR_LOG)
    flight.send(pk.RESET_COUNTERS)
    flight.send(pk.ENABLE_PORTS, BitMask=0x04)
    flight.send(pk.SET_LOG_MODE, LogMode=0)
    flight.send(pk.NOOP)
    flight.send(pk.SET_LOG_MODE, LogMode=9)
    with pytest.raises(CfeError):
        flight.call(lambda: flight.cfe.evs.send_info(1, "x"), app="MUTE")
    for _ in range(22):
        say(flight, text="x" * 122)
    flight.send(pk.DISABLE_APP_EVENTS, AppName="CFE_SB")
    flight.send(pk.SET_EVENT_FORMAT_MODE, MsgFormat=pk.FORMAT_SHORT)
    values = housekeeping(flight)
    apps = values.pop("AppData")
    assert values == {
        "CommandCounter": 5,
        "CommandErrorCounter": 1,
        "MessageFormatMode": pk.FORMAT_SHORT,
        "MessageTruncCounter": 22,
        "UnregisteredAppCounter": 1,
        "OutputPort": 5,
        "LogFullFlag": 1,
        "LogMode": 0,
        "MessageSendCounter": 24,  # 22, a NOOP and a refusal
        "LogOverflowCounter": 4,
        "LogEnabled": 1,
        "Spare1": 0,
        "Spare2": 0,
        "Spare3": 0,
    }
    names = [flight.cfe.es.get_app_name(app["AppID"]) for app in apps if app["AppID"]]
    assert names == ["CFE_EVS", "CFE_SB", "CFE_ES", "CFE_TIME", "CFE_TBL", "PROBE"]
    assert (apps[5]["AppMessageSentCounter"], apps[5]["AppEnableStatus"]) == (22, 1)
    assert [app["AppEnableStatus"] for app in apps[:5]] == [1, 0, 1, 1, 1]
    assert len(apps) == 16


@covers("cEVS3019", "cEVS3019.1", "cEVS3019.2")
def test_cEVS3019_filters_are_added(flight: Flight) -> None:
    for event_id in range(8):
        flight.send(pk.ADD_EVENT_FILTER, EventID=event_id, Mask=0xFFFF, **NAME)
    assert [len(say(flight)) for _ in range(3)] == [1, 0, 0]
    text = "Add Filter Command:AppName = PROBE, EventID = 0x00000005 is already registered for filtering"
    assert flight.send(pk.ADD_EVENT_FILTER, EventID=5, Mask=0, **NAME) == [("CFE_EVS", 37, ERROR, text)]
    text = "Add Filter Command: number of registered filters has reached max = 8"
    assert flight.send(pk.ADD_EVENT_FILTER, EventID=8, Mask=0, **NAME) == [("CFE_EVS", 11, ERROR, text)]
    values = housekeeping(flight)
    assert (values["CommandCounter"], values["CommandErrorCounter"]) == (8, 2)


@covers("cEVS3020", "cEVS3020.1")
def test_cEVS3020_filters_are_deleted(flight: Flight) -> None:
    register(flight, (5, 0xFFFF))
    flight.send(pk.DELETE_EVENT_FILTER, EventID=5, **NAME)
    assert [len(say(flight)) for _ in range(3)] == [1, 1, 1]
    text = "PROBE Event ID 5 not registered for filtering: CC = 16"
    assert flight.send(pk.DELETE_EVENT_FILTER, EventID=5, **NAME) == [("CFE_EVS", 6, ERROR, text)]
    assert housekeeping(flight)["CommandErrorCounter"] == 1
