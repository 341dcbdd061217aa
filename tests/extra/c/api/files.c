/* CFE_FS_*: headers, names, background writes. */
#include "api_test.h"

static CFE_FS_FileWriteMetaData_t dump;
static int records, ended;

static void headers(void)
{
    CFE_FS_Header_t header, back;
    osal_id_t file = OS_OBJECT_ID_UNDEFINED;
    memset(&header, 0xEE, sizeof header);
    CFE_FS_InitHeader(NULL, "text", 5);
    CFE_FS_InitHeader(&header, NULL, 5);
    SAY("untouched %08X", (unsigned)header.SubType);
    CFE_FS_InitHeader(&header, "A description of more than thirty-two characters", 5);
    SAY("type %08X, subtype %u, length %u, [%s]", (unsigned)header.ContentType, (unsigned)header.SubType,
        (unsigned)header.Length, header.Description);
    TELL(CFE_FS_WriteHeader(file, NULL));
    TELL(CFE_FS_WriteHeader(file, &header));
    SAY("type %08X", (unsigned)header.ContentType);
    TELL(OS_OpenCreate(&file, "/ram/header.dat", OS_FILE_FLAG_CREATE | OS_FILE_FLAG_TRUNCATE, OS_READ_WRITE));
    TELL(CFE_FS_WriteHeader(file, &header));
    SAY("type %08X, length %u, spacecraft %u, processor %u, app %d", (unsigned)header.ContentType,
        (unsigned)header.Length, (unsigned)header.SpacecraftID, (unsigned)header.ProcessorID, header.ApplicationID > 0);
    TELL(CFE_FS_SetTimestamp(OS_OBJECT_ID_UNDEFINED, (CFE_TIME_SysTime_t){1, 2}));
    TELL(CFE_FS_SetTimestamp(file, (CFE_TIME_SysTime_t){0x12345678, 0x9ABCDEF0}));
    TELL(CFE_FS_ReadHeader(NULL, file));
    TELL(CFE_FS_ReadHeader(&back, OS_OBJECT_ID_UNDEFINED));
    TELL(CFE_FS_ReadHeader(&back, file));
    SAY("time %08X %08X, [%s]", (unsigned)back.TimeSeconds, (unsigned)back.TimeSubSeconds, back.Description);
    header.TimeSeconds = back.TimeSeconds;
    header.TimeSubSeconds = back.TimeSubSeconds;
    SAY("equal %d", memcmp(&header, &back, sizeof back) == 0);
    OS_close(file);
    TELL(OS_OpenCreate(&file, "/ram/short.dat", OS_FILE_FLAG_CREATE | OS_FILE_FLAG_TRUNCATE, OS_READ_WRITE));
    OS_write(file, "too short", 9);
    TELL(CFE_FS_ReadHeader(&back, file));
    OS_close(file);
}

static void parse(const char *name, size_t size)
{
    char made[100];
    memset(made, 0x55, sizeof made);
    SAY("parse %s %lu: %08X [%s]", name ? name : "NULL", (unsigned long)size,
        (unsigned)CFE_FS_ParseInputFileName(made, name, size, CFE_FS_FileCategory_TEXT_LOG), made);
}

