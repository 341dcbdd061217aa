/* What an application does most, many times: a line in the system log after each, with the time that the PSP tells.
 * It is compiled for cfepy by `python -m benchmarks compiled`, and runs on NASA's cFE as well. */
#include "cfe.h"

#define TIMES 30000
#define FEW 3000
#define MSG_ID 0x1899

typedef struct { uint32 Values[16]; } BENCH_Table_t;

static void Tell(const char *What, OS_time_t *Since, int Count)
{
    OS_time_t Now;
    CFE_PSP_GetTime(&Now);
    CFE_ES_WriteToSysLog("BENCH %s: %d in %ld us\n", What, Count,
                         (long)OS_TimeGetTotalMicroseconds(OS_TimeSubtract(Now, *Since)));
    CFE_PSP_GetTime(Since);
}

void BENCH_Main(void)
{
    union { CFE_MSG_Message_t Msg; uint8 Bytes[80]; } Packet;
    CFE_SB_Buffer_t *Received;
    CFE_SB_PipeId_t Pipe;
    CFE_TBL_Handle_t Table;
    static BENCH_Table_t Image;
    void *Address;
    uint32 Run = CFE_ES_RunStatus_APP_RUN;
    OS_time_t Since;
    volatile uint32 Sum = 0;

    CFE_EVS_Register(NULL, 0, CFE_EVS_EventFilter_BINARY);
    CFE_SB_CreatePipe(&Pipe, 10, "BENCH");
    CFE_SB_Subscribe(CFE_SB_ValueToMsgId(MSG_ID), Pipe);
    CFE_MSG_Init(&Packet.Msg, CFE_SB_ValueToMsgId(MSG_ID), sizeof(Packet));
    CFE_TBL_Register(&Table, "Bench", sizeof(Image), CFE_TBL_OPT_DEFAULT, NULL);
    CFE_TBL_Load(Table, CFE_TBL_SRC_ADDRESS, &Image);
    CFE_ES_RunLoop(&Run);
    CFE_PSP_GetTime(&Since);
    Tell("begin", &Since, 0);
    for (int i = 0; i < TIMES; i++) {
        CFE_SB_TransmitMsg(&Packet.Msg, true);
        CFE_SB_ReceiveBuffer(&Received, Pipe, CFE_SB_POLL);
    }
    Tell("sb", &Since, TIMES);
    for (int i = 0; i < TIMES; i++)
        CFE_EVS_SendEvent(1, CFE_EVS_EventType_DEBUG, "masked event %d of %s", i, "bench");
    Tell("masked event", &Since, TIMES);
    for (int i = 0; i < FEW; i++)
        CFE_EVS_SendEvent(1, CFE_EVS_EventType_INFORMATION, "event %d of %s", i, "bench");
    Tell("event", &Since, FEW);
    for (int i = 0; i < TIMES; i++) {
        CFE_TBL_GetAddress(&Address, Table);
        Sum += ((BENCH_Table_t *)Address)->Values[i % 16];
        CFE_TBL_ReleaseAddress(Table);
    }
    Tell("table", &Since, TIMES);
    CFE_ES_ExitApp(CFE_ES_RunStatus_APP_EXIT);
}
