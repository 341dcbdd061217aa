/* Commands and telemetry of CFE_EVS: function codes, payloads, packets. */
#ifndef CFEPY_EVS_MESSAGES_H
#define CFEPY_EVS_MESSAGES_H

#include "message_kinds.h"

CFEPY_C_BEGIN

enum CFE_EVS_FunctionCode_ {
    CFE_EVS_FunctionCode_NOOP = 0, CFE_EVS_FunctionCode_RESET_COUNTERS = 1,
    CFE_EVS_FunctionCode_ENABLE_EVENT_TYPE = 2, CFE_EVS_FunctionCode_DISABLE_EVENT_TYPE = 3,
    CFE_EVS_FunctionCode_SET_EVENT_FORMAT_MODE = 4, CFE_EVS_FunctionCode_ENABLE_APP_EVENT_TYPE = 5,
    CFE_EVS_FunctionCode_DISABLE_APP_EVENT_TYPE = 6, CFE_EVS_FunctionCode_ENABLE_APP_EVENTS = 7,
    CFE_EVS_FunctionCode_DISABLE_APP_EVENTS = 8, CFE_EVS_FunctionCode_RESET_APP_COUNTER = 9,
    CFE_EVS_FunctionCode_SET_FILTER = 10, CFE_EVS_FunctionCode_ENABLE_PORTS = 11,
    CFE_EVS_FunctionCode_DISABLE_PORTS = 12, CFE_EVS_FunctionCode_RESET_FILTER = 13,
    CFE_EVS_FunctionCode_RESET_ALL_FILTERS = 14, CFE_EVS_FunctionCode_ADD_EVENT_FILTER = 15,
    CFE_EVS_FunctionCode_DELETE_EVENT_FILTER = 16, CFE_EVS_FunctionCode_WRITE_APP_DATA_FILE = 17,
    CFE_EVS_FunctionCode_WRITE_LOG_DATA_FILE = 18, CFE_EVS_FunctionCode_SET_LOG_MODE = 19,
    CFE_EVS_FunctionCode_CLEAR_LOG = 20
};

#define CFE_EVS_NOOP_CC                   0
#define CFE_EVS_RESET_COUNTERS_CC         1
#define CFE_EVS_ENABLE_EVENT_TYPE_CC      2
#define CFE_EVS_DISABLE_EVENT_TYPE_CC     3
#define CFE_EVS_SET_EVENT_FORMAT_MODE_CC  4
#define CFE_EVS_ENABLE_APP_EVENT_TYPE_CC  5
#define CFE_EVS_DISABLE_APP_EVENT_TYPE_CC 6
#define CFE_EVS_ENABLE_APP_EVENTS_CC      7
#define CFE_EVS_DISABLE_APP_EVENTS_CC     8
#define CFE_EVS_RESET_APP_COUNTER_CC      9
#define CFE_EVS_SET_FILTER_CC             10
#define CFE_EVS_ENABLE_PORTS_CC           11
#define CFE_EVS_DISABLE_PORTS_CC          12
#define CFE_EVS_RESET_FILTER_CC           13
#define CFE_EVS_RESET_ALL_FILTERS_CC      14
#define CFE_EVS_ADD_EVENT_FILTER_CC       15
#define CFE_EVS_DELETE_EVENT_FILTER_CC    16
#define CFE_EVS_WRITE_APP_DATA_FILE_CC    17
#define CFE_EVS_WRITE_LOG_DATA_FILE_CC    18
#define CFE_EVS_SET_LOG_MODE_CC           19
#define CFE_EVS_CLEAR_LOG_CC              20

typedef struct CFE_EVS_LogFileCmd_Payload {
    char LogFilename[CFE_MISSION_MAX_PATH_LEN];
} CFE_EVS_LogFileCmd_Payload_t;

typedef struct CFE_EVS_AppDataCmd_Payload {
    char AppDataFilename[CFE_MISSION_MAX_PATH_LEN];
} CFE_EVS_AppDataCmd_Payload_t;

typedef struct CFE_EVS_SetLogMode_Payload {
    CFE_EVS_LogMode_Enum_t LogMode;
    uint8 Spare;
} CFE_EVS_SetLogMode_Payload_t;

typedef struct CFE_EVS_SetEventFormatCode_Payload {
    CFE_EVS_MsgFormat_Enum_t MsgFormat;
    uint8 Spare;
} CFE_EVS_SetEventFormatMode_Payload_t;

typedef struct CFE_EVS_BitMaskCmd_Payload {
    uint8 BitMask, Spare;
} CFE_EVS_BitMaskCmd_Payload_t;

typedef struct CFE_EVS_AppNameCmd_Payload {
    char AppName[CFE_MISSION_MAX_API_LEN];
} CFE_EVS_AppNameCmd_Payload_t;

typedef struct CFE_EVS_AppNameEventIDCmd_Payload {
    char AppName[CFE_MISSION_MAX_API_LEN];
    uint16 EventID;
} CFE_EVS_AppNameEventIDCmd_Payload_t;

typedef struct CFE_EVS_AppNameBitMaskCmd_Payload {
    char AppName[CFE_MISSION_MAX_API_LEN];
    uint8 BitMask, Spare;
} CFE_EVS_AppNameBitMaskCmd_Payload_t;

typedef struct CFE_EVS_AppNameEventIDMaskCmd_Payload {
    char AppName[CFE_MISSION_MAX_API_LEN];
    uint16 EventID, Mask;
} CFE_EVS_AppNameEventIDMaskCmd_Payload_t;

