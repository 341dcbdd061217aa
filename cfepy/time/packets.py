"""Message ids, function codes and packet layouts of Time Services (default_cfe_time_msgstruct.h). Imports cfepy.msg."""

from __future__ import annotations

from cfepy.msg import Layout

CFE_TIME_CMD_MID = 0x1805
CFE_TIME_SEND_HK_MID = 0x180D
CFE_TIME_TONE_CMD_MID = 0x1810
CFE_TIME_ONEHZ_CMD_MID = 0x1811
CFE_TIME_DATA_CMD_MID = 0x1860
CFE_TIME_SEND_CMD_MID = 0x1862
CFE_TIME_HK_TLM_MID = 0x0805
CFE_TIME_DIAG_TLM_MID = 0x0806

CFE_TIME_NOOP_CC = 0
CFE_TIME_RESET_COUNTERS_CC = 1
CFE_TIME_SEND_DIAGNOSTIC_CC = 2
CFE_TIME_SET_SOURCE_CC = 3
CFE_TIME_SET_STATE_CC = 4
CFE_TIME_ADD_DELAY_CC = 5
CFE_TIME_SUB_DELAY_CC = 6
CFE_TIME_SET_TIME_CC = 7
CFE_TIME_SET_MET_CC = 8
CFE_TIME_SET_STCF_CC = 9
CFE_TIME_SET_LEAP_SECONDS_CC = 10
CFE_TIME_ADD_ADJUST_CC = 11
CFE_TIME_SUB_ADJUST_CC = 12
CFE_TIME_ADD_ONE_HZ_ADJUSTMENT_CC = 13
CFE_TIME_SUB_ONE_HZ_ADJUSTMENT_CC = 14
CFE_TIME_SET_SIGNAL_CC = 15

SYS_TIME = Layout("CFE_TIME_SysTime_t", [("Seconds", "u32"), ("Subseconds", "u32")])

HOUSEKEEPING = Layout(
    "CFE_TIME_HousekeepingTlm_Payload_t",
    [
        ("CommandCounter", "u8"),
        ("CommandErrorCounter", "u8"),
        ("ClockStateFlags", "u16"),
        ("ClockStateAPI", "i16"),
        ("LeapSeconds", "i16"),
        ("MET", SYS_TIME),
        ("STCF", SYS_TIME),
        ("AdjustmentFactor", SYS_TIME),
    ],
)

DIAGNOSTIC = Layout(
    "CFE_TIME_DiagnosticTlm_Payload_t",
    [
        ("AtToneMET", SYS_TIME),
        ("AtToneSTCF", SYS_TIME),
        ("AtToneDelay", SYS_TIME),
        ("AtToneLatch", SYS_TIME),
        ("AtToneLeapSeconds", "i16"),
        ("ClockStateAPI", "i16"),
        ("TimeSinceTone", SYS_TIME),
        ("CurrentLatch", SYS_TIME),
        ("CurrentMET", SYS_TIME),
        ("CurrentTAI", SYS_TIME),
        ("CurrentUTC", SYS_TIME),
        ("ClockSetState", "i16"),
        ("ClockFlyState", "i16"),
        ("ClockSource", "i16"),
        ("ClockSignal", "i16"),
        ("ServerFlyState", "i16"),
        ("Forced2Fly", "i16"),
        ("ClockStateFlags", "u16"),
        ("OneTimeDirection", "i16"),
        ("OneHzDirection", "i16"),
        ("DelayDirection", "i16"),
        ("OneTimeAdjust", SYS_TIME),
        ("OneHzAdjust", SYS_TIME),
        ("ToneSignalLatch", SYS_TIME),
        ("ToneDataLatch", SYS_TIME),
        ("ToneMatchCounter", "u32"),
        ("ToneMatchErrorCounter", "u32"),
        ("ToneSignalCounter", "u32"),
        ("ToneDataCounter", "u32"),
        ("ToneIntCounter", "u32"),
        ("ToneIntErrorCounter", "u32"),
        ("ToneTaskCounter", "u32"),
        ("VersionCounter", "u32"),
        ("LocalIntCounter", "u32"),
        ("LocalTaskCounter", "u32"),
        ("VirtualMET", "u32"),
        ("MinElapsed", "u32"),
        ("MaxElapsed", "u32"),
        ("MaxLocalClock", SYS_TIME),
        ("ToneOverLimit", "u32"),
        ("ToneUnderLimit", "u32"),
        ("DataStoreStatus", "u32"),
    ],
)

TONE_DATA = Layout(
    "CFE_TIME_ToneDataCmd_Payload_t",
    [("AtToneMET", SYS_TIME), ("AtToneSTCF", SYS_TIME), ("AtToneLeapSeconds", "i16"), ("AtToneState", "i16")],
)

TIME_COMMAND = Layout("CFE_TIME_TimeCmd_Payload_t", [("Seconds", "u32"), ("MicroSeconds", "u32")])
ONE_HZ_COMMAND = Layout("CFE_TIME_OneHzAdjustmentCmd_Payload_t", [("Seconds", "u32"), ("Subseconds", "u32")])
STATE_COMMAND = Layout("CFE_TIME_StateCmd_Payload_t", [("ClockState", "i16")])
SOURCE_COMMAND = Layout("CFE_TIME_SourceCmd_Payload_t", [("TimeSource", "i16")])
SIGNAL_COMMAND = Layout("CFE_TIME_SignalCmd_Payload_t", [("ToneSource", "i16")])
LEAPS_COMMAND = Layout("CFE_TIME_LeapsCmd_Payload_t", [("LeapSeconds", "i16")])
