/* Events and tables of an application whose registration failed, and headers that do not fit their buffers. */
#include "api_test.h"

static CFE_ES_AppId_t me;

static int32 event(uint16 number) { return CFE_EVS_SendEvent(number, CFE_EVS_EventType_ERROR, "event %u", number); }

static void events(void)
{
    CFE_EVS_BinFilter_t filters[10];
    memset(filters, 0, sizeof filters);
    for (int i = 0; i < 10; i++)
        filters[i].EventID = i + 1;
    filters[0].Mask = CFE_EVS_FIRST_ONE_STOP;
    SAY("-- never registered");
    TELL(event(1));
    TELL(event(2));
    TELL(CFE_EVS_SendEventWithAppID(3, CFE_EVS_EventType_ERROR, me, "by id"));
    TELL(CFE_EVS_SendTimedEvent((CFE_TIME_SysTime_t){1, 2}, 4, CFE_EVS_EventType_ERROR, "timed"));
    TELL(CFE_EVS_ResetFilter(1));
    TELL(CFE_EVS_ResetAllFilters());
    SAY("-- failed");
    TELL(CFE_EVS_Register(NULL, 3, CFE_EVS_EventFilter_BINARY));
    TELL(event(5));
    TELL(event(6));
    TELL(CFE_EVS_Register(filters, 3, 5));
    TELL(event(7));
    TELL(event(8));
    SAY("-- registered, then failed");
    TELL(CFE_EVS_Register(filters, 10, CFE_EVS_EventFilter_BINARY));
    TELL(event(1));
    TELL(event(1));
    TELL(CFE_EVS_ResetFilter(1));
    TELL(event(1));
    TELL(CFE_EVS_ResetFilter(9));
    TELL(CFE_EVS_ResetFilter(77));
    TELL(CFE_EVS_Register(filters, 3, 1));
    TELL(event(9));
    TELL(event(10));
    TELL(CFE_EVS_ResetFilter(1));
    TELL(CFE_EVS_Register(NULL, 0, CFE_EVS_EventFilter_BINARY));
    TELL(event(1));
    TELL(event(1));
    TELL(CFE_EVS_ResetFilter(1));
    TELL(CFE_EVS_Register(filters, 1, CFE_EVS_EventFilter_BINARY));
    TELL(event(1));
    TELL(event(1));
    TELL(CFE_EVS_SendEventWithAppID(11, CFE_EVS_EventType_ERROR, CFE_ES_APPID_UNDEFINED, "nobody"));
    TELL(CFE_EVS_SendEvent(12, CFE_EVS_EventType_ERROR, NULL));
    TELL(CFE_EVS_SendEvent(13, 0, "no type"));
    TELL(CFE_EVS_SendEvent(14, 0xFF, "all types"));
}

static void tables(void)
{
    CFE_TBL_Handle_t handle = CFE_TBL_BAD_TABLE_HANDLE;
    void *at = &handle;
    SAY("-- tables");
    TELL(CFE_TBL_Register(NULL, "T", 16, CFE_TBL_OPT_DEFAULT, NULL));
    TELL(CFE_TBL_Register(&handle, NULL, 16, CFE_TBL_OPT_DEFAULT, NULL));
    TELL(CFE_TBL_Register(&handle, "", 16, CFE_TBL_OPT_DEFAULT, NULL));
    TELL(CFE_TBL_Register(&handle, "NameOfMoreThan16Characters", 16, CFE_TBL_OPT_DEFAULT, NULL));
    TELL(CFE_TBL_Register(&handle, "T", 0, CFE_TBL_OPT_DEFAULT, NULL));
    TELL(CFE_TBL_Register(&handle, "T", 1000000, CFE_TBL_OPT_DEFAULT, NULL));
    TELL(CFE_TBL_Register(&handle, "T", 16, CFE_TBL_OPT_USR_DEF_ADDR | CFE_TBL_OPT_CRITICAL, NULL));
    TELL(CFE_TBL_Register(&handle, "T", 16, CFE_TBL_OPT_DUMP_ONLY | CFE_TBL_OPT_DBL_BUFFER, NULL));
    TELL(CFE_TBL_GetAddress(&at, handle));
    TELL(CFE_TBL_Load(handle, CFE_TBL_SRC_ADDRESS, &handle));
    TELL(CFE_TBL_Manage(handle));
    TELL(CFE_TBL_Register(&handle, "T", 16, CFE_TBL_OPT_DEFAULT, NULL));
    TELL(CFE_TBL_Register(&handle, "T", 16, CFE_TBL_OPT_DEFAULT, NULL));
    TELL(CFE_TBL_Register(&handle, "T", 20, CFE_TBL_OPT_DEFAULT, NULL));
    TELL(CFE_TBL_GetAddress(&at, handle));
    TELL(CFE_TBL_Unregister(handle));
    TELL(CFE_TBL_Unregister(handle));
    TELL(CFE_TBL_GetStatus(handle));
    TELL(event(1));
}

