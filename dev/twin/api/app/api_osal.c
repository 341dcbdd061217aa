/* The OSAL, as the script calls it. */
#define _XOPEN_SOURCE 600
#include <string.h>
#include <time.h>

#include "api_app.h"

static uint8 Buffer[70000];

#define CREATE(call, ...)                            \
    CALL(call)                                       \
    {                                                \
        osal_id_t id;                                \
        Status(call(&id, Text(2), __VA_ARGS__));     \
        Keep(1, OS_ObjectIdToInteger(id));           \
    }
#define ID_OF(call)                                  \
    CALL(call)                                       \
    {                                                \
        osal_id_t id;                                \
        Status(call(&id, Text(2)));                  \
        Keep(1, OS_ObjectIdToInteger(id));           \
    }
#define WITH_ID(call)         \
    CALL(call)                \
    {                         \
        Status(call(OSID(1))); \
    }
#define WITH_TEXT(call)         \
    CALL(call)                  \
    {                           \
        Status(call(Text(1)));  \
    }
#define INFO(call, type, ...)                    \
    CALL(call)                                   \
    {                                            \
        type info;                               \
        memset(&info, 0, sizeof(info));          \
        Status(call(OSID(1), &info));            \
        OutText(info.name, sizeof(info.name));   \
        OutId(OS_ObjectIdToInteger(info.creator)); \
        __VA_ARGS__;                             \
    }

CREATE(OS_TaskCreate, ChildMain, OSAL_TASK_STACK_ALLOCATE, Num(3), Num(4), Num(5))
ID_OF(OS_TaskGetIdByName)
INFO(OS_TaskGetInfo, OS_task_prop_t, OutNum(info.stack_size), OutNum(info.priority))
CALL(OS_TaskDelete)
{
    Status(OS_TaskDelete(OSID(1)));
    OS_TaskDelay(5);
}
CALL(OS_TaskSetPriority)
{
    Status(OS_TaskSetPriority(OSID(1), Num(2)));
}
CALL(OS_TaskGetId)
{
    Status(0);
    OutId(OS_ObjectIdToInteger(OS_TaskGetId()));
}
CALL(OS_TaskDelay)
{
    Status(OS_TaskDelay(Num(1)));
}

CREATE(OS_QueueCreate, Num(3), Num(4), Num(5))
WITH_ID(OS_QueueDelete)
ID_OF(OS_QueueGetIdByName)
INFO(OS_QueueGetInfo, OS_queue_prop_t, (void)0)
CALL(OS_QueuePut)
{
    size_t size;
    void * data = Bytes(2, &size);
    Status(OS_QueuePut(OSID(1), data, size, 0));
}
CALL(OS_QueueGet)
{
    size_t size = 0;
    Status(OS_QueueGet(OSID(1), Buffer, Num(2), &size, Num(3)));
    OutBytes(Buffer, size);
}

