"""Message ids, function codes and packet layouts of Event Services (default_cfe_evs_msgstruct.h). Imports cfepy.msg."""

from __future__ import annotations

from cfepy.msg import Layout

CFE_EVS_CMD_MID = 0x1801
CFE_EVS_SEND_HK_MID = 0x1809
CFE_EVS_HK_TLM_MID = 0x0801
CFE_EVS_LONG_EVENT_MSG_MID = 0x0808
CFE_EVS_SHORT_EVENT_MSG_MID = 0x0809

CFE_EVS_NOOP_CC = 0
CFE_EVS_RESET_COUNTERS_CC = 1
CFE_EVS_ENABLE_EVENT_TYPE_CC = 2
CFE_EVS_DISABLE_EVENT_TYPE_CC = 3
CFE_EVS_SET_EVENT_FORMAT_MODE_CC = 4
CFE_EVS_ENABLE_APP_EVENT_TYPE_CC = 5
CFE_EVS_DISABLE_APP_EVENT_TYPE_CC = 6
CFE_EVS_ENABLE_APP_EVENTS_CC = 7
CFE_EVS_DISABLE_APP_EVENTS_CC = 8
CFE_EVS_RESET_APP_COUNTER_CC = 9
CFE_EVS_SET_FILTER_CC = 10
CFE_EVS_ENABLE_PORTS_CC = 11
CFE_EVS_DISABLE_PORTS_CC = 12
CFE_EVS_RESET_FILTER_CC = 13
CFE_EVS_RESET_ALL_FILTERS_CC = 14
CFE_EVS_ADD_EVENT_FILTER_CC = 15
CFE_EVS_DELETE_EVENT_FILTER_CC = 16
CFE_EVS_WRITE_APP_DATA_FILE_CC = 17
CFE_EVS_WRITE_LOG_DATA_FILE_CC = 18
CFE_EVS_SET_LOG_MODE_CC = 19
CFE_EVS_CLEAR_LOG_CC = 20

FORMAT_SHORT, FORMAT_LONG = 0, 1
"""CFE_EVS_MsgFormat_Enum_t."""

APPS_IN_HOUSEKEEPING = 16
"""CFE_MISSION_ES_MAX_APPLICATIONS."""

PACKET_ID = Layout(
    "CFE_EVS_PacketID_t",
    [
        ("AppName", "char[20]"),
        ("EventID", "u16"),
        ("EventType", "u16"),
        ("SpacecraftID", "u32"),
        ("ProcessorID", "u32"),
    ],
)

LONG_EVENT = Layout(
    "CFE_EVS_LongEventTlm_Payload_t",
    [("PacketID", PACKET_ID), ("Message", "char[122]"), ("Spare1", "u8"), ("Spare2", "u8")],
)

SHORT_EVENT = Layout("CFE_EVS_ShortEventTlm_Payload_t", [("PacketID", PACKET_ID)])

APP_TLM = Layout(
    "CFE_EVS_AppTlmData_t",
    [
        ("AppID", "u32"),
        ("AppMessageSentCounter", "u16"),
        ("AppEnableStatus", "u8"),
        ("AppMessageSquelchedCounter", "u8"),
    ],
)

HOUSEKEEPING = Layout(
    "CFE_EVS_HousekeepingTlm_Payload_t",
    [
        ("CommandCounter", "u8"),
        ("CommandErrorCounter", "u8"),
        ("MessageFormatMode", "u8"),
        ("MessageTruncCounter", "u8"),
        ("UnregisteredAppCounter", "u8"),
        ("OutputPort", "u8"),
        ("LogFullFlag", "u8"),
        ("LogMode", "u8"),
        ("MessageSendCounter", "u16"),
        ("LogOverflowCounter", "u16"),
        ("LogEnabled", "u8"),
        ("Spare1", "u8"),
        ("Spare2", "u8"),
        ("Spare3", "u8"),
        ("AppData", (APP_TLM, APPS_IN_HOUSEKEEPING)),
    ],
)

FILTER_RECORD = Layout("EVS_BinFilter_t", [("EventID", "u16"), ("Mask", "u16"), ("Count", "u16"), ("Padding", "u16")])

APP_DATA_RECORD = Layout(
    "CFE_EVS_AppDataFile_t",
    [
        ("AppName", "char[20]"),
        ("ActiveFlag", "u8"),
        ("EventTypesActiveFlag", "u8"),
        ("EventCount", "u16"),
        ("SquelchedCount", "u8"),
        ("Spare", "u8[3]"),
        ("Filters", (FILTER_RECORD, 8)),
    ],
)

BIT_MASK_COMMAND = Layout("CFE_EVS_BitMaskCmd_Payload_t", [("BitMask", "u8"), ("Spare", "u8")])
FORMAT_COMMAND = Layout("CFE_EVS_SetEventFormatMode_Payload_t", [("MsgFormat", "u8"), ("Spare", "u8")])
LOG_MODE_COMMAND = Layout("CFE_EVS_SetLogMode_Payload_t", [("LogMode", "u8"), ("Spare", "u8")])
APP_COMMAND = Layout("CFE_EVS_AppNameCmd_Payload_t", [("AppName", "char[20]")])
APP_MASK_COMMAND = Layout(
    "CFE_EVS_AppNameBitMaskCmd_Payload_t", [("AppName", "char[20]"), ("BitMask", "u8"), ("Spare", "u8")]
)
APP_EVENT_COMMAND = Layout("CFE_EVS_AppNameEventIDCmd_Payload_t", [("AppName", "char[20]"), ("EventID", "u16")])
APP_FILTER_COMMAND = Layout(
    "CFE_EVS_AppNameEventIDMaskCmd_Payload_t", [("AppName", "char[20]"), ("EventID", "u16"), ("Mask", "u16")]
)
FILE_COMMAND = Layout("CFE_EVS_LogFileCmd_Payload_t", [("Filename", "char[64]")])
