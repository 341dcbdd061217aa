/* What CFE_PSP says of the EEPROM and of the table of memory ranges: odd addresses, sizes, types, words, pointers. */
#include "api_test.h"

enum { EEPROM = 1, FREE = 9 };

static uint32  type, attributes;
static cpuaddr start;
static size_t  size, word;

static void range(uint32 number)
{
    int32 status = CFE_PSP_MemRangeGet(number, &type, &start, &size, &word, &attributes);
    SAY("range %u: %08X type %u size %lX word %lu attributes %u", (unsigned)number, (unsigned)status, (unsigned)type,
        (unsigned long)size, (unsigned long)word, (unsigned)attributes);
}

static void ranges(void)
{
    SAY("%u ranges", (unsigned)CFE_PSP_MemRanges());
    range(FREE);
    range(10);
    range(0xFFFFFFFF);
    TELL(CFE_PSP_MemRangeGet(10, NULL, &start, &size, &word, &attributes));
    TELL(CFE_PSP_MemRangeGet(EEPROM, &type, NULL, &size, &word, &attributes));
    TELL(CFE_PSP_MemRangeGet(EEPROM, &type, &start, NULL, &word, &attributes));
    TELL(CFE_PSP_MemRangeGet(EEPROM, &type, &start, &size, NULL, &attributes));
    TELL(CFE_PSP_MemRangeGet(EEPROM, &type, &start, &size, &word, NULL));
    TELL(CFE_PSP_MemRangeSet(10, 77, 0, 0, 3, 0));
    TELL(CFE_PSP_MemRangeSet(FREE, CFE_PSP_MEM_ANY, 0, 0, 3, 0));
    TELL(CFE_PSP_MemRangeSet(FREE, CFE_PSP_MEM_INVALID, 0, 0, 3, 0));
    TELL(CFE_PSP_MemRangeSet(FREE, 0, 0, 0, 3, 0));
    TELL(CFE_PSP_MemRangeSet(FREE, CFE_PSP_MEM_RAM, 0, 0, 0, 0));
    TELL(CFE_PSP_MemRangeSet(FREE, CFE_PSP_MEM_RAM, 0, 0, 3, 0));
    TELL(CFE_PSP_MemRangeSet(FREE, CFE_PSP_MEM_RAM, 0, 0, 8, 0));
    TELL(CFE_PSP_MemRangeSet(FREE, CFE_PSP_MEM_RAM, 0, 0, CFE_PSP_MEM_SIZE_WORD, 0));
    TELL(CFE_PSP_MemRangeSet(FREE, CFE_PSP_MEM_RAM, 0, 0, CFE_PSP_MEM_SIZE_WORD, 4));
    range(FREE);
    TELL(CFE_PSP_MemRangeSet(FREE, CFE_PSP_MEM_EEPROM, 0xFFFFFFFFFFFFFFF0, 32, CFE_PSP_MEM_SIZE_BYTE, CFE_PSP_MEM_ATTR_READ));
    range(FREE);
    TELL(CFE_PSP_MemValidateRange(0xFFFFFFFFFFFFFFF0, 8, CFE_PSP_MEM_EEPROM));
    TELL(CFE_PSP_MemRangeSet(FREE, CFE_PSP_MEM_EEPROM, start, 0, CFE_PSP_MEM_SIZE_DWORD, CFE_PSP_MEM_ATTR_WRITE));
    range(FREE);
    TELL(CFE_PSP_MemValidateRange(0xFFFFFFFFFFFFFFF0, 8, CFE_PSP_MEM_EEPROM));
    TELL(CFE_PSP_MemValidateRange(0xFFFFFFFFFFFFFFF0, 16, CFE_PSP_MEM_ANY));
    TELL(CFE_PSP_MemValidateRange(0xFFFFFFFFFFFFFFF0, 17, CFE_PSP_MEM_ANY));
    TELL(CFE_PSP_MemValidateRange(0xFFFFFFFFFFFFFFF0, SIZE_MAX, CFE_PSP_MEM_EEPROM));
}