static void names(void)
{
    char made[OS_MAX_PATH_LEN], unended[4] = {'a', 'b', 'c', 'd'};
    for (int kind = -1; kind <= CFE_FS_FileCategory_MAX; kind++) {
        const char *mount = CFE_FS_GetDefaultMountPoint((CFE_FS_FileCategory_t)kind);
        const char *end = CFE_FS_GetDefaultExtension((CFE_FS_FileCategory_t)kind);
        SAY("kind %d: %s %s", kind, mount ? mount : "NULL", end ? end : "NULL");
    }
    parse("log", 64);
    parse("/cf/a.b", 64);
    parse("/ram//x///log..txt", 64);
    parse("", 64);
    parse(NULL, 64);
    parse("/", 64);
    parse("/ram/.log", 64);
    parse("toolong", 10);
    TELL(CFE_FS_ParseInputFileName(NULL, "x", 64, CFE_FS_FileCategory_TEMP));
    TELL(CFE_FS_ParseInputFileName(made, "x", 0, CFE_FS_FileCategory_TEMP));
    TELL(CFE_FS_ParseInputFileNameEx(made, unended, sizeof made, sizeof unended, "other", "/d", "e"));
    SAY("[%s]", made);
    TELL(CFE_FS_ParseInputFileNameEx(made, unended, sizeof made, 0, "other", "/d", "e"));
    SAY("[%s]", made);
    TELL(CFE_FS_ParseInputFileNameEx(made, NULL, sizeof made, 9, "other", NULL, NULL));
    SAY("[%s]", made);
    TELL(CFE_FS_ExtractFilenameFromPath(NULL, made));
    TELL(CFE_FS_ExtractFilenameFromPath("/cf/x.tbl", NULL));
    TELL(CFE_FS_ExtractFilenameFromPath("/cf/x.tbl", made));
    SAY("[%s]", made);
    TELL(CFE_FS_ExtractFilenameFromPath("x.tbl", made));
    TELL(CFE_FS_ExtractFilenameFromPath("/x.tbl", made));
    TELL(CFE_FS_ExtractFilenameFromPath("/cf/", made));
    SAY("[%s]", made);
}

static bool get_data(void *meta, uint32 record, void **buffer, size_t *size)
{
    static uint32 value;
    records++;
    value = record;
    *buffer = &value;
    *size = record == 1 ? 0 : sizeof value;
    return meta != &dump || record == 3;
}

static void on_event(void *meta, CFE_FS_FileWriteEvent_t event, int32 status, uint32 record, size_t size, size_t position)
{
    SAY("event %d of mine %d: %08X record %u, %lu bytes at %lu", (int)event, meta == &dump, (unsigned)status,
        (unsigned)record, (unsigned long)size, (unsigned long)position);
    ended++;
}

static void wait_for(int count)
{
    for (int i = 0; i < 100 && ended < count; i++)
        OS_TaskDelay(100);
    OS_TaskDelay(100);
    SAY("pending %d %d", CFE_FS_BackgroundFileDumpIsPending(&dump), dump.IsPending);
}

static void dumps(void)
{
    osal_id_t file;
    uint32 read[16 + 4];
    TELL(CFE_FS_BackgroundFileDumpRequest(NULL));
    TELL(CFE_FS_BackgroundFileDumpRequest(&dump));
    dump.GetData = get_data;
    TELL(CFE_FS_BackgroundFileDumpRequest(&dump));
    dump.OnEvent = on_event;
    TELL(CFE_FS_BackgroundFileDumpRequest(&dump));
    strcpy(dump.FileName, "/ram/dump.dat");
    strcpy(dump.Description, "records");
    dump.FileSubType = 0x12345;
    SAY("pending %d %d", CFE_FS_BackgroundFileDumpIsPending(NULL), CFE_FS_BackgroundFileDumpIsPending(&dump));
    TELL(CFE_FS_BackgroundFileDumpRequest(&dump));
    TELL(CFE_FS_BackgroundFileDumpRequest(&dump));
    wait_for(1);
    SAY("asked for %d records", records);
    TELL(OS_OpenCreate(&file, "/ram/dump.dat", 0, OS_READ_ONLY));
    TELL(OS_read(file, read, sizeof read));
    SAY("records %u %u %u", (unsigned)read[16], (unsigned)read[17], (unsigned)read[18]);
    OS_close(file);
    strcpy(dump.FileName, "/nowhere/dump.dat");
    TELL(CFE_FS_BackgroundFileDumpRequest(&dump));
    wait_for(2);
}

void APITEST_Main(void)
{
    headers();
    names();
    CFE_ES_WaitForSystemState(CFE_ES_SystemState_OPERATIONAL, 10000);
    dumps();
    CFE_ES_ExitApp(CFE_ES_RunStatus_APP_EXIT);
}
