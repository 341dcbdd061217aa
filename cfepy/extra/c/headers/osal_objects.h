/* OSAL: its status codes, ids, tasks, and what tasks wait for and hand over. */
#ifndef CFEPY_OSAL_OBJECTS_H
#define CFEPY_OSAL_OBJECTS_H

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "config.h"
#include "osal_time.h"

CFEPY_C_BEGIN

/* ---- status codes ---- */
#define OS_STATUS_STRING_LENGTH 12
#define OS_ERROR_NAME_LENGTH    35
#define OS_FS_ERR_PATH_INVALID         OSAL_STATUS_C(-108)
#define OS_FS_ERR_DEVICE_NOT_FREE      OSAL_STATUS_C(-107)
#define OS_FS_ERR_DRIVE_NOT_CREATED    OSAL_STATUS_C(-106)
#define OS_FS_ERR_NAME_TOO_LONG        OSAL_STATUS_C(-104)
#define OS_FS_ERR_PATH_TOO_LONG        OSAL_STATUS_C(-103)
#define OS_ERR_EMPTY_SET               OSAL_STATUS_C(-44)
#define OS_ERR_TRY_AGAIN               OSAL_STATUS_C(-43)
#define OS_ERR_INVALID_ARGUMENT        OSAL_STATUS_C(-42)
#define OS_ERR_OUTPUT_TOO_LARGE        OSAL_STATUS_C(-41)
#define OS_ERR_INVALID_SIZE            OSAL_STATUS_C(-40)
#define OS_ERR_OPERATION_NOT_SUPPORTED OSAL_STATUS_C(-38)
#define OS_ERR_STREAM_DISCONNECTED     OSAL_STATUS_C(-37)
#define OS_ERR_INCORRECT_OBJ_TYPE      OSAL_STATUS_C(-36)
#define OS_ERR_INCORRECT_OBJ_STATE     OSAL_STATUS_C(-35)
#define OS_ERR_BAD_ADDRESS             OSAL_STATUS_C(-34)
#define OS_ERR_OBJECT_IN_USE           OSAL_STATUS_C(-33)
#define OS_TIMER_ERR_INTERNAL          OSAL_STATUS_C(-32)
#define OS_TIMER_ERR_UNAVAILABLE       OSAL_STATUS_C(-31)
#define OS_TIMER_ERR_TIMER_ID          OSAL_STATUS_C(-30)
#define OS_TIMER_ERR_INVALID_ARGS      OSAL_STATUS_C(-29)
#define OS_ERR_NOT_IMPLEMENTED         OSAL_STATUS_C(-28)
#define OS_ERR_FILE                    OSAL_STATUS_C(-27)
#define OS_INVALID_SEM_VALUE           OSAL_STATUS_C(-20)
#define OS_ERR_INVALID_PRIORITY        OSAL_STATUS_C(-19)
#define OS_ERR_SEM_NOT_FULL            OSAL_STATUS_C(-18)
#define OS_ERR_NAME_NOT_FOUND          OSAL_STATUS_C(-17)
#define OS_ERR_INVALID_ID              OSAL_STATUS_C(-16)
#define OS_ERR_NAME_TAKEN              OSAL_STATUS_C(-15)
#define OS_ERR_NO_FREE_IDS             OSAL_STATUS_C(-14)
#define OS_ERR_NAME_TOO_LONG           OSAL_STATUS_C(-13)
#define OS_QUEUE_ID_ERROR              OSAL_STATUS_C(-12)
#define OS_QUEUE_INVALID_SIZE          OSAL_STATUS_C(-11)
#define OS_QUEUE_TIMEOUT               OSAL_STATUS_C(-10)
#define OS_QUEUE_FULL                  OSAL_STATUS_C(-9)
#define OS_QUEUE_EMPTY                 OSAL_STATUS_C(-8)
#define OS_SEM_TIMEOUT                 OSAL_STATUS_C(-7)
#define OS_SEM_FAILURE                 OSAL_STATUS_C(-6)
#define OS_INVALID_INT_NUM             OSAL_STATUS_C(-5)
#define OS_ERROR_TIMEOUT               OSAL_STATUS_C(-4)
#define OS_ERROR_ADDRESS_MISALIGNED    OSAL_STATUS_C(-3)
#define OS_INVALID_POINTER             OSAL_STATUS_C(-2)
#define OS_ERROR                       OSAL_STATUS_C(-1)
#define OS_SUCCESS                     OSAL_STATUS_C(0)
typedef char os_err_name_t[35];
typedef char os_status_string_t[12];
int32 OS_GetErrorName(int32 error_num, os_err_name_t *err_name);
char *OS_StatusToString(osal_status_t status, os_status_string_t *status_string);
static inline long OS_StatusToInteger(osal_status_t status)
{
    return status;
}

