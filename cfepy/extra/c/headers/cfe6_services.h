/* cFE 6: names of ES, EVS, TBL, TIME and FS, on those of cFE 7. */
#ifndef CFEPY_CFE6_SERVICES_H
#define CFEPY_CFE6_SERVICES_H

#if CFEPY_CFE_6 == 68
#include "cfe6_between.h"
#else
#include "cfe6_messages.h"
#endif
#include "es_messages.h"
#include "evs_messages.h"
#include "tbl_messages.h"
#include "time_messages.h"

/* ---- ES: an application and a task are registered before they run ---- */
#define CFE_ES_RegisterApp()       CFEPY_6_Status(CFE_SUCCESS)
#define CFE_ES_RegisterChildTask() CFEPY_6_Status(CFE_SUCCESS)
#if CFEPY_CFE_6 != 68
#define CFE_ES_RunLoop(status)     ((int32)CFE_ES_RunLoop(status))
#define CFE_ES_GetPoolBuf(buffer, handle, size) \
    CFE_ES_GetPoolBuf((CFE_ES_MemPoolBuf_t *)(void *)(buffer), handle, size)
#define CFE_ES_PoolCreateEx(handle, memory, size, count, sizes, mutex)                                \
    ({                                                                                                \
        const uint32 *cfepy_sizes = (const uint32 *)(sizes);                                          \
        const uint32 cfepy_count = (count);                                                           \
        size_t cfepy_wide[CFEPY_6_POOL_SIZES];                                                        \
        for (uint32 cfepy_i = 0; cfepy_sizes && cfepy_i < cfepy_count && cfepy_i < CFEPY_6_POOL_SIZES; cfepy_i++) { \
            cfepy_wide[cfepy_i] = cfepy_sizes[cfepy_i];                                               \
        }                                                                                             \
        CFE_ES_PoolCreateEx(handle, memory, size, (uint16)cfepy_count, cfepy_sizes ? cfepy_wide : NULL, mutex); \
    })
