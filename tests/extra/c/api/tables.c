/* CFE_TBL_*: registration, loads from addresses, validation, addresses, information. */
#include "api_test.h"

typedef struct {
    uint32 first, second;
} Table;

static int calls;
static Table seen;
static int32 answer;

static int32 validate(void *table)
{
    calls++;
    seen = *(Table *)table;
    return seen.first == 13 ? answer : 0;
}

static void info_of(const char *name)
{
    CFE_TBL_Info_t info;
    memset(&info, 0xEE, sizeof info);
    SAY("info of %s: %08X", name, (unsigned)CFE_TBL_GetInfo(&info, name));
    SAY("%lu bytes, %u users, crc %04X, once %d, dump only %d, double %d, own %d, critical %d", (unsigned long)info.Size,
        (unsigned)info.NumUsers, (unsigned)info.Crc, info.TableLoadedOnce, info.DumpOnly, info.DoubleBuffered,
        info.UserDefAddr, info.Critical);
    SAY("file %.4s%s, of %u.%u", info.LastFileLoaded, strstr(info.LastFileLoaded, "(*)") ? "(*)" : "",
        (unsigned)info.FileTime.Seconds, (unsigned)info.FileTime.Subseconds);
}

static void registration(void)
{
    CFE_TBL_Handle_t table, again;
    TELL(CFE_TBL_Register(NULL, "T", sizeof(Table), CFE_TBL_OPT_DEFAULT, NULL));
    TELL(CFE_TBL_Register(&table, NULL, sizeof(Table), CFE_TBL_OPT_DEFAULT, NULL));
    TELL(CFE_TBL_Register(&table, "", sizeof(Table), CFE_TBL_OPT_DEFAULT, NULL));
    SAY("bad %d", CFE_TBL_HANDLE_EQ(table, CFE_TBL_BAD_TABLE_HANDLE));
    TELL(CFE_TBL_Register(&table, "SixteenLettersXX", sizeof(Table), CFE_TBL_OPT_DEFAULT, NULL));
    TELL(CFE_TBL_Register(&table, "T", 0, CFE_TBL_OPT_DEFAULT, NULL));
    TELL(CFE_TBL_Register(&table, "T", 1 << 20, CFE_TBL_OPT_DEFAULT, NULL));
    TELL(CFE_TBL_Register(&table, "T", sizeof(Table), CFE_TBL_OPT_USR_DEF_ADDR | CFE_TBL_OPT_DBL_BUFFER, NULL));
    TELL(CFE_TBL_Register(&table, "T", sizeof(Table), CFE_TBL_OPT_DEFAULT, NULL));
    TELL(CFE_TBL_Register(&again, "T", sizeof(Table), CFE_TBL_OPT_DEFAULT, NULL));
    SAY("the same %d", CFE_TBL_HANDLE_EQ(table, again));
    TELL(CFE_TBL_Register(&again, "T", 4, CFE_TBL_OPT_DEFAULT, NULL));
    TELL(CFE_TBL_Share(NULL, "APITEST.T"));
    TELL(CFE_TBL_Share(&again, NULL));
    TELL(CFE_TBL_Share(&again, "APITEST.Nothing"));
    SAY("bad %d", CFE_TBL_HANDLE_EQ(again, CFE_TBL_BAD_TABLE_HANDLE));
    TELL(CFE_TBL_Share(&again, "APITEST.T"));
    SAY("another %d", !CFE_TBL_HANDLE_EQ(table, again));
    SAY("id defined %d %d, back %d", CFE_TBL_HandleID_IsDefined(CFE_TBL_HandleToID(table)),
        CFE_TBL_HandleID_IsDefined(CFE_TBL_HandleToID(CFE_TBL_BAD_TABLE_HANDLE)),
        CFE_TBL_HANDLE_EQ(table, CFE_TBL_HandleFromID(CFE_TBL_HandleToID(table))));
    SAY("of none %d", CFE_TBL_HANDLE_EQ(CFE_TBL_HandleFromID(CFE_TBL_HANDLEID_UNDEFINED), CFE_TBL_BAD_TABLE_HANDLE));
    info_of("APITEST.T");
    TELL(CFE_TBL_Unregister(again));
    TELL(CFE_TBL_Unregister(table));
    TELL(CFE_TBL_Unregister(table));
    TELL(CFE_TBL_GetInfo(NULL, "APITEST.T"));
    info_of("APITEST.T");
}

