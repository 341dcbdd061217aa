"""The packets and files of Executive Services: commands, telemetry, records (default_cfe_es_msgstruct.h).

Payload layouts come first, then the declarations of commands and telemetry.
"""

from __future__ import annotations

from cfepy.msg import NO_PAYLOAD, SYS_TIME, Command, Layout, Telemetry, ValueNames

CMD_MID = 0x1806
SEND_HK_MID = 0x1808
HK_TLM_MID = 0x0800
APP_TLM_MID = 0x080B
MEMSTATS_TLM_MID = 0x0810

LOG_MODES = ValueNames("u32", OVERWRITE=0, DISCARD=1)
RESET_TYPES = ValueNames("u32", PROCESSOR=1, POWERON=2)
RESET_SUBTYPES = ValueNames(
    "u32",
    POWER_CYCLE=1,
    PUSH_BUTTON=2,
    HW_SPECIAL_COMMAND=3,
    HW_WATCHDOG=4,
    RESET_COMMAND=5,
    EXCEPTION=6,
    UNDEFINED_RESET=7,
    HWDEBUG_RESET=8,
    BANKSWITCH_RESET=9,
)
PERF_STATES = ValueNames("u32", IDLE=0, WAITING_FOR_TRIGGER=1, TRIGGERED=2)
PERF_MODES = ValueNames("u32", START=0, CENTER=1, END=2)
APP_TYPES = ValueNames("u32", CORE=1, EXTERNAL=2, LIBRARY=3)
EXCEPTION_ACTIONS = ValueNames("u8", RESTART_APP=0, PROC_RESTART=1)
"""The names of values (default_cfe_es_extern_typedefs.h, cfe_psp.h, cfe_es_perf.h)."""

HOUSEKEEPING = Layout(
    "CFE_ES_HousekeepingTlm_Payload_t",
    [
        ("CommandCounter", "u8"),
        ("CommandErrorCounter", "u8"),
        ("CFECoreChecksum", "u16"),
        ("CFEMajorVersion", "u8"),
        ("CFEMinorVersion", "u8"),
        ("CFERevision", "u8"),
        ("CFEMissionRevision", "u8"),
        ("OSALMajorVersion", "u8"),
        ("OSALMinorVersion", "u8"),
        ("OSALRevision", "u8"),
        ("OSALMissionRevision", "u8"),
        ("PSPMajorVersion", "u8"),
        ("PSPMinorVersion", "u8"),
        ("PSPRevision", "u8"),
        ("PSPMissionRevision", "u8"),
        ("SysLogBytesUsed", "u64"),
        ("SysLogSize", "u64"),
        ("SysLogEntries", "u32"),
        ("SysLogMode", LOG_MODES),
        ("ERLogIndex", "u32"),
        ("ERLogEntries", "u32"),
        ("RegisteredCoreApps", "u32"),
        ("RegisteredExternalApps", "u32"),
        ("RegisteredTasks", "u32"),
        ("RegisteredLibs", "u32"),
        ("ResetType", RESET_TYPES),
        ("ResetSubtype", RESET_SUBTYPES),
        ("ProcessorResets", "u32"),
        ("MaxProcessorResets", "u32"),
        ("BootSource", "u32"),
        ("PerfState", PERF_STATES),
        ("PerfMode", PERF_MODES),
        ("PerfTriggerCount", "u32"),
        ("PerfFilterMask", "u32[4]"),
        ("PerfTriggerMask", "u32[4]"),
        ("PerfDataStart", "u32"),
        ("PerfDataEnd", "u32"),
        ("PerfDataCount", "u32"),
        ("PerfDataToWrite", "u32"),
        ("HeapBytesFree", "u64"),
        ("HeapBlocksFree", "u64"),
        ("HeapMaxBlockSize", "u64"),
    ],
)

APP_INFO = Layout(
    "CFE_ES_AppInfo_t",
    [
        ("ResourceId", "u32"),
        ("Type", APP_TYPES),
        ("Name", "char[20]"),
        ("EntryPoint", "char[20]"),
        ("FileName", "char[64]"),
        ("StackSize", "u64"),
        ("AddressesAreValid", "u32"),
        ("CodeAddress", "u64"),
        ("CodeSize", "u64"),
        ("DataAddress", "u64"),
        ("DataSize", "u64"),
        ("BSSAddress", "u64"),
        ("BSSSize", "u64"),
        ("StartAddress", "u64"),
        ("ExceptionAction", EXCEPTION_ACTIONS),
        ("Priority", "u16"),
        ("MainTaskId", "u32"),
        ("ExecutionCounter", "u32"),
        ("MainTaskName", "char[20]"),
        ("NumOfChildTasks", "u32"),
    ],
)

BLOCK_STATS = Layout("CFE_ES_BlockStats_t", [("BlockSize", "u64"), ("NumCreated", "u32"), ("NumFree", "u32")])
POOL_STATS = Layout(
    "CFE_ES_MemPoolStats_t",
    [
        ("PoolSize", "u64"),
        ("NumBlocksRequested", "u32"),
        ("CheckErrCtr", "u32"),
        ("NumFreeBytes", "u64"),
        ("BlockStats", (BLOCK_STATS, 17)),
    ],
)
POOL_STATS_TLM = Layout("CFE_ES_PoolStatsTlm_Payload_t", [("PoolHandle", "u32"), ("PoolStats", POOL_STATS)])