static void validate(void)
{
    cpuaddr eeprom;
    range(EEPROM);
    eeprom = start;
    SAY("aligned %lu", (unsigned long)(start % 4096));
    TELL(CFE_PSP_MemValidateRange(eeprom, size, CFE_PSP_MEM_EEPROM));
    TELL(CFE_PSP_MemValidateRange(eeprom, 0, CFE_PSP_MEM_EEPROM));
    TELL(CFE_PSP_MemValidateRange(eeprom + 1, size - 1, CFE_PSP_MEM_EEPROM));
    TELL(CFE_PSP_MemValidateRange(eeprom + 3, 5, CFE_PSP_MEM_EEPROM));
    TELL(CFE_PSP_MemValidateRange(eeprom + size - 1, 1, CFE_PSP_MEM_EEPROM));
    TELL(CFE_PSP_MemValidateRange(eeprom, size, CFE_PSP_MEM_ANY));
    TELL(CFE_PSP_MemValidateRange(eeprom, size, 0));
    TELL(CFE_PSP_MemValidateRange(eeprom, size, CFE_PSP_MEM_INVALID));
    TELL(CFE_PSP_MemValidateRange(eeprom, size, 77));
    TELL(CFE_PSP_MemValidateRange(eeprom, SIZE_MAX, CFE_PSP_MEM_EEPROM));
    TELL(CFE_PSP_MemValidateRange(eeprom, SIZE_MAX, 77));
}

static void written(void)
{
    volatile uint8 *at = (uint8 *)start;
    SAY("%02X %02X %02X %02X %02X %02X %02X %02X %02X", at[0], at[1], at[2], at[3], at[4], at[5], at[6], at[7], at[8]);
}

static void writes(void)
{
    static uint32 own[2];
    written();
    TELL(CFE_PSP_EepromWrite8(start, 0x11));
    TELL(CFE_PSP_EepromWrite8(start + 1, 0x22));
    written();
    TELL(CFE_PSP_EepromWrite16(start + 2, 0x3344));
    TELL(CFE_PSP_EepromWrite16(start + 5, 0x5566));
    written();
    TELL(CFE_PSP_EepromWrite32(start, 0x778899AA));
    TELL(CFE_PSP_EepromWrite32(start + 1, 0xBBCCDDEE));
    written();
    TELL(CFE_PSP_EepromWrite32(start + 2, 0x01020304));
    written();
    TELL(CFE_PSP_EepromWrite32(start + 5, 0x05060708));
    written();
    TELL(CFE_PSP_EepromWrite8(start + size - 1, 0xA5));
    TELL(CFE_PSP_EepromWrite16(start + size - 2, 0xC3D4));
    TELL(CFE_PSP_EepromWrite32(start + size - 4, 0xE5F60718));
    SAY("last %02X", *(uint8 *)(start + size - 1));
    TELL(CFE_PSP_EepromWrite8((cpuaddr)own, 0x12));
    TELL(CFE_PSP_EepromWrite16((cpuaddr)own + 2, 0x3456));
    TELL(CFE_PSP_EepromWrite32((cpuaddr)own + 3, 0x789ABCDE));
    SAY("own %08X %08X", (unsigned)own[0], (unsigned)own[1]);
}

static void banks(void)
{
    TELL(CFE_PSP_EepromWriteEnable(0));
    TELL(CFE_PSP_EepromWriteEnable(7));
    TELL(CFE_PSP_EepromWriteDisable(0));
    TELL(CFE_PSP_EepromWriteDisable(7));
    TELL(CFE_PSP_EepromWrite8(start + 8, 0x77));
    TELL(CFE_PSP_EepromPowerDown(0));
    TELL(CFE_PSP_EepromPowerDown(7));
    TELL(CFE_PSP_EepromWrite8(start + 8, 0x88));
    written();
    TELL(CFE_PSP_EepromPowerUp(0));
    TELL(CFE_PSP_EepromPowerUp(7));
}

static void copies(void)
{
    static uint8 own[16];
    TELL(CFE_PSP_MemSet((void *)(start + 1), 0x34, 3));
    written();
    TELL(CFE_PSP_MemCpy((void *)(start + 5), (void *)(start + 1), 3));
    written();
    TELL(CFE_PSP_MemCpy(own + 3, (void *)start, 9));
    SAY("own %02X %02X %02X %02X", own[2], own[3], own[4], own[11]);
    TELL(CFE_PSP_MemCpy((void *)start, own + 1, 9));
    written();
    TELL(CFE_PSP_MemCpy((void *)start, own, 0));
    TELL(CFE_PSP_MemSet((void *)start, 1, 0));
    TELL(CFE_PSP_MemCpy(NULL, own, 4));
    TELL(CFE_PSP_MemCpy(own, NULL, 0));
    TELL(CFE_PSP_MemSet(NULL, 1, 0));
    written();
}

void APITEST_Main(void)
{
    ranges();
    validate();
    writes();
    banks();
    copies();
    CFE_ES_ExitApp(CFE_ES_RunStatus_APP_EXIT);
}
