/* The platform support package: the processor, its memory, watchdog and resets. */
#ifndef CFEPY_PSP_H
#define CFEPY_PSP_H

#include "osal_objects.h"

CFEPY_C_BEGIN

/* ---- status ---- */
#define CFE_PSP_STATUS_C(X) ((CFE_PSP_Status_t)(X))
#define CFE_PSP_STATUS_STRING_LENGTH 12
#define CFE_PSP_NO_EXCEPTION_DATA        CFE_PSP_STATUS_C(-30)
#define CFE_PSP_INVALID_MODULE_ID        CFE_PSP_STATUS_C(-29)
#define CFE_PSP_INVALID_MODULE_NAME      CFE_PSP_STATUS_C(-28)
#define CFE_PSP_ERROR_NOT_IMPLEMENTED    CFE_PSP_STATUS_C(-27)
#define CFE_PSP_INVALID_MEM_ATTR         CFE_PSP_STATUS_C(-26)
#define CFE_PSP_INVALID_MEM_SIZE         CFE_PSP_STATUS_C(-25)
#define CFE_PSP_INVALID_MEM_WORDSIZE     CFE_PSP_STATUS_C(-24)
#define CFE_PSP_INVALID_MEM_RANGE        CFE_PSP_STATUS_C(-23)
#define CFE_PSP_INVALID_MEM_TYPE         CFE_PSP_STATUS_C(-22)
#define CFE_PSP_INVALID_MEM_ADDR         CFE_PSP_STATUS_C(-21)
#define CFE_PSP_INVALID_INT_NUM          CFE_PSP_STATUS_C(-5)
#define CFE_PSP_ERROR_TIMEOUT            CFE_PSP_STATUS_C(-4)
#define CFE_PSP_ERROR_ADDRESS_MISALIGNED CFE_PSP_STATUS_C(-3)
#define CFE_PSP_INVALID_POINTER          CFE_PSP_STATUS_C(-2)
#define CFE_PSP_ERROR                    CFE_PSP_STATUS_C(-1)
#define CFE_PSP_SUCCESS                  CFE_PSP_STATUS_C(0)
typedef int32 CFE_PSP_Status_t;
typedef char CFE_PSP_StatusString_t[12];
char *CFE_PSP_StatusToString(CFE_PSP_Status_t status, CFE_PSP_StatusString_t *status_string);

/* ---- who this is, and its versions ---- */
uint32 CFE_PSP_GetBuildNumber(void);
uint32 CFE_PSP_GetProcessorId(void);
const char *CFE_PSP_GetProcessorName(void);
uint32 CFE_PSP_GetSpacecraftId(void);
const char *CFE_PSP_GetVersionCodeName(void);
void CFE_PSP_GetVersionNumber(uint8 VersionNumbers[4]);
const char *CFE_PSP_GetVersionString(void);