static void messages(void)
{
    static union {
        CFE_MSG_Message_t message;
        uint8 bytes[70000];
    } large;
    CFE_SB_Buffer_t *buffer, *got = NULL;
    CFE_SB_PipeId_t pipe;
    CFE_MSG_Size_t size = 0;
    SAY("-- headers and buffers");
    TELL(CFE_MSG_Init(&large.message, CFE_SB_ValueToMsgId(0x1F80), 3));
    TELL(CFE_MSG_Init(&large.message, CFE_SB_ValueToMsgId(0x1F80), 6));
    TELL(CFE_MSG_Init(&large.message, CFE_SB_ValueToMsgId(0x1F80), 7));
    TELL(CFE_MSG_Init(&large.message, CFE_SB_ValueToMsgId(0x1F80), 0));
    TELL(CFE_MSG_Init(&large.message, CFE_SB_ValueToMsgId(0x1F80), 65542));
    TELL(CFE_MSG_Init(&large.message, CFE_SB_ValueToMsgId(0x1F80), 65543));
    TELL(CFE_MSG_Init(&large.message, CFE_SB_ValueToMsgId(0x2000), 8));
    TELL(CFE_MSG_Init(&large.message, CFE_SB_ValueToMsgId(0x1F80), 8));
    TELL(CFE_MSG_SetSize(&large.message, 6));
    TELL(CFE_MSG_SetSize(&large.message, 65543));
    TELL(CFE_SB_CreatePipe(&pipe, 10, "UNREG"));
    TELL(CFE_SB_Subscribe(CFE_SB_ValueToMsgId(0x1F80), pipe));
    TELL(CFE_SB_ReceiveBuffer(&got, pipe, CFE_SB_POLL));
    buffer = CFE_SB_AllocateMessageBuffer(8);
    SAY("allocated %d", buffer != NULL);
    TELL(CFE_MSG_Init(&buffer->Msg, CFE_SB_ValueToMsgId(0x1F80), 8));
    TELL(CFE_MSG_SetSize(&buffer->Msg, 20));
    TELL(CFE_SB_TransmitBuffer(buffer, true));
    TELL(CFE_SB_ReceiveBuffer(&got, pipe, CFE_SB_POLL));
    if (got)
        CFE_MSG_GetSize(&got->Msg, &size);
    SAY("%u bytes", (unsigned)size);
    SAY("allocated %d %d %d", CFE_SB_AllocateMessageBuffer(0) != NULL, CFE_SB_AllocateMessageBuffer(5) != NULL,
        CFE_SB_AllocateMessageBuffer(100000) != NULL);
    TELL(CFE_SB_ReleaseMessageBuffer(NULL));
    TELL(CFE_SB_TransmitBuffer(NULL, true));
    TELL(CFE_SB_TransmitMsg(NULL, true));
    buffer = CFE_SB_AllocateMessageBuffer(20);
    TELL(CFE_SB_ReleaseMessageBuffer(buffer));
    TELL(CFE_SB_ReleaseMessageBuffer(buffer));
    TELL(CFE_SB_DeletePipe(pipe));
    TELL(CFE_SB_DeletePipe(pipe));
    TELL(CFE_SB_Unsubscribe(CFE_SB_ValueToMsgId(0x1F80), pipe));
    TELL(CFE_SB_ReceiveBuffer(&got, pipe, CFE_SB_POLL));
}

void APITEST_Main(void)
{
    CFE_ES_GetAppID(&me);
    events();
    CFE_ES_WaitForSystemState(CFE_ES_SystemState_OPERATIONAL, 10000);
    tables();
    messages();
    CFE_ES_ExitApp(CFE_ES_RunStatus_APP_EXIT);
}
