"""Requirements of the Software Bus that the ground sees: commands, telemetry, files, resets (cSB4000-4013, 4500)."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from cfepy.evs import packets as evs_packets
from cfepy.fs import HEADER_SIZE, read_header
from cfepy.msg import Command, Layout, command, telemetry
from cfepy.ports import DEBUG, ERROR, INFORMATION
from cfepy.sb import packets as pk
from cfepy.status import CfeError
from tests.requirements.covers import covers
from tests.requirements.flight import POWERON_RESET, PROCESSOR_RESET, Flight

MID, OTHER_MID = 0x0FD1, 0x0FD2
COUNTERS = (
    "CommandCounter",
    "CommandErrorCounter",
    "NoSubscribersCounter",
    "MsgSendErrorCounter",
    "MsgReceiveErrorCounter",
    "CreatePipeErrorCounter",
    "SubscribeErrorCounter",
    "PipeOverflowErrorCounter",
    "MsgLimitErrorCounter",
    "DuplicateSubscriptionsCounter",
)
KEPT = ("PipeOptsErrorCounter", "GetPipeIdByNameErrorCounter")
"""Counters that the reset command leaves, as it does in cFE."""


@pytest.fixture
def flight(fly: Callable[..., Flight]) -> Flight:
    flight = fly(pk.HK_TLM_MID, pk.STATS_TLM_MID, pk.ONESUB_TLM_MID, pk.ALLSUBS_TLM_MID)
    flight.send(evs_packets.ENABLE_EVENT_TYPE, BitMask=0x0F)
    return flight


def pipe(flight: Flight, depth: int = 5, name: str = "PROBE_PIPE") -> int:
    return flight.call(lambda: flight.cfe.sb.create_pipe(depth, name))


def subscribe(flight: Flight, msg_id: int, pipe_id: int, limit: int = 9) -> None:
    flight.call(lambda: flight.cfe.sb.subscribe_ex(msg_id, pipe_id, 0, limit))


def transmit(flight: Flight, msg_id: int, payload: bytes = b"") -> None:
    flight.call(lambda: flight.cfe.sb.transmit_msg(telemetry(msg_id, payload)))


def drain(flight: Flight, pipe_id: int) -> list[bytes]:
    def take() -> list[bytes]:
        return list(iter(lambda: flight.cfe.sb.receive_buffer(pipe_id, 0), None))

    return flight.call(take)


def one_of_each_error(flight: Flight) -> None:
    """Make every counter of housekeeping stand at one."""
    sb = flight.cfe.sb
    full, narrow = pipe(flight, 1, "FULL"), pipe(flight, 5, "NARROW")
    subscribe(flight, MID, full)
    for _ in range(2):
        subscribe(flight, OTHER_MID, narrow, 1)
    for msg_id in (MID, OTHER_MID):
        transmit(flight, msg_id)
        transmit(flight, msg_id)
    bad: list[Callable[[], object]] = [
        lambda: sb.create_pipe(0, "NONE"),
        lambda: sb.subscribe(0, full),
        lambda: sb.receive_buffer(0, 0),
        lambda: sb.get_pipe_opts(0),
        lambda: sb.get_pipe_id_by_name("NONE"),
    ]
    for call in bad:
        with pytest.raises(CfeError):
            flight.call(call)
    transmit(flight, 0x0FD3)
    flight.transmit(bytes(command(pk.CMD_MID, 99)))


def test_cSB4000_noop(flight: Flight) -> None:
    (event,) = flight.send(pk.NOOP)
    assert (event.app, event.event_id, event.event_type) == ("CFE_SB", 28, INFORMATION)
    assert event.text.startswith("No-op Cmd Rcvd: CFE_SB v7.0.0")


@covers("cSB4001", "cSB4005")
def test_cSB4001_counters_are_reported_and_set_to_zero(flight: Flight) -> None:
    flight.send(pk.RESET_COUNTERS)
    flight.send(pk.NOOP)
    one_of_each_error(flight)
    values = flight.ask(pk.SEND_HK, pk.HK_TLM)
    assert {name: values[name] for name in COUNTERS} == dict.fromkeys(COUNTERS, 1) | {"MsgSendErrorCounter": 2}
    assert [values[name] for name in KEPT] == [1, 1]
    assert values["MemPoolHandle"] == flight.cfe.sb.pool_handle == 0x140001
    assert values["MemInUse"] == flight.cfe.sb.pool_use()[0] > 0
    assert values["UnmarkedMem"] == 524288 - flight.cfe.sb.peaks.memory
    (event,) = flight.send(pk.RESET_COUNTERS)
    assert (event.event_id, event.event_type, event.text) == (29, DEBUG, "Reset Counters Cmd Rcvd")
    values = flight.ask(pk.SEND_HK, pk.HK_TLM)
    assert {name: values[name] for name in COUNTERS} == dict.fromkeys(COUNTERS, 0)
    assert [values[name] for name in KEPT] == [1, 1]


def test_cSB4002_statistics(flight: Flight) -> None:
    one, gone = pipe(flight, 7), pipe(flight, name="GONE")
    for each in (one, gone):
        subscribe(flight, MID, each)
    flight.call(lambda: flight.cfe.sb.delete_pipe(gone))
    for _ in range(3):
        transmit(flight, MID)
    drain(flight, one)
    transmit(flight, MID)
    flight.send(pk.SEND_SB_STATS)  # the largest packet of this test, so the peak of the memory stays from here on
    housekeeping = flight.ask(pk.SEND_HK, pk.HK_TLM)
    events = flight.send(pk.SEND_SB_STATS)
    assert [event.text for event in events] == ["Software Bus Statistics packet sent"]
    (values,) = flight.all(pk.STATS_TLM)
    sb = flight.cfe.sb
    assert values["PipesInUse"] == len(sb.pipes) == values["PeakPipesInUse"] - 1
    assert (values["MaxPipesAllowed"], values["MaxMsgIdsAllowed"], values["MaxSubscriptionsAllowed"]) == (64, 256, 4096)
    assert (values["MaxMemAllowed"], values["MaxPipeDepthAllowed"]) == (524288, 50)
    assert values["MsgIdsInUse"] == len(sb.routes) == values["PeakMsgIdsInUse"]
    subscriptions = sum(len(route.destinations) for route in sb.routes.values())
    assert values["SubscriptionsInUse"] == subscriptions == values["PeakSubscriptionsInUse"] - 1
    assert values["MemInUse"] == housekeeping["MemInUse"]
    assert values["PeakMemInUse"] == values["MaxMemAllowed"] - housekeeping["UnmarkedMem"] > values["MemInUse"]
    assert values["SBBuffersInUse"] == 1 < values["PeakSBBuffersInUse"]
    (mine,) = (each for each in values["PipeDepthStats"] if each["PipeId"] == one)
    assert (mine["MaxQueueDepth"], mine["CurrentQueueDepth"], mine["PeakQueueDepth"]) == (7, 1, 3)


SUBTYPES = {pk.WRITE_PIPE_INFO: 20, pk.WRITE_ROUTING_INFO: 21, pk.WRITE_MAP_INFO: 22}


def dumped(flight: Flight, kind: Command, path: str, row: Layout, name: str = "") -> list[dict[str, object]]:
    """Command a file to be written. Returns its rows."""
    flight.send(kind, Filename=name)
    flight.run_for(3)
    data = flight.mission.files.read_file(path)
    header = read_header(data)
    assert (header.content_type, header.length, header.spacecraft_id) == (0x63464531, 64, 66)
    assert header.subtype == SUBTYPES[kind]
    rows = [row.unpack(data, at) for at in range(HEADER_SIZE, len(data), row.size)]
    assert any(
        (event.event_id, event.event_type) == (39, DEBUG) and event.text.startswith(f"{path} written:Size={len(data)},")
        for event in flight.events()
    )
    return rows


@covers("cSB4003", "cSB4003.1")
def test_cSB4003_routing_information_to_a_file(flight: Flight) -> None:
    one = pipe(flight)
    subscribe(flight, MID, one)
    expected = {"MsgId": MID, "PipeId": one, "State": 1, "MsgCnt": 0, "AppName": "PROBE", "PipeName": "PROBE_PIPE"}
    rows = dumped(flight, pk.WRITE_ROUTING_INFO, "/ram/routes.dat", pk.ROUTING_FILE_ENTRY, "routes.dat")
    assert rows[-1] == expected
    flight.send(pk.DISABLE_ROUTE, MsgId=MID, Pipe=one)
    rows = dumped(flight, pk.WRITE_ROUTING_INFO, "/ram/cfe_sb_route.dat", pk.ROUTING_FILE_ENTRY)
    assert rows[-1] == expected | {"State": 0}


@covers("cSB4007", "cSB4007.1")
def test_cSB4007_pipe_information_to_a_file(flight: Flight) -> None:
    one = pipe(flight, 2)
    subscribe(flight, MID, one, 1)
    flight.call(lambda: flight.cfe.sb.set_pipe_opts(one, 1))
    flight.transmit(bytes(telemetry(MID)))
    flight.transmit(bytes(telemetry(MID)))
    for name, path in (("", "/ram/cfe_sb_pipe.dat"), ("/ram/mine", "/ram/mine")):
        rows = dumped(flight, pk.WRITE_PIPE_INFO, path, pk.PIPE_FILE_ENTRY, name)
        (mine,) = (row for row in rows if row["PipeId"] == one)
        assert (mine["PipeName"], mine["AppName"], mine["Opts"]) == ("PROBE_PIPE", "PROBE", 1)
        assert (mine["MaxQueueDepth"], mine["CurrentQueueDepth"], mine["PeakQueueDepth"]) == (2, 1, 1)
        assert (mine["AppId"], mine["SendErrors"]) == (flight.cfe.es.get_app_id_by_name("PROBE"), 1)
        assert len(rows) == len(flight.cfe.sb.pipes)


@covers("cSB4008", "cSB4008.1")
def test_cSB4008_message_map_to_a_file(flight: Flight) -> None:
    for name, path in (("", "/ram/cfe_sb_msgmap.dat"), ("/ram/map.dat", "/ram/map.dat")):
        rows = dumped(flight, pk.WRITE_MAP_INFO, path, pk.MAP_FILE_ENTRY, name)
        assert [row["MsgId"] for row in rows] == list(flight.cfe.sb.routes)
        assert [row["Index"] for row in rows] == list(range(len(rows)))


def test_cSB4004_routes_are_disabled_and_enabled(flight: Flight) -> None:
    one, two = pipe(flight), pipe(flight, name="TWO")
    for each in (one, two):
        subscribe(flight, MID, each)
    (event,) = flight.send(pk.DISABLE_ROUTE, MsgId=MID, Pipe=one)
    assert (event.event_id, event.text) == (37, f"Route Disabled,Msg 0x{MID:x},Pipe {one}")
    transmit(flight, MID)
    assert (len(drain(flight, one)), len(drain(flight, two))) == (0, 1)
    (event,) = flight.send(pk.ENABLE_ROUTE, MsgId=MID, Pipe=one)
    assert (event.event_id, event.text) == (34, f"Enabling Route,Msg 0x{MID:x},Pipe {one}")
    transmit(flight, MID)
    assert (len(drain(flight, one)), len(drain(flight, two))) == (1, 1)


def test_cSB4009_valid_commands_are_counted(flight: Flight) -> None:
    one = pipe(flight)
    subscribe(flight, MID, one)
    for kind, fields in (
        (pk.NOOP, {}),
        (pk.SEND_SB_STATS, {}),
        (pk.DISABLE_ROUTE, {"MsgId": MID, "Pipe": one}),
        (pk.ENABLE_ROUTE, {"MsgId": MID, "Pipe": one}),
        (pk.WRITE_MAP_INFO, {}),
        (pk.WRITE_PIPE_INFO, {}),
        (pk.WRITE_ROUTING_INFO, {}),
    ):
        before = flight.ask(pk.SEND_HK, pk.HK_TLM)
        flight.send(kind, **fields)
        flight.run_for(3)  # one file at a time
        after = flight.ask(pk.SEND_HK, pk.HK_TLM)
        assert after["CommandCounter"] == before["CommandCounter"] + 1, kind
        assert after["CommandErrorCounter"] == before["CommandErrorCounter"], kind


@pytest.mark.parametrize(
    ("packet", "event_id", "text"),
    [
        (command(pk.CMD_MID, 99), 42, "Invalid Cmd, Unexpected Command Code 99"),
        (command(pk.SUB_RPT_CTRL_MID, 0), 42, "Invalid Cmd, Unexpected Command Code 0"),
        (command(pk.CMD_MID, 0, b"x"), 68, "Invalid msg length: ID = 0x1803,  CC = 0, Len = 9, Expected = 8"),
        (pk.ENABLE_ROUTE.packet(MsgId=MID), 35, f"Enbl Route Cmd:Invalid Param.Msg 0x{MID:x},Pipe 0"),
        (pk.DISABLE_ROUTE.packet(MsgId=MID), 38, f"Disable Route Cmd:Invalid Param.Msg 0x{MID:x},Pipe 0"),
        (
            pk.ENABLE_ROUTE.packet(MsgId=MID, Pipe=0x160001),
            33,
            f"Enbl Route Cmd:Route does not exist.Msg 0x{MID:x},Pipe 1441793",
        ),
        (
            pk.DISABLE_ROUTE.packet(MsgId=MID, Pipe=0x160001),
            36,
            f"Disable Route Cmd:Route does not exist,Msg 0x{MID:x},Pipe 1441793",
        ),
        (pk.WRITE_PIPE_INFO.packet(Filename="/ram/"), 40, "Error creating file /ram/, stat=0xc6000002"),
    ],
)
def test_cSB4010_invalid_commands_are_counted(flight: Flight, packet: bytes, event_id: int, text: str) -> None:
    before = flight.ask(pk.SEND_HK, pk.HK_TLM)
    flight.packets.clear()
    flight.transmit(bytes(packet))
    assert [(event.event_id, event.event_type, event.text) for event in flight.events()] == [(event_id, ERROR, text)]
    after = flight.ask(pk.SEND_HK, pk.HK_TLM)
    assert after["CommandErrorCounter"] == before["CommandErrorCounter"] + 1
    assert after["CommandCounter"] == before["CommandCounter"]


@covers("cSB4011", "cSB4012")
def test_cSB4011_subscriptions_are_reported_while_that_is_enabled(flight: Flight) -> None:
    one = pipe(flight)
    flight.send(pk.ENABLE_SUB_REPORTING)
    flight.call(lambda: flight.cfe.sb.subscribe_ex(MID, one, 0x0201, 4))
    quality = {"Priority": 1, "Reliability": 2}
    assert flight.all(pk.ONESUB_TLM) == [{"SubType": 0, "MsgId": MID, "Qos": quality, "Pipe": one}]
    assert flight.events()[-1].text == f"Sending Subscription Report Msg=0x{MID:x},Pipe={one},Stat=0x0"
    flight.send(pk.DISABLE_SUB_REPORTING)
    subscribe(flight, OTHER_MID, one)
    assert flight.all(pk.ONESUB_TLM) == []


def test_cSB4013_previous_subscriptions(flight: Flight) -> None:
    one = pipe(flight)
    flight.call(lambda: flight.cfe.sb.subscribe_local(MID, one, 4))
    for number in range(20):
        subscribe(flight, OTHER_MID + number, one)
    flight.send(pk.SEND_PREV_SUBS)
    packets = flight.all(pk.ALLSUBS_TLM)
    told = [entry["MsgId"] for packet in packets for entry in packet["Entry"][: packet["Entries"]]]
    assert [packet["PktSegment"] for packet in packets] == list(range(1, len(packets) + 1))
    assert [packet["Entries"] for packet in packets[:-1]] == [20] * (len(packets) - 1)
    assert {0x1801, 0x1803, 0x1806, 0x0808, *(OTHER_MID + number for number in range(20))} <= set(told)
    assert MID not in told, "nobody else needs what is local"
    assert len(set(told)) == len(told)
    texts = [event.text for event in flight.events()]
    assert texts[0] == "Full Sub Pkt 1 Sent,Entries=20,Stat=0x0"
    assert texts[-1] == f"Partial Sub Pkt {len(packets)} Sent,Entries={packets[-1]['Entries']},Stat=0x0"


@covers("cSB4500", "cSB4501")
@pytest.mark.parametrize("kind", [POWERON_RESET, PROCESSOR_RESET])
def test_cSB4500_routes_and_counters_are_empty_after_a_reset(flight: Flight, kind: bytes) -> None:
    before = set(flight.cfe.sb.routes)
    one_of_each_error(flight)
    assert {MID, OTHER_MID} <= set(flight.cfe.sb.routes)
    flight.reset(kind)
    assert set(flight.cfe.sb.routes) == before
    values = flight.ask(pk.SEND_HK, pk.HK_TLM)
    assert {values[name] for name in (*COUNTERS, *KEPT) if name != "NoSubscribersCounter"} == {0}
    transmit(flight, MID)
    assert flight.ask(pk.SEND_HK, pk.HK_TLM)["NoSubscribersCounter"] == values["NoSubscribersCounter"] + 1
