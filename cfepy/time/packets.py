"""Commands and telemetry of Time Services: message ids, function codes, layouts (default_cfe_time_msgstruct.h)."""

from __future__ import annotations

from cfepy.msg import SYS_TIME, Command, Layout, Telemetry, ValueNames

CMD_MID = 0x1805
SEND_HK_MID = 0x180D
TONE_CMD_MID = 0x1810
ONEHZ_CMD_MID = 0x1811
DATA_CMD_MID = 0x1860
SEND_CMD_MID = 0x1862
HK_TLM_MID = 0x0805
DIAG_TLM_MID = 0x0806

NOOP_CC = 0
RESET_COUNTERS_CC = 1
SEND_DIAGNOSTIC_CC = 2
SET_SOURCE_CC = 3
SET_STATE_CC = 4
ADD_DELAY_CC = 5
SUB_DELAY_CC = 6
SET_TIME_CC = 7
SET_MET_CC = 8
SET_STCF_CC = 9
SET_LEAP_SECONDS_CC = 10
ADD_ADJUST_CC = 11
SUB_ADJUST_CC = 12
ADD_ONE_HZ_ADJUSTMENT_CC = 13
SUB_ONE_HZ_ADJUSTMENT_CC = 14
SET_SIGNAL_CC = 15

CLOCK_STATES = ValueNames("i16", INVALID=-1, VALID=0, FLYWHEEL=1)
SOURCES = ValueNames("i16", INTERNAL=1, EXTERNAL=2)
SIGNALS = ValueNames("i16", PRIMARY=1, REDUNDANT=2)
SET_STATES = ValueNames("i16", NOT_SET=0, WAS_SET=1)
FLYWHEEL_STATES = ValueNames("i16", NO_FLY=0, IS_FLY=1)
DIRECTIONS = ValueNames("i16", ADD=1, SUBTRACT=2)
"""The names of values (default_cfe_time_extern_typedefs.h)."""