CREATE(OS_MutSemCreate, Num(3))
WITH_ID(OS_MutSemDelete)
WITH_ID(OS_MutSemTake)
WITH_ID(OS_MutSemGive)
ID_OF(OS_MutSemGetIdByName)
INFO(OS_MutSemGetInfo, OS_mut_sem_prop_t, (void)0)
CREATE(OS_BinSemCreate, Num(3), Num(4))
WITH_ID(OS_BinSemDelete)
WITH_ID(OS_BinSemTake)
WITH_ID(OS_BinSemGive)
WITH_ID(OS_BinSemFlush)
ID_OF(OS_BinSemGetIdByName)
INFO(OS_BinSemGetInfo, OS_bin_sem_prop_t, OutNum(info.value))
CALL(OS_BinSemTimedWait)
{
    Status(OS_BinSemTimedWait(OSID(1), Num(2)));
}
CREATE(OS_CountSemCreate, Num(3), Num(4))
WITH_ID(OS_CountSemDelete)
WITH_ID(OS_CountSemTake)
WITH_ID(OS_CountSemGive)
ID_OF(OS_CountSemGetIdByName)
INFO(OS_CountSemGetInfo, OS_count_sem_prop_t, OutNum(info.value))
CALL(OS_CountSemTimedWait)
{
    Status(OS_CountSemTimedWait(OSID(1), Num(2)));
}
CREATE(OS_CondVarCreate, Num(3))
WITH_ID(OS_CondVarDelete)
WITH_ID(OS_CondVarLock)
WITH_ID(OS_CondVarUnlock)
WITH_ID(OS_CondVarSignal)
WITH_ID(OS_CondVarBroadcast)
ID_OF(OS_CondVarGetIdByName)
INFO(OS_CondVarGetInfo, OS_condvar_prop_t, (void)0)
CALL(OS_CondVarTimedWait)
{
    OS_time_t until;
    OS_GetLocalTime(&until);
    until = OS_TimeAdd(until, OS_TimeFromTotalMilliseconds(Num(2)));
    Status(OS_CondVarTimedWait(OSID(1), &until));
}
CREATE(OS_RwLockCreate, Num(3))
WITH_ID(OS_RwLockDelete)
WITH_ID(OS_RwLockReadTake)
WITH_ID(OS_RwLockReadGive)
WITH_ID(OS_RwLockWriteTake)
WITH_ID(OS_RwLockWriteGive)
ID_OF(OS_RwLockGetIdByName)
INFO(OS_RwLockGetInfo, OS_rwlock_prop_t, (void)0)

static volatile int Fired;
static void Expire(osal_id_t timer)
{
    ++Fired;
}
static void ExpireWith(osal_id_t timer, void *arg)
{
    ++Fired;
}
static uint32 Sync(osal_id_t timebase)
{
    struct timespec pause = {0, 10000000};
    nanosleep(&pause, NULL);
    return 10000;
}
CALL(OS_TimerCreate)
{
    osal_id_t id;
    uint32    accuracy = 0;
    Status(OS_TimerCreate(&id, Text(2), &accuracy, Expire));
    Keep(1, OS_ObjectIdToInteger(id));
}
CALL(OS_TimerAdd)
{
    osal_id_t id;
    Status(OS_TimerAdd(&id, Text(2), OSID(3), ExpireWith, NULL));
    Keep(1, OS_ObjectIdToInteger(id));
}
CALL(OS_TimerSet)
{
    Status(OS_TimerSet(OSID(1), Num(2), Num(3)));
}
CALL(OS_TimerFires)
{
    int32 status;
    Fired  = 0;
    status = OS_TimerSet(OSID(1), Num(2), Num(3));
    OS_TaskDelay(250);
    Status(status);
    OutNum(Fired > 1 ? 2 : Fired);
    OS_TimerSet(OSID(1), 100000000, 0);
}
WITH_ID(OS_TimerDelete)
ID_OF(OS_TimerGetIdByName)
INFO(OS_TimerGetInfo, OS_timer_prop_t, OutNum(info.interval_time))
CALL(OS_TimeBaseCreate)
{
    osal_id_t id;
    Status(OS_TimeBaseCreate(&id, Text(2), Num(3) ? Sync : NULL));
    Keep(1, OS_ObjectIdToInteger(id));
}
CALL(OS_TimeBaseSet)
{
    Status(OS_TimeBaseSet(OSID(1), Num(2), Num(3)));
}
WITH_ID(OS_TimeBaseDelete)
ID_OF(OS_TimeBaseGetIdByName)
INFO(OS_TimeBaseGetInfo, OS_timebase_prop_t, OutNum(info.nominal_interval_time))
CALL(OS_TimeBaseGetFreeRun)
{
    uint32 ticks = 0;
    Status(OS_TimeBaseGetFreeRun(OSID(1), &ticks));
}

