/* Declarations of the PSP for compiled applications of tests, in plain C types. */
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct { uint32_t module; uint16_t subsystem, subchannel; } Location;
typedef struct { uint16_t count; int32_t *samples; } Reading;

int32_t CFE_PSP_GetResetArea(uint64_t *, uint32_t *), CFE_PSP_GetUserReservedArea(uint64_t *, uint32_t *);
int32_t CFE_PSP_GetVolatileDiskMem(uint64_t *, uint32_t *), CFE_PSP_GetKernelTextSegmentInfo(uint64_t *, uint32_t *);
int32_t CFE_PSP_GetCFETextSegmentInfo(uint64_t *, uint32_t *), CFE_PSP_MemValidateRange(uint64_t, size_t, uint32_t);
uint32_t CFE_PSP_MemRanges(void);
int32_t CFE_PSP_MemRangeSet(uint32_t, uint32_t, uint64_t, size_t, size_t, uint32_t);
int32_t CFE_PSP_MemRangeGet(uint32_t, uint32_t *, uint64_t *, size_t *, size_t *, uint32_t *);
int32_t CFE_PSP_MemRead8(uint64_t, uint8_t *), CFE_PSP_MemRead16(uint64_t, uint16_t *);
int32_t CFE_PSP_MemRead32(uint64_t, uint32_t *), CFE_PSP_MemWrite8(uint64_t, uint8_t);
int32_t CFE_PSP_MemWrite16(uint64_t, uint16_t), CFE_PSP_MemWrite32(uint64_t, uint32_t);
int32_t CFE_PSP_MemCpy(void *, const void *, uint32_t), CFE_PSP_MemSet(void *, uint8_t, uint32_t);
int32_t CFE_PSP_EepromWrite8(uint64_t, uint8_t), CFE_PSP_EepromWrite32(uint64_t, uint32_t);
int32_t CFE_PSP_EepromWriteEnable(uint32_t), CFE_PSP_EepromPowerUp(uint32_t);
int32_t CFE_PSP_PortRead8(uint64_t, uint8_t *), CFE_PSP_PortWrite8(uint64_t, uint8_t);
int32_t CFE_PSP_GetCDSSize(uint32_t *), CFE_PSP_WriteToCDS(const void *, uint32_t, uint32_t);
int32_t CFE_PSP_ReadFromCDS(void *, uint32_t, uint32_t), CFE_PSP_InitSSR(uint32_t, uint32_t, char *);
uint32_t CFE_PSP_GetProcessorId(void), CFE_PSP_GetSpacecraftId(void), CFE_PSP_GetRestartType(uint32_t *);
uint32_t CFE_PSP_WatchdogGet(void), CFE_PSP_GetTimerTicksPerSecond(void), CFE_PSP_Exception_GetCount(void);
const char *CFE_PSP_GetProcessorName(void), *CFE_PSP_GetVersionString(void);
char *CFE_PSP_StatusToString(int32_t, char *);
void CFE_PSP_GetTime(int64_t *), CFE_PSP_Get_Timebase(uint32_t *, uint32_t *), CFE_PSP_WatchdogSet(uint32_t);
void CFE_PSP_Restart(uint32_t), CFE_PSP_Panic(int32_t);
int32_t CFE_PSP_Exception_GetSummary(uint32_t *, uint32_t *, char *, uint32_t);
int32_t CFE_PSP_Exception_CopyContext(uint32_t, void *, uint32_t);
uint16_t CFE_PSP_HtoBE16(uint16_t);
uint32_t CFE_PSP_BE32toH(uint32_t);
uint64_t CFE_PSP_HtoBE64(uint64_t), CFE_PSP_LE64toH(uint64_t);
bool CFE_PSP_IsBigEndian(void), CFE_PSP_IsLittleEndian(void);
int32_t CFE_PSP_IODriver_FindByName(const char *, uint32_t *);
int32_t CFE_PSP_IODriver_Command(const Location *, uint32_t, uint64_t);
