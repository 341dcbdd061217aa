"""Message ids of packets (message_id_test.c)."""

from __future__ import annotations

from cfepy.app import Cfe
from cfepy.status import CFE_MSG_BAD_ARGUMENT
from tests.functional.harness import CMD_MID, TLM_MID, status_of

ALL_BITS = 0xFFFFFFFF


def test_set_get_message_id(cfe: Cfe) -> None:
    packet = bytearray(8)
    cfe.msg.set_msg_id(packet, 1)
    assert cfe.msg.get_msg_id(packet) == 1
    assert status_of(cfe.msg.set_msg_id, packet, ALL_BITS) == CFE_MSG_BAD_ARGUMENT
    assert cfe.msg.get_msg_id(packet) == 1


def test_get_type_from_message_id(cfe: Cfe) -> None:
    get_type = cfe.msg.get_type_from_msg_id
    assert get_type(CMD_MID) == cfe.msg.MsgType.CMD
    assert get_type(TLM_MID) == cfe.msg.MsgType.TLM
    assert status_of(get_type, 0) == CFE_MSG_BAD_ARGUMENT
    assert status_of(get_type, ALL_BITS) == CFE_MSG_BAD_ARGUMENT
