"""SCH's default schedule, NASA's: every four seconds a housekeeping request to each core service and to SCH itself.

After a change, `python -m apps.sch.tables.sch_def_schtbl` rewrites sch_def_schtbl.tbl.
"""

from __future__ import annotations

from cfepy.tbl import TableImage, write_beside

from ..definition import activity, schedule_image
from .sch_def_msgtbl import ES_HK, EVS_HK, SB_HK, SCH_HK, TBL_HK, TIME_HK

CDH = 0x000001
CFS_HK = 0x000010 | CDH
CFE_HK = 0x000020 | CDH
"""Multi-groups: command and data handling, and in it the housekeeping of apps and of cFE."""

SLOTS = {
    3: [activity(EVS_HK, 4, 3, CFE_HK)],
    13: [activity(SB_HK, 4, 3, CFE_HK)],
    23: [activity(TIME_HK, 4, 3, CFE_HK)],
    33: [activity(TBL_HK, 4, 3, CFE_HK)],
    43: [activity(ES_HK, 4, 3, CFE_HK)],
    49: [activity(SCH_HK, 4, 2, CFS_HK)],
}


def image() -> TableImage:
    """Return the table."""
    return schedule_image(SLOTS)


if __name__ == "__main__":
    write_beside(__file__, image())
