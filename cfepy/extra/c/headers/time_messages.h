/* Commands and telemetry of CFE_TIME: function codes, payloads, packets. */
#ifndef CFEPY_TIME_MESSAGES_H
#define CFEPY_TIME_MESSAGES_H

#include "message_kinds.h"

CFEPY_C_BEGIN

enum CFE_TIME_FunctionCode_ {
    CFE_TIME_FunctionCode_NOOP = 0, CFE_TIME_FunctionCode_RESET_COUNTERS = 1,
    CFE_TIME_FunctionCode_SEND_DIAGNOSTIC = 2, CFE_TIME_FunctionCode_SET_SOURCE = 3,
    CFE_TIME_FunctionCode_SET_STATE = 4, CFE_TIME_FunctionCode_ADD_DELAY = 5, CFE_TIME_FunctionCode_SUB_DELAY = 6,
    CFE_TIME_FunctionCode_SET_TIME = 7, CFE_TIME_FunctionCode_SET_MET = 8, CFE_TIME_FunctionCode_SET_STCF = 9,
    CFE_TIME_FunctionCode_SET_LEAP_SECONDS = 10, CFE_TIME_FunctionCode_ADD_ADJUST = 11,
    CFE_TIME_FunctionCode_SUB_ADJUST = 12, CFE_TIME_FunctionCode_ADD_ONE_HZ_ADJUSTMENT = 13,
    CFE_TIME_FunctionCode_SUB_ONE_HZ_ADJUSTMENT = 14, CFE_TIME_FunctionCode_SET_SIGNAL = 15
};

#define CFE_TIME_NOOP_CC                  0
#define CFE_TIME_RESET_COUNTERS_CC        1
#define CFE_TIME_SEND_DIAGNOSTIC_CC       2
#define CFE_TIME_SET_SOURCE_CC            3
#define CFE_TIME_SET_STATE_CC             4
#define CFE_TIME_ADD_DELAY_CC             5
#define CFE_TIME_SUB_DELAY_CC             6
#define CFE_TIME_SET_TIME_CC              7
#define CFE_TIME_SET_MET_CC               8
#define CFE_TIME_SET_STCF_CC              9
#define CFE_TIME_SET_LEAP_SECONDS_CC      10
#define CFE_TIME_ADD_ADJUST_CC            11
#define CFE_TIME_SUB_ADJUST_CC            12
#define CFE_TIME_ADD_ONE_HZ_ADJUSTMENT_CC 13
#define CFE_TIME_SUB_ONE_HZ_ADJUSTMENT_CC 14
#define CFE_TIME_SET_SIGNAL_CC            15

typedef struct CFE_TIME_LeapsCmd_Payload {
    int16 LeapSeconds;
} CFE_TIME_LeapsCmd_Payload_t;

typedef struct CFE_TIME_StateCmd_Payload {
    CFE_TIME_ClockState_Enum_t ClockState;
} CFE_TIME_StateCmd_Payload_t;

typedef struct CFE_TIME_SourceCmd_Payload {
    int16 TimeSource;
} CFE_TIME_SourceCmd_Payload_t;

typedef struct CFE_TIME_SignalCmd_Payload {
    int16 ToneSource;
} CFE_TIME_SignalCmd_Payload_t;

typedef struct CFE_TIME_TimeCmd_Payload {
    uint32 Seconds, MicroSeconds;
} CFE_TIME_TimeCmd_Payload_t;

typedef struct CFE_TIME_OneHzAdjustmentCmd_Payload {
    uint32 Seconds, Subseconds;
} CFE_TIME_OneHzAdjustmentCmd_Payload_t;

typedef struct CFE_TIME_ToneDataCmd_Payload {
    CFE_TIME_SysTime_t AtToneMET, AtToneSTCF;
    int16 AtToneLeapSeconds;
    CFE_TIME_ClockState_Enum_t AtToneState;
} CFE_TIME_ToneDataCmd_Payload_t;

typedef struct CFE_TIME_HousekeepingTlm_Payload {
    uint8 CommandCounter, CommandErrorCounter;
    uint16 ClockStateFlags;
    CFE_TIME_ClockState_Enum_t ClockStateAPI;
    int16 LeapSeconds;
    CFE_TIME_SysTime_t MET, STCF, AdjustmentFactor;
} CFE_TIME_HousekeepingTlm_Payload_t;