/* ---- checks that return from the function they stand in ---- */
#define BUGREPORT(...) OS_printf(__VA_ARGS__)
#define BUGCHECK(condition, error)                                                                        \
    if (!(condition)) {                                                                                        \
        BUGREPORT("%s, line %d: %s does not hold, so %s is returned\n", __func__, __LINE__, #condition, #error); \
        return error;                                                                                          \
    }
#define BUGCHECK_VOID(condition) BUGCHECK(condition, )
#define ARGCHECK(condition, error) \
    if (!(condition)) {            \
        return error;              \
    }
#define LENGTHCHECK(text, size, error) ARGCHECK(memchr(text, '\0', size), error)

/* ---- ids ---- */
#define OS_OBJECT_ID_UNDEFINED ((osal_id_t){0})
#define OS_OBJECT_CREATOR_ANY  OS_OBJECT_ID_UNDEFINED
#define OS_OBJECT_TYPE_UNDEFINED   0x0
#define OS_OBJECT_TYPE_OS_TASK     0x1
#define OS_OBJECT_TYPE_OS_QUEUE    0x2
#define OS_OBJECT_TYPE_OS_COUNTSEM 0x3
#define OS_OBJECT_TYPE_OS_BINSEM   0x4
#define OS_OBJECT_TYPE_OS_MUTEX    0x5
#define OS_OBJECT_TYPE_OS_STREAM   0x6
#define OS_OBJECT_TYPE_OS_DIR      0x7
#define OS_OBJECT_TYPE_OS_TIMEBASE 0x8
#define OS_OBJECT_TYPE_OS_TIMECB   0x9
#define OS_OBJECT_TYPE_OS_MODULE   0xA
#define OS_OBJECT_TYPE_OS_FILESYS  0xB
#define OS_OBJECT_TYPE_OS_CONSOLE  0xC
#define OS_OBJECT_TYPE_OS_CONDVAR  0xD
#define OS_OBJECT_TYPE_OS_RWLOCK   0xE
#define OS_OBJECT_TYPE_SHIFT       16
#define OS_OBJECT_TYPE_USER        0x10
#define OS_OBJECT_INDEX_MASK       0xFFFF
int32 OS_ConvertToArrayIndex(osal_id_t object_id, osal_index_t *ArrayIndex);
void OS_ForEachObject(osal_id_t creator_id, OS_ArgCallback_t callback_ptr, void *callback_arg);
void OS_ForEachObjectOfType(osal_objtype_t objtype, osal_id_t creator_id, OS_ArgCallback_t callback_ptr,
    void *callback_arg);
int32 OS_GetResourceName(osal_id_t object_id, char *buffer, size_t buffer_size);
osal_objtype_t OS_IdentifyObject(osal_id_t object_id);
int32 OS_ObjectIdToArrayIndex(osal_objtype_t idtype, osal_id_t object_id, osal_index_t *ArrayIndex);
static inline unsigned long OS_ObjectIdToInteger(osal_id_t id)
{
    return CFEPY_OS_ID_VALUE(id);
}
static inline osal_id_t OS_ObjectIdFromInteger(unsigned long value)
{
    osal_id_t id = {(uint32)value};
    return id;
}
static inline bool OS_ObjectIdEqual(osal_id_t one, osal_id_t other)
{
    return CFEPY_OS_ID_VALUE(one) == CFEPY_OS_ID_VALUE(other);
}
static inline bool OS_ObjectIdDefined(osal_id_t id)
{
    return CFEPY_OS_ID_VALUE(id) != 0;
}

/* ---- timeouts ---- */
#define OS_PEND               (-1)
#define OS_CHECK              0
#define OS_MAX_LOCAL_PATH_LEN 128

/* ---- OSAL itself ---- */
typedef enum {
    OS_EVENT_RESERVED = 0, OS_EVENT_RESOURCE_ALLOCATED, OS_EVENT_RESOURCE_CREATED, OS_EVENT_RESOURCE_DELETED,
    OS_EVENT_TASK_STARTUP, OS_EVENT_MAX
} OS_Event_t;

typedef int32 (*OS_EventHandler_t)(OS_Event_t event, osal_id_t object_id, void *data);

typedef struct {
    size_t free_bytes;
    osal_blockcount_t free_blocks;
    size_t largest_free_block;
} OS_heap_prop_t;

int32 OS_API_Init(void);
void OS_API_Teardown(void);
void OS_ApplicationExit(int32 Status);
void OS_ApplicationShutdown(uint8 flag);
void OS_Application_Run(void);
void OS_Application_Startup(void);
uint32 OS_BSP_GetArgC(void);
char * const *OS_BSP_GetArgV(void);
uint32 OS_BSP_GetResourceTypeConfig(uint32 ResourceType);
void OS_BSP_SetExitCode(int32 code);
void OS_BSP_SetResourceTypeConfig(uint32 ResourceType, uint32 ConfigOptionValue);
void OS_DeleteAllObjects(void);
int32 OS_HeapGetInfo(OS_heap_prop_t *heap_prop);
void OS_IdleLoop(void);
int32 OS_RegisterEventHandler(OS_EventHandler_t handler);
void OS_printf(const char *string, ...) OS_PRINTF(1, 2);
void OS_printf_disable(void);
void OS_printf_enable(void);
size_t OS_strnlen(const char *s, size_t maxlen);

/* ---- tasks ---- */
#define OSAL_TASK_STACK_ALLOCATE OSAL_STACKPTR_C(NULL)
#define OS_FP_ENABLED        1
#define OS_MAX_TASK_PRIORITY 255

typedef struct {
    char name[OS_MAX_API_NAME];
    osal_id_t creator;
    size_t stack_size;
    osal_priority_t priority;
} OS_task_prop_t;

typedef void osal_task;
typedef osal_task (*osal_task_entry)(void);
int32 OS_TaskCreate(osal_id_t *task_id, const char *task_name, osal_task_entry function_pointer,
    osal_stackptr_t stack_pointer, size_t stack_size, osal_priority_t priority, uint32 flags);
int32 OS_TaskDelay(uint32 millisecond);
int32 OS_TaskDelete(osal_id_t task_id);
void OS_TaskExit(void);
int32 OS_TaskFindIdBySystemData(osal_id_t *task_id, const void *sysdata, size_t sysdata_size);
osal_id_t OS_TaskGetId(void);
int32 OS_TaskGetIdByName(osal_id_t *task_id, const char *task_name);
int32 OS_TaskGetInfo(osal_id_t task_id, OS_task_prop_t *task_prop);
int32 OS_TaskInstallDeleteHandler(osal_task_entry function_pointer);
int32 OS_TaskSetPriority(osal_id_t task_id, osal_priority_t new_priority);

/* ---- queues ---- */
typedef struct {
    char name[OS_MAX_API_NAME];
    osal_id_t creator;
} OS_queue_prop_t;

int32 OS_QueueCreate(osal_id_t *queue_id, const char *queue_name, osal_blockcount_t queue_depth, size_t data_size,
    uint32 flags);
int32 OS_QueueDelete(osal_id_t queue_id);
int32 OS_QueueGet(osal_id_t queue_id, void *data, size_t size, size_t *size_copied, int32 timeout);
int32 OS_QueueGetIdByName(osal_id_t *queue_id, const char *queue_name);
int32 OS_QueueGetInfo(osal_id_t queue_id, OS_queue_prop_t *queue_prop);
int32 OS_QueuePut(osal_id_t queue_id, const void *data, size_t size, uint32 flags);

/* ---- semaphores, mutexes, condition variables, locks for readers and writers ---- */
#define OS_SEM_EMPTY 0
#define OS_SEM_FULL  1

typedef struct {
    char name[OS_MAX_API_NAME];
    osal_id_t creator;
    int32 value;
} OS_bin_sem_prop_t;

typedef struct {
    char name[OS_MAX_API_NAME];
    osal_id_t creator;
} OS_condvar_prop_t;

typedef struct {
    char name[OS_MAX_API_NAME];
    osal_id_t creator;
    int32 value;
} OS_count_sem_prop_t;

typedef struct {
    char name[OS_MAX_API_NAME];
    osal_id_t creator;
} OS_mut_sem_prop_t;

typedef struct {
    char name[OS_MAX_API_NAME];
    osal_id_t creator;
} OS_rwlock_prop_t;

int32 OS_BinSemCreate(osal_id_t *sem_id, const char *sem_name, uint32 sem_initial_value, uint32 options);
int32 OS_BinSemDelete(osal_id_t sem_id);
int32 OS_BinSemFlush(osal_id_t sem_id);
int32 OS_BinSemGetIdByName(osal_id_t *sem_id, const char *sem_name);
int32 OS_BinSemGetInfo(osal_id_t sem_id, OS_bin_sem_prop_t *bin_prop);
int32 OS_BinSemGive(osal_id_t sem_id);
int32 OS_BinSemTake(osal_id_t sem_id);
int32 OS_BinSemTimedWait(osal_id_t sem_id, uint32 msecs);
int32 OS_CountSemCreate(osal_id_t *sem_id, const char *sem_name, uint32 sem_initial_value, uint32 options);
int32 OS_CountSemDelete(osal_id_t sem_id);
int32 OS_CountSemGetIdByName(osal_id_t *sem_id, const char *sem_name);
int32 OS_CountSemGetInfo(osal_id_t sem_id, OS_count_sem_prop_t *count_prop);
int32 OS_CountSemGive(osal_id_t sem_id);
int32 OS_CountSemTake(osal_id_t sem_id);
int32 OS_CountSemTimedWait(osal_id_t sem_id, uint32 msecs);
int32 OS_MutSemCreate(osal_id_t *sem_id, const char *sem_name, uint32 options);
int32 OS_MutSemDelete(osal_id_t sem_id);
int32 OS_MutSemGetIdByName(osal_id_t *sem_id, const char *sem_name);
int32 OS_MutSemGetInfo(osal_id_t sem_id, OS_mut_sem_prop_t *mut_prop);
int32 OS_MutSemGive(osal_id_t sem_id);
int32 OS_MutSemTake(osal_id_t sem_id);
int32 OS_CondVarBroadcast(osal_id_t var_id);
int32 OS_CondVarCreate(osal_id_t *var_id, const char *var_name, uint32 options);
int32 OS_CondVarDelete(osal_id_t var_id);
int32 OS_CondVarGetIdByName(osal_id_t *var_id, const char *var_name);
int32 OS_CondVarGetInfo(osal_id_t var_id, OS_condvar_prop_t *condvar_prop);
int32 OS_CondVarLock(osal_id_t var_id);
int32 OS_CondVarSignal(osal_id_t var_id);
int32 OS_CondVarTimedWait(osal_id_t var_id, const OS_time_t *abs_wakeup_time);
int32 OS_CondVarUnlock(osal_id_t var_id);
int32 OS_CondVarWait(osal_id_t var_id);
int32 OS_RwLockCreate(osal_id_t *rw_id, const char *rw_name, uint32 options);
int32 OS_RwLockDelete(osal_id_t rw_id);
int32 OS_RwLockGetIdByName(osal_id_t *rw_id, const char *rw_name);
int32 OS_RwLockGetInfo(osal_id_t rw_id, OS_rwlock_prop_t *rw_prop);
int32 OS_RwLockReadGive(osal_id_t rw_id);
int32 OS_RwLockReadTake(osal_id_t rw_id);
int32 OS_RwLockWriteGive(osal_id_t rw_id);
int32 OS_RwLockWriteTake(osal_id_t rw_id);

/* ---- timers ---- */
typedef uint32 (*OS_TimerSync_t)(osal_id_t timer_id);

typedef struct {
    char name[OS_MAX_API_NAME];
    osal_id_t creator;
    uint32 nominal_interval_time, freerun_time, accuracy;
} OS_timebase_prop_t;

typedef void (*OS_TimerCallback_t)(osal_id_t timer_id);

typedef struct {
    char name[OS_MAX_API_NAME];
    osal_id_t creator;
    uint32 start_time, interval_time, accuracy;
} OS_timer_prop_t;

int32 OS_TimeBaseCreate(osal_id_t *timebase_id, const char *timebase_name, OS_TimerSync_t external_sync);
int32 OS_TimeBaseDelete(osal_id_t timebase_id);
int32 OS_TimeBaseGetFreeRun(osal_id_t timebase_id, uint32 *freerun_val);
int32 OS_TimeBaseGetIdByName(osal_id_t *timebase_id, const char *timebase_name);
int32 OS_TimeBaseGetInfo(osal_id_t timebase_id, OS_timebase_prop_t *timebase_prop);
int32 OS_TimeBaseSet(osal_id_t timebase_id, uint32 start_time, uint32 interval_time);
int32 OS_TimerAdd(osal_id_t *timer_id, const char *timer_name, osal_id_t timebase_id, OS_ArgCallback_t callback_ptr,
    void *callback_arg);
int32 OS_TimerCreate(osal_id_t *timer_id, const char *timer_name, uint32 *clock_accuracy,
    OS_TimerCallback_t callback_ptr);
int32 OS_TimerDelete(osal_id_t timer_id);
int32 OS_TimerGetIdByName(osal_id_t *timer_id, const char *timer_name);
int32 OS_TimerGetInfo(osal_id_t timer_id, OS_timer_prop_t *timer_prop);
int32 OS_TimerSet(osal_id_t timer_id, uint32 start_time, uint32 interval_time);

/* ---- version ---- */
#define OS_BUILD_NUMBER            0
#define OS_MINOR_VERSION           0
#define OS_MISSION_REV             0x0
#define OS_REVISION                0
#define OS_MAJOR_VERSION           7
#define OS_CFG_MAX_VERSION_STR_LEN 256
#define OSAL_API_VERSION           70000
#define OS_BUILD_BASELINE          "v7.0.0"
#define OS_BUILD_CODENAME          "Draco"
#define OS_BUILD_DEV_CYCLE         "v7.0.0"
#define OS_LAST_OFFICIAL           "v7.0.0"
#define OS_VERSION                 "v7.0.0+dev0"
#define OS_STR_HELPER(x) #x
#define OS_STR(x)        OS_STR_HELPER(x)
uint32 OS_GetBuildNumber(void);
const char *OS_GetVersionCodeName(void);
void OS_GetVersionNumber(uint8 VersionNumbers[4]);
const char *OS_GetVersionString(void);

CFEPY_C_END

#endif
