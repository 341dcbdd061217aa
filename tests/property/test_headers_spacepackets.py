"""Headers agree with an independent implementation, the spacepackets library, on every field."""

from __future__ import annotations

from hypothesis import given
from hypothesis import strategies as st
from spacepackets.ccsds.spacepacket import (  # type: ignore[import-untyped]  # it ships no types
    PacketType,
    SequenceFlags,
    SpacePacket,
    SpacePacketHeader,
)

from cfepy import msg
from cfepy.msg import MsgType, SegmentationFlag
from cfepy.status import CfeError

FLAGS = {
    SegmentationFlag.CONTINUE: SequenceFlags.CONTINUATION_SEGMENT,
    SegmentationFlag.FIRST: SequenceFlags.FIRST_SEGMENT,
    SegmentationFlag.LAST: SequenceFlags.LAST_SEGMENT,
    SegmentationFlag.UNSEGMENTED: SequenceFlags.UNSEGMENTED,
}


@given(
    version=st.integers(0, 7),
    msg_type=st.sampled_from([MsgType.CMD, MsgType.TLM]),
    secondary=st.booleans(),
    ap_id=st.integers(0, 0x7FF),
    flag=st.sampled_from(list(FLAGS)),
    count=st.integers(0, 0x3FFF),
    size=st.integers(7, 65542),
)
def test_headers_have_the_bytes_of_spacepackets(
    version: int, msg_type: MsgType, secondary: bool, ap_id: int, flag: SegmentationFlag, count: int, size: int
) -> None:
    packet = bytearray(6)
    msg.set_header_version(packet, version)
    msg.set_type(packet, msg_type)
    msg.set_has_secondary_header(packet, secondary)
    msg.set_ap_id(packet, ap_id)
    msg.set_segmentation_flag(packet, flag)
    msg.set_sequence_count(packet, count)
    msg.set_size(packet, size)
    other = SpacePacketHeader(
        packet_type=PacketType.TC if msg_type is MsgType.CMD else PacketType.TM,
        apid=ap_id,
        seq_count=count,
        data_len=size - 7,
        sec_header_flag=secondary,
        seq_flags=FLAGS[flag],
        ccsds_version=version,
    )
    assert bytes(packet) == bytes(other.pack())
    assert msg.get_header_version(packet) == version
    assert msg.get_type(packet) is msg_type
    assert msg.get_has_secondary_header(packet) is secondary
    assert msg.get_ap_id(packet) == ap_id
    assert msg.get_segmentation_flag(packet) is flag
    assert msg.get_sequence_count(packet) == count
    assert msg.get_size(packet) == size


@given(
    msg_id=st.integers(1, 0x1FFF),
    flag=st.sampled_from(list(FLAGS)),
    count=st.integers(0, 0x3FFF),
    body=st.binary(min_size=1, max_size=300),
)
def test_packet_of_any_valid_msg_id_survives_a_round_trip(
    msg_id: int, flag: SegmentationFlag, count: int, body: bytes
) -> None:
    packet = msg.init(msg_id, 6 + len(body))
    packet[6:] = body
    msg.set_segmentation_flag(packet, flag)
    msg.set_sequence_count(packet, count)
    theirs = SpacePacketHeader.unpack(bytes(packet))
    assert (theirs.ccsds_version, theirs.packet_type) == (0, PacketType(msg_id >> 12))
    assert (theirs.sec_header_flag, theirs.apid) == (bool(msg_id & 0x800), msg_id & 0x7FF)
    assert (theirs.seq_flags, theirs.seq_count, theirs.packet_len) == (FLAGS[flag], count, len(packet))
    again = bytes(SpacePacket(theirs, body[:0], body).pack())
    assert again == packet
    assert (msg.get_msg_id(again), msg.get_segmentation_flag(again)) == (msg_id, flag)
    assert (msg.get_sequence_count(again), msg.get_size(again)) == (count, len(again))


@given(st.integers(0x1800, 0x1FFF), st.integers(0, 127), st.binary(max_size=200))
def test_headers_of_commands_and_telemetry_are_read_by_spacepackets(msg_id: int, code: int, payload: bytes) -> None:
    for packet, kind in (
        (msg.command(msg_id, code, payload), PacketType.TC),
        (msg.telemetry(msg_id & 0x0FFF, payload), PacketType.TM),
    ):
        theirs = SpacePacketHeader.unpack(bytes(packet))
        assert (theirs.packet_type, theirs.apid, theirs.packet_len) == (kind, msg_id & 0x7FF, len(packet))
        assert (theirs.sec_header_flag, theirs.seq_flags) == (True, SequenceFlags.UNSEGMENTED)
        assert bytes(theirs.pack()) == packet[:6]


@given(st.integers(0x1800, 0x1FFF), st.integers(0, 127), st.binary(max_size=200))
def test_checksum_of_a_command_detects_a_flipped_bit(msg_id: int, code: int, payload: bytes) -> None:
    packet = msg.command(msg_id, code, payload)
    assert msg.validate_checksum(packet)
    packet[len(packet) - 1] ^= 0x40
    assert not msg.validate_checksum(packet)


@given(st.binary(max_size=20))
def test_getters_raise_only_cfe_errors(data: bytes) -> None:
    for getter in (msg.get_msg_id, msg.get_size, msg.get_fcn_code, msg.get_msg_time, msg.validate_checksum):
        try:
            getter(data)
        except CfeError:
            continue
