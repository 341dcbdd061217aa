/* CFE_ES: applications, tasks, memory pools, the Critical Data Store, counters, logs. */
#ifndef CFEPY_ES_H
#define CFEPY_ES_H

#include "ids.h"
#include "psp.h"

CFEPY_C_BEGIN

typedef uint64 CFE_ES_MemOffset_t;
typedef uint64 CFE_ES_MemAddress_t;
#define CFE_ES_MEMOFFSET_C(value)         ((CFE_ES_MemOffset_t)(value))
#define CFE_ES_MEMOFFSET_TO_SIZET(offset) ((size_t)(offset))
#define CFE_ES_MEMADDRESS_C(pointer)      ((CFE_ES_MemAddress_t)(cpuaddr)(pointer))
#define CFE_ES_MEMADDRESS_TO_PTR(address) ((void *)(cpuaddr)(address))

enum CFE_ES_LogMode { CFE_ES_LogMode_OVERWRITE = 0, CFE_ES_LogMode_DISCARD = 1 };
typedef uint8 CFE_ES_LogMode_Enum_t;
enum CFE_ES_ExceptionAction { CFE_ES_ExceptionAction_RESTART_APP = 0, CFE_ES_ExceptionAction_PROC_RESTART = 1 };
typedef uint8 CFE_ES_ExceptionAction_Enum_t;
enum CFE_ES_AppType { CFE_ES_AppType_CORE = 1, CFE_ES_AppType_EXTERNAL = 2, CFE_ES_AppType_LIBRARY = 3 };
typedef uint8 CFE_ES_AppType_Enum_t;

enum CFE_ES_RunStatus {
    CFE_ES_RunStatus_UNDEFINED = 0, CFE_ES_RunStatus_APP_RUN = 1, CFE_ES_RunStatus_APP_EXIT = 2,
    CFE_ES_RunStatus_APP_ERROR = 3, CFE_ES_RunStatus_SYS_EXCEPTION = 4, CFE_ES_RunStatus_SYS_RESTART = 5,
    CFE_ES_RunStatus_SYS_RELOAD = 6, CFE_ES_RunStatus_SYS_DELETE = 7, CFE_ES_RunStatus_CORE_APP_INIT_ERROR = 8,
    CFE_ES_RunStatus_CORE_APP_RUNTIME_ERROR = 9, CFE_ES_RunStatus_MAX
};

typedef uint32 CFE_ES_RunStatus_Enum_t;

enum CFE_ES_SystemState {
    CFE_ES_SystemState_UNDEFINED = 0, CFE_ES_SystemState_EARLY_INIT = 1, CFE_ES_SystemState_CORE_STARTUP = 2,
    CFE_ES_SystemState_CORE_READY = 3, CFE_ES_SystemState_APPS_INIT = 4, CFE_ES_SystemState_OPERATIONAL = 5,
    CFE_ES_SystemState_SHUTDOWN = 6, CFE_ES_SystemState_MAX
};

typedef uint32 CFE_ES_SystemState_Enum_t;
enum CFE_ES_LogEntryType { CFE_ES_LogEntryType_CORE = 1, CFE_ES_LogEntryType_APPLICATION = 2 };
typedef uint8 CFE_ES_LogEntryType_Enum_t;

enum CFE_ES_AppState {
    CFE_ES_AppState_UNDEFINED = 0, CFE_ES_AppState_EARLY_INIT = 1, CFE_ES_AppState_LATE_INIT = 2,
    CFE_ES_AppState_RUNNING = 3, CFE_ES_AppState_WAITING = 4, CFE_ES_AppState_STOPPED = 5, CFE_ES_AppState_MAX
};

typedef uint32 CFE_ES_AppState_Enum_t;
typedef uint16 CFE_ES_TaskPriority_Atom_t;

