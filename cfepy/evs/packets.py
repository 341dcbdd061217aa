"""Commands and telemetry of Event Services: message ids, function codes, layouts (default_cfe_evs_msgstruct.h)."""

from __future__ import annotations

from cfepy.msg import Command, Layout, Telemetry, ValueNames

CMD_MID = 0x1801
SEND_HK_MID = 0x1809
HK_TLM_MID = 0x0801
LONG_EVENT_MSG_MID = 0x0808
SHORT_EVENT_MSG_MID = 0x0809

NOOP_CC = 0
RESET_COUNTERS_CC = 1
ENABLE_EVENT_TYPE_CC = 2
DISABLE_EVENT_TYPE_CC = 3
SET_EVENT_FORMAT_MODE_CC = 4
ENABLE_APP_EVENT_TYPE_CC = 5
DISABLE_APP_EVENT_TYPE_CC = 6
ENABLE_APP_EVENTS_CC = 7
DISABLE_APP_EVENTS_CC = 8
RESET_APP_COUNTER_CC = 9
SET_FILTER_CC = 10
ENABLE_PORTS_CC = 11
DISABLE_PORTS_CC = 12
RESET_FILTER_CC = 13
RESET_ALL_FILTERS_CC = 14
ADD_EVENT_FILTER_CC = 15
DELETE_EVENT_FILTER_CC = 16
WRITE_APP_DATA_FILE_CC = 17
WRITE_LOG_DATA_FILE_CC = 18
SET_LOG_MODE_CC = 19
CLEAR_LOG_CC = 20

FORMAT_SHORT, FORMAT_LONG = 0, 1
"""CFE_EVS_MsgFormat_Enum_t."""

FORMATS = ValueNames("u8", SHORT=FORMAT_SHORT, LONG=FORMAT_LONG)
LOG_MODES = ValueNames("u8", OVERWRITE=0, DISCARD=1)
EVENT_TYPES = ValueNames("u16", DEBUG=1, INFORMATION=2, ERROR=3, CRITICAL=4)
TYPE_MASK = ValueNames("u8", flags=True, DEBUG=1, INFORMATION=2, ERROR=4, CRITICAL=8)
PORT_MASK = ValueNames("u8", flags=True, PORT1=1, PORT2=2, PORT3=4, PORT4=8)
FILTER_MASKS = ValueNames(
    "u16",
    NO_FILTER=0x0000,
    FIRST_ONE_STOP=0xFFFF,
    FIRST_TWO_STOP=0xFFFE,
    FIRST_4_STOP=0xFFFC,
    FIRST_8_STOP=0xFFF8,
    FIRST_16_STOP=0xFFF0,
    FIRST_32_STOP=0xFFE0,
    FIRST_64_STOP=0xFFC0,
    EVERY_OTHER_ONE=0x0001,
    EVERY_OTHER_TWO=0x0002,
    EVERY_FOURTH_ONE=0x0003,
)
"""The names of values (default_cfe_evs_extern_typedefs.h, cfe_evs_api_typedefs.h)."""

APPS_IN_HOUSEKEEPING = 16
"""CFE_MISSION_ES_MAX_APPLICATIONS."""

