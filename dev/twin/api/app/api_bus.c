/* Event Services, Software Bus, Table Services and Time Services, as the script calls them. */
#include <string.h>

#include "api_app.h"

#define PIPEID(word) ((CFE_SB_PipeId_t)CFE_RESOURCEID_WRAP(CFE_ResourceId_FromInteger((uint32)Num(word))))
#define MSGID(word) CFE_SB_ValueToMsgId((CFE_SB_MsgId_Atom_t)Num(word))

static CFE_TIME_SysTime_t Time(int word)
{
    CFE_TIME_SysTime_t time;
    time.Seconds    = Num(word);
    time.Subseconds = Num(word + 1);
    return time;
}

CALL(EVS_Register)
{
    CFE_EVS_BinFilter_t filters[20];
    int                 word, count = 0;
    for (word = 2; word + 1 <= Words(); word += 2)
    {
        filters[count].EventID = Num(word);
        filters[count].Mask    = Num(word + 1);
        ++count;
    }
    Status(CFE_EVS_Register(count ? filters : NULL, count, Num(1)));
}
CALL(EVS_SendEvent)
{
    Status(CFE_EVS_SendEvent(Num(1), Num(2), "%s", Text(3)));
}
CALL(EVS_SendEventWithAppID)
{
    Status(CFE_EVS_SendEventWithAppID(Num(1), Num(2), APPID(3), "%s", Text(4)));
}
CALL(EVS_SendTimedEvent)
{
    Status(CFE_EVS_SendTimedEvent(Time(1), Num(3), Num(4), "%s", Text(5)));
}
CALL(EVS_ResetFilter)
{
    Status(CFE_EVS_ResetFilter(Num(1)));
}
CALL(EVS_ResetAllFilters)
{
    Status(CFE_EVS_ResetAllFilters());
}

CALL(SB_CreatePipe)
{
    CFE_SB_PipeId_t id;
    Status(CFE_SB_CreatePipe(&id, Num(2), Text(3)));
    Keep(1, RAW(id));
}
CALL(SB_DeletePipe)
{
    Status(CFE_SB_DeletePipe(PIPEID(1)));
}
CALL(SB_PipeId_ToIndex)
{
    uint32 index = 0;
    Status(CFE_SB_PipeId_ToIndex(PIPEID(1), &index));
    OutNum(index);
}
CALL(SB_SetPipeOpts)
{
    Status(CFE_SB_SetPipeOpts(PIPEID(1), Num(2)));
}
CALL(SB_GetPipeOpts)
{
    uint8 opts = 0;
    Status(CFE_SB_GetPipeOpts(PIPEID(1), &opts));
    OutNum(opts);
}
CALL(SB_GetPipeName)
{
    char name[64] = "";
    Status(CFE_SB_GetPipeName(name, sizeof(name), PIPEID(1)));
    OutText(name, sizeof(name));
}
CALL(SB_GetPipeIdByName)
{
    CFE_SB_PipeId_t id;
    Status(CFE_SB_GetPipeIdByName(&id, Text(2)));
    Keep(1, RAW(id));
}
CALL(SB_Subscribe)
{
    Status(CFE_SB_Subscribe(MSGID(1), PIPEID(2)));
}
CALL(SB_SubscribeEx)
{
    CFE_SB_Qos_t quality = {Num(3), Num(4)};
    Status(CFE_SB_SubscribeEx(MSGID(1), PIPEID(2), quality, Num(5)));
}
CALL(SB_SubscribeLocal)
{
    Status(CFE_SB_SubscribeLocal(MSGID(1), PIPEID(2), Num(3)));
}
CALL(SB_Unsubscribe)
{
    Status(CFE_SB_Unsubscribe(MSGID(1), PIPEID(2)));
}
CALL(SB_UnsubscribeLocal)
{
    Status(CFE_SB_UnsubscribeLocal(MSGID(1), PIPEID(2)));
}
CALL(SB_TransmitMsg)
{
    size_t size;
    Status(CFE_SB_TransmitMsg((CFE_MSG_Message_t *)Bytes(1, &size), Num(2)));
}
CALL(SB_ReceiveBuffer)
{
    CFE_SB_Buffer_t *buffer = NULL;
    CFE_MSG_Size_t   size   = 0;
    Status(CFE_SB_ReceiveBuffer(&buffer, PIPEID(1), Num(2)));
    if (buffer != NULL)
    {
        CFE_MSG_GetSize(&buffer->Msg, &size);
        OutBytes(buffer, size);
    }
}
static CFE_SB_Buffer_t *Buffers[SLOTS];

