/* CFE_SB_* with good and bad arguments, and names of ES that are cut. */
#include "api_test.h"

typedef union {
    CFE_MSG_Message_t message;
    uint8 bytes[64];
} Packet;

static void pipes(void)
{
    CFE_SB_PipeId_t pipe = CFE_SB_PIPEID_C(CFE_ResourceId_FromInteger(77)), other;
    char name[OS_MAX_API_NAME];
    uint8 options = 9;
    uint32 index;
    TELL(CFE_SB_CreatePipe(NULL, 5, "PIPE"));
    TELL(CFE_SB_CreatePipe(&pipe, 5, ""));
    TELL(CFE_SB_CreatePipe(&pipe, 0, "PIPE"));
    TELL(CFE_SB_CreatePipe(&pipe, 5, NULL));
    TELL(CFE_SB_CreatePipe(&pipe, 5, "A name that is much too long"));
    SAY("id %lX", CFE_RESOURCEID_TO_ULONG(pipe));
    TELL(CFE_SB_CreatePipe(&pipe, 5, "PIPE"));
    TELL(CFE_SB_CreatePipe(&other, 5, "PIPE"));
    TELL(CFE_SB_PipeId_ToIndex(pipe, NULL));
    TELL(CFE_SB_PipeId_ToIndex(CFE_SB_INVALID_PIPE, &index));
    TELL(CFE_SB_SetPipeOpts(pipe, CFE_SB_PIPEOPTS_IGNOREMINE));
    TELL(CFE_SB_SetPipeOpts(CFE_SB_INVALID_PIPE, 0));
    TELL(CFE_SB_GetPipeOpts(pipe, NULL));
    TELL(CFE_SB_GetPipeOpts(CFE_SB_INVALID_PIPE, &options));
    SAY("untouched %u", options);
    TELL(CFE_SB_GetPipeOpts(pipe, &options));
    SAY("options %u", options);
    TELL(CFE_SB_GetPipeName(NULL, sizeof name, pipe));
    TELL(CFE_SB_GetPipeName(name, 0, pipe));
    TELL(CFE_SB_GetPipeName(name, sizeof name, CFE_SB_INVALID_PIPE));
    TELL(CFE_SB_GetPipeName(name, sizeof name, pipe));
    SAY("name %s", name);
    TELL(CFE_SB_GetPipeName(name, 3, pipe));
    SAY("name %s", name);
    TELL(CFE_SB_GetPipeIdByName(NULL, "PIPE"));
    TELL(CFE_SB_GetPipeIdByName(&other, NULL));
    TELL(CFE_SB_GetPipeIdByName(&other, "NOBODY"));
    TELL(CFE_SB_GetPipeIdByName(&other, "PIPE"));
    SAY("found %d", CFE_RESOURCEID_TEST_EQUAL(pipe, other));
    TELL(CFE_SB_DeletePipe(CFE_SB_INVALID_PIPE));
    TELL(CFE_SB_DeletePipe(pipe));
    TELL(CFE_SB_DeletePipe(pipe));
}

static void subscriptions(CFE_SB_PipeId_t pipe)
{
    CFE_SB_MsgId_t good = CFE_SB_ValueToMsgId(0x08F0), bad = CFE_SB_INVALID_MSG_ID;
    TELL(CFE_SB_Subscribe(bad, pipe));
    TELL(CFE_SB_Subscribe(CFE_SB_ValueToMsgId(0x2000), pipe));
    TELL(CFE_SB_Subscribe(good, CFE_SB_INVALID_PIPE));
    TELL(CFE_SB_Unsubscribe(good, pipe));
    TELL(CFE_SB_SubscribeEx(good, pipe, CFE_SB_DEFAULT_QOS, 2));
    TELL(CFE_SB_Subscribe(good, pipe));
    TELL(CFE_SB_SubscribeLocal(good, pipe, 3));
    TELL(CFE_SB_UnsubscribeLocal(bad, pipe));
    TELL(CFE_SB_UnsubscribeLocal(good, CFE_SB_INVALID_PIPE));
    TELL(CFE_SB_UnsubscribeLocal(good, pipe));
    TELL(CFE_SB_Unsubscribe(good, pipe));
    TELL(CFE_SB_Subscribe(good, pipe));
}