#define CFEPY_6_POOL_SIZES            17
#define CFE_ES_MAX_MEMPOOL_BLOCK_SIZES CFEPY_6_POOL_SIZES
#endif
#define CFE_ES_CDS_MAX_FULL_NAME_LEN  (CFE_MISSION_ES_CDS_MAX_NAME_LENGTH + OS_MAX_API_NAME + 2)
#define CFE_ES_APP_RUN                CFE_ES_RunStatus_APP_RUN
#define CFE_ES_APP_EXIT               CFE_ES_RunStatus_APP_EXIT
#define CFE_ES_APP_ERROR              CFE_ES_RunStatus_APP_ERROR
#define CFE_ES_SYS_EXCEPTION          CFE_ES_RunStatus_SYS_EXCEPTION
#define CFE_ES_SYS_RESTART            CFE_ES_RunStatus_SYS_RESTART
#define CFE_ES_SYS_RELOAD             CFE_ES_RunStatus_SYS_RELOAD
#define CFE_ES_SYS_DELETE             CFE_ES_RunStatus_SYS_DELETE
#define CFE_ES_CORE_APP_INIT_ERROR    CFE_ES_RunStatus_CORE_APP_INIT_ERROR
#define CFE_ES_CORE_APP_RUNTIME_ERROR CFE_ES_RunStatus_CORE_APP_RUNTIME_ERROR
#define CFE_ES_RUNSTATUS_APP_RUN      CFE_ES_RunStatus_APP_RUN
#define CFE_ES_RUNSTATUS_APP_EXIT     CFE_ES_RunStatus_APP_EXIT
#define CFE_ES_RUNSTATUS_APP_ERROR    CFE_ES_RunStatus_APP_ERROR
#define CFE_ES_RUNSTATUS_SYS_EXCEPTION CFE_ES_RunStatus_SYS_EXCEPTION
#define CFE_ES_RUNSTATUS_SYS_RESTART  CFE_ES_RunStatus_SYS_RESTART
#define CFE_ES_RUNSTATUS_SYS_RELOAD   CFE_ES_RunStatus_SYS_RELOAD
#define CFE_ES_RUNSTATUS_SYS_DELETE   CFE_ES_RunStatus_SYS_DELETE
#define CFE_ES_RUNSTATUS_CORE_APP_INIT_ERROR    CFE_ES_RunStatus_CORE_APP_INIT_ERROR
#define CFE_ES_RUNSTATUS_CORE_APP_RUNTIME_ERROR CFE_ES_RunStatus_CORE_APP_RUNTIME_ERROR
#define CFE_ES_APP_STATE_UNDEFINED    CFE_ES_AppState_UNDEFINED
#define CFE_ES_APP_STATE_EARLY_INIT   CFE_ES_AppState_EARLY_INIT
#define CFE_ES_APP_STATE_LATE_INIT    CFE_ES_AppState_LATE_INIT
#define CFE_ES_APP_STATE_RUNNING      CFE_ES_AppState_RUNNING
#define CFE_ES_APP_STATE_WAITING      CFE_ES_AppState_WAITING
#define CFE_ES_APP_STATE_STOPPED      CFE_ES_AppState_STOPPED
#define CFE_ES_APP_TYPE_CORE          CFE_ES_AppType_CORE
#define CFE_ES_APP_TYPE_EXTERNAL      CFE_ES_AppType_EXTERNAL
#define CFE_ES_SYSTEM_STATE_OPERATIONAL CFE_ES_SystemState_OPERATIONAL
#define CFE_ES_LOG_OVERWRITE          CFE_ES_LogMode_OVERWRITE
#define CFE_ES_LOG_DISCARD            CFE_ES_LogMode_DISCARD
#define CFE_ES_POWERON_RESET          CFE_PSP_RST_TYPE_POWERON
#define CFE_ES_PROCESSOR_RESET        CFE_PSP_RST_TYPE_PROCESSOR
#define CFE_ES_POWER_CYCLE            CFE_PSP_RST_SUBTYPE_POWER_CYCLE
#define CFE_ES_PUSH_BUTTON            CFE_PSP_RST_SUBTYPE_PUSH_BUTTON
#define CFE_ES_HW_SPECIAL_COMMAND     CFE_PSP_RST_SUBTYPE_HW_SPECIAL_COMMAND
#define CFE_ES_HW_WATCHDOG            CFE_PSP_RST_SUBTYPE_HW_WATCHDOG
#define CFE_ES_RESET_COMMAND          CFE_PSP_RST_SUBTYPE_RESET_COMMAND
#define CFE_ES_EXCEPTION              CFE_PSP_RST_SUBTYPE_EXCEPTION
#define CFE_ES_UNDEFINED_RESET        CFE_PSP_RST_SUBTYPE_UNDEFINED_RESET
#define CFE_ES_HWDEBUG_RESET          CFE_PSP_RST_SUBTYPE_HWDEBUG_RESET
#define CFE_ES_BANKSWITCH_RESET       CFE_PSP_RST_SUBTYPE_BANKSWITCH_RESET
#define CFS_MODULE_DECLARE_APP(name, priority, stack)
#define CFS_MODULE_DECLARE_LIB(name)

