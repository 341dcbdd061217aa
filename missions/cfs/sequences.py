"""SC's sequences that the other files here write: commands, each some wake-ups (s) after the one before."""

from __future__ import annotations

from cfepy.msg import command
from cfepy.tbl import TableImage

SEQUENCE_SIZE = 300  # bytes
LC_CMD, DS_CMD, SC_CMD, FM_CMD, POWER_CMD = 0x18A4, 0x18BB, 0x18A9, 0x188C, 0x18D0


def image(number: int, steps: list[tuple[int, int, int, bytes]]) -> TableImage:
    """The table of a sequence.

    Args:
        number: of the sequence, from 1 on.
        steps: (wake-ups, MsgId, function code, payload) of each command.
    """
    data = b""
    for wakeups, msg_id, code, payload in steps:
        packet = bytes(command(msg_id, code, payload))
        data += wakeups.to_bytes(4, "little") + packet + bytes(-len(packet) % 4)
    return TableImage(f"SC.RTS_TBL{number:03}", data.ljust(SEQUENCE_SIZE, b"\0"), f"Sequence {number}")
