"""Event ids of SAMPLE_APP (sample_app_eventids.h): the ground filters and greps by these numbers."""

from __future__ import annotations

INIT_INF_EID = 1
CC_ERR_EID = 2
NOOP_INF_EID = 3
RESET_INF_EID = 4
MID_ERR_EID = 5
CMD_LEN_ERR_EID = 6
PIPE_ERR_EID = 7
VALUE_INF_EID = 8
CR_PIPE_ERR_EID = 9
SUB_HK_ERR_EID = 10
SUB_CMD_ERR_EID = 11
TABLE_REG_ERR_EID = 12
