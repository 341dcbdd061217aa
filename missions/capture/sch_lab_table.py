"""SCH_LAB's schedule in this mission: housekeeping of the core services and of HK once a second, then HK's packet.

After a change, `python sch_lab_table.py` writes sch_lab_table.tbl anew.
"""

from __future__ import annotations

import struct

from cfepy.apps.hk.packets import COMBINED_PKT1_MID, SEND_COMBINED_PKT_MID, SEND_HK_MID
from cfepy.apps.sch_lab import schedule
from cfepy.tbl import TableImage, write_beside

TICKS_PER_SECOND = 10
EVERY_SECOND = 10  # ticks
SEND_HK = {"ES": 0x1808, "EVS": 0x1809, "SB": 0x180B, "TBL": 0x180C, "TIME": 0x180D, "HK": SEND_HK_MID}


def image() -> TableImage:
    """The table."""
    rows = [(msg_id, EVERY_SECOND, 0, b"") for msg_id in SEND_HK.values()]
    rows.append((SEND_COMBINED_PKT_MID, EVERY_SECOND, 0, struct.pack("<I", COMBINED_PKT1_MID)))
    return schedule.image(TICKS_PER_SECOND, rows)


if __name__ == "__main__":
    write_beside(__file__, image())
