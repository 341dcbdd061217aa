/* CFE_Config_*, CFE_ResourceId_*, and what the Software Bus says of ids. */
#include "api_test.h"

static uint32 used, last, keys, named;
static void *told;

static bool is_used(CFE_ResourceId_t id)
{
    last = CFE_ResourceId_ToInteger(id);
    return (used >> (last & 31)) & 1;
}

static bool always(CFE_ResourceId_t id) { return CFE_ResourceId_IsDefined(id); }

static CFE_ResourceId_t two_on(CFE_ResourceId_t id, void *argument)
{
    int *left = argument;
    uint32 value = (uint32)CFE_ResourceId_ToInteger(id);
    return (*left)-- > 0 ? CFE_ResourceId_FromInteger(value + 2) : CFE_RESOURCEID_UNDEFINED;
}

static void on_key(void *argument, CFE_ConfigId_t id, const char *name)
{
    told = argument;
    keys++;
    named += name != NULL && strcmp(name, CFE_Config_GetName(id)) == 0;
}

static void configuration(void)
{
    char text[100];
    CFE_ConfigId_t none = CFE_CONFIGID_UNDEFINED, major = CFE_Config_GetIdByName("CORE_VERSION_MAJOR");
    CFE_ConfigId_t mission = CFE_Config_GetIdByName("MISSION_NAME");
    CFE_ConfigId_t sizes = CFE_Config_GetIdByName("PLATFORM_ES_MEM_BLOCK_SIZE");
    SAY("major %u, of none %u, of a text %u", (unsigned)CFE_Config_GetValue(major), (unsigned)CFE_Config_GetValue(none),
        (unsigned)CFE_Config_GetValue(mission));
    SAY("texts %s %s, a text %d", CFE_Config_GetString(none), CFE_Config_GetString(major),
        strcmp(CFE_Config_GetString(mission), "[unknown]") != 0);
    SAY("the same place %d", CFE_Config_GetString(mission) == CFE_Config_GetObjPointer(mission));
    SAY("pointers %d %d", CFE_Config_GetObjPointer(none) == NULL, CFE_Config_GetObjPointer(major) == NULL);
    SAY("names %s %s", CFE_Config_GetName(none), CFE_Config_GetName(major));
    SAY("nobody %lX", CFE_RESOURCEID_TO_ULONG(CFE_Config_GetIdByName("NOBODY")));
    CFE_Config_ArrayValue_t array = CFE_Config_GetArrayValue(sizes);
    const size_t *elements = array.ElementPtr;
    SAY("%lu sizes from %lu to %lu", (unsigned long)array.NumElements, (unsigned long)elements[0],
        (unsigned long)elements[array.NumElements - 1]);
    array = CFE_Config_GetArrayValue(major);
    SAY("no array %lu %d", (unsigned long)array.NumElements, array.ElementPtr == NULL);
    CFE_Config_IterateAll(text, on_key);
    SAY("told %d, all named %d, many %d", told == text, keys == named, keys > 4);
    memset(text, 0x55, sizeof text);
    CFE_Config_GetVersionString(text, sizeof text, "PART", "v1.2", "Code", "v1.0");
    SAY("[%s]", text);
    CFE_Config_GetVersionString(text, 10, "PART", "v1.2", "Code", "v1.0");
    SAY("[%s]", text);
}

