"""The schedule: wake-ups and requests of housekeeping, in tenths of a second.

After a change, `python sch_lab_table.py` writes sch_lab_table.tbl anew.
"""

from __future__ import annotations

import struct

from cfepy.apps.sch_lab import schedule
from cfepy.tbl import TableImage, write_beside

TICKS_PER_S = 10
SECOND, FOUR_SECONDS = TICKS_PER_S, 4 * TICKS_PER_S
ALL_ACTIONPOINTS = struct.pack("<HHHH", 0, 175, 1, 0)
COMBINED_PACKET = struct.pack("<I", 0x089C)

ROWS = [  # MsgId, period, function code, payload
    (0x1886, 1, 0, b""),  # CI_LAB takes what came up
    (0x18B5, 1, 0, b""),  # CF works
    (0x18A6, SECOND, 0, ALL_ACTIONPOINTS),  # LC judges
    (0x18AB, SECOND, 0, b""),  # SC goes on with its sequences
    (0x18B0, SECOND, 0, b""),  # HS looks
    (0x1892, SECOND, 0, b""),  # MD dwells
    (0x18A1, SECOND, 0, b""),  # CS checks
    (0x18BC, SECOND, 0, b""),  # DS looks at the age of its files, and tells its housekeeping
    (0x189C, FOUR_SECONDS, 0, COMBINED_PACKET),  # HK
    *((msg_id, FOUR_SECONDS, 0, b"") for msg_id in (0x1808, 0x1809, 0x180B, 0x180C, 0x180D)),  # the core
    *((msg_id, FOUR_SECONDS, 0, b"") for msg_id in (0x1885, 0x1881)),  # CI_LAB, TO_LAB
    *((msg_id, FOUR_SECONDS, 0, b"") for msg_id in (0x189B, 0x18A5, 0x1891, 0x18B4, 0x18AA)),  # HK LC MD CF SC
    *((msg_id, FOUR_SECONDS, 0, b"") for msg_id in (0x18AF, 0x188D, 0x1889, 0x18A0)),  # HS FM MM CS
]


def image() -> TableImage:
    """The table."""
    return schedule.image(TICKS_PER_S, ROWS)


if __name__ == "__main__":
    write_beside(__file__, image())
