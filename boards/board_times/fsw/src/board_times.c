/*
** Measures on a board the three times that `cfepy board new` makes a profile of, tells them in an event, and ends.
**
** The startup script needs one line:
**
**   CFE_APP, board_times, BOARD_TIMES_Main, BOARD_TIMES, 50, 16384, 0x0, 0;
**
** The event has the options of the command, with times in ns. A time is the mean of many rounds, by OS_GetLocalTime;
** the first rounds, in which caches are cold, do not count. Take the priority and the interrupts of the flight: what
** else runs meanwhile is in the times.
*/
#include "cfe.h"

#ifndef BOARD_TIMES_MID
#define BOARD_TIMES_MID 0x08FE /* of the message that goes to its own pipe; nobody else is to have it */
#endif

#ifndef BOARD_TIMES_ROUNDS
#define BOARD_TIMES_ROUNDS 10000
#endif

#define BOARD_TIMES_COLD_ROUNDS 100
#define BOARD_TIMES_STACK       8192
#define BOARD_TIMES_LONGEST     2048 /* bytes */

#define BOARD_TIMES_TIMES_INF_EID   1
#define BOARD_TIMES_MADE_ERR_EID    2
#define BOARD_TIMES_ROUND_ERR_EID   3

static union
{
    CFE_MSG_Message_t Msg;
    uint8             Bytes[BOARD_TIMES_LONGEST];
} BOARD_TIMES_Sent;

static CFE_SB_PipeId_t BOARD_TIMES_Pipe;
static osal_id_t       BOARD_TIMES_There;
static osal_id_t       BOARD_TIMES_Back;

/* The other task: answers each signal with one, until the application has ended. */
static void BOARD_TIMES_Other(void)
{
    while (OS_BinSemTake(BOARD_TIMES_There) == OS_SUCCESS)
    {
        OS_BinSemGive(BOARD_TIMES_Back);
    }
}

static int32 BOARD_TIMES_Trip(void)
{
    int32 Status = OS_BinSemGive(BOARD_TIMES_There);

    return Status == OS_SUCCESS ? OS_BinSemTake(BOARD_TIMES_Back) : Status;
}

static int32 BOARD_TIMES_Message(void)
{
    CFE_SB_Buffer_t *Taken;
    CFE_Status_t     Status = CFE_SB_TransmitMsg(&BOARD_TIMES_Sent.Msg, true);

    return Status == CFE_SUCCESS ? CFE_SB_ReceiveBuffer(&Taken, BOARD_TIMES_Pipe, CFE_SB_POLL) : Status;
}

/* Mean time of a round in ns; -1 when one failed, with the event that says so. */
static int64 BOARD_TIMES_Measure(const char *Name, int32 (*Round)(void))
{
    OS_time_t Begun = OS_TIME_ZERO;
    OS_time_t Ended;
    int32     Status;
    uint32    i;

    for (i = 0; i < BOARD_TIMES_COLD_ROUNDS + BOARD_TIMES_ROUNDS; i++)
    {
        if (i == BOARD_TIMES_COLD_ROUNDS)
        {
            OS_GetLocalTime(&Begun);
        }
        Status = Round();
        if (Status != 0)
        {
            CFE_EVS_SendEvent(BOARD_TIMES_ROUND_ERR_EID, CFE_EVS_EventType_ERROR, "BOARD_TIMES: %s failed, RC = 0x%08X",
                              Name, (unsigned int)Status);
            return -1;
        }
    }
    OS_GetLocalTime(&Ended);
    return OS_TimeGetTotalNanoseconds(OS_TimeSubtract(Ended, Begun)) / BOARD_TIMES_ROUNDS;
}

static int64 BOARD_TIMES_MeasureMessage(const char *Name, size_t Size)
{
    CFE_MSG_Init(&BOARD_TIMES_Sent.Msg, CFE_SB_ValueToMsgId(BOARD_TIMES_MID), Size);
    return BOARD_TIMES_Measure(Name, BOARD_TIMES_Message);
}

static int32 BOARD_TIMES_Make(CFE_ES_TaskId_t *Other)
{
    OS_task_prop_t Own;
    int32          Status = OS_TaskGetInfo(OS_TaskGetId(), &Own);

    if (Status == OS_SUCCESS)
    {
        Status = OS_BinSemCreate(&BOARD_TIMES_There, "BOARD_THERE", OS_SEM_EMPTY, 0);
    }
    if (Status == OS_SUCCESS)
    {
        Status = OS_BinSemCreate(&BOARD_TIMES_Back, "BOARD_BACK", OS_SEM_EMPTY, 0);
    }
    if (Status == OS_SUCCESS)
    {
        Status = CFE_SB_CreatePipe(&BOARD_TIMES_Pipe, 2, "BOARD_TIMES");
    }
    if (Status == CFE_SUCCESS)
    {
        Status = CFE_SB_Subscribe(CFE_SB_ValueToMsgId(BOARD_TIMES_MID), BOARD_TIMES_Pipe);
    }
    if (Status == CFE_SUCCESS)
    {
        Status = CFE_ES_CreateChildTask(Other, "BOARD_OTHER", BOARD_TIMES_Other, CFE_ES_TASK_STACK_ALLOCATE,
                                        BOARD_TIMES_STACK, Own.priority, 0);
    }
    return Status;
}

void BOARD_TIMES_Main(void)
{
    CFE_ES_TaskId_t Other;
    int64           RoundTrip;
    int64           Short;
    int64           Long;
    int32           Status;

    CFE_EVS_Register(NULL, 0, CFE_EVS_EventFilter_BINARY);
    CFE_ES_WaitForStartupSync(10000);
    Status = BOARD_TIMES_Make(&Other);
    if (Status != CFE_SUCCESS)
    {
        CFE_EVS_SendEvent(BOARD_TIMES_MADE_ERR_EID, CFE_EVS_EventType_ERROR,
                          "BOARD_TIMES: what it needs cannot be made, RC = 0x%08X", (unsigned int)Status);
        CFE_ES_ExitApp(CFE_ES_RunStatus_APP_ERROR);
    }
    OS_TaskDelay(1000); /* what boots beside it has come to its end */
    RoundTrip = BOARD_TIMES_Measure("a round trip", BOARD_TIMES_Trip);
    Short     = BOARD_TIMES_MeasureMessage("a short message", 32);
    Long      = BOARD_TIMES_MeasureMessage("a long message", BOARD_TIMES_LONGEST);
    if (RoundTrip >= 0 && Short >= 0 && Long >= 0)
    {
        CFE_EVS_SendEvent(BOARD_TIMES_TIMES_INF_EID, CFE_EVS_EventType_INFORMATION,
                          "--round-trip %luns --short %luns --long %luns", (unsigned long)RoundTrip,
                          (unsigned long)Short, (unsigned long)Long);
    }
    CFE_ES_ExitApp(CFE_ES_RunStatus_APP_EXIT);
}
