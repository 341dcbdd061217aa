"""TO_LAB seen from the ground: its table, its commands, its packets."""

from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path

import pytest

from apps.ci_lab import packets as ci_lab
from apps.to_lab import packets as pk
from apps.to_lab.tables import to_lab_sub
from cfepy.msg import Command, Layout, Telemetry, telemetry
from cfepy.status import CFE_SB_BAD_ARGUMENT
from cfepy.tbl import build
from tests.apps.lab import Lab, lab
from tests.layouts import assert_same

DATA = Path(__file__).parents[1] / "data"
APP = Path(to_lab_sub.__file__).parent
ENABLE = pk.OUTPUT_ENABLE.packet(dest_IP="127.0.0.1")
SPY = Telemetry("SPY", 0x08F1)
SUBSCRIBE_SPY = pk.ADD_PKT.packet(Stream=SPY.msg_id, BufLimit=7)


@pytest.fixture
def session(tmp_path: Path) -> Iterator[Lab]:
    with lab(tmp_path) as made:
        yield made


def spy(session: Lab, count: int) -> int:
    """Send packets of a MsgId from inside the mission. Returns how many arrived on the ground."""
    for number in range(count):
        session.mission.cfe.sb.transmit_msg(bytes(telemetry(SPY.msg_id, bytes([number]))))
    session.mission.run_for(0.6)
    return len(session.packets(SPY))


@pytest.mark.parametrize(
    ("layout", "c_name"),
    [(pk.ENABLE_OUTPUT, "TO_LAB_EnableOutput_Payload_t"), (pk.SUBSCRIPTION, "TO_LAB_Sub_t")],
    ids=["EnableOutput", "Sub"],
)
def test_layouts(layout: Layout, c_name: str) -> None:
    assert_same(layout, c_name)


