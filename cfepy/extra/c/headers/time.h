/* CFE_TIME: the clock of the spacecraft. */
#ifndef CFEPY_TIME_H
#define CFEPY_TIME_H

#include "status.h"

CFEPY_C_BEGIN

typedef struct CFE_TIME_SysTime {
    uint32 Seconds, Subseconds;
} CFE_TIME_SysTime_t;

enum CFE_TIME_FlagBit {
    CFE_TIME_FlagBit_CLKSET = 0, CFE_TIME_FlagBit_FLYING = 1, CFE_TIME_FlagBit_SRCINT = 2,
    CFE_TIME_FlagBit_SIGPRI = 3, CFE_TIME_FlagBit_SRVFLY = 4, CFE_TIME_FlagBit_CMDFLY = 5,
    CFE_TIME_FlagBit_ADDADJ = 6, CFE_TIME_FlagBit_ADD1HZ = 7, CFE_TIME_FlagBit_ADDTCL = 8,
    CFE_TIME_FlagBit_SERVER = 9, CFE_TIME_FlagBit_GDTONE = 10
};

typedef uint8 CFE_TIME_FlagBit_Enum_t;

enum CFE_TIME_ClockState {
    CFE_TIME_ClockState_INVALID = -1, CFE_TIME_ClockState_VALID = 0, CFE_TIME_ClockState_FLYWHEEL = 1
};

typedef int16 CFE_TIME_ClockState_Enum_t;
enum CFE_TIME_SourceSelect { CFE_TIME_SourceSelect_INTERNAL = 1, CFE_TIME_SourceSelect_EXTERNAL = 2 };
typedef uint8 CFE_TIME_SourceSelect_Enum_t;
enum CFE_TIME_ToneSignalSelect { CFE_TIME_ToneSignalSelect_PRIMARY = 1, CFE_TIME_ToneSignalSelect_REDUNDANT = 2 };
typedef uint8 CFE_TIME_ToneSignalSelect_Enum_t;
enum CFE_TIME_AdjustDirection { CFE_TIME_AdjustDirection_ADD = 1, CFE_TIME_AdjustDirection_SUBTRACT = 2 };
typedef uint8 CFE_TIME_AdjustDirection_Enum_t;
enum CFE_TIME_FlywheelState { CFE_TIME_FlywheelState_NO_FLY = 0, CFE_TIME_FlywheelState_IS_FLY = 1 };
typedef uint8 CFE_TIME_FlywheelState_Enum_t;
enum CFE_TIME_SetState { CFE_TIME_SetState_NOT_SET = 0, CFE_TIME_SetState_WAS_SET = 1 };
typedef uint8 CFE_TIME_SetState_Enum_t;
typedef enum CFE_TIME_Compare { CFE_TIME_A_LT_B = -1, CFE_TIME_EQUAL = 0, CFE_TIME_A_GT_B = 1 } CFE_TIME_Compare_t;
typedef int32 (*CFE_TIME_SynchCallbackPtr_t)(void);
#define CFE_TIME_PRINTED_STRING_SIZE 24
#define CFE_TIME_ZERO_VALUE ((CFE_TIME_SysTime_t){0, 0})
#define CFE_TIME_Copy(to, from)                   \
    {                                             \
        (to)->Seconds    = (from)->Seconds;       \
        (to)->Subseconds = (from)->Subseconds;    \
    }

/* ---- now ---- */
uint16 CFE_TIME_GetClockInfo(void);
CFE_TIME_ClockState_Enum_t CFE_TIME_GetClockState(void);
int16 CFE_TIME_GetLeapSeconds(void);
CFE_TIME_SysTime_t CFE_TIME_GetMET(void);
uint32 CFE_TIME_GetMETseconds(void);
uint32 CFE_TIME_GetMETsubsecs(void);
CFE_TIME_SysTime_t CFE_TIME_GetSTCF(void);
CFE_TIME_SysTime_t CFE_TIME_GetTAI(void);
CFE_TIME_SysTime_t CFE_TIME_GetTime(void);
CFE_TIME_SysTime_t CFE_TIME_GetUTC(void);

/* ---- sums and conversions ---- */
CFE_TIME_SysTime_t CFE_TIME_Add(CFE_TIME_SysTime_t Time1, CFE_TIME_SysTime_t Time2);
CFE_TIME_Compare_t CFE_TIME_Compare(CFE_TIME_SysTime_t TimeA, CFE_TIME_SysTime_t TimeB);
CFE_TIME_SysTime_t CFE_TIME_MET2SCTime(CFE_TIME_SysTime_t METTime);
uint32 CFE_TIME_Micro2SubSecs(uint32 MicroSeconds);
CFE_Status_t CFE_TIME_Print(char *PrintBuffer, CFE_TIME_SysTime_t TimeToPrint);
uint32 CFE_TIME_Sub2MicroSecs(uint32 SubSeconds);
CFE_TIME_SysTime_t CFE_TIME_Subtract(CFE_TIME_SysTime_t Time1, CFE_TIME_SysTime_t Time2);

/* ---- tones and times from outside ---- */
void CFE_TIME_ExternalGPS(CFE_TIME_SysTime_t NewTime, int16 NewLeaps);
void CFE_TIME_ExternalMET(CFE_TIME_SysTime_t NewMET);
void CFE_TIME_ExternalTime(CFE_TIME_SysTime_t NewTime);
void CFE_TIME_ExternalTone(void);
void CFE_TIME_Local1HzISR(void);
CFE_Status_t CFE_TIME_RegisterSynchCallback(CFE_TIME_SynchCallbackPtr_t CallbackFuncPtr);
CFE_Status_t CFE_TIME_UnregisterSynchCallback(CFE_TIME_SynchCallbackPtr_t CallbackFuncPtr);

CFEPY_C_END

#endif
