"""The schedule table: its layout (sch_lab_tbl.h), and the commands that it makes."""

from __future__ import annotations

from contextlib import suppress
from struct import Struct
from typing import Any

from cfepy.msg import CMD_HEADER_SIZE, PRIMARY_HEADER_SIZE, Layout, init, is_valid_msg_id, set_fcn_code
from cfepy.status import CfeError
from cfepy.tbl import TableImage, TableType

MAX_ENTRIES = 32
MAX_PAYLOAD = 64
DEFAULT_MSG_ID = 0x800
"""What CFE_MSG_Init leaves in a header whose MsgId cannot be: the flag of a secondary header."""
LEAST_SIZE = PRIMARY_HEADER_SIZE + 1
_BEHIND_PAYLOAD = Struct("<HxxII")
"""PayloadLength, PacketRate and Counter of SCH_LAB_StateEntry_t."""

ENTRY = Layout(
    "SCH_LAB_ScheduleTableEntry_t",
    [
        ("MessageID", "u32"),
        ("PacketRate", "u32"),
        ("FcnCode", "u16"),
        ("PayloadLength", "u16"),
        ("MessageBuffer", f"u8[{MAX_PAYLOAD}]"),
    ],
)
"""PacketRate is a period: the command goes out every so many ticks; 0 for never. The payload is bytes here, in C
16-bit words; the memory is the same."""

TABLE = Layout("SCH_LAB_ScheduleTable_t", [("TickRate", "u32"), ("Config", (ENTRY, MAX_ENTRIES))])
"""TickRate is in ticks a second."""

SCHEDULE_TABLE = TableType(
    "SCH_LAB.ScheduleTable", TABLE, file="/cf/sch_lab_table.tbl", description="Schedule Lab MsgID Table"
)
TABLES = (SCHEDULE_TABLE,)


class ScheduleEntry:
    """One command and when it is due.

    Args:
        packet: the whole command.
        period: ticks.
    """

    __slots__ = ("_period", "_ticks", "packet")

    def __init__(self, packet: bytes, period: int) -> None:
        self.packet = packet
        self._period = period
        self._ticks = 0

    def tick(self) -> bool:
        """Count a tick. Returns whether the command is due now."""
        self._ticks += 1
        if self._ticks < self._period:
            return False
        self._ticks = 0
        return True


def read(table: bytes | memoryview) -> tuple[int, list[ScheduleEntry]]:
    """Return the tick rate of a schedule table and its entries that are in use, in table order."""
    values = TABLE.unpack(table)
    rows = [row for row in values["Config"] if row["PacketRate"]]
    return values["TickRate"], [ScheduleEntry(_message(row), row["PacketRate"]) for row in rows]


def _message(row: dict[str, Any]) -> bytes:
    """Make the message of an entry with CFE_MSG_Init and CFE_MSG_SetFcnCode. SCH_LAB ignores their status.

    If a payload is longer than its field, the bytes behind it are the rest of the entry.
    """
    msg_id, length = row["MessageID"], row["PayloadLength"]
    if not is_valid_msg_id(msg_id):
        return bytes(init(DEFAULT_MSG_ID, LEAST_SIZE))
    try:
        packet = init(msg_id, CMD_HEADER_SIZE + length)
    except CfeError:  # the length does not fit into a header
        return bytes(init(msg_id, LEAST_SIZE))
    memory = bytes(row["MessageBuffer"]) + _BEHIND_PAYLOAD.pack(length, row["PacketRate"], 0)
    packet[CMD_HEADER_SIZE:] = memory[:length].ljust(length, b"\0")
    with suppress(CfeError):
        set_fcn_code(packet, row["FcnCode"])
    return bytes(packet)


def image(tick_rate: int, rows: list[tuple[int, int, int, bytes]]) -> TableImage:
    """Return the file of a schedule table.

    Args:
        tick_rate: ticks per second.
        rows: (message id, period in ticks, function code, payload) of each command.

    Raises:
        UsageError: too many rows, or a value that does not fit.
    """
    config = [
        {"MessageID": mid, "PacketRate": period, "FcnCode": code, "PayloadLength": len(data), "MessageBuffer": data}
        for mid, period, code, data in rows
    ]
    return SCHEDULE_TABLE.image({"TickRate": tick_rate, "Config": config})