PACKET_ID = Layout(
    "CFE_EVS_PacketID_t",
    [
        ("AppName", "char[20]"),
        ("EventID", "u16"),
        ("EventType", EVENT_TYPES),
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
        ("MessageFormatMode", FORMATS),
        ("MessageTruncCounter", "u8"),
        ("UnregisteredAppCounter", "u8"),
        ("OutputPort", PORT_MASK),
        ("LogFullFlag", "u8"),
        ("LogMode", LOG_MODES),
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

TYPES_COMMAND = Layout("CFE_EVS_BitMaskCmd_Payload_t", [("BitMask", TYPE_MASK), ("Spare", "u8")])
PORTS_COMMAND = Layout("CFE_EVS_BitMaskCmd_Payload_t", [("BitMask", PORT_MASK), ("Spare", "u8")])
FORMAT_COMMAND = Layout("CFE_EVS_SetEventFormatMode_Payload_t", [("MsgFormat", FORMATS), ("Spare", "u8")])
LOG_MODE_COMMAND = Layout("CFE_EVS_SetLogMode_Payload_t", [("LogMode", LOG_MODES), ("Spare", "u8")])
APP_COMMAND = Layout("CFE_EVS_AppNameCmd_Payload_t", [("AppName", "char[20]")])
APP_MASK_COMMAND = Layout(
    "CFE_EVS_AppNameBitMaskCmd_Payload_t", [("AppName", "char[20]"), ("BitMask", TYPE_MASK), ("Spare", "u8")]
)
APP_EVENT_COMMAND = Layout("CFE_EVS_AppNameEventIDCmd_Payload_t", [("AppName", "char[20]"), ("EventID", "u16")])
APP_FILTER_COMMAND = Layout(
    "CFE_EVS_AppNameEventIDMaskCmd_Payload_t", [("AppName", "char[20]"), ("EventID", "u16"), ("Mask", FILTER_MASKS)]
)
LOG_FILE_COMMAND = Layout("CFE_EVS_LogFileCmd_Payload_t", [("LogFilename", "char[64]")])
APP_DATA_COMMAND = Layout("CFE_EVS_AppDataCmd_Payload_t", [("AppDataFilename", "char[64]")])

NOOP = Command("CFE_EVS_NOOP", CMD_MID, NOOP_CC, text="Answer with an event.")
RESET_COUNTERS = Command("CFE_EVS_RESET_COUNTERS", CMD_MID, RESET_COUNTERS_CC, text="Set the counters to 0.")
ENABLE_EVENT_TYPE = Command(
    "CFE_EVS_ENABLE_EVENT_TYPE",
    CMD_MID,
    ENABLE_EVENT_TYPE_CC,
    TYPES_COMMAND,
    "Let all applications send events of some types.",
)
DISABLE_EVENT_TYPE = Command(
    "CFE_EVS_DISABLE_EVENT_TYPE",
    CMD_MID,
    DISABLE_EVENT_TYPE_CC,
    TYPES_COMMAND,
    "Hold back events of some types of all applications.",
)
SET_EVENT_FORMAT_MODE = Command(
    "CFE_EVS_SET_EVENT_FORMAT_MODE",
    CMD_MID,
    SET_EVENT_FORMAT_MODE_CC,
    FORMAT_COMMAND,
    "Send events short, 0, or long, 1.",
)
ENABLE_APP_EVENT_TYPE = Command(
    "CFE_EVS_ENABLE_APP_EVENT_TYPE",
    CMD_MID,
    ENABLE_APP_EVENT_TYPE_CC,
    APP_MASK_COMMAND,
    "Let an application send events of some types.",
)
DISABLE_APP_EVENT_TYPE = Command(
    "CFE_EVS_DISABLE_APP_EVENT_TYPE",
    CMD_MID,
    DISABLE_APP_EVENT_TYPE_CC,
    APP_MASK_COMMAND,
    "Hold back events of some types of an application.",
)
ENABLE_APP_EVENTS = Command(
    "CFE_EVS_ENABLE_APP_EVENTS", CMD_MID, ENABLE_APP_EVENTS_CC, APP_COMMAND, "Let an application send events."
)
DISABLE_APP_EVENTS = Command(
    "CFE_EVS_DISABLE_APP_EVENTS", CMD_MID, DISABLE_APP_EVENTS_CC, APP_COMMAND, "Hold back an application's events."
)
RESET_APP_COUNTER = Command(
    "CFE_EVS_RESET_APP_COUNTER",
    CMD_MID,
    RESET_APP_COUNTER_CC,
    APP_COMMAND,
    "Set the counts of an application's sent and squelched events to 0.",
)
SET_FILTER = Command(
    "CFE_EVS_SET_FILTER", CMD_MID, SET_FILTER_CC, APP_FILTER_COMMAND, "Change the mask of an event's filter."
)
ENABLE_PORTS = Command(
    "CFE_EVS_ENABLE_PORTS", CMD_MID, ENABLE_PORTS_CC, PORTS_COMMAND, "Write events to some output ports."
)
DISABLE_PORTS = Command(
    "CFE_EVS_DISABLE_PORTS", CMD_MID, DISABLE_PORTS_CC, PORTS_COMMAND, "Write no events to some output ports."
)
RESET_FILTER = Command(
    "CFE_EVS_RESET_FILTER", CMD_MID, RESET_FILTER_CC, APP_EVENT_COMMAND, "Let the filter of an event count from 0."
)
RESET_ALL_FILTERS = Command(
    "CFE_EVS_RESET_ALL_FILTERS",
    CMD_MID,
    RESET_ALL_FILTERS_CC,
    APP_COMMAND,
    "Let all filters of an application count from 0.",
)
ADD_EVENT_FILTER = Command(
    "CFE_EVS_ADD_EVENT_FILTER", CMD_MID, ADD_EVENT_FILTER_CC, APP_FILTER_COMMAND, "Give an event a filter."
)
DELETE_EVENT_FILTER = Command(
    "CFE_EVS_DELETE_EVENT_FILTER",
    CMD_MID,
    DELETE_EVENT_FILTER_CC,
    APP_EVENT_COMMAND,
    "Take the filter of an event away.",
)
WRITE_APP_DATA_FILE = Command(
    "CFE_EVS_WRITE_APP_DATA_FILE",
    CMD_MID,
    WRITE_APP_DATA_FILE_CC,
    APP_DATA_COMMAND,
    "Write the data of all applications to a file.",
)
WRITE_LOG_DATA_FILE = Command(
    "CFE_EVS_WRITE_LOG_DATA_FILE",
    CMD_MID,
    WRITE_LOG_DATA_FILE_CC,
    LOG_FILE_COMMAND,
    "Write the event log to a file.",
)
SET_LOG_MODE = Command(
    "CFE_EVS_SET_LOG_MODE",
    CMD_MID,
    SET_LOG_MODE_CC,
    LOG_MODE_COMMAND,
    "Let a full event log overwrite the oldest event, 0, or discard the new one, 1.",
)
CLEAR_LOG = Command("CFE_EVS_CLEAR_LOG", CMD_MID, CLEAR_LOG_CC, text="Empty the event log.")
SEND_HK = Command("CFE_EVS_SEND_HK", SEND_HK_MID, text="Send the housekeeping packet.")

COMMANDS: tuple[Command, ...] = (
    NOOP,
    RESET_COUNTERS,
    ENABLE_EVENT_TYPE,
    DISABLE_EVENT_TYPE,
    SET_EVENT_FORMAT_MODE,
    ENABLE_APP_EVENT_TYPE,
    DISABLE_APP_EVENT_TYPE,
    ENABLE_APP_EVENTS,
    DISABLE_APP_EVENTS,
    RESET_APP_COUNTER,
    SET_FILTER,
    ENABLE_PORTS,
    DISABLE_PORTS,
    RESET_FILTER,
    RESET_ALL_FILTERS,
    ADD_EVENT_FILTER,
    DELETE_EVENT_FILTER,
    WRITE_APP_DATA_FILE,
    WRITE_LOG_DATA_FILE,
    SET_LOG_MODE,
    CLEAR_LOG,
    SEND_HK,
)

HK_TLM = Telemetry("CFE_EVS_HK_TLM", HK_TLM_MID, HOUSEKEEPING, "Counters and settings of EVS and of 16 applications.")
LONG_EVENT_MSG = Telemetry("CFE_EVS_LONG_EVENT_MSG", LONG_EVENT_MSG_MID, LONG_EVENT, "An event with its text.")
SHORT_EVENT_MSG = Telemetry("CFE_EVS_SHORT_EVENT_MSG", SHORT_EVENT_MSG_MID, SHORT_EVENT, "An event without its text.")

TELEMETRY: tuple[Telemetry, ...] = (HK_TLM, LONG_EVENT_MSG, SHORT_EVENT_MSG)
