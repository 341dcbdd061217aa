/* The Software Bus as benchmarks/bus.py has it, on NASA's cFE: one task, two tasks, one to many. `python -m benchmarks
 * peers` compiles it with the headers of the cFE that it flies it on, and reads the lines that it writes to the log. */
#include "cfe.h"

#define PACKET_BYTES 64
#define WIDTH 16
#define ONE_TASK 200000
#define ROUND_TRIPS 50000
#define FAN_OUT 10000
#define MSG_ID_ALONE 0x0881
#define MSG_ID_THERE 0x0882
#define MSG_ID_BACK 0x0883
#define MSG_ID_MANY 0x0884

typedef union { CFE_MSG_Message_t Msg; uint8 Bytes[PACKET_BYTES]; } PEER_Packet_t;

static CFE_SB_PipeId_t PEER_There, PEER_Back;

static CFE_SB_PipeId_t PEER_Pipe(const char *Name, CFE_SB_MsgId_Atom_t MsgId)
{
    CFE_SB_PipeId_t Pipe;
    CFE_SB_CreatePipe(&Pipe, 10, Name);
    CFE_SB_Subscribe(CFE_SB_ValueToMsgId(MsgId), Pipe);
    return Pipe;
}

static void PEER_Tell(const char *What, OS_time_t Since, int Count)
{
    OS_time_t Now;
    CFE_PSP_GetTime(&Now);
    CFE_ES_WriteToSysLog("PEER %s: %d in %ld us\n", What, Count,
                         (long)OS_TimeGetTotalMicroseconds(OS_TimeSubtract(Now, Since)));
}

static void PEER_Child(void)
{
    PEER_Packet_t    Packet;
    CFE_SB_Buffer_t *Received;
    CFE_MSG_Init(&Packet.Msg, CFE_SB_ValueToMsgId(MSG_ID_BACK), sizeof(Packet));
    for (int i = 0; i < ROUND_TRIPS; i++)
    {
        CFE_SB_ReceiveBuffer(&Received, PEER_There, CFE_SB_PEND_FOREVER);
        CFE_SB_TransmitMsg(&Packet.Msg, true);
    }
    CFE_ES_ExitChildTask();
}

void PEER_Main(void)
{
    PEER_Packet_t    Packet;
    CFE_SB_Buffer_t *Received;
    CFE_SB_PipeId_t  Alone, Many[WIDTH];
    CFE_ES_TaskId_t  Child;
    OS_time_t        Since;
    char             Name[] = "MANY_A";

    Alone      = PEER_Pipe("ALONE", MSG_ID_ALONE);
    PEER_There = PEER_Pipe("THERE", MSG_ID_THERE);
    PEER_Back  = PEER_Pipe("BACK", MSG_ID_BACK);
    for (int i = 0; i < WIDTH; i++, Name[5]++)
        Many[i] = PEER_Pipe(Name, MSG_ID_MANY);

    CFE_MSG_Init(&Packet.Msg, CFE_SB_ValueToMsgId(MSG_ID_ALONE), sizeof(Packet));
    CFE_PSP_GetTime(&Since);
    for (int i = 0; i < ONE_TASK; i++)
    {
        CFE_SB_TransmitMsg(&Packet.Msg, true);
        CFE_SB_ReceiveBuffer(&Received, Alone, CFE_SB_POLL);
    }
    PEER_Tell("one_task", Since, ONE_TASK);

    CFE_ES_CreateChildTask(&Child, "PEER_CHILD", PEER_Child, CFE_ES_TASK_STACK_ALLOCATE, 16384, 50, 0);
    CFE_MSG_Init(&Packet.Msg, CFE_SB_ValueToMsgId(MSG_ID_THERE), sizeof(Packet));
    CFE_PSP_GetTime(&Since);
    for (int i = 0; i < ROUND_TRIPS; i++)
    {
        CFE_SB_TransmitMsg(&Packet.Msg, true);
        CFE_SB_ReceiveBuffer(&Received, PEER_Back, CFE_SB_PEND_FOREVER);
    }
    PEER_Tell("ping_pong", Since, ROUND_TRIPS);

    CFE_MSG_Init(&Packet.Msg, CFE_SB_ValueToMsgId(MSG_ID_MANY), sizeof(Packet));
    CFE_PSP_GetTime(&Since);
    for (int i = 0; i < FAN_OUT; i++)
    {
        CFE_SB_TransmitMsg(&Packet.Msg, true);
        for (int j = 0; j < WIDTH; j++)
            CFE_SB_ReceiveBuffer(&Received, Many[j], CFE_SB_POLL);
    }
    PEER_Tell("fan_out", Since, FAN_OUT * WIDTH);
    CFE_ES_ExitApp(CFE_ES_RunStatus_APP_EXIT);
}