CALL(SB_AllocateMessageBuffer)
{
    CFE_SB_Buffer_t *buffer  = CFE_SB_AllocateMessageBuffer(Num(2));
    Buffers[Num(1) % SLOTS] = buffer;
    Status(buffer ? 0 : -1);
}
CALL(SB_TransmitBuffer)
{
    CFE_SB_Buffer_t *buffer = Buffers[Num(1) % SLOTS];
    size_t           size;
    uint8 *          data = Bytes(2, &size);
    int32            status;
    if (buffer == NULL)
    {
        Status(0);
        return;
    }
    memcpy(buffer, data, size);
    status = CFE_SB_TransmitBuffer(buffer, Num(3));
    Status(status);
    if (status == CFE_SUCCESS)
    {
        Buffers[Num(1) % SLOTS] = NULL;
    }
}
CALL(SB_ReleaseMessageBuffer)
{
    CFE_SB_Buffer_t *buffer = Buffers[Num(1) % SLOTS];
    Buffers[Num(1) % SLOTS] = NULL;
    Status(buffer ? CFE_SB_ReleaseMessageBuffer(buffer) : 0);
}

static int32 Validate(void *table)
{
    switch (*(uint8 *)table)
    {
        case 0xEE:
            return -1;
        case 0xDD:
            return 5;
        default:
            return 0;
    }
}

/* Ids stand in the script; a build with CFE_OMIT_DEPRECATED has them as handles, others their serial numbers. */
#define HANDLE(word) ((CFE_TBL_Handle_t)(Num(word) & (sizeof(CFE_TBL_Handle_t) == 2 ? 0xFFFF : 0xFFFFFFFF)))