TASK_INFO = Layout(
    "CFE_ES_TaskInfo_t",
    [
        ("TaskId", "u32"),
        ("ExecutionCounter", "u32"),
        ("TaskName", "char[20]"),
        ("AppId", "u32"),
        ("AppName", "char[20]"),
        ("StackSize", "u64"),
        ("Priority", "u16"),
        ("Spare", "u8[2]"),
    ],
)

_DEBUG_VARIABLES = Layout(
    "CFE_ES_DebugVariables_t",
    [("DebugFlag", "u32"), ("WatchdogWriteFlag", "u32"), ("PrintfEnabledFlag", "u32"), ("LastAppId", "u32")],
)
ER_LOG_BASE_INFO = Layout(
    "CFE_ES_ERLog_BaseInfo_t",
    [
        ("LogEntryType", "u32"),
        ("ResetType", "u32"),
        ("ResetSubtype", "u32"),
        ("BootSource", "u32"),
        ("ProcessorResetCount", "u32"),
        ("MaxProcessorResetCount", "u32"),
        ("DebugVars", _DEBUG_VARIABLES),
        ("TimeCode", SYS_TIME),
        ("Description", "char[80]"),
    ],
)
ER_LOG_FILE_ENTRY = Layout(
    "CFE_ES_ERLog_FileEntry_t",
    [("BaseInfo", ER_LOG_BASE_INFO), ("ContextSize", "u32"), ("AppID", "u32"), ("Context", "u8[256]")],
)
CDS_REG_DUMP_RECORD = Layout(
    "CFE_ES_CDSRegDumpRec_t",
    [("Handle", "u32"), ("Size", "u64"), ("Table", "bool"), ("Name", "char[40]"), ("ByteAlignSpare", "u8[3]")],
)
PERF_METADATA = Layout(
    "CFE_ES_PerfMetaData_t",
    [
        ("Version", "u8"),
        ("Endian", "u8"),
        ("Spare", "u8[2]"),
        ("TimerTicksPerSecond", "u32"),
        ("TimerLow32Rollover", "u32"),
        ("State", "u32"),
        ("Mode", "u32"),
        ("TriggerCount", "u32"),
        ("DataStart", "u32"),
        ("DataEnd", "u32"),
        ("DataCount", "u32"),
        ("InvalidMarkerReported", "u32"),
        ("FilterTriggerMaskSize", "u32"),
        ("FilterMask", "u32[4]"),
        ("TriggerMask", "u32[4]"),
    ],
)
PERF_ENTRY = Layout("CFE_ES_PerfDataEntry_t", [("Data", "u32"), ("TimerUpper32", "u32"), ("TimerLower32", "u32")])

_RESTART = Layout("CFE_ES_RestartCmd_Payload_t", [("RestartType", ValueNames("u16", PROCESSOR=1, POWERON=2))])
_START_APP = Layout(
    "CFE_ES_StartAppCmd_Payload_t",
    [
        ("Application", "char[20]"),
        ("AppEntryPoint", "char[20]"),
        ("AppFileName", "char[64]"),
        ("StackSize", "u64"),
        ("ExceptionAction", EXCEPTION_ACTIONS),
        ("Priority", "u16"),
    ],
)
_APP_NAME = Layout("CFE_ES_AppNameCmd_Payload_t", [("Application", "char[20]")])
_APP_RELOAD = Layout("CFE_ES_AppReloadCmd_Payload_t", [("Application", "char[20]"), ("AppFileName", "char[64]")])
_FILE_NAME = Layout("CFE_ES_FileNameCmd_Payload_t", [("FileName", "char[64]")])
_LOG_MODE = Layout("CFE_ES_OverWriteSysLogCmd_Payload_t", [("Mode", LOG_MODES)])
_START_PERF = Layout("CFE_ES_StartPerfCmd_Payload_t", [("TriggerMode", PERF_MODES)])
_STOP_PERF = Layout("CFE_ES_StopPerfCmd_Payload_t", [("DataFileName", "char[64]")])
_FILTER_MASK = Layout("CFE_ES_SetPerfFilterMaskCmd_Payload_t", [("FilterMaskNum", "u32"), ("FilterMask", "u32")])
_TRIGGER_MASK = Layout("CFE_ES_SetPerfTrigMaskCmd_Payload_t", [("TriggerMaskNum", "u32"), ("TriggerMask", "u32")])
_MAX_PR_COUNT = Layout("CFE_ES_SetMaxPRCountCmd_Payload_t", [("MaxPRCount", "u16")])
_CDS_NAME = Layout("CFE_ES_DeleteCDSCmd_Payload_t", [("CdsName", "char[40]")])
_POOL = Layout("CFE_ES_SendMemPoolStatsCmd_Payload_t", [("Application", "char[20]"), ("PoolHandle", "u32")])
_DUMP_FILE = Layout("CFE_ES_DumpCDSRegistryCmd_Payload_t", [("DumpFilename", "char[64]")])