HOUSEKEEPING = Layout(
    "CFE_TIME_HousekeepingTlm_Payload_t",
    [
        ("CommandCounter", "u8"),
        ("CommandErrorCounter", "u8"),
        ("ClockStateFlags", "u16"),
        ("ClockStateAPI", CLOCK_STATES),
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
        ("ClockStateAPI", CLOCK_STATES),
        ("TimeSinceTone", SYS_TIME),
        ("CurrentLatch", SYS_TIME),
        ("CurrentMET", SYS_TIME),
        ("CurrentTAI", SYS_TIME),
        ("CurrentUTC", SYS_TIME),
        ("ClockSetState", SET_STATES),
        ("ClockFlyState", FLYWHEEL_STATES),
        ("ClockSource", SOURCES),
        ("ClockSignal", SIGNALS),
        ("ServerFlyState", FLYWHEEL_STATES),
        ("Forced2Fly", "i16"),
        ("ClockStateFlags", "u16"),
        ("OneTimeDirection", DIRECTIONS),
        ("OneHzDirection", DIRECTIONS),
        ("DelayDirection", DIRECTIONS),
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
    [("AtToneMET", SYS_TIME), ("AtToneSTCF", SYS_TIME), ("AtToneLeapSeconds", "i16"), ("AtToneState", CLOCK_STATES)],
)

TIME_COMMAND = Layout("CFE_TIME_TimeCmd_Payload_t", [("Seconds", "u32"), ("MicroSeconds", "u32")])
ONE_HZ_COMMAND = Layout("CFE_TIME_OneHzAdjustmentCmd_Payload_t", [("Seconds", "u32"), ("Subseconds", "u32")])
STATE_COMMAND = Layout("CFE_TIME_StateCmd_Payload_t", [("ClockState", CLOCK_STATES)])
SOURCE_COMMAND = Layout("CFE_TIME_SourceCmd_Payload_t", [("TimeSource", SOURCES)])
SIGNAL_COMMAND = Layout("CFE_TIME_SignalCmd_Payload_t", [("ToneSource", SIGNALS)])
LEAPS_COMMAND = Layout("CFE_TIME_LeapsCmd_Payload_t", [("LeapSeconds", "i16")])

RESET_VARS = Layout(
    "CFE_TIME_ResetVars_t",
    [
        ("Signature", "u32"),
        ("LeapSeconds", "i16"),
        ("ClockSignal", "u16"),
        ("CurrentMET", SYS_TIME),
        ("CurrentSTCF", SYS_TIME),
        ("CurrentDelay", SYS_TIME),
    ],
)

NOOP = Command("CFE_TIME_NOOP", CMD_MID, NOOP_CC, text="Answer with an event.")
RESET_COUNTERS = Command("CFE_TIME_RESET_COUNTERS", CMD_MID, RESET_COUNTERS_CC, text="Set the counters to 0.")
SEND_DIAGNOSTIC = Command("CFE_TIME_SEND_DIAGNOSTIC", CMD_MID, SEND_DIAGNOSTIC_CC, text="Send the diagnostic packet.")
SET_SOURCE = Command(
    "CFE_TIME_SET_SOURCE", CMD_MID, SET_SOURCE_CC, SOURCE_COMMAND, "Take the time from inside, 1, or outside, 2."
)
SET_STATE = Command(
    "CFE_TIME_SET_STATE",
    CMD_MID,
    SET_STATE_CC,
    STATE_COMMAND,
    "Set the clock state: -1 invalid, 0 valid, 1 flywheel (the clock runs without a tone).",
)
ADD_DELAY = Command(
    "CFE_TIME_ADD_DELAY", CMD_MID, ADD_DELAY_CC, TIME_COMMAND, "Set by how much the tone of a client is late."
)
SUB_DELAY = Command(
    "CFE_TIME_SUB_DELAY", CMD_MID, SUB_DELAY_CC, TIME_COMMAND, "Set by how much the tone of a client is early."
)
SET_TIME = Command("CFE_TIME_SET_TIME", CMD_MID, SET_TIME_CC, TIME_COMMAND, "Set the spacecraft time through STCF.")
SET_MET = Command("CFE_TIME_SET_MET", CMD_MID, SET_MET_CC, TIME_COMMAND, "Set the mission elapsed time.")
SET_STCF = Command(
    "CFE_TIME_SET_STCF", CMD_MID, SET_STCF_CC, TIME_COMMAND, "Set STCF, the offset from MET to the spacecraft time."
)
SET_LEAP_SECONDS = Command(
    "CFE_TIME_SET_LEAP_SECONDS", CMD_MID, SET_LEAP_SECONDS_CC, LEAPS_COMMAND, "Set the seconds that TAI is before UTC."
)
ADD_ADJUST = Command("CFE_TIME_ADD_ADJUST", CMD_MID, ADD_ADJUST_CC, TIME_COMMAND, "Add to STCF once.")
SUB_ADJUST = Command("CFE_TIME_SUB_ADJUST", CMD_MID, SUB_ADJUST_CC, TIME_COMMAND, "Subtract from STCF once.")
ADD_ONE_HZ_ADJUSTMENT = Command(
    "CFE_TIME_ADD_ONE_HZ_ADJUSTMENT",
    CMD_MID,
    ADD_ONE_HZ_ADJUSTMENT_CC,
    ONE_HZ_COMMAND,
    "Add to STCF every second.",
)
SUB_ONE_HZ_ADJUSTMENT = Command(
    "CFE_TIME_SUB_ONE_HZ_ADJUSTMENT",
    CMD_MID,
    SUB_ONE_HZ_ADJUSTMENT_CC,
    ONE_HZ_COMMAND,
    "Subtract from STCF every second.",
)
SET_SIGNAL = Command(
    "CFE_TIME_SET_SIGNAL", CMD_MID, SET_SIGNAL_CC, SIGNAL_COMMAND, "Take the primary tone, 1, or the redundant one, 2."
)
SEND_HK = Command("CFE_TIME_SEND_HK", SEND_HK_MID, text="Send the housekeeping packet.")
TONE_CMD = Command("CFE_TIME_TONE_CMD", TONE_CMD_MID, text="Report a tone.")
ONEHZ_CMD = Command("CFE_TIME_ONEHZ_CMD", ONEHZ_CMD_MID, text="Report the end of a second.")
DATA_CMD = Command("CFE_TIME_DATA_CMD", DATA_CMD_MID, payload=TONE_DATA, text="Report the time at the tone.")
SEND_CMD = Command("CFE_TIME_SEND_CMD", SEND_CMD_MID, text="Request the time at the tone from a server.")

COMMANDS: tuple[Command, ...] = (
    NOOP,
    RESET_COUNTERS,
    SEND_DIAGNOSTIC,
    SET_SOURCE,
    SET_STATE,
    ADD_DELAY,
    SUB_DELAY,
    SET_TIME,
    SET_MET,
    SET_STCF,
    SET_LEAP_SECONDS,
    ADD_ADJUST,
    SUB_ADJUST,
    ADD_ONE_HZ_ADJUSTMENT,
    SUB_ONE_HZ_ADJUSTMENT,
    SET_SIGNAL,
    SEND_HK,
    TONE_CMD,
    ONEHZ_CMD,
    DATA_CMD,
    SEND_CMD,
)

HK_TLM = Telemetry("CFE_TIME_HK_TLM", HK_TLM_MID, HOUSEKEEPING, "Counters, clock state, MET and STCF.")
DIAG_TLM = Telemetry("CFE_TIME_DIAG_TLM", DIAG_TLM_MID, DIAGNOSTIC, "The complete state of the clock.")

TELEMETRY: tuple[Telemetry, ...] = (HK_TLM, DIAG_TLM)