typedef struct CFE_EVS_AppTlmData {
    CFE_ES_AppId_t AppID;
    uint16 AppMessageSentCounter;
    uint8 AppEnableStatus, AppMessageSquelchedCounter;
} CFE_EVS_AppTlmData_t;

typedef struct CFE_EVS_HousekeepingTlm_Payload {
    uint8 CommandCounter, CommandErrorCounter, MessageFormatMode, MessageTruncCounter, UnregisteredAppCounter,
        OutputPort, LogFullFlag, LogMode;
    uint16 MessageSendCounter, LogOverflowCounter;
    uint8 LogEnabled, Spare1, Spare2, Spare3;
    CFE_EVS_AppTlmData_t AppData[16];
} CFE_EVS_HousekeepingTlm_Payload_t;

typedef struct CFE_EVS_PacketID {
    char AppName[CFE_MISSION_MAX_API_LEN];
    uint16 EventID;
    CFE_EVS_EventType_Enum_t EventType;
    uint32 SpacecraftID, ProcessorID;
} CFE_EVS_PacketID_t;

typedef struct CFE_EVS_LongEventTlm_Payload {
    CFE_EVS_PacketID_t PacketID;
    char Message[122];
    uint8 Spare1, Spare2;
} CFE_EVS_LongEventTlm_Payload_t;

typedef struct CFE_EVS_ShortEventTlm_Payload {
    CFE_EVS_PacketID_t PacketID;
} CFE_EVS_ShortEventTlm_Payload_t;

#define CFE_EVS_DEBUG_BIT       1
#define CFE_EVS_PORT1_BIT       1
#define CFE_EVS_INFORMATION_BIT 2
#define CFE_EVS_PORT2_BIT       2
#define CFE_EVS_ERROR_BIT       4
#define CFE_EVS_PORT3_BIT       4
#define CFE_EVS_CRITICAL_BIT    8
#define CFE_EVS_PORT4_BIT       8

CFEPY_COMMAND(CFE_EVS_NoopCmd);
CFEPY_COMMAND(CFE_EVS_ResetCountersCmd);
CFEPY_COMMAND(CFE_EVS_ClearLogCmd);
CFEPY_COMMAND(CFE_EVS_SendHkCmd);
CFEPY_COMMAND_WITH(CFE_EVS_WriteLogDataFileCmd, CFE_EVS_LogFileCmd_Payload_t);
CFEPY_COMMAND_WITH(CFE_EVS_WriteAppDataFileCmd, CFE_EVS_AppDataCmd_Payload_t);
CFEPY_COMMAND_WITH(CFE_EVS_SetLogModeCmd, CFE_EVS_SetLogMode_Payload_t);
CFEPY_COMMAND_WITH(CFE_EVS_SetEventFormatModeCmd, CFE_EVS_SetEventFormatMode_Payload_t);
CFEPY_COMMAND_WITH(CFE_EVS_EnablePortsCmd, CFE_EVS_BitMaskCmd_Payload_t);
CFEPY_COMMAND_WITH(CFE_EVS_DisablePortsCmd, CFE_EVS_BitMaskCmd_Payload_t);
CFEPY_COMMAND_WITH(CFE_EVS_EnableEventTypeCmd, CFE_EVS_BitMaskCmd_Payload_t);
CFEPY_COMMAND_WITH(CFE_EVS_DisableEventTypeCmd, CFE_EVS_BitMaskCmd_Payload_t);
CFEPY_COMMAND_WITH(CFE_EVS_EnableAppEventsCmd, CFE_EVS_AppNameCmd_Payload_t);
CFEPY_COMMAND_WITH(CFE_EVS_DisableAppEventsCmd, CFE_EVS_AppNameCmd_Payload_t);
CFEPY_COMMAND_WITH(CFE_EVS_ResetAppCounterCmd, CFE_EVS_AppNameCmd_Payload_t);
CFEPY_COMMAND_WITH(CFE_EVS_ResetAllFiltersCmd, CFE_EVS_AppNameCmd_Payload_t);
CFEPY_COMMAND_WITH(CFE_EVS_ResetFilterCmd, CFE_EVS_AppNameEventIDCmd_Payload_t);
CFEPY_COMMAND_WITH(CFE_EVS_DeleteEventFilterCmd, CFE_EVS_AppNameEventIDCmd_Payload_t);
CFEPY_COMMAND_WITH(CFE_EVS_EnableAppEventTypeCmd, CFE_EVS_AppNameBitMaskCmd_Payload_t);
CFEPY_COMMAND_WITH(CFE_EVS_DisableAppEventTypeCmd, CFE_EVS_AppNameBitMaskCmd_Payload_t);
CFEPY_COMMAND_WITH(CFE_EVS_AddEventFilterCmd, CFE_EVS_AppNameEventIDMaskCmd_Payload_t);
CFEPY_COMMAND_WITH(CFE_EVS_SetFilterCmd, CFE_EVS_AppNameEventIDMaskCmd_Payload_t);
CFEPY_TELEMETRY(CFE_EVS_HousekeepingTlm, CFE_EVS_HousekeepingTlm_Payload_t);
CFEPY_TELEMETRY(CFE_EVS_LongEventTlm, CFE_EVS_LongEventTlm_Payload_t);
CFEPY_TELEMETRY(CFE_EVS_ShortEventTlm, CFE_EVS_ShortEventTlm_Payload_t);

CFEPY_C_END

#endif
