"""SCH's default messages, NASA's: a housekeeping request to every core service and to SCH itself.

After a change, `python -m apps.sch.tables.sch_def_msgtbl` rewrites sch_def_msgtbl.tbl.
"""

from __future__ import annotations

from cfepy.msg import CMD_HEADER_SIZE, init
from cfepy.tbl import TableImage, write_beside

from ..definition import message_image
from ..packets import SEND_HK_MID

ES_HK, EVS_HK, SB_HK, TIME_HK, TBL_HK, SCH_HK = 1, 2, 3, 4, 5, 15
"""Places of the messages in the table."""

REQUESTS = {ES_HK: 0x1808, EVS_HK: 0x1809, SB_HK: 0x180B, TIME_HK: 0x180D, TBL_HK: 0x180C, SCH_HK: SEND_HK_MID}


def image() -> TableImage:
    """Return the table."""
    return message_image({index: init(msg_id, CMD_HEADER_SIZE) for index, msg_id in REQUESTS.items()})


if __name__ == "__main__":
    write_beside(__file__, image())
