"""SCH_LAB's schedule in this mission: once a second HK sends its combined packet.

After a change, `python sch_lab_table.py` writes sch_lab_table.tbl anew.
"""

from __future__ import annotations

import struct

from cfepy.apps.hk.packets import COMBINED_PKT1_MID, SEND_COMBINED_PKT_MID
from cfepy.apps.sch_lab import schedule
from cfepy.tbl import TableImage, write_beside

TICKS_PER_SECOND = 10
EVERY_SECOND = 10  # ticks


def image() -> TableImage:
    """The table."""
    row = (SEND_COMBINED_PKT_MID, EVERY_SECOND, 0, struct.pack("<I", COMBINED_PKT1_MID))
    return schedule.image(TICKS_PER_SECOND, [row])


if __name__ == "__main__":
    write_beside(__file__, image())