/* ---- status codes: what the functions of cFE 7 return in the same situation ---- */
#define CFE_ES_ERR_APPID          CFE_ES_ERR_RESOURCEID_NOT_VALID
#define CFE_ES_ERR_TASKID         CFE_ES_ERR_RESOURCEID_NOT_VALID
#define CFE_ES_ERR_MEM_HANDLE     CFE_ES_ERR_RESOURCEID_NOT_VALID
#define CFE_TBL_ERR_BAD_APP_ID    CFE_ES_ERR_RESOURCEID_NOT_VALID
#define CFE_ES_ERR_APPNAME        CFE_ES_ERR_NAME_NOT_FOUND
#define CFE_ES_CDS_NOT_FOUND_ERR  CFE_ES_ERR_NAME_NOT_FOUND
#define CFE_ES_ERR_BUFFER         CFE_ES_BAD_ARGUMENT
#define CFE_ES_CDS_REGISTRY_FULL  CFE_ES_NO_RESOURCE_IDS_AVAILABLE
#define CFE_TBL_ERR_FILE_NOT_FOUND CFE_TBL_ERR_ACCESS
#define CFE_OSAPI_NOT_IMPLEMENTED CFE_STATUS_NOT_IMPLEMENTED
/* These are returned no more. */
#define CFE_SB_NO_SUBSCRIBERS     ((int32)0xca00000b)
#define CFE_EVS_FUNCTION_DISABLED ((int32)0xc2000009)

/* ---- EVS: a long event, with the header of cFE 7's packets; PacketID and Message with and without Payload ---- */
#define CFE_EVS_DEBUG         CFE_EVS_EventType_DEBUG
#define CFE_EVS_INFORMATION   CFE_EVS_EventType_INFORMATION
#define CFE_EVS_ERROR         CFE_EVS_EventType_ERROR
#define CFE_EVS_CRITICAL      CFE_EVS_EventType_CRITICAL
#define CFE_EVS_BINARY_FILTER CFE_EVS_EventFilter_BINARY
#define CFE_EVS_PORT1         CFE_EVS_EventOutput_PORT1
#define CFE_EVS_PORT2         CFE_EVS_EventOutput_PORT2
#define CFE_EVS_PORT3         CFE_EVS_EventOutput_PORT3
#define CFE_EVS_PORT4         CFE_EVS_EventOutput_PORT4
#define CFE_EVS_LONG_FORMAT   CFE_EVS_MsgFormat_LONG
#define CFE_EVS_SHORT_FORMAT  CFE_EVS_MsgFormat_SHORT
#define CFE_EVS_Unregister()  CFEPY_6_Status(CFE_SUCCESS)
typedef union {
    struct {
        uint8 TlmHeader[sizeof(CFE_MSG_TelemetryHeader_t)];
        CFE_EVS_LongEventTlm_Payload_t Payload;
    };
    struct {
        CFE_MSG_TelemetryHeader_t cfepy_header;
        CFE_EVS_PacketID_t PacketID;
        char Message[CFE_MISSION_EVS_MAX_MESSAGE_LENGTH];
        uint8 Spare1, Spare2;
    };
} CFE_EVS_Packet_t;

/* ---- PSP, of which cFE 7 has the limits of the watchdog in a private header ---- */
#ifndef CFE_PSP_WATCHDOG_MIN
#define CFE_PSP_WATCHDOG_MIN 0
#define CFE_PSP_WATCHDOG_MAX 0xFFFFFFFF
#endif

/* ---- TBL ---- */
#define CFE_TBL_NotifyByMessage(handle, id, code, value) \
    CFE_TBL_NotifyByMessage(handle, CFEPY_6_Id(id), code, value)
#if CFEPY_CFE_6 != 68
#define CFE_TBL_GetAddress(address, handle) CFE_TBL_GetAddress((void **)(void *)(address), handle)
#endif
#define CFE_TBL_INACTIVE_BUFFER            CFE_TBL_BufferSelect_INACTIVE
#define CFE_TBL_ACTIVE_BUFFER              CFE_TBL_BufferSelect_ACTIVE
#define CFE_TBL_MAX_FULL_NAME_LEN_COMP     (CFE_MISSION_TBL_MAX_NAME_LENGTH + OS_MAX_API_NAME + 2)
#if CFEPY_CFE_6 == 65
#define DblBuffered DoubleBuffered
#endif