CALL(TBL_Register)
{
    CFE_TBL_Handle_t handle = CFE_TBL_BAD_TABLE_HANDLE;
    Status(CFE_TBL_Register(&handle, Text(2), Num(3), Num(4), Num(5) ? Validate : NULL));
    Keep(1, ((unsigned long)handle & 0xFFFF) | 0x1b0000);
}
CALL(TBL_Share)
{
    CFE_TBL_Handle_t handle = CFE_TBL_BAD_TABLE_HANDLE;
    Status(CFE_TBL_Share(&handle, Text(2)));
    Keep(1, ((unsigned long)handle & 0xFFFF) | 0x1b0000);
}
#define WITH_HANDLE(call)                  \
    CALL(call)                             \
    {                                      \
        Status(CFE_##call(HANDLE(1)));     \
    }
WITH_HANDLE(TBL_Unregister)
WITH_HANDLE(TBL_Update)
WITH_HANDLE(TBL_Validate)
WITH_HANDLE(TBL_Manage)
WITH_HANDLE(TBL_DumpToBuffer)
WITH_HANDLE(TBL_Modified)
WITH_HANDLE(TBL_ReleaseAddress)
WITH_HANDLE(TBL_GetStatus)

CALL(TBL_LoadFile)
{
    Status(CFE_TBL_Load(HANDLE(1), CFE_TBL_SRC_FILE, Text(2)));
}
CALL(TBL_LoadAddress)
{
    static uint8 image[40000]; /* stays, as a table with an address of its own wants */
    size_t       size;
    uint8 *      data = Bytes(2, &size);
    memset(image, 0, sizeof(image));
    memcpy(image, data, size);
    Status(CFE_TBL_Load(HANDLE(1), CFE_TBL_SRC_ADDRESS, image));
}
CALL(TBL_GetAddress)
{
    void *address = NULL;
    Status(CFE_TBL_GetAddress(&address, HANDLE(1)));
    if (address != NULL)
    {
        OutBytes(address, Num(2));
    }
}
CALL(TBL_GetAddresses)
{
    void *           address[2] = {NULL, NULL};
    void **          addresses[] = {&address[0], &address[1]};
    CFE_TBL_Handle_t handles[]   = {HANDLE(1), HANDLE(2)};
    Status(CFE_TBL_GetAddresses(addresses, 2, handles));
}
CALL(TBL_ReleaseAddresses)
{
    CFE_TBL_Handle_t handles[] = {HANDLE(1), HANDLE(2)};
    Status(CFE_TBL_ReleaseAddresses(2, handles));
}
CALL(TBL_GetInfo)
{
    CFE_TBL_Info_t info = {0};
    Status(CFE_TBL_GetInfo(&info, Text(1)));
    OutNum(info.Size);
    OutNum(info.NumUsers);
    OutNum(info.FileTime.Seconds);
    OutNum(info.Crc);
    OutNum(info.TableLoadedOnce);
    OutNum(info.DumpOnly);
    OutNum(info.DoubleBuffered);
    OutNum(info.UserDefAddr);
    OutNum(info.Critical);
    if (memcmp(info.LastFileLoaded, "Addr", 4) != 0)
    {
        OutText(info.LastFileLoaded, sizeof(info.LastFileLoaded));
    }
}
CALL(TBL_NotifyByMessage)
{
    Status(CFE_TBL_NotifyByMessage(HANDLE(1), MSGID(2), Num(3), Num(4)));
}

static void OutTime(CFE_TIME_SysTime_t time)
{
    OutNum(time.Seconds);
    OutNum(time.Subseconds);
}
CALL(TIME_Add)
{
    Status(0);
    OutTime(CFE_TIME_Add(Time(1), Time(3)));
}
CALL(TIME_Subtract)
{
    Status(0);
    OutTime(CFE_TIME_Subtract(Time(1), Time(3)));
}
CALL(TIME_Compare)
{
    Status(0);
    OutNum(CFE_TIME_Compare(Time(1), Time(3)));
}
CALL(TIME_MET2SCTime)
{
    Status(0);
    OutTime(CFE_TIME_MET2SCTime(Time(1)));
}
CALL(TIME_Sub2MicroSecs)
{
    Status(0);
    OutNum(CFE_TIME_Sub2MicroSecs(Num(1)));
}
CALL(TIME_Micro2SubSecs)
{
    Status(0);
    OutNum(CFE_TIME_Micro2SubSecs(Num(1)));
}
CALL(TIME_Print)
{
    char text[CFE_TIME_PRINTED_STRING_SIZE];
    Status(CFE_TIME_Print(text, Time(1)));
    OutText(text, sizeof(text));
}
CALL(TIME_Settings)
{
    CFE_TIME_SysTime_t tai = CFE_TIME_GetTAI(), utc, met;
    Status(0);
    OutTime(CFE_TIME_GetSTCF());
    OutNum(CFE_TIME_GetLeapSeconds());
    OutNum(CFE_TIME_GetClockState());
    OutNum(CFE_TIME_GetClockInfo());
    utc = CFE_TIME_GetUTC();
    met = CFE_TIME_GetMET();
    OutNum(tai.Seconds + 2 - utc.Seconds - (uint32)CFE_TIME_GetLeapSeconds() < 4);
    OutNum(CFE_TIME_GetMETseconds() - met.Seconds < 2);
    OutNum(CFE_TIME_Compare(CFE_TIME_GetTime(), utc) != CFE_TIME_A_LT_B);
}
static int   Synchs[2];
static int32 Synch0(void)
{
    ++Synchs[0];
    return 0;
}
static int32 Synch1(void)
{
    ++Synchs[1];
    return 0;
}
CALL(TIME_RegisterSynchCallback)
{
    Status(CFE_TIME_RegisterSynchCallback(Num(1) ? Synch1 : Synch0));
}
CALL(TIME_UnregisterSynchCallback)
{
    Status(CFE_TIME_UnregisterSynchCallback(Num(1) ? Synch1 : Synch0));
}
CALL(TIME_SynchCallbacksCame)
{
    int before[2] = {Synchs[0], Synchs[1]};
    OS_TaskDelay(2500);
    Status(0);
    OutNum(Synchs[0] > before[0]);
    OutNum(Synchs[1] > before[1]);
}
CALL(TIME_ExternalTone)
{
    CFE_TIME_ExternalTone();
    Status(0);
}

const Call BusCalls[] = {ROW(EVS_Register), ROW(EVS_SendEvent), ROW(EVS_SendEventWithAppID), ROW(EVS_SendTimedEvent),
    ROW(EVS_ResetFilter), ROW(EVS_ResetAllFilters), ROW(SB_CreatePipe), ROW(SB_DeletePipe), ROW(SB_PipeId_ToIndex),
    ROW(SB_SetPipeOpts), ROW(SB_GetPipeOpts), ROW(SB_GetPipeName), ROW(SB_GetPipeIdByName), ROW(SB_Subscribe),
    ROW(SB_SubscribeEx), ROW(SB_SubscribeLocal), ROW(SB_Unsubscribe), ROW(SB_UnsubscribeLocal), ROW(SB_TransmitMsg),
    ROW(SB_ReceiveBuffer), ROW(SB_AllocateMessageBuffer), ROW(SB_TransmitBuffer), ROW(SB_ReleaseMessageBuffer),
    ROW(TBL_Register), ROW(TBL_Share), ROW(TBL_Unregister), ROW(TBL_Update), ROW(TBL_Validate), ROW(TBL_Manage),
    ROW(TBL_DumpToBuffer), ROW(TBL_Modified), ROW(TBL_ReleaseAddress), ROW(TBL_GetStatus), ROW(TBL_LoadFile),
    ROW(TBL_LoadAddress), ROW(TBL_GetAddress), ROW(TBL_GetAddresses), ROW(TBL_ReleaseAddresses), ROW(TBL_GetInfo),
    ROW(TBL_NotifyByMessage), ROW(TIME_Add), ROW(TIME_Subtract), ROW(TIME_Compare), ROW(TIME_MET2SCTime),
    ROW(TIME_Sub2MicroSecs), ROW(TIME_Micro2SubSecs), ROW(TIME_Print), ROW(TIME_Settings),
    ROW(TIME_RegisterSynchCallback), ROW(TIME_UnregisterSynchCallback), ROW(TIME_SynchCallbacksCame),
    ROW(TIME_ExternalTone), {NULL, NULL}};
