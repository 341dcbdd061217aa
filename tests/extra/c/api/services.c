/* What CFE_ES and CFE_EVS say of pointers that must not be NULL, and of callers that are no application. */
#include "api_test.h"

static volatile int done;

static int32 on_tone(void) { return 0; }

static void nobody(void)
{
    CFE_ES_AppId_t app = CFE_ES_APPID_C(77);
    CFE_ES_CDSHandle_t block = CFE_ES_CDSHANDLE_C(77);
    CFE_ES_MemHandle_t pool;
    CFE_TBL_Handle_t table;
    static uint8 memory[1024];
    TELL(CFE_ES_GetAppID(&app));
    SAY("none %lX", CFE_RESOURCEID_TO_ULONG(app));
    TELL(CFE_ES_RegisterCDS(&block, 8, "Data"));
    SAY("none %lX", CFE_RESOURCEID_TO_ULONG(block));
    TELL(CFE_TBL_Register(&table, "T", 8, CFE_TBL_OPT_DEFAULT, NULL));
    TELL(CFE_TBL_GetStatus(CFE_TBL_BAD_TABLE_HANDLE));
    TELL(CFE_EVS_Register(NULL, 0, CFE_EVS_EventFilter_BINARY));
    TELL(CFE_EVS_SendEvent(1, CFE_EVS_EventType_INFORMATION, "hello"));
    TELL(CFE_EVS_ResetAllFilters());
    TELL(CFE_TIME_RegisterSynchCallback(on_tone));
    TELL(CFE_ES_PoolCreate(&pool, memory, sizeof memory));
    TELL(CFE_ES_PoolDelete(pool));
    done = 1;
}

void APITEST_Main(void)
{
    osal_id_t task;
    CFE_ES_TaskId_t child = CFE_ES_TASKID_C(77);
    TELL(CFE_ES_GetAppInfo(NULL, CFE_ES_APPID_UNDEFINED));
    TELL(CFE_ES_GetLibInfo(NULL, CFE_ES_LIBID_UNDEFINED));
    TELL(CFE_ES_GetTaskInfo(NULL, CFE_ES_TASKID_UNDEFINED));
    TELL(CFE_ES_GetModuleInfo(NULL, CFE_RESOURCEID_UNDEFINED));
    TELL(CFE_ES_CreateChildTask(NULL, NULL, nobody, NULL, 16384, 60, 0));
    TELL(CFE_ES_CreateChildTask(NULL, "CHILD", nobody, NULL, 16384, 60, 0));
    TELL(CFE_ES_CreateChildTask(&child, NULL, nobody, NULL, 16384, 60, 0));
    TELL(CFE_ES_CreateChildTask(&child, "CHILD", NULL, NULL, 16384, 60, 0));
    SAY("untouched %lX", CFE_RESOURCEID_TO_ULONG(child));
    TELL(OS_TaskCreate(&task, "NOBODY", nobody, OSAL_TASK_STACK_ALLOCATE, OSAL_SIZE_C(16384), OSAL_PRIORITY_C(60), 0));
    for (int i = 0; i < 50 && !done; i++)
        OS_TaskDelay(20);
    SAY("done %d", done);
    CFE_ES_ExitApp(CFE_ES_RunStatus_APP_EXIT);
}