/* One call of a timer's callback, by its number; what it answers. */
static long InTimer(int which, osal_id_t timer, osal_id_t given)
{
    static CFE_MSG_CommandHeader_t packet;
    osal_id_t       id;
    uint32          accuracy;
    OS_timer_prop_t info;
    CFE_ES_AppId_t  app;
    CFE_ES_TaskId_t task;
    CFE_SB_PipeId_t pipe;
    uint32          run = CFE_ES_RunStatus_APP_RUN;
    int32           status;

    switch (which)
    {
        case 0: return OS_TimerDelete(timer);
        case 1: return OS_TimerSet(timer, 100000000, 0);
        case 2: return OS_TimerCreate(&id, "IN_TIMER_2", &accuracy, Expire);
        case 3: return OS_TimeBaseCreate(&id, "IN_TIMER_2", NULL);
        case 4: return OS_TimerAdd(&id, "IN_TIMER_2", given, ExpireWith, NULL);
        case 5: return OS_TimerGetInfo(timer, &info);
        case 6: return OS_TaskDelay(1);
        case 7: return OS_ObjectIdDefined(OS_TaskGetId());
        case 8: return OS_BinSemGive(given);
        case 9: return OS_BinSemTimedWait(given, 0);
        case 10: return OS_CountSemGive(given);
        case 11: return OS_QueuePut(given, "in", 1, 0);
        case 12: return CFE_ES_GetAppID(&app);
        case 13: return CFE_ES_GetTaskID(&task);
        case 14: return CFE_EVS_SendEvent(1, CFE_EVS_EventType_ERROR, "in a timer");
        case 15:
            CFE_MSG_Init(CFE_MSG_PTR(packet), CFE_SB_ValueToMsgId(0x1890), sizeof(packet));
            return CFE_SB_TransmitMsg(CFE_MSG_PTR(packet), true);
        case 16: return CFE_SB_CreatePipe(&pipe, 2, "IN_TIMER");
        case 17: return CFE_ES_WriteToSysLog("in a timer\n");
        case 18:
            status = OS_OpenCreate(&id, "/ram/in_timer", OS_FILE_FLAG_CREATE, OS_READ_WRITE);
            return status == OS_SUCCESS ? OS_close(id) : status;
        case 19: return OS_TaskSetPriority(OS_TaskGetId(), 50);
        case 20: return CFE_ES_CreateChildTask(&task, "IN_TIMER", ChildMain, NULL, 4096, 50, 0);
        case 21: return CFE_ES_RunLoop(&run);
        case 22: return OS_BinSemDelete(given);
        case 23: return OS_QueueDelete(given);
        case 24: return OS_TimerDelete(given);
        case 25: return OS_TimerSet(given, 100000000, 0);
        case 26: return CFE_EVS_ResetAllFilters();
        case 27: return OS_MutSemDelete(given);
        default: return OS_CountSemTimedWait(given, 0);
    }
}
static int       InsideCall;
static long      InsideAnswer;
static osal_id_t InsideId;
static void ExpireInside(osal_id_t timer)
{
    InsideAnswer = InTimer(InsideCall, timer, InsideId);
}
CALL(OS_InTimer)
{
    osal_id_t timer;
    uint32    accuracy;
    int32     status = OS_TimerCreate(&timer, "IN_TIMER", &accuracy, ExpireInside);

    InsideCall   = Num(1);
    InsideId     = OSID(2);
    InsideAnswer = 12345;
    if (status == OS_SUCCESS)
    {
        OS_TimerSet(timer, 20000, 0);
        OS_TaskDelay(200);
        OS_TimerDelete(timer);
    }
    Status(status);
    OutNum((int32)InsideAnswer);
}