static void resource_ids(void)
{
    uint32 index = 77;
    int left = 3;
    CFE_ES_AppId_t app;
    CFE_ES_GetAppID(&app);
    CFE_ResourceId_t id = CFE_RESOURCEID_UNWRAP(app), start = CFE_ResourceId_FromInteger(0x110000 + 5);
    SAY("base %08X, serial %08X", (unsigned)CFE_ResourceId_GetBase(start), (unsigned)CFE_ResourceId_GetSerial(start));
    SAY("base of an app %08X", (unsigned)CFE_ResourceId_GetBase(id));
    used = 1 << 6 | 1 << 7;
    SAY("next %lX", CFE_ResourceId_ToInteger(CFE_ResourceId_FindNext(start, 16, is_used)));
    SAY("none %lX", CFE_ResourceId_ToInteger(CFE_ResourceId_FindNext(start, 16, always)));
    SAY("none %lX", CFE_ResourceId_ToInteger(CFE_ResourceId_FindNext(start, 16, NULL)));
    SAY("none %lX", CFE_ResourceId_ToInteger(CFE_ResourceId_FindNext(start, 0, is_used)));
    SAY("wraps %lX",
        CFE_ResourceId_ToInteger(CFE_ResourceId_FindNext(CFE_ResourceId_FromInteger(0x11FFFE), 16, is_used)));
    used = 1 << 7;
    int before = left;
    SAY("ex %lX, left %d", CFE_ResourceId_ToInteger(CFE_ResourceId_FindNextEx(start, two_on, &left, is_used)), before);
    before = left;
    SAY("ex none %lX, left %d", CFE_ResourceId_ToInteger(CFE_ResourceId_FindNextEx(start, two_on, &left, always)),
        before);
    SAY("ex none %lX", CFE_ResourceId_ToInteger(CFE_ResourceId_FindNextEx(start, NULL, &left, always)));
    SAY("ex none %lX", CFE_ResourceId_ToInteger(CFE_ResourceId_FindNextEx(start, two_on, &left, NULL)));
    TELL(CFE_ResourceId_ToIndex(start, 0x110000, 16, NULL));
    TELL(CFE_ResourceId_ToIndex(start, 0x110000, 0, &index));
    TELL(CFE_ResourceId_ToIndex(start, 0x120000, 16, &index));
    SAY("untouched %u", (unsigned)index);
    TELL(CFE_ResourceId_ToIndex(start, 0x110000, 4, &index));
    SAY("index %u", (unsigned)index);
    TELL(CFE_ResourceId_ToIndex(start, 0x110003, 4, &index));
    SAY("index %u", (unsigned)index);
}

static void topics(void)
{
    SAY("commands %X %X %X %X", (unsigned)CFE_SB_CmdTopicIdToMsgId(5, 1), (unsigned)CFE_SB_CmdTopicIdToMsgId(5, 0),
        (unsigned)CFE_SB_GlobalCmdTopicIdToMsgId(5), (unsigned)CFE_SB_LocalCmdTopicIdToMsgId(5));
    SAY("telemetry %X %X %X %X", (unsigned)CFE_SB_TlmTopicIdToMsgId(5, 1), (unsigned)CFE_SB_TlmTopicIdToMsgId(5, 0),
        (unsigned)CFE_SB_GlobalTlmTopicIdToMsgId(5), (unsigned)CFE_SB_LocalTlmTopicIdToMsgId(5));
}

static void integrity(void)
{
    union {
        CFE_MSG_Message_t message;
        uint8 bytes[20];
    } packet;
    bool acceptable = false, valid = false;
    CFE_TIME_SysTime_t time;
    CFE_MSG_Init(&packet.message, CFE_SB_ValueToMsgId(0x1882), 12);
    TELL(CFE_MSG_OriginationAction(NULL, 12, &acceptable));
    TELL(CFE_MSG_OriginationAction(&packet.message, 12, NULL));
    TELL(CFE_MSG_OriginationAction(&packet.message, 12, &acceptable));
    CFE_MSG_ValidateChecksum(&packet.message, &valid);
    SAY("acceptable %d, checksum %d", acceptable, valid);
    CFE_MSG_Init(&packet.message, CFE_SB_ValueToMsgId(0x0882), 20);
    TELL(CFE_MSG_OriginationAction(&packet.message, 20, &acceptable));
    CFE_MSG_GetMsgTime(&packet.message, &time);
    SAY("a time %d", time.Seconds > 0);
    acceptable = false;
    TELL(CFE_MSG_VerificationAction(NULL, 20, &acceptable));
    TELL(CFE_MSG_VerificationAction(&packet.message, 20, NULL));
    TELL(CFE_MSG_VerificationAction(&packet.message, 20, &acceptable));
    SAY("acceptable %d", acceptable);
}

void APITEST_Main(void)
{
    configuration();
    resource_ids();
    topics();
    integrity();
    CFE_ES_ExitApp(CFE_ES_RunStatus_APP_EXIT);
}
