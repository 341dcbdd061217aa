"""The schedule table: its layout (sch_lab_tbl.h), and the commands that it makes."""

from __future__ import annotations

from cfepy.msg import Layout, command
from cfepy.tbl import TableImage, TableType

MAX_ENTRIES = 32
MAX_PAYLOAD = 64

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
        """Count a tick; whether the command is due now."""
        self._ticks += 1
        if self._ticks < self._period:
            return False
        self._ticks = 0
        return True


def read(table: bytes | memoryview) -> tuple[int, list[ScheduleEntry]]:
    """The tick rate of a schedule table and its entries that are in use, in table order.

    Raises:
        CfeError: CFE_MSG_BAD_ARGUMENT when an entry's message id or function code cannot be.
    """
    values = TABLE.unpack(table)
    entries = []
    for row in values["Config"]:
        if row["PacketRate"]:
            payload = bytes(row["MessageBuffer"][: row["PayloadLength"]])
            packet = command(row["MessageID"], row["FcnCode"], payload)
            entries.append(ScheduleEntry(bytes(packet), row["PacketRate"]))
    return values["TickRate"], entries


def image(tick_rate: int, rows: list[tuple[int, int, int, bytes]]) -> TableImage:
    """A schedule table's file.

    Args:
        tick_rate: ticks a second.
        rows: (message id, period in ticks, function code, payload) of each command.

    Raises:
        UsageError: too many rows, or a value that does not fit.
    """
    config = [
        {"MessageID": mid, "PacketRate": period, "FcnCode": code, "PayloadLength": len(data), "MessageBuffer": data}
        for mid, period, code, data in rows
    ]
    return SCHEDULE_TABLE.image({"TickRate": tick_rate, "Config": config})
