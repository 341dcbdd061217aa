"""Event ids of SBN (sbn_main_events.h), of its module UDP (sbn_udp_events.h) and of its filter Remap.

The events of a module count from the base that the configuration table gives it.
"""

from __future__ import annotations

SB_EID = 1
INIT_EID = 2
MSG_EID = 3
TBL_EID = 4
PEER_EID = 5
PROTO_EID = 6
CMD_EID = 7
SUB_EID = 8
PEERTASK_EID = 10

UDP_SOCK_EID = 1
UDP_CONFIG_EID = 2
UDP_DEBUG_EID = 3

REMAP_TBL_EID = 2
