"""LC's watchpoints: a value in a packet, and the value that it is compared with.

After a change, `python lc_def_wdt.py` writes lc_def_wdt.tbl anew.
"""

from __future__ import annotations

from cfepy.msg import Layout
from cfepy.tbl import TableImage, TableType, write_beside

WATCHPOINT = Layout(
    "LC_WDTEntry_t",
    [
        ("DataType", "u8"),
        ("OperatorID", "u8"),
        ("MessageID", "u32"),
        ("WatchpointOffset", "u32"),
        ("BitMask", "u32"),
        ("ComparisonValue", "u32"),
        ("ResultAgeWhenStale", "u32"),
        ("CustomFuncArgument", "u32"),
    ],
)
WATCHPOINTS = 176
TABLE = TableType("LC.LC_WDT", WATCHPOINT, rows=WATCHPOINTS, description="Watchpoints")
NOT_USED, ALL_BITS = 0xFF, 0xFFFFFFFF
UNSIGNED_16_LE, LESS_THAN = 6, 1
POWER_HK, CHARGE, LOWEST_CHARGE = 0x08D0, 16, 40  # MsgId, byte in the packet, percent

USED = [
    {
        "DataType": UNSIGNED_16_LE,
        "OperatorID": LESS_THAN,
        "MessageID": POWER_HK,
        "WatchpointOffset": CHARGE,
        "BitMask": ALL_BITS,
        "ComparisonValue": LOWEST_CHARGE,
    }
]


def image() -> TableImage:
    """The table."""
    unused = {"DataType": NOT_USED, "OperatorID": NOT_USED, "BitMask": ALL_BITS}
    return TABLE.image([*USED, *[unused] * (WATCHPOINTS - len(USED))])


if __name__ == "__main__":
    write_beside(__file__, image())
