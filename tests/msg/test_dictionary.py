"""Declared commands and telemetry."""

from __future__ import annotations

import pytest

from cfepy import msg
from cfepy.msg import Command, CommandTable, Layout, Telemetry, dispatch
from cfepy.status import UsageError

NOOP = Command("APP_NOOP", 0x1882, 0)
SET = Command("APP_SET", 0x1882, 3, Layout("Set", [("Value", "u16")]))
SEND_HK = Command("APP_SEND_HK", 0x1883)
HK = Telemetry("APP_HK_TLM", 0x0883, Layout("Hk", [("Count", "u32")]))


def test_packet_and_read_are_inverse() -> None:
    packet = SET.packet(Value=513)
    assert packet == bytes(msg.command(0x1882, 3, b"\x01\x02"))
    assert SET.read(packet) == {"Value": 513}
    assert (NOOP.length, SET.length, HK.length) == (8, 10, 20)
    assert HK.packet(Count=7) == bytes(msg.telemetry(0x0883, b"\x07\0\0\0"))
    assert HK.read(HK.packet({"Count": 7})) == {"Count": 7}


def test_unknown_field_is_refused() -> None:
    with pytest.raises(UsageError, match="unknown field"):
        NOOP.packet(Value=1)


def test_declared_commands_are_dispatched_by_code_and_length() -> None:
    commands, seen = CommandTable(), list[bytes]()
    for command in (NOOP, SET, SEND_HK):
        commands.handle(command, seen.append)
    assert commands.dispatch(SET.packet(Value=1)).outcome == dispatch.DONE
    assert commands.dispatch(SEND_HK.packet()).outcome == dispatch.DONE
    assert commands.dispatch(NOOP.packet() + b"x").outcome == dispatch.BAD_LENGTH
    assert len(seen) == 2


def test_handler_may_accept_packets_of_any_length() -> None:
    table = CommandTable((NOOP, len))
    for declared in (SET, SEND_HK):
        table.handle(declared, len, any_length=True)
    assert [table.dispatch(each.packet() + b"x").outcome for each in (NOOP, SET, SEND_HK)] == [
        dispatch.BAD_LENGTH,
        dispatch.DONE,
        dispatch.DONE,
    ]
