/* Commands and telemetry of CFE_ES: function codes, payloads, packets. */
#ifndef CFEPY_ES_MESSAGES_H
#define CFEPY_ES_MESSAGES_H

#include "message_kinds.h"

CFEPY_C_BEGIN

enum CFE_ES_FunctionCode_ {
    CFE_ES_FunctionCode_NOOP = 0, CFE_ES_FunctionCode_RESET_COUNTERS = 1, CFE_ES_FunctionCode_RESTART = 2,
    CFE_ES_FunctionCode_START_APP = 4, CFE_ES_FunctionCode_STOP_APP = 5, CFE_ES_FunctionCode_RESTART_APP = 6,
    CFE_ES_FunctionCode_RELOAD_APP = 7, CFE_ES_FunctionCode_QUERY_ONE = 8, CFE_ES_FunctionCode_QUERY_ALL = 9,
    CFE_ES_FunctionCode_CLEAR_SYS_LOG = 10, CFE_ES_FunctionCode_WRITE_SYS_LOG = 11,
    CFE_ES_FunctionCode_CLEAR_ER_LOG = 12, CFE_ES_FunctionCode_WRITE_ER_LOG = 13,
    CFE_ES_FunctionCode_START_PERF_DATA = 14, CFE_ES_FunctionCode_STOP_PERF_DATA = 15,
    CFE_ES_FunctionCode_SET_PERF_FILTER_MASK = 16, CFE_ES_FunctionCode_SET_PERF_TRIGGER_MASK = 17,
    CFE_ES_FunctionCode_OVER_WRITE_SYS_LOG = 18, CFE_ES_FunctionCode_RESET_PR_COUNT = 19,
    CFE_ES_FunctionCode_SET_MAX_PR_COUNT = 20, CFE_ES_FunctionCode_DELETE_CDS = 21,
    CFE_ES_FunctionCode_SEND_MEM_POOL_STATS = 22, CFE_ES_FunctionCode_DUMP_CDS_REGISTRY = 23,
    CFE_ES_FunctionCode_QUERY_ALL_TASKS = 24
};

#define CFE_ES_NOOP_CC                  0
#define CFE_ES_RESET_COUNTERS_CC        1
#define CFE_ES_RESTART_CC               2
#define CFE_ES_START_APP_CC             4
#define CFE_ES_STOP_APP_CC              5
#define CFE_ES_RESTART_APP_CC           6
#define CFE_ES_RELOAD_APP_CC            7
#define CFE_ES_QUERY_ONE_CC             8
#define CFE_ES_QUERY_ALL_CC             9
#define CFE_ES_CLEAR_SYS_LOG_CC         10
#define CFE_ES_WRITE_SYS_LOG_CC         11
#define CFE_ES_CLEAR_ER_LOG_CC          12
#define CFE_ES_WRITE_ER_LOG_CC          13
#define CFE_ES_START_PERF_DATA_CC       14
#define CFE_ES_STOP_PERF_DATA_CC        15
#define CFE_ES_SET_PERF_FILTER_MASK_CC  16
#define CFE_ES_SET_PERF_TRIGGER_MASK_CC 17
#define CFE_ES_OVER_WRITE_SYS_LOG_CC    18
#define CFE_ES_RESET_PR_COUNT_CC        19
#define CFE_ES_SET_MAX_PR_COUNT_CC      20
#define CFE_ES_DELETE_CDS_CC            21
#define CFE_ES_SEND_MEM_POOL_STATS_CC   22
#define CFE_ES_DUMP_CDS_REGISTRY_CC     23
#define CFE_ES_QUERY_ALL_TASKS_CC       24

typedef struct CFE_ES_RestartCmd_Payload {
    uint16 RestartType;
} CFE_ES_RestartCmd_Payload_t;

typedef struct CFE_ES_FileNameCmd_Payload {
    char FileName[CFE_MISSION_MAX_PATH_LEN];
} CFE_ES_FileNameCmd_Payload_t;

typedef struct CFE_ES_OverWriteSysLogCmd_Payload {
    uint32 Mode;
} CFE_ES_OverWriteSysLogCmd_Payload_t;

