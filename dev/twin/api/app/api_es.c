/* Executive Services, as the script calls them. */
#include <stdlib.h>
#include <string.h>

#include "api_app.h"

#define TASKID(word) ((CFE_ES_TaskId_t)CFE_RESOURCEID_WRAP(CFE_ResourceId_FromInteger((uint32)Num(word))))
#define LIBID(word) ((CFE_ES_LibId_t)CFE_RESOURCEID_WRAP(CFE_ResourceId_FromInteger((uint32)Num(word))))
#define COUNTERID(word) ((CFE_ES_CounterId_t)CFE_RESOURCEID_WRAP(CFE_ResourceId_FromInteger((uint32)Num(word))))
#define POOLID(word) ((CFE_ES_MemHandle_t)CFE_RESOURCEID_WRAP(CFE_ResourceId_FromInteger((uint32)Num(word))))
#define CDSID(word) ((CFE_ES_CDSHandle_t)CFE_RESOURCEID_WRAP(CFE_ResourceId_FromInteger((uint32)Num(word))))

static char Name[64];

#define NAME_OF(call, id)                          \
    CALL(call)                                     \
    {                                              \
        Status(CFE_##call(Name, id(1), Num(2)));   \
        OutText(Name, sizeof(Name));               \
    }
#define ID_OF(call, type)                          \
    CALL(call)                                     \
    {                                              \
        type id;                                   \
        Status(CFE_##call(&id, Text(2)));          \
        Keep(1, RAW(id));                          \
    }
#define INDEX_OF(call, id)                         \
    CALL(call)                                     \
    {                                              \
        uint32 index = 0;                          \
        Status(CFE_##call(id(1), &index));         \
        OutNum(index);                             \
    }

NAME_OF(ES_GetAppName, APPID)
NAME_OF(ES_GetLibName, LIBID)
NAME_OF(ES_GetTaskName, TASKID)
NAME_OF(ES_GetGenCounterName, COUNTERID)
NAME_OF(ES_GetCDSBlockName, CDSID)
ID_OF(ES_GetAppIDByName, CFE_ES_AppId_t)
ID_OF(ES_GetLibIDByName, CFE_ES_LibId_t)
ID_OF(ES_GetTaskIDByName, CFE_ES_TaskId_t)
ID_OF(ES_GetGenCounterIDByName, CFE_ES_CounterId_t)
ID_OF(ES_RegisterGenCounter, CFE_ES_CounterId_t)
ID_OF(ES_GetCDSBlockIDByName, CFE_ES_CDSHandle_t)
INDEX_OF(ES_AppID_ToIndex, APPID)
INDEX_OF(ES_LibID_ToIndex, LIBID)
INDEX_OF(ES_TaskID_ToIndex, TASKID)
INDEX_OF(ES_CounterID_ToIndex, COUNTERID)

CALL(ES_GetAppID)
{
    CFE_ES_AppId_t id;
    Status(CFE_ES_GetAppID(&id));
    Keep(1, RAW(id));
}
CALL(ES_GetTaskID)
{
    CFE_ES_TaskId_t id;
    Status(CFE_ES_GetTaskID(&id));
    Keep(1, RAW(id));
}

static void Info(int32 status, const CFE_ES_AppInfo_t *info)
{
    Status(status);
    OutId(CFE_ResourceId_ToInteger(info->ResourceId));
    OutNum(info->Type);
    OutText(info->Name, sizeof(info->Name));
    OutText(info->EntryPoint, sizeof(info->EntryPoint));
    OutText(info->FileName, sizeof(info->FileName));
    OutNum(info->StackSize);
    OutNum(info->ExceptionAction);
    OutNum(info->Priority);
    OutId(RAW(info->MainTaskId));
    OutText(info->MainTaskName, sizeof(info->MainTaskName));
    OutNum(info->NumOfChildTasks);
}
CALL(ES_GetAppInfo)
{
    CFE_ES_AppInfo_t info = {0};
    Info(CFE_ES_GetAppInfo(&info, APPID(1)), &info);
}
CALL(ES_GetLibInfo)
{
    CFE_ES_AppInfo_t info = {0};
    Info(CFE_ES_GetLibInfo(&info, LIBID(1)), &info);
}
CALL(ES_GetModuleInfo)
{
    CFE_ES_AppInfo_t info = {0};
    Info(CFE_ES_GetModuleInfo(&info, CFE_ResourceId_FromInteger((uint32)Num(1))), &info);
}
CALL(ES_GetTaskInfo)
{
    CFE_ES_TaskInfo_t info = {0};
    Status(CFE_ES_GetTaskInfo(&info, TASKID(1)));
    OutId(RAW(info.TaskId));
    OutText(info.TaskName, sizeof(info.TaskName));
    OutId(RAW(info.AppId));
    OutText(info.AppName, sizeof(info.AppName));
    OutNum(info.StackSize);
    OutNum(info.Priority);
}

CALL(ES_CreateChildTask)
{
    CFE_ES_TaskId_t id;
    Status(CFE_ES_CreateChildTask(&id, Text(2), ChildMain, CFE_ES_TASK_STACK_ALLOCATE, Num(3), Num(4), Num(5)));
    Keep(1, RAW(id));
    OS_TaskDelay(5);
}
CALL(ES_DeleteChildTask)
{
    Status(CFE_ES_DeleteChildTask(TASKID(1)));
    OS_TaskDelay(5);
}
CALL(ES_ExitChildTask)
{
    CFE_ES_ExitChildTask(); /* of a main task: it comes back */
    Status(0);
}
CALL(ES_IncrementTaskCounter)
{
    CFE_ES_IncrementTaskCounter();
    Status(0);
}
CALL(ES_ExecutionCounter)
{
    CFE_ES_TaskInfo_t info = {0};
    Status(CFE_ES_GetTaskInfo(&info, TASKID(1)));
    OutNum(info.ExecutionCounter);
}
CALL(ES_BackgroundWakeup)
{
    CFE_ES_BackgroundWakeup();
    Status(0);
    OS_TaskDelay(5);
}
CALL(ES_ProcessAsyncEvent)
{
    CFE_ES_ProcessAsyncEvent();
    Status(0);
}
CALL(ES_WaitForSystemState)
{
    Status(CFE_ES_WaitForSystemState(Num(1), Num(2)));
}
CALL(ES_WaitForStartupSync)
{
    CFE_ES_WaitForStartupSync(Num(1));
    Status(0);
}
CALL(ES_GetResetType)
{
    uint32 subtype = 0;
    Status(CFE_ES_GetResetType(&subtype));
    OutNum(subtype);
}
CALL(ES_RestartApp)
{
    Status(CFE_ES_RestartApp(APPID(1)));
}
CALL(ES_ReloadApp)
{
    Status(CFE_ES_ReloadApp(APPID(1), Text(2)));
}
CALL(ES_DeleteApp)
{
    Status(CFE_ES_DeleteApp(APPID(1)));
}
CALL(ES_ResetCFE)
{
    Status(CFE_ES_ResetCFE(Num(1)));
}
CALL(ES_RunLoop)
{
    uint32 status = Num(1);
    bool   goes_on = CFE_ES_RunLoop(&status);
    Status(0);
    OutNum(goes_on);
    status = CFE_ES_RunStatus_APP_RUN;
    CFE_ES_RunLoop(&status);
}
CALL(ES_WriteToSysLog)
{
    Status(CFE_ES_WriteToSysLog("%s\n", Text(1)));
}
CALL(ES_CalculateCRC)
{
    size_t size;
    void * data = Bytes(1, &size);
    Status(0);
    OutNum(CFE_ES_CalculateCRC(data, size, Num(2), Num(3)));
}
CALL(ES_PerfLogAdd)
{
    CFE_ES_PerfLogAdd(Num(1), Num(2));
    Status(0);
}
CALL(ES_StatusToString)
{
    CFE_StatusString_t text;
    Status(0);
    OutText(CFE_ES_StatusToString(Num(1), &text), sizeof(text));
}

CALL(ES_RegisterCDS)
{
    CFE_ES_CDSHandle_t handle;
    Status(CFE_ES_RegisterCDS(&handle, Num(2), Text(3)));
    Keep(1, RAW(handle));
}
CALL(ES_CopyToCDS)
{
    size_t size;
    void * data = Bytes(2, &size);
    Status(CFE_ES_CopyToCDS(CDSID(1), data));
}
CALL(ES_RestoreFromCDS)
{
    static uint8 data[100000];
    Status(CFE_ES_RestoreFromCDS(data, CDSID(1)));
    OutBytes(data, Num(2));
}

/* A pool in fresh memory of its own, which is never given back: blocks may still be asked for. */
static uint8 *Arena[SLOTS];
static uint8 *Block[SLOTS];
static int    ArenaOf[SLOTS];

static uint8 *Memory(int slot, size_t size)
{
    uint8 *memory = calloc(1, size + 256);
    Arena[slot] = memory + (16 - (cpuaddr)memory % 16) % 16;
    return Arena[slot];
}
static int Slot(int word)
{
    return (int)(Num(word) % SLOTS);
}
CALL(ES_PoolCreate)
{
    CFE_ES_MemHandle_t id;
    Status(CFE_ES_PoolCreate(&id, Memory(Slot(4), Num(2)), Num(2)));
    Keep(1, RAW(id));
}
CALL(ES_PoolCreateNoSem)
{
    CFE_ES_MemHandle_t id;
    Status(CFE_ES_PoolCreateNoSem(&id, Memory(Slot(4), Num(2)), Num(2)));
    Keep(1, RAW(id));
}
CALL(ES_PoolCreateEx)
{
    CFE_ES_MemHandle_t id;
    size_t             sizes[40];
    int                word, count = 0;
    for (word = 5; word <= Words(); ++word)
    {
        sizes[count++] = Num(word);
    }
    Status(CFE_ES_PoolCreateEx(&id, Memory(Slot(4), Num(2)), Num(2), count, count ? sizes : NULL, Num(3)));
    Keep(1, RAW(id));
}
CALL(ES_PoolDelete)
{
    Status(CFE_ES_PoolDelete(POOLID(1)));
}
CALL(ES_GetPoolBuf)
{
    CFE_ES_MemPoolBuf_t block = NULL;
    int32               status = CFE_ES_GetPoolBuf(&block, POOLID(1), Num(2));
    Status(status);
    if (status >= 0)
    {
        Block[Slot(3)]   = (uint8 *)block;
        ArenaOf[Slot(3)] = Slot(4);
        OutNum(Block[Slot(3)] - Arena[Slot(4)]);
        memset(block, 0xA5, Num(2));
    }
}
CALL(ES_GetPoolBufInfo)
{
    Status(Block[Slot(2)] ? CFE_ES_GetPoolBufInfo(POOLID(1), CFE_ES_MEMPOOLBUF_C(Block[Slot(2)])) : 0);
}
CALL(ES_PutPoolBuf)
{
    Status(Block[Slot(2)] ? CFE_ES_PutPoolBuf(POOLID(1), CFE_ES_MEMPOOLBUF_C(Block[Slot(2)])) : 0);
}
CALL(ES_GetMemPoolStats)
{
    CFE_ES_MemPoolStats_t stats;
    int                   bucket;
    Status(CFE_ES_GetMemPoolStats(&stats, POOLID(1)));
    OutNum(stats.PoolSize);
    OutNum(stats.NumBlocksRequested);
    OutNum(stats.CheckErrCtr);
    OutNum(stats.NumFreeBytes);
    for (bucket = 0; bucket < CFE_MISSION_ES_POOL_MAX_BUCKETS; ++bucket)
    {
        OutNum(stats.BlockStats[bucket].BlockSize);
        OutNum(stats.BlockStats[bucket].NumCreated);
        OutNum(stats.BlockStats[bucket].NumFree);
    }
}

CALL(ES_DeleteGenCounter)
{
    Status(CFE_ES_DeleteGenCounter(COUNTERID(1)));
}
CALL(ES_IncrementGenCounter)
{
    Status(CFE_ES_IncrementGenCounter(COUNTERID(1)));
}
CALL(ES_SetGenCount)
{
    Status(CFE_ES_SetGenCount(COUNTERID(1), Num(2)));
}
CALL(ES_GetGenCount)
{
    uint32 count = 0;
    Status(CFE_ES_GetGenCount(COUNTERID(1), &count));
    OutNum(count);
}

const Call EsCalls[] = {ROW(ES_GetAppName), ROW(ES_GetLibName), ROW(ES_GetTaskName), ROW(ES_GetGenCounterName),
    ROW(ES_GetCDSBlockName), ROW(ES_GetAppIDByName), ROW(ES_GetLibIDByName), ROW(ES_GetTaskIDByName),
    ROW(ES_GetGenCounterIDByName), ROW(ES_RegisterGenCounter), ROW(ES_GetCDSBlockIDByName), ROW(ES_AppID_ToIndex),
    ROW(ES_LibID_ToIndex), ROW(ES_TaskID_ToIndex), ROW(ES_CounterID_ToIndex), ROW(ES_GetAppID), ROW(ES_GetTaskID),
    ROW(ES_GetAppInfo), ROW(ES_GetLibInfo), ROW(ES_GetModuleInfo), ROW(ES_GetTaskInfo), ROW(ES_CreateChildTask),
    ROW(ES_DeleteChildTask), ROW(ES_ExitChildTask), ROW(ES_IncrementTaskCounter), ROW(ES_ExecutionCounter),
    ROW(ES_BackgroundWakeup), ROW(ES_ProcessAsyncEvent), ROW(ES_WaitForSystemState), ROW(ES_WaitForStartupSync),
    ROW(ES_GetResetType), ROW(ES_RestartApp), ROW(ES_ReloadApp), ROW(ES_DeleteApp), ROW(ES_ResetCFE), ROW(ES_RunLoop),
    ROW(ES_WriteToSysLog), ROW(ES_CalculateCRC), ROW(ES_PerfLogAdd), ROW(ES_StatusToString), ROW(ES_RegisterCDS),
    ROW(ES_CopyToCDS), ROW(ES_RestoreFromCDS), ROW(ES_PoolCreate), ROW(ES_PoolCreateNoSem), ROW(ES_PoolCreateEx),
    ROW(ES_PoolDelete), ROW(ES_GetPoolBuf), ROW(ES_GetPoolBufInfo), ROW(ES_PutPoolBuf), ROW(ES_GetMemPoolStats),
    ROW(ES_DeleteGenCounter), ROW(ES_IncrementGenCounter), ROW(ES_SetGenCount), ROW(ES_GetGenCount), {NULL, NULL}};
