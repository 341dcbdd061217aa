/* What CFE_MSG answers to what cannot be, and what it leaves in the header: ids, sizes, fields, kinds, pointers. */
#include "api_test.h"

static union
{
    CFE_MSG_Message_t message;
    uint8 bytes[48];
} it;
#define MESSAGE (&it.message)

static void shown(void)
{
    const uint8 *b = it.bytes;
    SAY("%02X%02X %02X%02X %02X%02X %02X%02X%02X%02X%02X%02X %02X%02X", b[0], b[1], b[2], b[3], b[4], b[5], b[6], b[7],
        b[8], b[9], b[10], b[11], b[12], b[13]);
}

#define SHOW(call) (TELL(call), shown())

static void begin(uint32 id)
{
    memset(it.bytes, 0xEE, sizeof it.bytes);
    CFE_MSG_Init(MESSAGE, CFE_SB_ValueToMsgId(id), 24);
}

static void dirty(void) { memset(it.bytes, 0xEE, sizeof it.bytes); }

static void inits(void)
{
    static const uint32 ids[] = {0, 1, 0x800, 0x1FFF, 0x2000, 0xFFFF, 0x10891, 0xFFFFFFFF};
    static const CFE_MSG_Size_t sizes[] = {0, 6, 7, 8, 40};
    for (unsigned i = 0; i < sizeof ids / sizeof *ids; i++) {
        dirty();
        SAY("id %X", (unsigned)ids[i]);
        SHOW(CFE_MSG_Init(MESSAGE, CFE_SB_ValueToMsgId(ids[i]), 24));
    }
    for (unsigned i = 0; i < sizeof sizes / sizeof *sizes; i++) {
        dirty();
        SAY("size %u", (unsigned)sizes[i]);
        SHOW(CFE_MSG_Init(MESSAGE, CFE_SB_ValueToMsgId(0x1891), sizes[i]));
    }
    dirty();
    SHOW(CFE_MSG_Init(MESSAGE, CFE_SB_ValueToMsgId(0), 3));
    TELL(CFE_MSG_Init(NULL, CFE_SB_ValueToMsgId(0), 3));
}

static void fields(void)
{
    dirty();
    SHOW(CFE_MSG_SetMsgId(MESSAGE, CFE_SB_ValueToMsgId(0x2000)));
    SHOW(CFE_MSG_SetMsgId(MESSAGE, CFE_SB_ValueToMsgId(0)));
    SHOW(CFE_MSG_SetMsgId(MESSAGE, CFE_SB_ValueToMsgId(0x10001)));
    SHOW(CFE_MSG_SetMsgId(MESSAGE, CFE_SB_ValueToMsgId(0x1FFF)));
    SHOW(CFE_MSG_SetSize(MESSAGE, 6));
    SHOW(CFE_MSG_SetSize(MESSAGE, 7));
    SHOW(CFE_MSG_SetSize(MESSAGE, 65542));
    SHOW(CFE_MSG_SetSize(MESSAGE, 65543));
    SHOW(CFE_MSG_SetSize(MESSAGE, 0x100000010));
    SHOW(CFE_MSG_SetType(MESSAGE, CFE_MSG_Type_Invalid));
    SHOW(CFE_MSG_SetType(MESSAGE, CFE_MSG_Type_Tlm));
    SHOW(CFE_MSG_SetType(MESSAGE, CFE_MSG_Type_Cmd));
    SHOW(CFE_MSG_SetType(MESSAGE, (CFE_MSG_Type_t)3));
    SHOW(CFE_MSG_SetHeaderVersion(MESSAGE, 7));
    SHOW(CFE_MSG_SetHeaderVersion(MESSAGE, 8));
    SHOW(CFE_MSG_SetHeaderVersion(MESSAGE, 0));
    SHOW(CFE_MSG_SetHasSecondaryHeader(MESSAGE, false));
    SHOW(CFE_MSG_SetHasSecondaryHeader(MESSAGE, true));
    SHOW(CFE_MSG_SetApId(MESSAGE, 0x7FF));
    SHOW(CFE_MSG_SetApId(MESSAGE, 0x800));
    SHOW(CFE_MSG_SetApId(MESSAGE, 5));
    SHOW(CFE_MSG_SetSegmentationFlag(MESSAGE, CFE_MSG_SegFlag_Invalid));
    SHOW(CFE_MSG_SetSegmentationFlag(MESSAGE, CFE_MSG_SegFlag_Continue));
    SHOW(CFE_MSG_SetSegmentationFlag(MESSAGE, CFE_MSG_SegFlag_First));
    SHOW(CFE_MSG_SetSegmentationFlag(MESSAGE, CFE_MSG_SegFlag_Last));
    SHOW(CFE_MSG_SetSegmentationFlag(MESSAGE, CFE_MSG_SegFlag_Unsegmented));
    SHOW(CFE_MSG_SetSegmentationFlag(MESSAGE, (CFE_MSG_SegmentationFlag_t)5));
    SHOW(CFE_MSG_SetSequenceCount(MESSAGE, 0x3FFF));
    SHOW(CFE_MSG_SetSequenceCount(MESSAGE, 0x4000));
    SHOW(CFE_MSG_SetSequenceCount(MESSAGE, 0));
    SAY("next %u %u %u %u", CFE_MSG_GetNextSequenceCount(0), CFE_MSG_GetNextSequenceCount(0x3FFE),
        CFE_MSG_GetNextSequenceCount(0x3FFF), CFE_MSG_GetNextSequenceCount(0xFFFF));
}