CALL(OS_OpenCreate)
{
    osal_id_t id;
    Status(OS_OpenCreate(&id, Text(2), Num(3), Num(4)));
    Keep(1, OS_ObjectIdToInteger(id));
}
WITH_ID(OS_close)
CALL(OS_read)
{
    int32 status = OS_read(OSID(1), Buffer, Num(2));
    Status(status);
    OutBytes(Buffer, status > 0 ? status : 0);
}
CALL(OS_TimedRead)
{
    int32 status = OS_TimedRead(OSID(1), Buffer, Num(2), Num(3));
    Status(status);
    OutBytes(Buffer, status > 0 ? status : 0);
}
CALL(OS_write)
{
    size_t size;
    void * data = Bytes(2, &size);
    Status(OS_write(OSID(1), data, size));
}
CALL(OS_TimedWrite)
{
    size_t size;
    void * data = Bytes(2, &size);
    Status(OS_TimedWrite(OSID(1), data, size, Num(3)));
}
CALL(OS_FileAllocate)
{
    Status(OS_FileAllocate(OSID(1), Num(2), Num(3)));
}
CALL(OS_FileTruncate)
{
    Status(OS_FileTruncate(OSID(1), Num(2)));
}
CALL(OS_lseek)
{
    Status(OS_lseek(OSID(1), Num(2), Num(3)));
}
CALL(OS_chmod)
{
    Status(OS_chmod(Text(1), Num(2)));
}
CALL(OS_stat)
{
    os_fstat_t stats;
    memset(&stats, 0, sizeof(stats));
    Status(OS_stat(Text(1), &stats));
    OutNum(OS_FILESTAT_ISDIR(stats) != 0);
    if (!OS_FILESTAT_ISDIR(stats))
    {
        OutNum(OS_FILESTAT_SIZE(stats));
    }
}
WITH_TEXT(OS_remove)
WITH_TEXT(OS_rmdir)
WITH_TEXT(OS_FileOpenCheck)
WITH_TEXT(OS_CloseFileByName)
CALL(OS_mkdir)
{
    Status(OS_mkdir(Text(1), Num(2)));
}
CALL(OS_rename)
{
    Status(OS_rename(Text(1), Text(2)));
}
CALL(OS_cp)
{
    Status(OS_cp(Text(1), Text(2)));
}
CALL(OS_mv)
{
    Status(OS_mv(Text(1), Text(2)));
}
CALL(OS_FDGetInfo)
{
    OS_file_prop_t info;
    memset(&info, 0, sizeof(info));
    Status(OS_FDGetInfo(OSID(1), &info));
    OutText(info.Path, sizeof(info.Path));
    OutId(OS_ObjectIdToInteger(info.User));
    OutNum(info.IsValid);
}
ID_OF(OS_DirectoryOpen)
WITH_ID(OS_DirectoryClose)
WITH_ID(OS_DirectoryRewind)
CALL(OS_DirectoryCount)
{
    os_dirent_t entry;
    int         count = 0;
    while (OS_DirectoryRead(OSID(1), &entry) == OS_SUCCESS)
    {
        ++count;
    }
    Status(0);
    OutNum(count);
}
CALL(OS_TranslatePath)
{
    char path[OS_MAX_LOCAL_PATH_LEN];
    Status(OS_TranslatePath(Text(1), path));
}