typedef struct CFE_ES_AppInfo {
    CFE_ResourceId_t ResourceId;
    uint32 Type;
    char Name[CFE_MISSION_MAX_API_LEN], EntryPoint[CFE_MISSION_MAX_API_LEN], FileName[CFE_MISSION_MAX_PATH_LEN];
    CFE_ES_MemOffset_t StackSize;
    uint32 AddressesAreValid;
    CFE_ES_MemAddress_t CodeAddress;
    CFE_ES_MemOffset_t CodeSize;
    CFE_ES_MemAddress_t DataAddress;
    CFE_ES_MemOffset_t DataSize;
    CFE_ES_MemAddress_t BSSAddress;
    CFE_ES_MemOffset_t BSSSize;
    CFE_ES_MemAddress_t StartAddress;
    CFE_ES_ExceptionAction_Enum_t ExceptionAction;
    CFE_ES_TaskPriority_Atom_t Priority;
    CFE_ES_TaskId_t MainTaskId;
    uint32 ExecutionCounter;
    char MainTaskName[CFE_MISSION_MAX_API_LEN];
    uint32 NumOfChildTasks;
} CFE_ES_AppInfo_t;

typedef struct CFE_ES_TaskInfo {
    CFE_ES_TaskId_t TaskId;
    uint32 ExecutionCounter;
    char TaskName[CFE_MISSION_MAX_API_LEN];
    CFE_ES_AppId_t AppId;
    char AppName[CFE_MISSION_MAX_API_LEN];
    CFE_ES_MemOffset_t StackSize;
    CFE_ES_TaskPriority_Atom_t Priority;
    uint8 Spare[2];
} CFE_ES_TaskInfo_t;

typedef struct CFE_ES_CDSRegDumpRec {
    CFE_ES_CDSHandle_t Handle;
    CFE_ES_MemOffset_t Size;
    bool Table;
    char Name[40];
    uint8 ByteAlignSpare[3];
} CFE_ES_CDSRegDumpRec_t;

typedef struct CFE_ES_BlockStats {
    CFE_ES_MemOffset_t BlockSize;
    uint32 NumCreated, NumFree;
} CFE_ES_BlockStats_t;

typedef struct CFE_ES_MemPoolStats {
    CFE_ES_MemOffset_t PoolSize;
    uint32 NumBlocksRequested, CheckErrCtr;
    CFE_ES_MemOffset_t NumFreeBytes;
    CFE_ES_BlockStats_t BlockStats[17];
} CFE_ES_MemPoolStats_t;

typedef void (*CFE_ES_TaskEntryFuncPtr_t)(void);
typedef int32 (*CFE_ES_LibraryEntryFuncPtr_t)(CFE_ES_LibId_t LibId);
typedef CFE_ES_TaskEntryFuncPtr_t CFE_ES_ChildTaskMainFuncPtr_t;
typedef void *CFE_ES_StackPointer_t;

typedef enum CFE_ES_CrcType_Enum {
    CFE_ES_CrcType_NONE = 0, CFE_ES_CrcType_16_ARC = 1, CFE_ES_CrcType_MAX = 2,
    CFE_ES_CrcType_CRC_16 = CFE_ES_CrcType_16_ARC, CFE_ES_CrcType_CRC_8 = CFE_ES_CrcType_MAX + 1,
    CFE_ES_CrcType_CRC_32 = CFE_ES_CrcType_MAX + 2
} CFE_ES_CrcType_Enum_t;

typedef union CFE_ES_PoolAlign {
    void *Ptr;
    long long int LongInt;
    long double LongDouble;
} CFE_ES_PoolAlign_t;

typedef void *CFE_ES_MemPoolBuf_t;
#define CFE_ES_NO_MUTEX    false
#define CFE_ES_USE_MUTEX   true
#define CFE_ES_APP_RESTART 3
#define CFE_ES_TASK_STACK_ALLOCATE NULL
#define CFE_ES_MEMPOOLBUF_C(pointer) ((CFE_ES_MemPoolBuf_t)(pointer))
#define CFE_ES_STATIC_POOL_TYPE(size) \
    union {                           \
        CFE_ES_PoolAlign_t Align;     \
        uint8 Data[size];             \
    }