typedef struct CFE_ES_StartAppCmd_Payload {
    char Application[CFE_MISSION_MAX_API_LEN], AppEntryPoint[CFE_MISSION_MAX_API_LEN],
        AppFileName[CFE_MISSION_MAX_PATH_LEN];
    CFE_ES_MemOffset_t StackSize;
    CFE_ES_ExceptionAction_Enum_t ExceptionAction;
    CFE_ES_TaskPriority_Atom_t Priority;
} CFE_ES_StartAppCmd_Payload_t;

typedef struct CFE_ES_AppNameCmd_Payload {
    char Application[CFE_MISSION_MAX_API_LEN];
} CFE_ES_AppNameCmd_Payload_t;

typedef struct CFE_ES_AppReloadCmd_Payload {
    char Application[CFE_MISSION_MAX_API_LEN], AppFileName[CFE_MISSION_MAX_PATH_LEN];
} CFE_ES_AppReloadCmd_Payload_t;

typedef struct CFE_ES_SetMaxPRCountCmd_Payload {
    uint16 MaxPRCount;
} CFE_ES_SetMaxPRCountCmd_Payload_t;

typedef struct CFE_ES_DeleteCDSCmd_Payload {
    char CdsName[40];
} CFE_ES_DeleteCDSCmd_Payload_t;

enum CFE_ES_PerfMode { CFE_ES_PerfTrigger_START = 0, CFE_ES_PerfTrigger_CENTER, CFE_ES_PerfTrigger_END };
typedef uint32 CFE_ES_PerfMode_Enum_t;

typedef struct CFE_ES_StartPerfCmd_Payload {
    CFE_ES_PerfMode_Enum_t TriggerMode;
} CFE_ES_StartPerfCmd_Payload_t;

typedef struct CFE_ES_StopPerfCmd_Payload {
    char DataFileName[CFE_MISSION_MAX_PATH_LEN];
} CFE_ES_StopPerfCmd_Payload_t;

typedef struct CFE_ES_SetPerfFilterMaskCmd_Payload {
    uint32 FilterMaskNum, FilterMask;
} CFE_ES_SetPerfFilterMaskCmd_Payload_t;

typedef struct CFE_ES_SetPerfTrigMaskCmd_Payload {
    uint32 TriggerMaskNum, TriggerMask;
} CFE_ES_SetPerfTrigMaskCmd_Payload_t;

typedef struct CFE_ES_SendMemPoolStatsCmd_Payload {
    char Application[CFE_MISSION_MAX_API_LEN];
    CFE_ES_MemHandle_t PoolHandle;
} CFE_ES_SendMemPoolStatsCmd_Payload_t;

typedef struct CFE_ES_DumpCDSRegistryCmd_Payload {
    char DumpFilename[CFE_MISSION_MAX_PATH_LEN];
} CFE_ES_DumpCDSRegistryCmd_Payload_t;

typedef struct CFE_ES_OneAppTlm_Payload {
    CFE_ES_AppInfo_t AppInfo;
} CFE_ES_OneAppTlm_Payload_t;

typedef struct CFE_ES_PoolStatsTlm_Payload {
    CFE_ES_MemHandle_t PoolHandle;
    CFE_ES_MemPoolStats_t PoolStats;
} CFE_ES_PoolStatsTlm_Payload_t;

typedef struct CFE_ES_HousekeepingTlm_Payload {
    uint8 CommandCounter, CommandErrorCounter;
    uint16 CFECoreChecksum;
    uint8 CFEMajorVersion, CFEMinorVersion, CFERevision, CFEMissionRevision, OSALMajorVersion, OSALMinorVersion,
        OSALRevision, OSALMissionRevision, PSPMajorVersion, PSPMinorVersion, PSPRevision, PSPMissionRevision;
    CFE_ES_MemOffset_t SysLogBytesUsed, SysLogSize;
    uint32 SysLogEntries, SysLogMode, ERLogIndex, ERLogEntries, RegisteredCoreApps, RegisteredExternalApps,
        RegisteredTasks, RegisteredLibs, ResetType, ResetSubtype, ProcessorResets, MaxProcessorResets, BootSource,
        PerfState, PerfMode, PerfTriggerCount, PerfFilterMask[128 / 32], PerfTriggerMask[128 / 32], PerfDataStart,
        PerfDataEnd, PerfDataCount, PerfDataToWrite;
    CFE_ES_MemOffset_t HeapBytesFree, HeapBlocksFree, HeapMaxBlockSize;
} CFE_ES_HousekeepingTlm_Payload_t;