CALL(OS_Clock)
{
    OS_time_t first = OS_TimeFromTotalNanoseconds(Num(1)), second = OS_TimeFromTotalNanoseconds(Num(2));
    Status(0);
    OutNum(OS_TimeGetTotalNanoseconds(OS_TimeAdd(first, second)));
    OutNum(OS_TimeGetTotalNanoseconds(OS_TimeSubtract(first, second)));
    OutNum(OS_TimeGetTotalSeconds(first));
    OutNum(OS_TimeGetTotalMilliseconds(first));
    OutNum(OS_TimeGetTotalMicroseconds(first));
    OutNum(OS_TimeGetFractionalPart(first));
    OutNum(OS_TimeGetSubsecondsPart(first));
    OutNum(OS_TimeGetMillisecondsPart(first));
    OutNum(OS_TimeGetMicrosecondsPart(first));
    OutNum(OS_TimeGetNanosecondsPart(first));
    OutNum(OS_TimeEqual(first, second));
    OutNum(OS_TimeGetSign(first));
    OutNum(OS_TimeCompare(first, second));
}
CALL(OS_Assemble)
{
    Status(0);
    OutNum(OS_TimeGetTotalNanoseconds(OS_TimeAssembleFromNanoseconds(Num(1), Num(2))));
    OutNum(OS_TimeGetTotalNanoseconds(OS_TimeAssembleFromMicroseconds(Num(1), Num(2))));
    OutNum(OS_TimeGetTotalNanoseconds(OS_TimeAssembleFromMilliseconds(Num(1), Num(2))));
    OutNum(OS_TimeGetTotalNanoseconds(OS_TimeAssembleFromSubseconds(Num(1), Num(2))));
    OutNum(OS_TimeGetTotalNanoseconds(OS_TimeFromTotalSeconds(Num(1))));
    OutNum(OS_TimeGetTotalNanoseconds(OS_TimeFromTotalMilliseconds(Num(1))));
    OutNum(OS_TimeGetTotalNanoseconds(OS_TimeFromTotalMicroseconds(Num(1))));
}
CALL(OS_HeapGetInfo)
{
    OS_heap_prop_t heap;
    Status(OS_HeapGetInfo(&heap));
}
CALL(OS_GetResourceName)
{
    char name[64] = "";
    Status(OS_GetResourceName(OSID(1), name, sizeof(name)));
    OutText(name, sizeof(name));
}
CALL(OS_IdentifyObject)
{
    Status(0);
    OutNum(OS_IdentifyObject(OSID(1)));
}
CALL(OS_ConvertToArrayIndex)
{
    osal_index_t index;
    Status(OS_ConvertToArrayIndex(OSID(1), &index));
}
CALL(OS_ObjectIdToArrayIndex)
{
    osal_index_t index;
    Status(OS_ObjectIdToArrayIndex(Num(1), OSID(2), &index));
}
static int  Objects;
static void Count(osal_id_t id, void *arg)
{
    ++Objects;
}
CALL(OS_ForEachObjectOfType)
{
    Objects = 0;
    OS_ForEachObjectOfType(Num(1), OS_TaskGetId(), Count, NULL);
    Status(0);
    OutNum(Objects);
}
CALL(OS_GetErrorName)
{
    os_err_name_t name;
    Status(OS_GetErrorName(Num(1), &name));
    OutText(name, sizeof(name));
}
CALL(OS_StatusToString)
{
    os_status_string_t text;
    Status(0);
    OutText(OS_StatusToString(Num(1), &text), sizeof(text));
}
CALL(OS_strnlen)
{
    Status(0);
    OutNum(OS_strnlen(Text(1), Num(2)));
}
CALL(OS_SelectSingle)
{
    uint32 flags = Num(2);
    Status(OS_SelectSingle(OSID(1), &flags, Num(3)));
}
CALL(OS_mkfs)
{
    Status(OS_mkfs(NULL, Text(1), Text(2), Num(3), Num(4)));
}
CALL(OS_initfs)
{
    Status(OS_initfs(NULL, Text(1), Text(2), Num(3), Num(4)));
}
CALL(OS_mount)
{
    Status(OS_mount(Text(1), Text(2)));
}
WITH_TEXT(OS_unmount)
WITH_TEXT(OS_rmfs)
CALL(OS_FS_GetPhysDriveName)
{
    char name[100] = "";
    Status(OS_FS_GetPhysDriveName(name, Text(1)));
}