typedef struct CFE_TIME_DiagnosticTlm_Payload {
    CFE_TIME_SysTime_t AtToneMET, AtToneSTCF, AtToneDelay, AtToneLatch;
    int16 AtToneLeapSeconds;
    CFE_TIME_ClockState_Enum_t ClockStateAPI;
    CFE_TIME_SysTime_t TimeSinceTone, CurrentLatch, CurrentMET, CurrentTAI, CurrentUTC;
    int16 ClockSetState, ClockFlyState, ClockSource, ClockSignal, ServerFlyState, Forced2Fly;
    uint16 ClockStateFlags;
    int16 OneTimeDirection, OneHzDirection, DelayDirection;
    CFE_TIME_SysTime_t OneTimeAdjust, OneHzAdjust, ToneSignalLatch, ToneDataLatch;
    uint32 ToneMatchCounter, ToneMatchErrorCounter, ToneSignalCounter, ToneDataCounter, ToneIntCounter,
        ToneIntErrorCounter, ToneTaskCounter, VersionCounter, LocalIntCounter, LocalTaskCounter, VirtualMET,
        MinElapsed, MaxElapsed;
    CFE_TIME_SysTime_t MaxLocalClock;
    uint32 ToneOverLimit, ToneUnderLimit, DataStoreStatus;
} CFE_TIME_DiagnosticTlm_Payload_t;

#define CFE_TIME_FLAG_UNUSED 0xF
#define CFE_TIME_FLAG_REFERR 0x10
#define CFE_TIME_FLAG_GDTONE 0x20
#define CFE_TIME_FLAG_SERVER 0x40
#define CFE_TIME_FLAG_ADDTCL 0x80
#define CFE_TIME_FLAG_ADD1HZ 0x100
#define CFE_TIME_FLAG_ADDADJ 0x200
#define CFE_TIME_FLAG_CMDFLY 0x400
#define CFE_TIME_FLAG_SRVFLY 0x800
#define CFE_TIME_FLAG_SIGPRI 0x1000
#define CFE_TIME_FLAG_SRCINT 0x2000
#define CFE_TIME_FLAG_FLYING 0x4000
#define CFE_TIME_FLAG_CLKSET 0x8000

CFEPY_COMMAND(CFE_TIME_NoopCmd);
CFEPY_COMMAND(CFE_TIME_ResetCountersCmd);
CFEPY_COMMAND(CFE_TIME_SendDiagnosticCmd);
CFEPY_COMMAND(CFE_TIME_OneHzCmd);
CFEPY_COMMAND(CFE_TIME_ToneSignalCmd);
CFEPY_COMMAND(CFE_TIME_FakeToneCmd);
CFEPY_COMMAND(CFE_TIME_SendHkCmd);
CFEPY_COMMAND_WITH(CFE_TIME_SetLeapSecondsCmd, CFE_TIME_LeapsCmd_Payload_t);
CFEPY_COMMAND_WITH(CFE_TIME_SetStateCmd, CFE_TIME_StateCmd_Payload_t);
CFEPY_COMMAND_WITH(CFE_TIME_SetSourceCmd, CFE_TIME_SourceCmd_Payload_t);
CFEPY_COMMAND_WITH(CFE_TIME_SetSignalCmd, CFE_TIME_SignalCmd_Payload_t);
CFEPY_COMMAND_WITH(CFE_TIME_AddDelayCmd, CFE_TIME_TimeCmd_Payload_t);
CFEPY_COMMAND_WITH(CFE_TIME_SubDelayCmd, CFE_TIME_TimeCmd_Payload_t);
CFEPY_COMMAND_WITH(CFE_TIME_SetMETCmd, CFE_TIME_TimeCmd_Payload_t);
CFEPY_COMMAND_WITH(CFE_TIME_SetSTCFCmd, CFE_TIME_TimeCmd_Payload_t);
CFEPY_COMMAND_WITH(CFE_TIME_AddAdjustCmd, CFE_TIME_TimeCmd_Payload_t);
CFEPY_COMMAND_WITH(CFE_TIME_SubAdjustCmd, CFE_TIME_TimeCmd_Payload_t);
CFEPY_COMMAND_WITH(CFE_TIME_SetTimeCmd, CFE_TIME_TimeCmd_Payload_t);
CFEPY_COMMAND_WITH(CFE_TIME_AddOneHzAdjustmentCmd, CFE_TIME_OneHzAdjustmentCmd_Payload_t);
CFEPY_COMMAND_WITH(CFE_TIME_SubOneHzAdjustmentCmd, CFE_TIME_OneHzAdjustmentCmd_Payload_t);
CFEPY_COMMAND_WITH(CFE_TIME_ToneDataCmd, CFE_TIME_ToneDataCmd_Payload_t);
CFEPY_TELEMETRY(CFE_TIME_HousekeepingTlm, CFE_TIME_HousekeepingTlm_Payload_t);
CFEPY_TELEMETRY(CFE_TIME_DiagnosticTlm, CFE_TIME_DiagnosticTlm_Payload_t);

CFEPY_C_END

#endif
