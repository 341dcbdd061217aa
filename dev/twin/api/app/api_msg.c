/* Message headers, File Services and resource ids, as the script calls them. */
#include <string.h>

#include "api_app.h"

#define MSGID(word) CFE_SB_ValueToMsgId((CFE_SB_MsgId_Atom_t)Num(word))

/* A packet out of the script; all of them are at least 16 bytes long. */
static size_t Size;

static CFE_MSG_Message_t *Packet(void)
{
    return (CFE_MSG_Message_t *)Bytes(1, &Size);
}

#define GET(call, type)                        \
    CALL(call)                                 \
    {                                          \
        type value = 0;                        \
        Status(CFE_##call(Packet(), &value));  \
        OutNum(value);                         \
    }
#define SET(call, type)                                    \
    CALL(call)                                             \
    {                                                      \
        CFE_MSG_Message_t *packet = Packet();              \
        Status(CFE_##call(packet, (type)Num(2)));          \
        OutBytes(packet, Size);                            \
    }
GET(MSG_GetSize, CFE_MSG_Size_t)
GET(MSG_GetType, CFE_MSG_Type_t)
GET(MSG_GetHeaderVersion, CFE_MSG_HeaderVersion_t)
GET(MSG_GetHasSecondaryHeader, bool)
GET(MSG_GetApId, CFE_MSG_ApId_t)
GET(MSG_GetSegmentationFlag, CFE_MSG_SegmentationFlag_t)
GET(MSG_GetSequenceCount, CFE_MSG_SequenceCount_t)
GET(MSG_ValidateChecksum, bool)
GET(MSG_GetFcnCode, CFE_MSG_FcnCode_t)
SET(MSG_SetSize, CFE_MSG_Size_t)
SET(MSG_SetType, CFE_MSG_Type_t)
SET(MSG_SetHeaderVersion, CFE_MSG_HeaderVersion_t)
SET(MSG_SetHasSecondaryHeader, bool)
SET(MSG_SetApId, CFE_MSG_ApId_t)
SET(MSG_SetSegmentationFlag, CFE_MSG_SegmentationFlag_t)
SET(MSG_SetSequenceCount, CFE_MSG_SequenceCount_t)
SET(MSG_SetFcnCode, CFE_MSG_FcnCode_t)

CALL(MSG_GenerateChecksum)
{
    CFE_MSG_Message_t *packet = Packet();
    Status(CFE_MSG_GenerateChecksum(packet));
    OutBytes(packet, Size);
}
CALL(MSG_Init)
{
    static uint8 data[40000];
    Status(CFE_MSG_Init((CFE_MSG_Message_t *)data, MSGID(1), Num(2)));
    OutBytes(data, Num(2));
}
CALL(MSG_GetMsgTime)
{
    CFE_TIME_SysTime_t time = {0, 0};
    Status(CFE_MSG_GetMsgTime(Packet(), &time));
    OutNum(time.Seconds);
    OutNum(time.Subseconds);
}
CALL(MSG_SetMsgTime)
{
    CFE_MSG_Message_t *packet = Packet();
    CFE_TIME_SysTime_t time;
    time.Seconds    = Num(2);
    time.Subseconds = Num(3);
    Status(CFE_MSG_SetMsgTime(packet, time));
    OutBytes(packet, Size);
}
CALL(MSG_GetMsgId)
{
    CFE_SB_MsgId_t id;
    Status(CFE_MSG_GetMsgId(Packet(), &id));
    OutNum(CFE_SB_MsgIdToValue(id));
}
CALL(MSG_SetMsgId)
{
    CFE_MSG_Message_t *packet = Packet();
    Status(CFE_MSG_SetMsgId(packet, MSGID(2)));
    OutBytes(packet, Size);
}
CALL(MSG_GetTypeFromMsgId)
{
    CFE_MSG_Type_t type = 0;
    Status(CFE_MSG_GetTypeFromMsgId(MSGID(1), &type));
    OutNum(type);
}
CALL(MSG_GetNextSequenceCount)
{
    Status(0);
    OutNum(CFE_MSG_GetNextSequenceCount(Num(1)));
}
CALL(SB_SetUserDataLength)
{
    CFE_MSG_Message_t *packet = Packet();
    CFE_SB_SetUserDataLength(packet, Num(2));
    Status(0);
    OutBytes(packet, Size);
}
CALL(SB_GetUserDataLength)
{
    Status(0);
    OutNum((long long)CFE_SB_GetUserDataLength(Packet()));
}
CALL(SB_IsValidMsgId)
{
    Status(0);
    OutNum(CFE_SB_IsValidMsgId(MSGID(1)));
}
CALL(SB_CmdTopicIdToMsgId)
{
    Status(0);
    OutNum(CFE_SB_CmdTopicIdToMsgId(Num(1), Num(2)));
}
CALL(SB_TlmTopicIdToMsgId)
{
    Status(0);
    OutNum(CFE_SB_TlmTopicIdToMsgId(Num(1), Num(2)));
}
CALL(SB_GlobalCmdTopicIdToMsgId)
{
    Status(0);
    OutNum(CFE_SB_GlobalCmdTopicIdToMsgId(Num(1)));
}
CALL(SB_LocalTlmTopicIdToMsgId)
{
    Status(0);
    OutNum(CFE_SB_LocalTlmTopicIdToMsgId(Num(1)));
}
CALL(SB_MessageStringGet)
{
    char   text[300];
    size_t size;
    char * field = (char *)Bytes(1, &size);
    Status(CFE_SB_MessageStringGet(text, field, Words() > 2 ? Text(3) : NULL, Num(2), size));
    OutText(text, sizeof(text));
}
CALL(SB_MessageStringSet)
{
    char field[300] = {0};
    Status(CFE_SB_MessageStringSet(field, Text(1), Num(2), 256));
    OutBytes(field, Num(2));
}

CALL(FS_Header)
{
    CFE_FS_Header_t header;
    CFE_FS_InitHeader(&header, Text(2), Num(3));
    Status(CFE_FS_WriteHeader(OSID(1), &header));
}
CALL(FS_ReadHeader)
{
    CFE_FS_Header_t header = {0};
    Status(CFE_FS_ReadHeader(&header, OSID(1)));
    OutNum(header.ContentType);
    OutNum(header.SubType);
    OutNum(header.Length);
    OutNum(header.SpacecraftID);
    OutNum(header.ProcessorID);
    OutNum(header.ApplicationID);
    OutText(header.Description, sizeof(header.Description));
}
CALL(FS_SetTimestamp)
{
    CFE_TIME_SysTime_t time;
    time.Seconds    = Num(2);
    time.Subseconds = Num(3);
    Status(CFE_FS_SetTimestamp(OSID(1), time));
}
CALL(FS_ParseInputFileName)
{
    char name[300] = "";
    Status(CFE_FS_ParseInputFileName(name, Text(1), Num(3), Num(2)));
    OutText(name, sizeof(name));
}
CALL(FS_ParseInputFileNameEx)
{
    char        path[300] = "";
    const char *name      = Text(1);
    Status(CFE_FS_ParseInputFileNameEx(path, name, Num(5), strlen(name), Text(2), Text(3), Text(4)));
    OutText(path, sizeof(path));
}
CALL(FS_ExtractFilenameFromPath)
{
    char name[300] = "";
    Status(CFE_FS_ExtractFilenameFromPath(Text(1), name));
    OutText(name, sizeof(name));
}
CALL(FS_Defaults)
{
    const char *point     = CFE_FS_GetDefaultMountPoint(Num(1));
    const char *extension = CFE_FS_GetDefaultExtension(Num(1));
    Status(0);
    OutText(point ? point : "-", 100);
    OutText(extension ? extension : "-", 100);
}
static bool Records(void *meta, uint32 number, void **buffer, size_t *size)
{
    static uint8 data[10] = "0123456789";
    *buffer = data;
    *size   = number < 3 ? sizeof(data) : 0;
    return number >= 3;
}
static int  DumpEvents[8];
static void DumpEvent(void *meta, CFE_FS_FileWriteEvent_t event, int32 status, uint32 number, size_t size,
                      size_t position)
{
    ++DumpEvents[event % 8];
}
CALL(FS_BackgroundFileDump)
{
    static CFE_FS_FileWriteMetaData_t meta;
    int32                             status;
    int                               event;
    memset(&meta, 0, sizeof(meta));
    memset(DumpEvents, 0, sizeof(DumpEvents));
    strncpy(meta.FileName, Text(1), sizeof(meta.FileName) - 1);
    strcpy(meta.Description, "twin");
    meta.FileSubType = Num(2);
    meta.GetData     = Records;
    meta.OnEvent     = DumpEvent;
    status           = CFE_FS_BackgroundFileDumpRequest(&meta);
    Status(status);
    OS_TaskDelay(200);
    OutNum(CFE_FS_BackgroundFileDumpIsPending(&meta));
    for (event = 0; event < 8; ++event)
    {
        OutNum(DumpEvents[event]);
    }
}

CALL(ResourceId)
{
    CFE_ResourceId_t id    = CFE_ResourceId_FromInteger((uint32)Num(1));
    uint32           index = 0;
    OutNum(CFE_ResourceId_IsDefined(id));
    OutNum(CFE_ResourceId_GetBase(id) >> 16);
    OutNum(CFE_ResourceId_GetSerial(id));
    OutNum(CFE_ResourceId_ToIndex(id, (uint32)Num(2) << 16, Num(3), &index));
    OutNum(index);
}

const Call MsgCalls[] = {ROW(MSG_GetSize), ROW(MSG_GetType), ROW(MSG_GetHeaderVersion), ROW(MSG_GetHasSecondaryHeader),
    ROW(MSG_GetApId), ROW(MSG_GetSegmentationFlag), ROW(MSG_GetSequenceCount),
    ROW(MSG_ValidateChecksum),
    ROW(MSG_GetFcnCode), ROW(MSG_SetSize), ROW(MSG_SetType), ROW(MSG_SetHeaderVersion), ROW(MSG_SetHasSecondaryHeader),
    ROW(MSG_SetApId), ROW(MSG_SetSegmentationFlag), ROW(MSG_SetSequenceCount),
    ROW(MSG_SetFcnCode),
    ROW(MSG_GenerateChecksum), ROW(MSG_Init), ROW(MSG_GetMsgTime), ROW(MSG_SetMsgTime), ROW(MSG_GetMsgId),
    ROW(MSG_SetMsgId), ROW(MSG_GetTypeFromMsgId), ROW(MSG_GetNextSequenceCount), ROW(SB_SetUserDataLength),
    ROW(SB_GetUserDataLength), ROW(SB_IsValidMsgId), ROW(SB_CmdTopicIdToMsgId), ROW(SB_TlmTopicIdToMsgId),
    ROW(SB_GlobalCmdTopicIdToMsgId), ROW(SB_LocalTlmTopicIdToMsgId), ROW(SB_MessageStringGet), ROW(SB_MessageStringSet),
    ROW(FS_Header), ROW(FS_ReadHeader), ROW(FS_SetTimestamp), ROW(FS_ParseInputFileName), ROW(FS_ParseInputFileNameEx),
    ROW(FS_ExtractFilenameFromPath), ROW(FS_Defaults), ROW(FS_BackgroundFileDump), ROW(ResourceId), {NULL, NULL}};