def _command(name: str, code: int, text: str, payload: Layout = NO_PAYLOAD) -> Command:
    return Command(f"CFE_ES_{name}", CMD_MID, code, payload, text)


NOOP = _command("NOOP", 0, "Report the versions in an event, without any other action.")
RESET_COUNTERS = _command("RESET_COUNTERS", 1, "Set both command counters to zero.")
RESTART = _command("RESTART", 2, "Reset the processor: 1 keeps retained memory, 2 is a power-on reset.", _RESTART)
START_APP = _command("START_APP", 4, "Load an application and start it.", _START_APP)
STOP_APP = _command("STOP_APP", 5, "End an application and clean up after it.", _APP_NAME)
RESTART_APP = _command("RESTART_APP", 6, "End an application and start it again.", _APP_NAME)
RELOAD_APP = _command("RELOAD_APP", 7, "End an application and start it again from another file.", _APP_RELOAD)
QUERY_ONE = _command("QUERY_ONE", 8, "Send a packet about an application or a library.", _APP_NAME)
QUERY_ALL = _command("QUERY_ALL", 9, "Write a file about all applications and libraries.", _FILE_NAME)
CLEAR_SYS_LOG = _command("CLEAR_SYS_LOG", 10, "Empty the system log.")
WRITE_SYS_LOG = _command("WRITE_SYS_LOG", 11, "Write the system log to a file.", _FILE_NAME)
CLEAR_ER_LOG = _command("CLEAR_ER_LOG", 12, "Empty the exception and reset log.")
WRITE_ER_LOG = _command("WRITE_ER_LOG", 13, "Write the exception and reset log to a file.", _FILE_NAME)
START_PERF_DATA = _command("START_PERF_DATA", 14, "Begin to collect performance data.", _START_PERF)
STOP_PERF_DATA = _command("STOP_PERF_DATA", 15, "Stop collecting and write the data to a file.", _STOP_PERF)
SET_PERF_FILTER_MASK = _command(
    "SET_PERF_FILTER_MASK", 16, "Choose which of 32 performance ids are recorded.", _FILTER_MASK
)
SET_PERF_TRIGGER_MASK = _command(
    "SET_PERF_TRIGGER_MASK", 17, "Choose which of 32 performance ids are triggers.", _TRIGGER_MASK
)
OVER_WRITE_SYS_LOG = _command(
    "OVER_WRITE_SYS_LOG", 18, "Set whether a full system log overwrites or discards lines.", _LOG_MODE
)
RESET_PR_COUNT = _command("RESET_PR_COUNT", 19, "Set the count of processor resets to zero.")
SET_MAX_PR_COUNT = _command(
    "SET_MAX_PR_COUNT", 20, "Set how many processor resets there may be before a power-on reset.", _MAX_PR_COUNT
)
DELETE_CDS = _command("DELETE_CDS", 21, "Delete a block of the critical data store.", _CDS_NAME)
SEND_MEM_POOL_STATS = _command("SEND_MEM_POOL_STATS", 22, "Send a packet about a memory pool.", _POOL)
DUMP_CDS_REGISTRY = _command(
    "DUMP_CDS_REGISTRY", 23, "Write the registry of the critical data store to a file.", _DUMP_FILE
)
QUERY_ALL_TASKS = _command("QUERY_ALL_TASKS", 24, "Write a file about all tasks.", _FILE_NAME)
SEND_HK = Command("CFE_ES_SEND_HK", SEND_HK_MID, text="Send the housekeeping packet.")

COMMANDS: tuple[Command, ...] = (
    NOOP,
    RESET_COUNTERS,
    RESTART,
    START_APP,
    STOP_APP,
    RESTART_APP,
    RELOAD_APP,
    QUERY_ONE,
    QUERY_ALL,
    CLEAR_SYS_LOG,
    WRITE_SYS_LOG,
    CLEAR_ER_LOG,
    WRITE_ER_LOG,
    START_PERF_DATA,
    STOP_PERF_DATA,
    SET_PERF_FILTER_MASK,
    SET_PERF_TRIGGER_MASK,
    OVER_WRITE_SYS_LOG,
    RESET_PR_COUNT,
    SET_MAX_PR_COUNT,
    DELETE_CDS,
    SEND_MEM_POOL_STATS,
    DUMP_CDS_REGISTRY,
    QUERY_ALL_TASKS,
    SEND_HK,
)

HK_TLM = Telemetry("CFE_ES_HK_TLM", HK_TLM_MID, HOUSEKEEPING, "Housekeeping of Executive Services.")
APP_TLM = Telemetry("CFE_ES_APP_TLM", APP_TLM_MID, APP_INFO, "One application or library.")
MEMSTATS_TLM = Telemetry("CFE_ES_MEMSTATS_TLM", MEMSTATS_TLM_MID, POOL_STATS_TLM, "One memory pool.")

TELEMETRY: tuple[Telemetry, ...] = (HK_TLM, APP_TLM, MEMSTATS_TLM)
