"""Headers against real packets."""

from __future__ import annotations

from typing import Any

import pytest

from cfepy import msg
from cfepy.msg import Layout
from tests.msg.golden import golden_commands, golden_telemetry


@pytest.mark.parametrize("golden", golden_commands(), ids=lambda golden: str(golden["desc"])[:40])
def test_commands(golden: dict[str, Any]) -> None:
    packet = bytes.fromhex(golden["hex"])
    assert msg.get_msg_id(packet) == golden["mid"]
    assert msg.get_fcn_code(packet) == golden["fc"]
    assert msg.get_size(packet) == len(packet) == golden["length"]
    assert msg.get_type(packet) is msg.get_type_from_msg_id(golden["mid"]) is msg.MsgType.CMD
    again = bytearray(packet)
    msg.generate_checksum(again)
    assert (again == packet) == msg.validate_checksum(packet)


def test_commands_are_built_byte_for_byte() -> None:
    for golden in golden_commands():
        packet = bytes.fromhex(golden["hex"])
        built = msg.command(golden["mid"], golden["fc"], packet[msg.CMD_HEADER_SIZE :])
        msg.set_sequence_count(built, msg.get_sequence_count(packet))
        if msg.validate_checksum(packet):
            msg.generate_checksum(built)
            assert built == packet


@pytest.mark.parametrize("golden", golden_telemetry(), ids=lambda golden: f"{golden['desc']}-{golden['seq']}")
def test_telemetry(golden: dict[str, Any]) -> None:
    packet = bytes.fromhex(golden["hex"])
    assert msg.get_msg_id(packet) == golden["mid"]
    assert msg.get_sequence_count(packet) == golden["seq"]
    assert msg.get_size(packet) == len(packet) == golden["length"]
    assert msg.get_msg_time(packet) == (golden["time_sec"], golden["time_sub16"] << 16)
    built = msg.telemetry(golden["mid"], bytes(msg.get_user_data(packet)))
    msg.set_sequence_count(built, golden["seq"])
    msg.origination_action(built, golden["time_sec"] << 16 | golden["time_sub16"])
    assert built == packet


def test_a_long_event_unpacks_and_packs() -> None:
    packet_id = Layout(
        "CFE_EVS_PacketID_t",
        [
            ("AppName", "char[20]"),
            ("EventID", "u16"),
            ("EventType", "u16"),
            ("SpacecraftID", "u32"),
            ("ProcessorID", "u32"),
        ],
    )
    event = Layout(
        "CFE_EVS_LongEventTlm_Payload_t",
        [("PacketID", packet_id), ("Message", "char[122]"), ("Spare1", "u8"), ("Spare2", "u8")],
    )
    for golden in golden_telemetry():
        if golden["mid"] != 0x0808:
            continue
        packet = bytes.fromhex(golden["hex"])
        values = event.unpack(packet, msg.TLM_HEADER_SIZE)
        assert values["PacketID"]["AppName"] == golden["event"]["app"]
        assert values["PacketID"]["EventID"] == golden["event"]["eid"]
        assert values["Message"] == golden["event"]["text"]
        assert event.pack(values) == packet[msg.TLM_HEADER_SIZE :]