static void loads(uint16 options)
{
    CFE_TBL_Handle_t table;
    Table values = {1, 2};
    Table *image = (Table *)&values;
    SAY("loads with %X", options);
    TELL(CFE_TBL_Register(&table, "L", sizeof(Table), options, validate));
    TELL(CFE_TBL_GetAddress((void **)&image, table));
    SAY("null %d", image == NULL);
    TELL(CFE_TBL_ReleaseAddress(table));
    TELL(CFE_TBL_Load(table, CFE_TBL_SRC_ADDRESS, NULL));
    TELL(CFE_TBL_Load(CFE_TBL_BAD_TABLE_HANDLE, CFE_TBL_SRC_ADDRESS, &values));
    TELL(CFE_TBL_Load(table, (CFE_TBL_SrcEnum_t)7, &values));
    TELL(CFE_TBL_Load(table, CFE_TBL_SRC_FILE, "/cf/nothing.tbl"));
    values.first = 13;
    answer = -5;
    TELL(CFE_TBL_Load(table, CFE_TBL_SRC_ADDRESS, &values));
    answer = 5;
    TELL(CFE_TBL_Load(table, CFE_TBL_SRC_ADDRESS, &values));
    SAY("validated %d times, saw %u %u", calls, (unsigned)seen.first, (unsigned)seen.second);
    values.first = 4;
    TELL(CFE_TBL_Load(table, CFE_TBL_SRC_ADDRESS, &values));
    TELL(CFE_TBL_GetAddress((void **)&image, table));
    SAY("values %u %u, own memory %d", (unsigned)image->first, (unsigned)image->second, image == &values);
    image->second = 99;
    TELL(CFE_TBL_Modified(table));
    info_of("APITEST.L");
    values.first = 5;
    TELL(CFE_TBL_Load(table, CFE_TBL_SRC_ADDRESS, &values));
    SAY("held: %u", (unsigned)image->first);
    TELL(CFE_TBL_ReleaseAddress(table));
    TELL(CFE_TBL_Manage(table));
    TELL(CFE_TBL_GetStatus(table));
    TELL(CFE_TBL_Update(table));
    TELL(CFE_TBL_Validate(table));
    TELL(CFE_TBL_DumpToBuffer(table));
    TELL(CFE_TBL_GetAddress((void **)&image, table));
    SAY("values %u %u", (unsigned)image->first, (unsigned)image->second);
    TELL(CFE_TBL_GetAddress((void **)&image, table));
    TELL(CFE_TBL_ReleaseAddress(table));
    TELL(CFE_TBL_NotifyByMessage(table, CFE_SB_ValueToMsgId(0x1882), 9, 42));
    TELL(CFE_TBL_Unregister(table));
}

static void bad_handles(void)
{
    CFE_TBL_Handle_t bad = CFE_TBL_BAD_TABLE_HANDLE;
    void *address = &bad;
    TELL(CFE_TBL_Update(bad));
    TELL(CFE_TBL_Validate(bad));
    TELL(CFE_TBL_Manage(bad));
    TELL(CFE_TBL_GetStatus(bad));
    TELL(CFE_TBL_DumpToBuffer(bad));
    TELL(CFE_TBL_Modified(bad));
    TELL(CFE_TBL_Unregister(bad));
    TELL(CFE_TBL_GetAddress(NULL, bad));
    TELL(CFE_TBL_GetAddress(&address, bad));
    SAY("null %d", address == NULL);
    TELL(CFE_TBL_ReleaseAddress(bad));
    TELL(CFE_TBL_NotifyByMessage(bad, CFE_SB_ValueToMsgId(0x1882), 9, 42));
}

