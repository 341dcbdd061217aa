/* The PSP, as the script calls it. */
#include <string.h>

#include "api_app.h"

CALL(PSP_Ids)
{
    Status(0);
    OutNum(CFE_PSP_GetProcessorId());
    OutNum(CFE_PSP_GetSpacecraftId());
    OutText(CFE_PSP_GetProcessorName(), 100);
}
CALL(PSP_Times)
{
    OS_time_t first, second;
    CFE_PSP_GetTime(&first);
    CFE_PSP_GetTime(&second);
    Status(0);
    OutNum(OS_TimeCompare(first, second) <= 0);
    OutNum(CFE_PSP_GetTimerTicksPerSecond());
    OutNum(CFE_PSP_GetTimerLow32Rollover());
}
CALL(PSP_ReadFromCDS)
{
    static uint8 data[70000];
    Status(CFE_PSP_ReadFromCDS(data, Num(1), Num(2)));
}
CALL(PSP_GetCDSSize)
{
    uint32 size = 0;
    Status(CFE_PSP_GetCDSSize(&size));
    OutNum(size);
}
CALL(PSP_Areas)
{
    cpuaddr at;
    uint32  size = 0;
    Status(CFE_PSP_GetResetArea(&at, &size));
    OutNum(CFE_PSP_GetUserReservedArea(&at, &size));
    OutNum(size);
    OutNum(CFE_PSP_GetVolatileDiskMem(&at, &size));
    OutNum(CFE_PSP_GetKernelTextSegmentInfo(&at, &size));
}
CALL(PSP_MemRanges)
{
    Status(CFE_PSP_MemRanges());
}
CALL(PSP_MemRangeGet)
{
    uint32  type = 0, attributes = 0;
    size_t  size = 0, word = 0;
    cpuaddr at;
    Status(CFE_PSP_MemRangeGet(Num(1), &type, &at, &size, &word, &attributes));
    if (Num(1) > 1) /* 0 and 1 are of the host */
    {
        OutNum(type);
        OutNum(size);
        OutNum(word);
        OutNum(attributes);
    }
}
CALL(PSP_MemRangeSet)
{
    Status(CFE_PSP_MemRangeSet(Num(1), Num(2), Num(3), Num(4), Num(5), Num(6)));
}
CALL(PSP_MemValidateRange)
{
    Status(CFE_PSP_MemValidateRange(Num(1), Num(2), Num(3)));
}
CALL(PSP_Exceptions)
{
    uint32    log = 0;
    osal_id_t task;
    char      reason[100];
    Status(CFE_PSP_Exception_GetCount());
    OutNum(CFE_PSP_Exception_GetSummary(&log, &task, reason, sizeof(reason)));
    OutNum(CFE_PSP_Exception_CopyContext(Num(1), reason, sizeof(reason)));
}
CALL(PSP_PortRead)
{
    uint8  byte;
    uint16 word;
    uint32 both;
    OutNum(CFE_PSP_PortRead8(Num(1), &byte));
    OutNum(CFE_PSP_PortRead16(Num(1), &word));
    OutNum(CFE_PSP_PortRead32(Num(1), &both));
    OutNum(CFE_PSP_PortWrite8(Num(1), 0));
}
CALL(PSP_Eeprom)
{
    OutNum(CFE_PSP_EepromWriteEnable(Num(1)));
    OutNum(CFE_PSP_EepromWriteDisable(Num(1)));
    OutNum(CFE_PSP_EepromPowerUp(Num(1)));
    OutNum(CFE_PSP_EepromPowerDown(Num(1)));
}
CALL(PSP_Watchdog)
{
    CFE_PSP_WatchdogSet(Num(1));
    CFE_PSP_WatchdogService();
    Status(0);
    OutNum(CFE_PSP_WatchdogGet());
}
CALL(PSP_StatusToString)
{
    CFE_PSP_StatusString_t text;
    Status(0);
    OutText(CFE_PSP_StatusToString(Num(1), &text), sizeof(text));
}

const Call PspCalls[] = {ROW(PSP_Ids), ROW(PSP_Times), ROW(PSP_ReadFromCDS),
    ROW(PSP_GetCDSSize), ROW(PSP_Areas), ROW(PSP_MemRanges), ROW(PSP_MemRangeGet), ROW(PSP_MemRangeSet),
    ROW(PSP_MemValidateRange), ROW(PSP_Exceptions), ROW(PSP_PortRead), ROW(PSP_Eeprom), ROW(PSP_Watchdog),
    ROW(PSP_StatusToString), {NULL, NULL}};