def test_packets_are_as_long_as_the_recorded_ones() -> None:
    recorded = json.loads((DATA / "packets.json").read_text(encoding="utf-8"))
    lengths = {(row["mid"], row.get("fc")): len(row["hex"]) // 2 for kind in recorded.values() for row in kind}
    for packet in (pk.NOOP, pk.ADD_PKT, pk.SEND_DATA_TYPES, pk.OUTPUT_ENABLE):
        assert packet.length == lengths[packet.msg_id, packet.code]
    for sent in (pk.HK_TLM, pk.DATA_TYPES_TLM):
        assert sent.length == lengths[sent.msg_id, None]


def test_the_default_table_is_nasas() -> None:
    assert build(to_lab_sub.image()) == (DATA / "to_lab_sub.tbl").read_bytes()
    assert (APP / "to_lab_sub.tbl").read_bytes() == (DATA / "to_lab_sub.tbl").read_bytes()


def test_nothing_comes_down_before_output_is_enabled(session: Lab) -> None:
    assert session.ground.received() == []
    assert session.events(ENABLE) == ["TO_LAB 3: TO telemetry output enabled for IP 127.0.0.1"]
    assert session.ground.received()[0][1][:2] == b"\x08\x08"


def test_packets_leave_every_500_ms_in_the_order_of_the_bus(session: Lab) -> None:
    session.events(ENABLE)
    session.ground.received()
    session.mission.run_until(4_000_000_000)
    for request in (pk.SEND_HK, ci_lab.SEND_HK, ci_lab.SEND_HK):
        session.mission.cfe.sb.transmit_msg(request.packet())
    session.mission.run_for(1.2)
    down = session.ground.received()
    assert [packet[:2].hex() for _, packet in down] == ["0884", "0884", "0880"]
    times = [time // 1_000_000 for time, _ in down]
    assert {(time - times[0]) % 500 for time in times} == {0}


def test_counters(session: Lab) -> None:
    unknown = Command("UNKNOWN", pk.CMD_MID, 7).packet()
    session.events(ENABLE)
    assert session.events(unknown, app="TO_LAB") == [
        "TO_LAB 9: L76 TO: Invalid Function Code Rcvd In Ground Command 0x7"
    ]
    assert session.latest(pk.HK_TLM, pk.NOOP.packet(), pk.SEND_HK.packet()) == {
        "CommandCounter": 2,
        "CommandErrorCounter": 1,
        "spareToAlign": [0, 0],
    }
    assert session.events(pk.RESET_STATUS.packet(), app="TO_LAB") == ["TO_LAB 13: Reset counters command"]
    fields = session.latest(pk.HK_TLM, pk.SEND_HK.packet())
    assert (fields["CommandCounter"], fields["CommandErrorCounter"]) == (0, 0)


def test_the_packet_of_all_data_types(session: Lab) -> None:
    rows = json.loads((DATA / "packets.json").read_text(encoding="utf-8"))["telemetry"]
    recorded = next(bytes.fromhex(row["hex"]) for row in rows if row["mid"] == pk.DATA_TYPES_MID)
    session.events(ENABLE, pk.SEND_DATA_TYPES.packet(), seconds=2)
    (packet,) = session.packets(pk.DATA_TYPES_TLM)
    assert packet[16:] == recorded[16:]
    assert packet[:2] + packet[4:6] == recorded[:2] + recorded[4:6]


def test_adding_and_removing_a_packet(session: Lab) -> None:
    session.events(ENABLE)
    assert spy(session, 2) == 0
    assert session.events(SUBSCRIBE_SPY, app="TO_LAB") == ["TO_LAB 15: L172 TO AddPkt 0x8f1, QoS 0.0, limit 7"]
    assert spy(session, 9) == 7
    remove = pk.REMOVE_PKT.packet(Stream=SPY.msg_id)
    assert session.events(remove, app="TO_LAB") == ["TO_LAB 16: L196 TO RemovePkt 0x8f1"]
    assert spy(session, 2) == 0


def test_invalid_message_id_is_reported_when_added_or_removed(session: Lab) -> None:
    status = CFE_SB_BAD_ARGUMENT
    add, remove = pk.ADD_PKT.packet(Stream=0x2000), pk.REMOVE_PKT.packet(Stream=0)
    assert session.events(add, app="TO_LAB") == [f"TO_LAB 10: L169 TO Can't subscribe 0x2000 status {status}"]
    assert session.events(remove, app="TO_LAB") == [
        f"TO_LAB 11: L193 TO Can't Unsubscribe to Stream 0x0, status {status}"
    ]


def test_removing_all_packets_of_the_table(session: Lab) -> None:
    session.events(ENABLE, SUBSCRIBE_SPY)
    events = session.events(pk.REMOVE_ALL_PKT.packet(), app="TO_LAB")
    assert events == ["TO_LAB 17: L228 TO Unsubscribed to all Commands and Telemetry"]
    session.ground.received()
    assert session.events(pk.NOOP.packet(), pk.SEND_HK.packet(), app="TO_LAB")
    assert session.packets(pk.HK_TLM) == []
    assert spy(session, 1) == 1


def test_fifty_packets_in_a_round(session: Lab) -> None:
    subscribe = [pk.ADD_PKT.packet(Stream=0x0900 + number, BufLimit=50) for number in range(3)]
    session.events(ENABLE, *subscribe)
    session.ground.received()
    for number in range(3):
        for _ in range(20):
            session.mission.cfe.sb.transmit_msg(bytes(telemetry(0x0900 + number)))
    session.mission.run_for(0.6)
    assert len(session.ground.received()) == 50  # as many as the pipe holds


@pytest.mark.parametrize("host", ["10.0.0.7", "127.0.0.1"])
def test_ground_receives_packets_for_any_address(session: Lab, host: str) -> None:
    session.events(pk.OUTPUT_ENABLE.packet(dest_IP=host))
    assert session.ground.received()


def test_host_name_that_is_not_an_address_stands_for_the_local_host(session: Lab) -> None:
    seen = []
    session.mission.network.outlets.append(seen.append)
    session.events(pk.OUTPUT_ENABLE.packet(dest_IP="ground"))
    assert {datagram.target for datagram in seen} == {("0.0.0.0", 1235)}


def test_a_command_that_is_too_short_is_filled_up_with_zeros(session: Lab) -> None:
    short = Command("SHORT", pk.CMD_MID, pk.REMOVE_PKT.code).packet()
    expected = f"TO_LAB 11: L193 TO Can't Unsubscribe to Stream 0x0, status {CFE_SB_BAD_ARGUMENT}"
    assert session.events(short, app="TO_LAB") == [expected]


def test_a_missing_table_ends_the_app(tmp_path: Path) -> None:
    (tmp_path / "to_lab_sub.tbl").write_bytes(b"no table")
    with lab(tmp_path) as session:
        session.mission.run_for(3)
        lines = session.mission.console.lines
        assert any("TO_LAB 19: L156 TO Can't load table status" in line for line in lines)
        assert lines.count("TO delete callback -- Closing TO Network socket.") == 1