/* ---- the life of applications and of the processor ---- */
void CFE_ES_BackgroundWakeup(void);
CFE_Status_t CFE_ES_DeleteApp(CFE_ES_AppId_t AppID);
void CFE_ES_ExitApp(uint32 ExitStatus);
int32 CFE_ES_GetResetType(uint32 *ResetSubtypePtr);
void CFE_ES_Main(uint32 StartType, uint32 StartSubtype, uint32 ModeId, const char *StartFilePath);
void CFE_ES_ProcessAsyncEvent(void);
CFE_Status_t CFE_ES_ReloadApp(CFE_ES_AppId_t AppID, const char *AppFileName);
CFE_Status_t CFE_ES_ResetCFE(uint32 ResetType);
CFE_Status_t CFE_ES_RestartApp(CFE_ES_AppId_t AppID);
bool CFE_ES_RunLoop(uint32 *RunStatus);
void CFE_ES_WaitForStartupSync(uint32 TimeOutMilliseconds);
CFE_Status_t CFE_ES_WaitForSystemState(uint32 MinSystemState, uint32 TimeOutMilliseconds);

/* ---- who there is ---- */
CFE_Status_t CFE_ES_AppID_ToIndex(CFE_ES_AppId_t AppID, uint32 *Idx);
CFE_Status_t CFE_ES_CounterID_ToIndex(CFE_ES_CounterId_t CounterId, uint32 *Idx);
CFE_Status_t CFE_ES_GetAppID(CFE_ES_AppId_t *AppIdPtr);
CFE_Status_t CFE_ES_GetAppIDByName(CFE_ES_AppId_t *AppIdPtr, const char *AppName);
CFE_Status_t CFE_ES_GetAppInfo(CFE_ES_AppInfo_t *AppInfo, CFE_ES_AppId_t AppId);
CFE_Status_t CFE_ES_GetAppName(char *AppName, CFE_ES_AppId_t AppId, size_t BufferLength);
CFE_Status_t CFE_ES_GetLibIDByName(CFE_ES_LibId_t *LibIdPtr, const char *LibName);
int32 CFE_ES_GetLibInfo(CFE_ES_AppInfo_t *LibInfo, CFE_ES_LibId_t LibId);
CFE_Status_t CFE_ES_GetLibName(char *LibName, CFE_ES_LibId_t LibId, size_t BufferLength);
int32 CFE_ES_GetModuleInfo(CFE_ES_AppInfo_t *ModuleInfo, CFE_ResourceId_t ResourceId);
CFE_Status_t CFE_ES_GetTaskID(CFE_ES_TaskId_t *TaskIdPtr);
CFE_Status_t CFE_ES_GetTaskIDByName(CFE_ES_TaskId_t *TaskIdPtr, const char *TaskName);
CFE_Status_t CFE_ES_GetTaskInfo(CFE_ES_TaskInfo_t *TaskInfo, CFE_ES_TaskId_t TaskId);
CFE_Status_t CFE_ES_GetTaskName(char *TaskName, CFE_ES_TaskId_t TaskId, size_t BufferLength);
int32 CFE_ES_LibID_ToIndex(CFE_ES_LibId_t LibId, uint32 *Idx);
CFE_Status_t CFE_ES_TaskID_ToIndex(CFE_ES_TaskId_t TaskID, uint32 *Idx);

/* ---- child tasks ---- */
CFE_Status_t CFE_ES_CreateChildTask(CFE_ES_TaskId_t *TaskIdPtr, const char *TaskName,
    CFE_ES_ChildTaskMainFuncPtr_t FunctionPtr, CFE_ES_StackPointer_t StackPtr, size_t StackSize,
    CFE_ES_TaskPriority_Atom_t Priority, uint32 Flags);
CFE_Status_t CFE_ES_DeleteChildTask(CFE_ES_TaskId_t TaskId);
void CFE_ES_ExitChildTask(void);
void CFE_ES_IncrementTaskCounter(void);

