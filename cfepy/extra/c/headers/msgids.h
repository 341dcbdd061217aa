/* Topics and message ids of cFE's services, and how a topic becomes a message id. */
#ifndef CFEPY_MSGIDS_H
#define CFEPY_MSGIDS_H

#include "config.h"

#ifndef CFEPY_CMD_MID_BASE /* a mission may have other bases */
#define CFEPY_CMD_MID_BASE                      0x1800
#endif
#ifndef CFEPY_TLM_MID_BASE
#define CFEPY_TLM_MID_BASE                      0x0800
#endif
#ifndef CFEPY_GLOBAL_CMD_MID_BASE
#define CFEPY_GLOBAL_CMD_MID_BASE               0x1860
#endif
#ifndef CFEPY_GLOBAL_TLM_MID_BASE
#define CFEPY_GLOBAL_TLM_MID_BASE               0x0860
#endif
#define CFE_PLATFORM_BASE_MIDVAL(kind)          CFEPY_##kind##_MID_BASE
#define CFE_GLOBAL_BASE_MIDVAL(kind)            CFEPY_GLOBAL_##kind##_MID_BASE
#define CFE_PLATFORM_CMD_TOPICID_TO_MIDV(topic) (CFE_PLATFORM_BASE_MIDVAL(CMD) | (topic))
#define CFE_PLATFORM_TLM_TOPICID_TO_MIDV(topic) (CFE_PLATFORM_BASE_MIDVAL(TLM) | (topic))
#define CFE_GLOBAL_CMD_TOPICID_TO_MIDV(topic)   (CFE_GLOBAL_BASE_MIDVAL(CMD) | (topic))
#define CFE_GLOBAL_TLM_TOPICID_TO_MIDV(topic)   (CFE_GLOBAL_BASE_MIDVAL(TLM) | (topic))

/* ---- topics ---- */
#define CFE_MISSION_ES_HK_TLM_TOPICID           0
#define CFE_MISSION_TIME_DATA_CMD_TOPICID       0
#define CFE_MISSION_EVS_CMD_TOPICID             1
#define CFE_MISSION_EVS_HK_TLM_TOPICID          1
#define CFE_MISSION_TIME_SEND_CMD_TOPICID       2
#define CFE_MISSION_SB_CMD_TOPICID              3
#define CFE_MISSION_SB_HK_TLM_TOPICID           3
#define CFE_MISSION_TBL_CMD_TOPICID             4
#define CFE_MISSION_TBL_HK_TLM_TOPICID          4
#define CFE_MISSION_TIME_CMD_TOPICID            5
#define CFE_MISSION_TIME_HK_TLM_TOPICID         5
#define CFE_MISSION_ES_CMD_TOPICID              6
#define CFE_MISSION_TIME_DIAG_TLM_TOPICID       6
#define CFE_MISSION_ES_SEND_HK_TOPICID          8
#define CFE_MISSION_EVS_LONG_EVENT_MSG_TOPICID  8
#define CFE_MISSION_EVS_SEND_HK_TOPICID         9
#define CFE_MISSION_EVS_SHORT_EVENT_MSG_TOPICID 9
#define CFE_MISSION_SB_STATS_TLM_TOPICID        10
#define CFE_MISSION_ES_APP_TLM_TOPICID          11
#define CFE_MISSION_SB_SEND_HK_TOPICID          11
#define CFE_MISSION_TBL_REG_TLM_TOPICID         12
#define CFE_MISSION_TBL_SEND_HK_TOPICID         12
#define CFE_MISSION_SB_ALLSUBS_TLM_TOPICID      13
#define CFE_MISSION_TIME_SEND_HK_TOPICID        13
#define CFE_MISSION_SB_ONESUB_TLM_TOPICID       14
#define CFE_MISSION_SB_SUB_RPT_CTRL_TOPICID     14
#define CFE_MISSION_ES_MEMSTATS_TLM_TOPICID     16
#define CFE_MISSION_TIME_TONE_CMD_TOPICID       16
#define CFE_MISSION_TIME_ONEHZ_CMD_TOPICID      17

/* ---- message ids ---- */
#define CFE_ES_HK_TLM_MID           2048
#define CFE_EVS_HK_TLM_MID          2049
#define CFE_SB_HK_TLM_MID           2051
#define CFE_TBL_HK_TLM_MID          2052
#define CFE_TIME_HK_TLM_MID         2053
#define CFE_TIME_DIAG_TLM_MID       2054
#define CFE_EVS_LONG_EVENT_MSG_MID  2056
#define CFE_EVS_SHORT_EVENT_MSG_MID 2057
#define CFE_SB_STATS_TLM_MID        2058
#define CFE_ES_APP_TLM_MID          2059
#define CFE_TBL_REG_TLM_MID         2060
#define CFE_SB_ALLSUBS_TLM_MID      2061
#define CFE_SB_ONESUB_TLM_MID       2062
#define CFE_ES_MEMSTATS_TLM_MID     2064
#define CFE_EVS_CMD_MID             6145
#define CFE_SB_CMD_MID              6147
#define CFE_TBL_CMD_MID             6148
#define CFE_TIME_CMD_MID            6149
#define CFE_ES_CMD_MID              6150
#define CFE_ES_SEND_HK_MID          6152
#define CFE_EVS_SEND_HK_MID         6153
#define CFE_SB_SEND_HK_MID          6155
#define CFE_TBL_SEND_HK_MID         6156
#define CFE_TIME_SEND_HK_MID        6157
#define CFE_SB_SUB_RPT_CTRL_MID     6158
#define CFE_TIME_TONE_CMD_MID       6160
#define CFE_TIME_ONEHZ_CMD_MID      6161
#define CFE_TIME_DATA_CMD_MID       6240
#define CFE_TIME_SEND_CMD_MID       6242
#ifndef CFE_OMIT_DEPRECATED_6_8
#define CFE_TIME_1HZ_CMD_MID CFE_TIME_ONEHZ_CMD_MID
#endif

#endif