const Call OsalCalls[] = {ROW(OS_TaskCreate), ROW(OS_TaskGetIdByName), ROW(OS_TaskGetInfo), ROW(OS_TaskDelete),
    ROW(OS_TaskSetPriority), ROW(OS_TaskGetId), ROW(OS_TaskDelay), ROW(OS_QueueCreate), ROW(OS_QueueDelete),
    ROW(OS_QueueGetIdByName), ROW(OS_QueueGetInfo), ROW(OS_QueuePut), ROW(OS_QueueGet), ROW(OS_MutSemCreate),
    ROW(OS_MutSemDelete), ROW(OS_MutSemTake), ROW(OS_MutSemGive), ROW(OS_MutSemGetIdByName), ROW(OS_MutSemGetInfo),
    ROW(OS_BinSemCreate), ROW(OS_BinSemDelete), ROW(OS_BinSemTake), ROW(OS_BinSemGive), ROW(OS_BinSemFlush),
    ROW(OS_BinSemGetIdByName), ROW(OS_BinSemGetInfo), ROW(OS_BinSemTimedWait), ROW(OS_CountSemCreate),
    ROW(OS_CountSemDelete), ROW(OS_CountSemTake), ROW(OS_CountSemGive), ROW(OS_CountSemGetIdByName),
    ROW(OS_CountSemGetInfo), ROW(OS_CountSemTimedWait), ROW(OS_CondVarCreate), ROW(OS_CondVarDelete),
    ROW(OS_CondVarLock), ROW(OS_CondVarUnlock), ROW(OS_CondVarSignal), ROW(OS_CondVarBroadcast),
    ROW(OS_CondVarGetIdByName), ROW(OS_CondVarGetInfo), ROW(OS_CondVarTimedWait), ROW(OS_RwLockCreate),
    ROW(OS_RwLockDelete), ROW(OS_RwLockReadTake), ROW(OS_RwLockReadGive), ROW(OS_RwLockWriteTake),
    ROW(OS_RwLockWriteGive), ROW(OS_RwLockGetIdByName), ROW(OS_RwLockGetInfo), ROW(OS_TimerCreate), ROW(OS_TimerAdd),
    ROW(OS_TimerSet), ROW(OS_TimerFires), ROW(OS_InTimer), ROW(OS_TimerDelete), ROW(OS_TimerGetIdByName), ROW(OS_TimerGetInfo),
    ROW(OS_TimeBaseCreate), ROW(OS_TimeBaseSet), ROW(OS_TimeBaseDelete), ROW(OS_TimeBaseGetIdByName),
    ROW(OS_TimeBaseGetInfo), ROW(OS_TimeBaseGetFreeRun), ROW(OS_OpenCreate), ROW(OS_close), ROW(OS_read),
    ROW(OS_TimedRead), ROW(OS_write), ROW(OS_TimedWrite), ROW(OS_FileAllocate), ROW(OS_FileTruncate), ROW(OS_lseek),
    ROW(OS_chmod), ROW(OS_stat), ROW(OS_remove), ROW(OS_rmdir), ROW(OS_FileOpenCheck), ROW(OS_CloseFileByName),
    ROW(OS_mkdir), ROW(OS_rename), ROW(OS_cp), ROW(OS_mv), ROW(OS_FDGetInfo), ROW(OS_DirectoryOpen),
    ROW(OS_DirectoryClose), ROW(OS_DirectoryRewind), ROW(OS_DirectoryCount), ROW(OS_TranslatePath), ROW(OS_Clock),
    ROW(OS_Assemble), ROW(OS_HeapGetInfo), ROW(OS_GetResourceName), ROW(OS_IdentifyObject),
    ROW(OS_ConvertToArrayIndex), ROW(OS_ObjectIdToArrayIndex), ROW(OS_ForEachObjectOfType), ROW(OS_GetErrorName),
    ROW(OS_StatusToString), ROW(OS_strnlen), ROW(OS_SelectSingle), ROW(OS_mkfs), ROW(OS_initfs), ROW(OS_mount),
    ROW(OS_unmount), ROW(OS_rmfs), ROW(OS_FS_GetPhysDriveName), {NULL, NULL}};