CFEPY_COMMAND(CFE_ES_NoopCmd);
CFEPY_COMMAND(CFE_ES_ResetCountersCmd);
CFEPY_COMMAND(CFE_ES_ClearSysLogCmd);
CFEPY_COMMAND(CFE_ES_ClearERLogCmd);
CFEPY_COMMAND(CFE_ES_ResetPRCountCmd);
CFEPY_COMMAND(CFE_ES_SendHkCmd);
CFEPY_COMMAND_WITH(CFE_ES_RestartCmd, CFE_ES_RestartCmd_Payload_t);
CFEPY_COMMAND_WITH(CFE_ES_FileNameCmd, CFE_ES_FileNameCmd_Payload_t);
CFEPY_COMMAND_WITH(CFE_ES_QueryAllCmd, CFE_ES_FileNameCmd_Payload_t);
CFEPY_COMMAND_WITH(CFE_ES_QueryAllTasksCmd, CFE_ES_FileNameCmd_Payload_t);
CFEPY_COMMAND_WITH(CFE_ES_WriteSysLogCmd, CFE_ES_FileNameCmd_Payload_t);
CFEPY_COMMAND_WITH(CFE_ES_WriteERLogCmd, CFE_ES_FileNameCmd_Payload_t);
CFEPY_COMMAND_WITH(CFE_ES_OverWriteSysLogCmd, CFE_ES_OverWriteSysLogCmd_Payload_t);
CFEPY_COMMAND_WITH(CFE_ES_StartAppCmd, CFE_ES_StartAppCmd_Payload_t);
CFEPY_COMMAND_WITH(CFE_ES_StopAppCmd, CFE_ES_AppNameCmd_Payload_t);
CFEPY_COMMAND_WITH(CFE_ES_RestartAppCmd, CFE_ES_AppNameCmd_Payload_t);
CFEPY_COMMAND_WITH(CFE_ES_QueryOneCmd, CFE_ES_AppNameCmd_Payload_t);
CFEPY_COMMAND_WITH(CFE_ES_ReloadAppCmd, CFE_ES_AppReloadCmd_Payload_t);
CFEPY_COMMAND_WITH(CFE_ES_SetMaxPRCountCmd, CFE_ES_SetMaxPRCountCmd_Payload_t);
CFEPY_COMMAND_WITH(CFE_ES_DeleteCDSCmd, CFE_ES_DeleteCDSCmd_Payload_t);
CFEPY_COMMAND_WITH(CFE_ES_StartPerfDataCmd, CFE_ES_StartPerfCmd_Payload_t);
CFEPY_COMMAND_WITH(CFE_ES_StopPerfDataCmd, CFE_ES_StopPerfCmd_Payload_t);
CFEPY_COMMAND_WITH(CFE_ES_SetPerfFilterMaskCmd, CFE_ES_SetPerfFilterMaskCmd_Payload_t);
CFEPY_COMMAND_WITH(CFE_ES_SetPerfTriggerMaskCmd, CFE_ES_SetPerfTrigMaskCmd_Payload_t);
CFEPY_COMMAND_WITH(CFE_ES_SendMemPoolStatsCmd, CFE_ES_SendMemPoolStatsCmd_Payload_t);
CFEPY_COMMAND_WITH(CFE_ES_DumpCDSRegistryCmd, CFE_ES_DumpCDSRegistryCmd_Payload_t);
CFEPY_TELEMETRY(CFE_ES_OneAppTlm, CFE_ES_OneAppTlm_Payload_t);
CFEPY_TELEMETRY(CFE_ES_MemStatsTlm, CFE_ES_PoolStatsTlm_Payload_t);
CFEPY_TELEMETRY(CFE_ES_HousekeepingTlm, CFE_ES_HousekeepingTlm_Payload_t);

CFEPY_C_END

#endif
