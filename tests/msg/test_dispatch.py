"""The command table's three checks."""

from __future__ import annotations

import pytest

from cfepy import msg
from cfepy.msg import CommandTable, dispatch
from cfepy.status import CfeError


def table() -> tuple[CommandTable, list[bytes]]:
    seen: list[bytes] = []
    commands = CommandTable()
    commands.add(0x1806, 0, 8, lambda packet: seen.append(packet))
    commands.add(0x1806, 3, 10, lambda packet: "reply")
    commands.add_message(0x1808, 8, lambda packet: seen.append(packet))
    commands.add_message(0x0811, 0, lambda packet: seen.append(packet))
    return commands, seen


def test_valid_packets_reach_their_handler() -> None:
    commands, seen = table()
    noop = bytes(msg.command(0x1806, 0))
    assert commands.dispatch(noop) == (dispatch.DONE, 0x1806, 0, 8, 8, None)
    assert commands.dispatch(bytes(msg.command(0x1806, 3, b"ab"))).result == "reply"
    assert commands.dispatch(bytes(msg.command(0x1808, 0))).outcome == dispatch.DONE
    assert commands.dispatch(bytes(msg.telemetry(0x0811, b"any"))).outcome == dispatch.DONE
    assert seen[0] == noop
    assert len(seen) == 3


def test_invalid_packets_are_distinguished() -> None:
    commands, seen = table()
    assert commands.dispatch(bytes(msg.command(0x1807, 5))) == (dispatch.BAD_MSG_ID, 0x1807, 5, 8, 0, None)
    assert commands.dispatch(bytes(msg.command(0x1806, 99))) == (dispatch.BAD_CODE, 0x1806, 99, 8, 0, None)
    assert commands.dispatch(bytes(msg.command(0x1806, 0, b"x"))) == (dispatch.BAD_LENGTH, 0x1806, 0, 9, 8, None)
    assert commands.dispatch(bytes(msg.command(0x1808, 0, b"x"))).outcome == dispatch.BAD_LENGTH
    assert seen == []


def test_second_handler_is_refused() -> None:
    commands, _ = table()
    with pytest.raises(CfeError, match="already has a handler"):
        commands.add(0x1806, 0, 8, print)
    with pytest.raises(CfeError, match="already has a handler"):
        commands.add(0x1808, 0, 8, print)
    with pytest.raises(CfeError, match="already has a handler"):
        commands.add_message(0x1806, 8, print)


def test_function_code_is_read_from_a_packet_of_7_bytes() -> None:
    """A length field of 0 leaves 7 bytes. NASA's code reads the function code nevertheless."""
    codes: list[bytes] = []
    table = CommandTable()
    table.add(0x1880, 1, 0, codes.append)
    packet = bytes.fromhex("1880c000000001")
    assert table.dispatch(packet).outcome == dispatch.DONE
    assert codes == [packet]
    assert msg.get_fcn_code(packet) == 1


def test_message_without_codes_reports_its_function_code() -> None:
    """As the events of NASA's services about its length do."""
    table = CommandTable()
    table.add_message(0x180C, 8, print)
    done = table.dispatch(bytes.fromhex("180cc0000029074b").ljust(48, b"\0"))
    assert (done.outcome, done.fcn_code) == (dispatch.BAD_LENGTH, 7)