/* ---- start, resets, watchdog ---- */
#define CFE_PSP_PANIC_STARTUP                  1
#define CFE_PSP_RST_SUBTYPE_POWER_CYCLE        1
#define CFE_PSP_RST_TYPE_PROCESSOR             1
#define CFE_PSP_PANIC_VOLATILE_DISK            2
#define CFE_PSP_RST_SUBTYPE_PUSH_BUTTON        2
#define CFE_PSP_RST_TYPE_POWERON               2
#define CFE_PSP_PANIC_MEMORY_ALLOC             3
#define CFE_PSP_RST_SUBTYPE_HW_SPECIAL_COMMAND 3
#define CFE_PSP_RST_TYPE_MAX                   3
#define CFE_PSP_PANIC_NONVOL_DISK              4
#define CFE_PSP_RST_SUBTYPE_HW_WATCHDOG        4
#define CFE_PSP_PANIC_STARTUP_SEM              5
#define CFE_PSP_RST_SUBTYPE_RESET_COMMAND      5
#define CFE_PSP_PANIC_CORE_APP                 6
#define CFE_PSP_RST_SUBTYPE_EXCEPTION          6
#define CFE_PSP_PANIC_GENERAL_FAILURE          7
#define CFE_PSP_RST_SUBTYPE_UNDEFINED_RESET    7
#define CFE_PSP_RST_SUBTYPE_HWDEBUG_RESET      8
#define CFE_PSP_RST_SUBTYPE_BANKSWITCH_RESET   9
#define CFE_PSP_RST_SUBTYPE_MAX                10
uint32 CFE_PSP_GetRestartType(uint32 *restartSubType);
void CFE_PSP_Main(void);
void CFE_PSP_Panic(int32 ErrorCode);
void CFE_PSP_Restart(uint32 resetType);
void CFE_PSP_WatchdogDisable(void);
void CFE_PSP_WatchdogEnable(void);
uint32 CFE_PSP_WatchdogGet(void);
void CFE_PSP_WatchdogInit(void);
void CFE_PSP_WatchdogService(void);
void CFE_PSP_WatchdogSet(uint32 WatchdogValue);
#define PSP_DEBUG(...)
#define PSP_DEBUG_LEV(level, ...)

/* ---- clocks ---- */
#define CFE_PSP_SOFT_TIMEBASE_NAME "cFS-Master"
void CFE_PSP_GetTime(OS_time_t *LocalTime);
uint32 CFE_PSP_GetTimerLow32Rollover(void);
uint32 CFE_PSP_GetTimerTicksPerSecond(void);
void CFE_PSP_Get_Timebase(uint32 *Tbu, uint32 *Tbl);

/* ---- memory ---- */
#define CFE_PSP_MEM_ATTR_WRITE     0x1
#define CFE_PSP_MEM_RAM            1
#define CFE_PSP_MEM_SIZE_BYTE      0x1
#define CFE_PSP_MEM_ATTR_READ      0x2
#define CFE_PSP_MEM_EEPROM         2
#define CFE_PSP_MEM_SIZE_WORD      0x2
#define CFE_PSP_MEM_ANY            3
#define CFE_PSP_MEM_ATTR_READWRITE 0x3
#define CFE_PSP_MEM_INVALID        4
#define CFE_PSP_MEM_SIZE_DWORD     0x4
int32 CFE_PSP_MemCpy(void *dest, const void *src, uint32 n);
int32 CFE_PSP_MemRangeGet(uint32 RangeNum, uint32 *MemoryType, cpuaddr *StartAddr, size_t *Size, size_t *WordSize,
    uint32 *Attributes);
int32 CFE_PSP_MemRangeSet(uint32 RangeNum, uint32 MemoryType, cpuaddr StartAddr, size_t Size, size_t WordSize,
    uint32 Attributes);