static void kinds(uint32 id)
{
    CFE_TIME_SysTime_t time = {0x12345678, 0x9ABCDEF0};
    CFE_MSG_FcnCode_t  code = 99;
    CFE_MSG_Type_t     type = 99;
    bool               valid = true;
    begin(id);
    SAY("kind %X", (unsigned)id);
    SHOW(CFE_MSG_SetFcnCode(MESSAGE, 127));
    SHOW(CFE_MSG_SetFcnCode(MESSAGE, 128));
    SHOW(CFE_MSG_SetFcnCode(MESSAGE, 0xFFFF));
    it.bytes[6] |= 0x80;
    TELL(CFE_MSG_GetFcnCode(MESSAGE, &code));
    SHOW(CFE_MSG_SetFcnCode(MESSAGE, 5));
    TELL(CFE_MSG_ValidateChecksum(MESSAGE, &valid));
    SAY("code %u valid %d", code, valid);
    SHOW(CFE_MSG_GenerateChecksum(MESSAGE));
    TELL(CFE_MSG_ValidateChecksum(MESSAGE, &valid));
    SAY("valid %d", valid);
    it.bytes[20]++;
    TELL(CFE_MSG_ValidateChecksum(MESSAGE, &valid));
    SAY("valid %d", valid);
    SHOW(CFE_MSG_SetMsgTime(MESSAGE, time));
    time.Seconds = time.Subseconds = 7;
    TELL(CFE_MSG_GetMsgTime(MESSAGE, &time));
    TELL(CFE_MSG_GetType(MESSAGE, &type));
    SAY("time %X %X type %u", (unsigned)time.Seconds, (unsigned)time.Subseconds, (unsigned)type);
    type = 99;
    TELL(CFE_MSG_GetTypeFromMsgId(CFE_SB_ValueToMsgId(id), &type));
    SAY("type %u size %u data %u", (unsigned)type, (unsigned)CFE_SB_GetUserDataLength(MESSAGE),
        (unsigned)((uint8 *)CFE_SB_GetUserData(MESSAGE) - it.bytes));
}

static void pointers(void)
{
    CFE_TIME_SysTime_t time = {1, 2};
    CFE_MSG_Size_t     size = 5;
    CFE_SB_MsgId_t     id;
    CFE_MSG_Type_t     type = 9;
    CFE_MSG_FcnCode_t  code = 9;
    bool               valid = true;
    begin(0x1891);
    TELL(CFE_MSG_GetMsgId(NULL, &id));
    TELL(CFE_MSG_GetMsgId(MESSAGE, NULL));
    TELL(CFE_MSG_SetMsgId(NULL, CFE_SB_ValueToMsgId(1)));
    TELL(CFE_MSG_GetSize(NULL, &size));
    TELL(CFE_MSG_GetSize(MESSAGE, NULL));
    TELL(CFE_MSG_SetSize(NULL, 10));
    TELL(CFE_MSG_GetType(NULL, &type));
    TELL(CFE_MSG_GetType(MESSAGE, NULL));
    TELL(CFE_MSG_GetTypeFromMsgId(CFE_SB_ValueToMsgId(0), &type));
    TELL(CFE_MSG_GetTypeFromMsgId(CFE_SB_ValueToMsgId(0x2000), &type));
    TELL(CFE_MSG_GetTypeFromMsgId(CFE_SB_ValueToMsgId(1), NULL));
    TELL(CFE_MSG_GetFcnCode(NULL, &code));
    TELL(CFE_MSG_GetFcnCode(MESSAGE, NULL));
    TELL(CFE_MSG_SetFcnCode(NULL, 1));
    TELL(CFE_MSG_GenerateChecksum(NULL));
    TELL(CFE_MSG_ValidateChecksum(NULL, &valid));
    TELL(CFE_MSG_ValidateChecksum(MESSAGE, NULL));
    TELL(CFE_MSG_GetMsgTime(NULL, &time));
    TELL(CFE_MSG_GetMsgTime(MESSAGE, NULL));
    TELL(CFE_MSG_SetMsgTime(NULL, time));
    TELL(CFE_MSG_OriginationAction(NULL, 24, &valid));
    TELL(CFE_MSG_OriginationAction(MESSAGE, 24, NULL));
    TELL(CFE_MSG_VerificationAction(NULL, 24, &valid));
    TELL(CFE_MSG_VerificationAction(MESSAGE, 24, NULL));
    SAY("size %u type %u code %u valid %d", (unsigned)size, (unsigned)type, code, valid);
    shown();
}

