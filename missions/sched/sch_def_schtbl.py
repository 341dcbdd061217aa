"""SCH's schedule in this mission: who is asked for housekeeping in which slot, and when HK sends its packet.

After a change, `python sch_def_schtbl.py` writes sch_def_schtbl.tbl anew; so does
`cfepy tbl build sch_def_schtbl.yaml` from the YAML that `cfepy tbl show --yaml sch_def_schtbl.tbl` prints.
"""

from __future__ import annotations

import sch_def_msgtbl as msg

from cfepy.apps.sch.definition import activity, schedule_image
from cfepy.tbl import TableImage, write_beside

CORE, APPS = 0x000020, 0x000010
"""Multi-groups, which SCH_DISABLE_GROUP can silence together."""

SLOTS = {
    5: [activity(msg.EVS_HK, groups=CORE), activity(msg.TIME_HK, groups=CORE)],
    15: [activity(msg.SB_HK, groups=CORE), activity(msg.ES_HK, groups=CORE)],
    25: [activity(msg.TBL_HK, groups=CORE)],
    45: [activity(msg.SAMPLE_HK, groups=APPS), activity(msg.HK_HK, frequency=2, remainder=1, groups=APPS)],
    75: [activity(msg.SEND_COMBINED)],
    98: [activity(msg.SCH_HK, frequency=4, remainder=3)],
}


def image() -> TableImage:
    """The table."""
    return schedule_image(SLOTS)


if __name__ == "__main__":
    write_beside(__file__, image())