/* ---- TIME ---- */
#define CFE_TIME_INVALID    CFE_TIME_ClockState_INVALID
#define CFE_TIME_VALID      CFE_TIME_ClockState_VALID
#define CFE_TIME_FLYWHEEL   CFE_TIME_ClockState_FLYWHEEL
#define CFE_TIME_USE_INTERN CFE_TIME_SourceSelect_INTERNAL
#define CFE_TIME_USE_EXTERN CFE_TIME_SourceSelect_EXTERNAL
#define CFE_TIME_TONE_PRI   CFE_TIME_ToneSignalSelect_PRIMARY
#define CFE_TIME_TONE_RED   CFE_TIME_ToneSignalSelect_REDUNDANT
#define CFE_TIME_ADD_ADJUST CFE_TIME_AdjustDirection_ADD
#define CFE_TIME_SUB_ADJUST CFE_TIME_AdjustDirection_SUBTRACT
#define CFE_TIME_NO_FLY     CFE_TIME_FlywheelState_NO_FLY
#define CFE_TIME_IS_FLY     CFE_TIME_FlywheelState_IS_FLY
#define CFE_TIME_NOT_SET    CFE_TIME_SetState_NOT_SET
#define CFE_TIME_WAS_SET    CFE_TIME_SetState_WAS_SET
typedef CFE_TIME_ClockState_Enum_t CFE_TIME_ClockState_t;
static inline uint32 CFEPY_6_FromFile(uint32 seconds)
{
    return seconds < CFE_MISSION_TIME_FS_FACTOR ? 0 : seconds - CFE_MISSION_TIME_FS_FACTOR;
}
#define CFE_TIME_FS2CFESeconds(seconds) CFEPY_6_FromFile(seconds)
#define CFE_TIME_CFE2FSSeconds(seconds) ((uint32)(seconds) + (uint32)CFE_MISSION_TIME_FS_FACTOR)

/* ---- FS ---- */
#define CFE_FS_ES_ERLOG_SUBTYPE         CFE_FS_SubType_ES_ERLOG
#define CFE_FS_ES_SYSLOG_SUBTYPE        CFE_FS_SubType_ES_SYSLOG
#define CFE_FS_ES_QUERYALL_SUBTYPE      CFE_FS_SubType_ES_QUERYALL
#define CFE_FS_ES_PERFDATA_SUBTYPE      CFE_FS_SubType_ES_PERFDATA
#define CFE_FS_ES_CDS_REG_SUBTYPE       CFE_FS_SubType_ES_CDS_REG
#define CFE_FS_TBL_REG_SUBTYPE          CFE_FS_SubType_TBL_REG
#define CFE_FS_TBL_IMG_SUBTYPE          CFE_FS_SubType_TBL_IMG
#define CFE_FS_EVS_APPDATA_SUBTYPE      CFE_FS_SubType_EVS_APPDATA
#define CFE_FS_EVS_EVENTLOG_SUBTYPE     CFE_FS_SubType_EVS_EVENTLOG
#define CFE_FS_SB_PIPEDATA_SUBTYPE      CFE_FS_SubType_SB_PIPEDATA
#define CFE_FS_SB_ROUTEDATA_SUBTYPE     CFE_FS_SubType_SB_ROUTEDATA
#define CFE_FS_SB_MAPDATA_SUBTYPE       CFE_FS_SubType_SB_MAPDATA
#define CFE_FS_ES_QUERYALLTASKS_SUBTYPE CFE_FS_SubType_ES_QUERYALLTASKS

/* ---- packets of cFE itself, as cFE 7 sends and takes them ---- */
typedef CFE_ES_HousekeepingTlm_t CFE_ES_HkPacket_t;
typedef CFE_TBL_HousekeepingTlm_t CFE_TBL_HkPacket_t;
typedef CFE_TIME_HousekeepingTlm_t CFE_TIME_HkPacket_t;
typedef CFE_SB_HousekeepingTlm_t CFE_SB_HKMsg_t;
typedef CFE_EVS_HousekeepingTlm_t CFE_EVS_TlmPkt_t;

#endif