static void user_data(void)
{
    static const uint32 ids[] = {0x1891, 0x0891, 0x0091};
    for (unsigned i = 0; i < sizeof ids / sizeof *ids; i++) {
        begin(ids[i]);
        SAY("id %X", (unsigned)ids[i]);
        CFE_SB_SetUserDataLength(MESSAGE, 4);
        shown();
        CFE_SB_SetUserDataLength(MESSAGE, 0);
        shown();
        SAY("data %u", (unsigned)CFE_SB_GetUserDataLength(MESSAGE));
        CFE_SB_SetUserDataLength(MESSAGE, 40000);
        shown();
        CFE_SB_SetUserDataLength(MESSAGE, 70000);
        shown();
        CFE_MSG_SetSize(MESSAGE, 7);
        SAY("data %u", (unsigned)CFE_SB_GetUserDataLength(MESSAGE));
        CFE_SB_TimeStampMsg(MESSAGE);
        SAY("%02X%02X %02X%02X", it.bytes[0], it.bytes[1], it.bytes[2], it.bytes[3]);
    }
    CFE_SB_SetUserDataLength(NULL, 4);
    CFE_SB_TimeStampMsg(NULL);
    SAY("none %u %d", (unsigned)CFE_SB_GetUserDataLength(NULL), CFE_SB_GetUserData(NULL) == NULL);
    for (uint32 id = 0; id < 0x20000; id += 0xFFF)
        SAY("%X %d", (unsigned)id, CFE_SB_IsValidMsgId(CFE_SB_ValueToMsgId(id)));
    SAY("topics %X %X %X %X %X", (unsigned)CFE_SB_CmdTopicIdToMsgId(5, 3), (unsigned)CFE_SB_TlmTopicIdToMsgId(5, 3),
        (unsigned)CFE_SB_GlobalCmdTopicIdToMsgId(0xFFFF), (unsigned)CFE_SB_LocalTlmTopicIdToMsgId(0xFFFF),
        (unsigned)CFE_SB_CmdTopicIdToMsgId(0x80, 0xFFFF));
}

static void text(int32 length, const char *to)
{
    SAY("%d: %02X %02X %02X %02X %02X %02X", (int)length, to[0] & 0xFF, to[1] & 0xFF, to[2] & 0xFF, to[3] & 0xFF,
        to[4] & 0xFF, to[5] & 0xFF);
}

static void strings(void)
{
    char to[8];
#define GET(...) (memset(to, 0x55, sizeof to), text(CFE_SB_MessageStringGet(to, __VA_ARGS__), to))
#define SET(...) (memset(to, 0x55, sizeof to), text(CFE_SB_MessageStringSet(to, __VA_ARGS__), to))
    GET("abcdef", "no", 6, 6);
    GET("abcdef", "no", 4, 6);
    GET("abcdef", "no", 6, 4);
    GET("ab\0def", "no", 6, 6);
    GET("", "no", 6, 6);
    GET("", "default", 6, 6);
    GET("", NULL, 6, 6);
    GET("abc", "no", 0, 6);
    GET("abc", "no", 6, 0);
    GET("abc", "no", 1, 3);
    SET("abcdef", 6, 6);
    SET("abcdef", 4, 6);
    SET("abcdef", 6, 4);
    SET("ab", 6, 6);
    SET("ab", 6, 1);
    SET("", 6, 6);
    SET("ab", 0, 6);
    SET("ab", 6, 0);
    text(CFE_SB_MessageStringGet(NULL, "a", "b", 4, 4), "      ");
    text(CFE_SB_MessageStringSet(NULL, "a", 4, 4), "      ");
}

void APITEST_Main(void)
{
    inits();
    fields();
    kinds(0x1891);
    kinds(0x0891);
    kinds(0x1091);
    kinds(0x0091);
    pointers();
    user_data();
    strings();
    CFE_ES_ExitApp(CFE_ES_RunStatus_APP_EXIT);
}
