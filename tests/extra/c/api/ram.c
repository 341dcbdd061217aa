/* What NASA's PSP for Linux says of memory by address: its table, which addresses are valid, and what it reads. */
#include "api_test.h"

static uint32  word = 0x11223344;
static cpuaddr eeprom, reset, user;
static uint32  size;

static void range(uint32 number)
{
    uint32  type, attributes;
    cpuaddr start;
    size_t  bytes, width;
    int32   status = CFE_PSP_MemRangeGet(number, &type, &start, &bytes, &width, &attributes);
    SAY("range %u: %08X type %u start %d size %lX word %lu attributes %u", (unsigned)number, (unsigned)status,
        (unsigned)type, start != 0, (unsigned long)bytes, (unsigned long)width, (unsigned)attributes);
    if (number == 1)
        eeprom = start;
}

static void valid(const char *what, cpuaddr at, size_t bytes)
{
    SAY("%s %lX: any %d, RAM %d, EEPROM %d", what, (unsigned long)bytes,
        (int)CFE_PSP_MemValidateRange(at, bytes, CFE_PSP_MEM_ANY),
        (int)CFE_PSP_MemValidateRange(at, bytes, CFE_PSP_MEM_RAM),
        (int)CFE_PSP_MemValidateRange(at, bytes, CFE_PSP_MEM_EEPROM));
}

static void access(const char *what, cpuaddr at)
{
    uint8  byte = 9;
    uint16 half = 9;
    uint32 whole = 9;
    SAY("%s: read %d %d %d, odd %d %d, write %d %d %d, odd %d %d", what, (int)CFE_PSP_MemRead8(at, &byte),
        (int)CFE_PSP_MemRead16(at, &half), (int)CFE_PSP_MemRead32(at, &whole), (int)CFE_PSP_MemRead16(at + 1, &half),
        (int)CFE_PSP_MemRead32(at + 2, &whole), (int)CFE_PSP_MemWrite8(at, 1), (int)CFE_PSP_MemWrite16(at, 2),
        (int)CFE_PSP_MemWrite32(at, 3), (int)CFE_PSP_MemWrite16(at + 1, 2), (int)CFE_PSP_MemWrite32(at + 2, 3));
    SAY("%s: got %u %u %u", what, byte, half, (unsigned)whole);
    SAY("%s: set %d, copy %d", what, (int)CFE_PSP_MemSet((void *)at, 0x51, 4), (int)CFE_PSP_MemCpy(&whole, (void *)at, 4));
    SAY("%s: got %X", what, (unsigned)whole);
    SAY("%s: EEPROM write %d %d", what, (int)CFE_PSP_EepromWrite8(at, 5), (int)CFE_PSP_EepromWrite16(at + 1, 0x0706));
    CFE_PSP_MemCpy(&whole, (void *)at, 4);
    SAY("%s: got %X", what, (unsigned)whole);
}

static void segments(void)
{
    cpuaddr at = 1;
    uint32  bytes = 1;
    TELL(CFE_PSP_GetVolatileDiskMem(&at, &bytes));
    SAY("%lu %u", (unsigned long)at, (unsigned)bytes);
    at = bytes = 1;
    TELL(CFE_PSP_GetKernelTextSegmentInfo(&at, &bytes));
    SAY("%lu %u", (unsigned long)at, (unsigned)bytes);
}

static void facts(void)
{
    CFE_ES_AppInfo_t info;
    CFE_ES_AppId_t   app;
    CFE_ES_GetAppID(&app);
    memset(&info, 0x55, sizeof info);
    TELL(CFE_ES_GetAppInfo(&info, app));
    SAY("valid %d code %lX %lX data %lX %lX bss %lX %lX start %d", info.AddressesAreValid,
        (unsigned long)info.CodeAddress, (unsigned long)info.CodeSize, (unsigned long)info.DataAddress,
        (unsigned long)info.DataSize, (unsigned long)info.BSSAddress, (unsigned long)info.BSSSize, info.StartAddress != 0);
}

void APITEST_Main(void)
{
    void *block = calloc(1, 100);
    SAY("%u ranges", (unsigned)CFE_PSP_MemRanges());
    for (uint32 number = 0; number < 4; number++)
        range(number);
    TELL(CFE_PSP_GetResetArea(&reset, &size));
    TELL(CFE_PSP_GetUserReservedArea(&user, &size));
    valid("variable", (cpuaddr)&word, 4);
    valid("block", (cpuaddr)block, 4);
    valid("stack", (cpuaddr)&block, 4);
    valid("code", (cpuaddr)&APITEST_Main, 4);
    valid("EEPROM", eeprom, 4);
    valid("EEPROM", eeprom, 0x80000);
    valid("EEPROM", eeprom, 0x80001);
    valid("reset area", reset, 4);
    valid("user area", user, 4);
    valid("NULL", 0, 4);
    valid("page", 4096, 4);
    valid("middle", 0x8000000000000000, 4);
    valid("all", 0, SIZE_MAX);
    valid("last", SIZE_MAX - 3, 3);
    valid("last", SIZE_MAX - 3, 4);
    access("variable", (cpuaddr)&word);
    access("block", (cpuaddr)block);
    access("EEPROM", eeprom + 16);
    access("user area", user);
    TELL(CFE_PSP_MemRead8(0, (uint8 *)&word));
    TELL(CFE_PSP_MemRead8((cpuaddr)&word, NULL));
    TELL(CFE_PSP_MemRead16(1, NULL));
    TELL(CFE_PSP_MemWrite32(0, 0));
    TELL(CFE_PSP_MemCpy(NULL, &word, 4));
    TELL(CFE_PSP_MemCpy(&word, NULL, 4));
    TELL(CFE_PSP_MemSet(NULL, 1, 4));
    segments();
    facts();
    free(block);
    CFE_ES_ExitApp(CFE_ES_RunStatus_APP_EXIT);
}
