"""What does not go from one processor to the other, and what has another MsgId there.

Both subscribe to the commands and requests of their own core services: without this table each would do what the ground
wants of the other, too. An entry is used by the processor that has the other one for a peer.

After a change: `python missions/pair/sbn_remap_tbl.py` writes sbn_remap_tbl.tbl anew.
"""

from cfepy.apps.sbn.definition import remapping
from cfepy.tbl import write_beside

CORE_COMMANDS = (0x1801, 0x1803, 0x1804, 0x1805, 0x1806)  # EVS, SB, TBL, TIME, ES
CORE_REQUESTS = (0x1808, 0x1809, 0x180B, 0x180C)  # housekeeping of ES, EVS, SB, TBL; that of TIME passes
ONE_HZ, SEND_TONE_DATA = 0x1811, 0x1862  # a second of one's own clock; a server is asked for the time at its own tone
TIME_HK, TIME_HK_OF_CLIENT = 0x0805, 0x0825
NOWHERE = 0

TO_CLIENT = [(2, msg_id, NOWHERE) for msg_id in (*CORE_COMMANDS, *CORE_REQUESTS, ONE_HZ)]
TO_SERVER = [(1, msg_id, NOWHERE) for msg_id in (*CORE_COMMANDS, SEND_TONE_DATA)]

if __name__ == "__main__":
    write_beside(__file__, remapping([*TO_CLIENT, *TO_SERVER, (1, TIME_HK, TIME_HK_OF_CLIENT)]))