/* ---- the Critical Data Store ---- */
CFE_Status_t CFE_ES_CopyToCDS(CFE_ES_CDSHandle_t Handle, const void *DataToCopy);
CFE_Status_t CFE_ES_GetCDSBlockIDByName(CFE_ES_CDSHandle_t *BlockIdPtr, const char *BlockName);
CFE_Status_t CFE_ES_GetCDSBlockName(char *BlockName, CFE_ES_CDSHandle_t BlockId, size_t BufferLength);
CFE_Status_t CFE_ES_RegisterCDS(CFE_ES_CDSHandle_t *CDSHandlePtr, size_t BlockSize, const char *Name);
CFE_Status_t CFE_ES_RestoreFromCDS(void *RestoreToMemory, CFE_ES_CDSHandle_t Handle);

/* ---- memory pools ---- */
CFE_Status_t CFE_ES_GetMemPoolStats(CFE_ES_MemPoolStats_t *BufPtr, CFE_ES_MemHandle_t Handle);
int32 CFE_ES_GetPoolBuf(CFE_ES_MemPoolBuf_t *BufPtr, CFE_ES_MemHandle_t Handle, size_t Size);
CFE_Status_t CFE_ES_GetPoolBufInfo(CFE_ES_MemHandle_t Handle, CFE_ES_MemPoolBuf_t BufPtr);
CFE_Status_t CFE_ES_PoolCreate(CFE_ES_MemHandle_t *PoolID, void *MemPtr, size_t Size);
CFE_Status_t CFE_ES_PoolCreateEx(CFE_ES_MemHandle_t *PoolID, void *MemPtr, size_t Size, uint16 NumBlockSizes,
    const size_t *BlockSizes, bool UseMutex);
CFE_Status_t CFE_ES_PoolCreateEx_WithAlignment(CFE_ES_MemHandle_t *PoolID, void *MemPtr, size_t Size,
    uint16 NumBlockSizes, const size_t *BlockSizes, bool UseMutex, size_t Alignment);
CFE_Status_t CFE_ES_PoolCreateNoSem(CFE_ES_MemHandle_t *PoolID, void *MemPtr, size_t Size);
int32 CFE_ES_PoolDelete(CFE_ES_MemHandle_t PoolID);
int32 CFE_ES_PutPoolBuf(CFE_ES_MemHandle_t Handle, CFE_ES_MemPoolBuf_t BufPtr);

/* ---- generic counters ---- */
CFE_Status_t CFE_ES_DeleteGenCounter(CFE_ES_CounterId_t CounterId);
CFE_Status_t CFE_ES_GetGenCount(CFE_ES_CounterId_t CounterId, uint32 *Count);
CFE_Status_t CFE_ES_GetGenCounterIDByName(CFE_ES_CounterId_t *CounterIdPtr, const char *CounterName);
CFE_Status_t CFE_ES_GetGenCounterName(char *CounterName, CFE_ES_CounterId_t CounterId, size_t BufferLength);
CFE_Status_t CFE_ES_IncrementGenCounter(CFE_ES_CounterId_t CounterId);
CFE_Status_t CFE_ES_RegisterGenCounter(CFE_ES_CounterId_t *CounterIdPtr, const char *CounterName);
CFE_Status_t CFE_ES_SetGenCount(CFE_ES_CounterId_t CounterId, uint32 Count);

/* ---- logs, performance, checksums ---- */
uint32 CFE_ES_CalculateCRC(const void *DataPtr, size_t DataLength, uint32 InputCRC, CFE_ES_CrcType_Enum_t TypeCRC);
void CFE_ES_PerfLogAdd(uint32 Marker, uint32 EntryExit);
CFE_Status_t CFE_ES_WriteToSysLog(const char *SpecStringPtr, ...) OS_PRINTF(1, 2);
#define CFE_ES_PerfLogEntry(id) (CFE_ES_PerfLogAdd(id, 0))
#define CFE_ES_PerfLogExit(id)  (CFE_ES_PerfLogAdd(id, 1))

CFEPY_C_END

#endif
