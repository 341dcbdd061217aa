"""What has another MsgId on the other processor, and what does not go there.

Both subscribe to the commands and requests of their own core services: without this table both would do what the
ground wants of one. With it, those of processor 2 have MsgIds of their own on processor 1: 0x1826 are commands for its
Executive Services, which are 0x1806 there. An entry is used by the processor that has the other one for a peer.

After a change: `python missions/pair/sbn_remap_tbl.py` writes sbn_remap_tbl.tbl anew.
"""

from cfepy.apps.sbn.definition import remapping
from cfepy.tbl import write_beside

CORE_COMMANDS = (0x1801, 0x1803, 0x1804, 0x1805, 0x1806)  # EVS, SB, TBL, TIME, ES
CORE_REQUESTS = (0x1808, 0x1809, 0x180B, 0x180C)  # housekeeping of ES, EVS, SB, TBL; the one for TIME's is for both
OF_CLIENT = 0x20  # more than on processor 2
ONE_HZ, SEND_TONE_DATA = 0x1811, 0x1862  # a second of one's own clock; a server is asked for the time at its own tone
TIME_HK = 0x0805
NOWHERE = 0

TO_CLIENT = [(2, msg_id + OF_CLIENT, msg_id) for msg_id in (*CORE_COMMANDS, *CORE_REQUESTS)]
TO_SERVER = [(1, TIME_HK, TIME_HK + OF_CLIENT), (1, SEND_TONE_DATA, NOWHERE)]

if __name__ == "__main__":
    write_beside(__file__, remapping([*TO_CLIENT, (2, ONE_HZ, NOWHERE), *TO_SERVER]))