static void several(void)
{
    CFE_TBL_Handle_t tables[3];
    Table values = {7, 8}, *one = &values, *two = &values, *three = &values;
    void **addresses[3] = {(void **)&one, (void **)&two, (void **)&three};
    TELL(CFE_TBL_Register(&tables[0], "A", sizeof(Table), CFE_TBL_OPT_DEFAULT, NULL));
    TELL(CFE_TBL_Register(&tables[1], "B", sizeof(Table), CFE_TBL_OPT_DEFAULT, NULL));
    TELL(CFE_TBL_Register(&tables[2], "C", sizeof(Table), CFE_TBL_OPT_DEFAULT, NULL));
    TELL(CFE_TBL_GetAddresses(NULL, 3, tables));
    TELL(CFE_TBL_GetAddresses(addresses, 3, NULL));
    TELL(CFE_TBL_GetAddresses(addresses, 3, tables));
    SAY("null %d %d %d", one == NULL, two == NULL, three == NULL);
    TELL(CFE_TBL_Load(tables[0], CFE_TBL_SRC_ADDRESS, &values));
    TELL(CFE_TBL_Load(tables[2], CFE_TBL_SRC_ADDRESS, &values));
    TELL(CFE_TBL_GetAddresses(addresses, 3, tables));
    SAY("null %d %d %d, value %u", one == NULL, two == NULL, three == NULL, (unsigned)three->second);
    TELL(CFE_TBL_GetAddresses(addresses, 1, tables));
    TELL(CFE_TBL_ReleaseAddresses(3, NULL));
    TELL(CFE_TBL_ReleaseAddresses(3, tables));
    TELL(CFE_TBL_ReleaseAddresses(0, tables));
    TELL(CFE_TBL_GetAddresses(addresses, 0, tables));
    for (int i = 0; i < 3; i++)
        TELL(CFE_TBL_Unregister(tables[i]));
}

static void special(void)
{
    static Table mine = {21, 22};
    CFE_TBL_Handle_t table;
    Table *image;
    TELL(CFE_TBL_Register(&table, "Dump", sizeof(Table), CFE_TBL_OPT_DUMP_ONLY, NULL));
    TELL(CFE_TBL_Load(table, CFE_TBL_SRC_ADDRESS, &mine));
    TELL(CFE_TBL_GetAddress((void **)&image, table));
    SAY("zeros %u %u", (unsigned)image->first, (unsigned)image->second);
    TELL(CFE_TBL_ReleaseAddress(table));
    TELL(CFE_TBL_DumpToBuffer(table));
    info_of("APITEST.Dump");
    TELL(CFE_TBL_Register(&table, "Mine", sizeof(Table), CFE_TBL_OPT_USR_DEF_ADDR, NULL));
    TELL(CFE_TBL_GetAddress((void **)&image, table));
    TELL(CFE_TBL_Load(table, CFE_TBL_SRC_FILE, "/cf/nothing.tbl"));
    TELL(CFE_TBL_Load(table, CFE_TBL_SRC_ADDRESS, &mine));
    TELL(CFE_TBL_Load(table, CFE_TBL_SRC_ADDRESS, &mine));
    TELL(CFE_TBL_GetAddress((void **)&image, table));
    SAY("mine itself %d", image == &mine);
    mine.first = 77;
    SAY("at once %u", (unsigned)image->first);
    TELL(CFE_TBL_Modified(table));
    info_of("APITEST.Mine");
    TELL(CFE_TBL_Register(&table, "Crit", sizeof(Table), CFE_TBL_OPT_CRITICAL, NULL));
    TELL(CFE_TBL_Load(table, CFE_TBL_SRC_ADDRESS, &mine));
    info_of("APITEST.Crit");
}

void APITEST_Main(void)
{
    CFE_EVS_Register(NULL, 0, CFE_EVS_EventFilter_BINARY);
    registration();
    loads(CFE_TBL_OPT_DEFAULT);
    loads(CFE_TBL_OPT_DBL_BUFFER);
    bad_handles();
    several();
    special();
    CFE_ES_ExitApp(CFE_ES_RunStatus_APP_EXIT);
}