static void messages(CFE_SB_PipeId_t pipe)
{
    Packet packet;
    CFE_SB_Buffer_t *buffer = (CFE_SB_Buffer_t *)&packet;
    CFE_MSG_SequenceCount_t count;
    memset(&packet, 0, sizeof packet);
    TELL(CFE_SB_ReceiveBuffer(NULL, pipe, CFE_SB_POLL));
    TELL(CFE_SB_ReceiveBuffer(&buffer, pipe, -2));
    SAY("null %d", buffer == NULL);
    buffer = (CFE_SB_Buffer_t *)&packet;
    TELL(CFE_SB_ReceiveBuffer(&buffer, CFE_SB_INVALID_PIPE, CFE_SB_POLL));
    SAY("null %d", buffer == NULL);
    TELL(CFE_SB_ReceiveBuffer(&buffer, pipe, CFE_SB_POLL));
    TELL(CFE_SB_ReceiveBuffer(&buffer, pipe, 1));
    TELL(CFE_SB_ReceiveBuffer(&buffer, pipe, 2));
    TELL(CFE_SB_ReceiveBuffer(&buffer, pipe, 20));
    TELL(CFE_SB_TransmitMsg(NULL, true));
    TELL(CFE_SB_TransmitMsg(&packet.message, true));
    CFE_MSG_Init(&packet.message, CFE_SB_ValueToMsgId(0x08F0), sizeof packet);
    packet.bytes[63] = 0xAB;
    TELL(CFE_SB_TransmitMsg(&packet.message, true));
    TELL(CFE_SB_TransmitMsg(&packet.message, false));
    TELL(CFE_SB_ReceiveBuffer(&buffer, pipe, CFE_SB_POLL));
    CFE_MSG_GetSequenceCount(&buffer->Msg, &count);
    SAY("own buffer %d, count %u, last %02X", buffer != (void *)&packet, count, ((uint8 *)buffer)[63]);
    TELL(CFE_SB_ReceiveBuffer(&buffer, pipe, CFE_SB_PEND_FOREVER));
    SAY("length %lu", (unsigned long)CFE_SB_GetUserDataLength(&buffer->Msg));
    CFE_MSG_SetSize(&packet.message, 0xFFFF);
    TELL(CFE_SB_TransmitMsg(&packet.message, true));
    TELL(CFE_SB_ReleaseMessageBuffer(NULL));
    TELL(CFE_SB_TransmitBuffer(NULL, true));
    SAY("too large %d", CFE_SB_AllocateMessageBuffer(1 << 20) == NULL);
    buffer = CFE_SB_AllocateMessageBuffer(32);
    SAY("a buffer %d", buffer != NULL);
    TELL(CFE_SB_ReleaseMessageBuffer(buffer));
    buffer = CFE_SB_AllocateMessageBuffer(32);
    TELL(CFE_SB_TransmitBuffer(buffer, true));
    CFE_MSG_Init(&buffer->Msg, CFE_SB_ValueToMsgId(0x08F0), 32);
    TELL(CFE_SB_TransmitBuffer(buffer, true));
    CFE_SB_Buffer_t *got = NULL;
    TELL(CFE_SB_ReceiveBuffer(&got, pipe, CFE_SB_POLL));
    SAY("the same %d", got == buffer);
    CFE_SB_TimeStampMsg(NULL);
    SAY("no data %d", CFE_SB_GetUserData(NULL) == NULL);
    CFE_SB_SetUserDataLength(NULL, 5);
    CFE_SB_SetUserDataLength(&packet.message, 0x20000);
}

static void names(void)
{
    char name[20];
    CFE_ES_AppId_t app, other;
    CFE_ES_TaskId_t task;
    CFE_ES_CounterId_t counter;
    CFE_ES_GetAppID(&app);
    CFE_ES_GetTaskID(&task);
    TELL(CFE_ES_GetAppID(NULL));
    TELL(CFE_ES_GetTaskID(NULL));
    TELL(CFE_ES_GetAppIDByName(&other, NULL));
    TELL(CFE_ES_GetAppIDByName(NULL, "APITEST"));
    TELL(CFE_ES_GetAppIDByName(&other, "NOBODY"));
    TELL(CFE_ES_GetAppIDByName(&other, "APITEST"));
    SAY("mine %d", CFE_RESOURCEID_TEST_EQUAL(app, other));
    TELL(CFE_ES_GetAppName(name, app, 4));
    SAY("cut %s", name);
    TELL(CFE_ES_GetAppName(name, CFE_ES_APPID_UNDEFINED, sizeof name));
    SAY("empty %d", name[0] == 0);
    TELL(CFE_ES_GetTaskName(name, task, 4));
    SAY("cut %s", name);
    TELL(CFE_ES_GetTaskName(name, CFE_ES_TASKID_UNDEFINED, sizeof name));
    TELL(CFE_ES_RegisterGenCounter(NULL, "COUNTER"));
    TELL(CFE_ES_RegisterGenCounter(&counter, NULL));
    TELL(CFE_ES_RegisterGenCounter(&counter, "COUNTER"));
    TELL(CFE_ES_RegisterGenCounter(&counter, "COUNTER"));
    TELL(CFE_ES_GetGenCounterIDByName(&counter, "COUNTER"));
    TELL(CFE_ES_GetGenCounterName(name, counter, 4));
    SAY("cut %s", name);
    TELL(CFE_ES_GetGenCount(counter, NULL));
    TELL(CFE_ES_DeleteGenCounter(counter));
    TELL(CFE_ES_DeleteGenCounter(counter));
}

void APITEST_Main(void)
{
    CFE_SB_PipeId_t pipe;
    CFE_EVS_Register(NULL, 0, CFE_EVS_EventFilter_BINARY);
    pipes();
    TELL(CFE_SB_CreatePipe(&pipe, 10, "MINE"));
    subscriptions(pipe);
    messages(pipe);
    names();
    CFE_ES_ExitApp(CFE_ES_RunStatus_APP_EXIT);
}
