/* CFE_EVS: events. */
#ifndef CFEPY_EVS_H
#define CFEPY_EVS_H

#include "ids.h"
#include "time.h"

CFEPY_C_BEGIN

enum CFE_EVS_MsgFormat { CFE_EVS_MsgFormat_SHORT = 0, CFE_EVS_MsgFormat_LONG = 1 };
typedef uint8 CFE_EVS_MsgFormat_Enum_t;
enum CFE_EVS_LogMode { CFE_EVS_LogMode_OVERWRITE = 0, CFE_EVS_LogMode_DISCARD = 1 };
typedef uint8 CFE_EVS_LogMode_Enum_t;

enum CFE_EVS_EventType {
    CFE_EVS_EventType_DEBUG = 1, CFE_EVS_EventType_INFORMATION = 2, CFE_EVS_EventType_ERROR = 3,
    CFE_EVS_EventType_CRITICAL = 4
};

typedef uint16 CFE_EVS_EventType_Enum_t;
enum CFE_EVS_EventFilter { CFE_EVS_EventFilter_BINARY = 0 };
typedef uint8 CFE_EVS_EventFilter_Enum_t;

enum CFE_EVS_EventOutput {
    CFE_EVS_EventOutput_PORT1 = 1, CFE_EVS_EventOutput_PORT2 = 2, CFE_EVS_EventOutput_PORT3 = 3,
    CFE_EVS_EventOutput_PORT4 = 4
};

typedef uint8 CFE_EVS_EventOutput_Enum_t;

typedef struct CFE_EVS_BinFilter {
    uint16 EventID, Mask;
} CFE_EVS_BinFilter_t;

/* Masks of filters, by how many events they let through. */
#define CFE_EVS_EVERY_FOURTH_ONE 0x3
#define CFE_EVS_EVERY_OTHER_ONE  0x1
#define CFE_EVS_EVERY_OTHER_TWO  0x2
#define CFE_EVS_FIRST_16_STOP    0xFFF0
#define CFE_EVS_FIRST_32_STOP    0xFFE0
#define CFE_EVS_FIRST_4_STOP     0xFFFC
#define CFE_EVS_FIRST_64_STOP    0xFFC0
#define CFE_EVS_FIRST_8_STOP     0xFFF8
#define CFE_EVS_FIRST_ONE_STOP   0xFFFF
#define CFE_EVS_FIRST_TWO_STOP   0xFFFE
#define CFE_EVS_NO_FILTER        0x0

CFE_Status_t CFE_EVS_Register(const void *Filters, uint16 NumEventFilters, uint16 FilterScheme);
CFE_Status_t CFE_EVS_ResetAllFilters(void);
CFE_Status_t CFE_EVS_ResetFilter(uint16 EventID);
CFE_Status_t CFE_EVS_SendEvent(uint16 EventID, CFE_EVS_EventType_Enum_t EventType, const char *Spec, ...) OS_PRINTF(3,
    4);
CFE_Status_t CFE_EVS_SendEventWithAppID(uint16 EventID, CFE_EVS_EventType_Enum_t EventType, CFE_ES_AppId_t AppID,
    const char *Spec, ...) OS_PRINTF(4, 5);
CFE_Status_t CFE_EVS_SendTimedEvent(CFE_TIME_SysTime_t Time, uint16 EventID, CFE_EVS_EventType_Enum_t EventType,
    const char *Spec, ...) OS_PRINTF(4, 5);
/* The type of an event as the name of the function. */
#define CFE_EVS_Send(id, type, ...)  CFE_EVS_SendEvent((id), CFE_EVS_EventType_##type, __VA_ARGS__)
#define CFE_EVS_SendDbg(id, ...)     CFE_EVS_Send(id, DEBUG, __VA_ARGS__)
#define CFE_EVS_SendInfo(id, ...)    CFE_EVS_Send(id, INFORMATION, __VA_ARGS__)
#define CFE_EVS_SendErr(id, ...)     CFE_EVS_Send(id, ERROR, __VA_ARGS__)
#define CFE_EVS_SendCrit(id, ...)    CFE_EVS_Send(id, CRITICAL, __VA_ARGS__)

CFEPY_C_END

#endif
