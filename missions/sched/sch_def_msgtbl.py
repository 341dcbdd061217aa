"""The messages that SCH sends in this mission, by their place in the table.

After a change, `python sch_def_msgtbl.py` writes sch_def_msgtbl.tbl anew.
"""

from __future__ import annotations

from cfepy.apps.hk import packets as hk
from cfepy.apps.sample_app import packets as sample
from cfepy.apps.sch import packets as sch
from cfepy.apps.sch.definition import message_image
from cfepy.es import packets as es
from cfepy.evs import packets as evs
from cfepy.msg import CMD_HEADER_SIZE, init
from cfepy.sb import packets as sb
from cfepy.tbl import TableImage, write_beside
from cfepy.tbl import packets as tbl
from cfepy.time import packets as time

ES_HK, EVS_HK, SB_HK, TIME_HK, TBL_HK, SAMPLE_HK, HK_HK, SCH_HK, SEND_COMBINED = range(1, 10)

REQUESTS = {
    ES_HK: es.SEND_HK_MID,
    EVS_HK: evs.SEND_HK_MID,
    SB_HK: sb.SEND_HK_MID,
    TIME_HK: time.SEND_HK_MID,
    TBL_HK: tbl.SEND_HK_MID,
    SAMPLE_HK: sample.SEND_HK_MID,
    HK_HK: hk.SEND_HK_MID,
    SCH_HK: sch.SEND_HK_MID,
}


def image() -> TableImage:
    """The table."""
    combined = hk.SEND_COMBINED_PKT.packet(OutMsgToSend=hk.COMBINED_PKT1_MID)
    messages = {place: bytes(init(msg_id, CMD_HEADER_SIZE)) for place, msg_id in REQUESTS.items()}
    return message_image({**messages, SEND_COMBINED: combined})


if __name__ == "__main__":
    write_beside(__file__, image())