uint32 CFE_PSP_MemRanges(void);
int32 CFE_PSP_MemRead16(cpuaddr MemoryAddress, uint16 *uint16Value);
int32 CFE_PSP_MemRead32(cpuaddr MemoryAddress, uint32 *uint32Value);
int32 CFE_PSP_MemRead8(cpuaddr MemoryAddress, uint8 *ByteValue);
int32 CFE_PSP_MemSet(void *dest, uint8 value, uint32 n);
int32 CFE_PSP_MemValidateRange(cpuaddr Address, size_t Size, uint32 MemoryType);
int32 CFE_PSP_MemWrite16(cpuaddr MemoryAddress, uint16 uint16Value);
int32 CFE_PSP_MemWrite32(cpuaddr MemoryAddress, uint32 uint32Value);
int32 CFE_PSP_MemWrite8(cpuaddr MemoryAddress, uint8 ByteValue);
int32 CFE_PSP_PortRead16(cpuaddr PortAddress, uint16 *uint16Value);
int32 CFE_PSP_PortRead32(cpuaddr PortAddress, uint32 *uint32Value);
int32 CFE_PSP_PortRead8(cpuaddr PortAddress, uint8 *ByteValue);
int32 CFE_PSP_PortWrite16(cpuaddr PortAddress, uint16 uint16Value);
int32 CFE_PSP_PortWrite32(cpuaddr PortAddress, uint32 uint32Value);
int32 CFE_PSP_PortWrite8(cpuaddr PortAddress, uint8 ByteValue);
int32 CFE_PSP_EepromPowerDown(uint32 Bank);
int32 CFE_PSP_EepromPowerUp(uint32 Bank);
int32 CFE_PSP_EepromWrite16(cpuaddr MemoryAddress, uint16 uint16Value);
int32 CFE_PSP_EepromWrite32(cpuaddr MemoryAddress, uint32 uint32Value);
int32 CFE_PSP_EepromWrite8(cpuaddr MemoryAddress, uint8 ByteValue);
int32 CFE_PSP_EepromWriteDisable(uint32 Bank);
int32 CFE_PSP_EepromWriteEnable(uint32 Bank);
void CFE_PSP_FlushCaches(uint32 type, void *address, uint32 size);
int32 CFE_PSP_GetCFETextSegmentInfo(cpuaddr *PtrToCFESegment, uint32 *SizeOfCFESegment);
int32 CFE_PSP_GetKernelTextSegmentInfo(cpuaddr *PtrToKernelSegment, uint32 *SizeOfKernelSegment);
int32 CFE_PSP_GetResetArea(cpuaddr *PtrToResetArea, uint32 *SizeOfResetArea);
int32 CFE_PSP_GetUserReservedArea(cpuaddr *PtrToUserArea, uint32 *SizeOfUserArea);
int32 CFE_PSP_GetVolatileDiskMem(cpuaddr *PtrToVolDisk, uint32 *SizeOfVolDisk);
int32 CFE_PSP_InitSSR(uint32 bus, uint32 device, char *DeviceName);
int32 CFE_PSP_GetCDSSize(uint32 *SizeOfCDS);
int32 CFE_PSP_ReadFromCDS(void *PtrToDataFromRead, uint32 CDSOffset, uint32 NumBytes);
int32 CFE_PSP_WriteToCDS(const void *PtrToDataToWrite, uint32 CDSOffset, uint32 NumBytes);

/* ---- exceptions ---- */
void CFE_PSP_AttachExceptions(void);
int32 CFE_PSP_Exception_CopyContext(uint32 ContextLogId, void *ContextBuf, uint32 ContextSize);
uint32 CFE_PSP_Exception_GetCount(void);
int32 CFE_PSP_Exception_GetSummary(uint32 *ContextLogId, osal_id_t *TaskId, char *ReasonBuf, uint32 ReasonSize);
void CFE_PSP_SetDefaultExceptionEnvironment(void);

/* ---- byte order ---- */
uint16 CFE_PSP_BE16toH(uint16 big_endian_16bits);
uint32 CFE_PSP_BE32toH(uint32 big_endian_32bits);
uint64 CFE_PSP_BE64toH(uint64 big_endian_64bits);
uint16 CFE_PSP_HtoBE16(uint16 host_16bits);
uint32 CFE_PSP_HtoBE32(uint32 host_32bits);
uint64 CFE_PSP_HtoBE64(uint64 host_64bits);
uint16 CFE_PSP_HtoLE16(uint16 host_16bits);
uint32 CFE_PSP_HtoLE32(uint32 host_32bits);
uint64 CFE_PSP_HtoLE64(uint64 host_64bits);
bool CFE_PSP_IsBigEndian(void);
bool CFE_PSP_IsLittleEndian(void);
uint16 CFE_PSP_LE16toH(uint16 little_endian_16bits);
uint32 CFE_PSP_LE32toH(uint32 little_endian_32bits);
uint64 CFE_PSP_LE64toH(uint64 little_endian_64bits);

CFEPY_C_END

#endif
