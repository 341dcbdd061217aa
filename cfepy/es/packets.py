"""Message ids, function codes and packet layouts of Executive Services (default_cfe_es_msgstruct.h)."""

from __future__ import annotations

from cfepy.msg import Layout

CMD_MID = 0x1806
SEND_HK_MID = 0x1808
HK_TLM_MID = 0x0800
APP_TLM_MID = 0x080B
MEMSTATS_TLM_MID = 0x0810

NOOP_CC = 0
RESET_COUNTERS_CC = 1
RESTART_CC = 2
START_APP_CC = 4
STOP_APP_CC = 5
RESTART_APP_CC = 6
RELOAD_APP_CC = 7
QUERY_ONE_CC = 8
CLEAR_SYS_LOG_CC = 10
OVER_WRITE_SYS_LOG_CC = 18
SEND_MEM_POOL_STATS_CC = 22

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
        ("SysLogMode", "u32"),
        ("ERLogIndex", "u32"),
        ("ERLogEntries", "u32"),
        ("RegisteredCoreApps", "u32"),
        ("RegisteredExternalApps", "u32"),
        ("RegisteredTasks", "u32"),
        ("RegisteredLibs", "u32"),
        ("ResetType", "u32"),
        ("ResetSubtype", "u32"),
        ("ProcessorResets", "u32"),
        ("MaxProcessorResets", "u32"),
        ("BootSource", "u32"),
        ("PerfState", "u32"),
        ("PerfMode", "u32"),
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
        ("Type", "u32"),
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
        ("ExceptionAction", "u8"),
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

RESTART_COMMAND = Layout("CFE_ES_RestartCmd_Payload_t", [("RestartType", "u16")])
START_APP_COMMAND = Layout(
    "CFE_ES_StartAppCmd_Payload_t",
    [
        ("Application", "char[20]"),
        ("AppEntryPoint", "char[20]"),
        ("AppFileName", "char[64]"),
        ("StackSize", "u64"),
        ("ExceptionAction", "u8"),
        ("Priority", "u16"),
    ],
)
APP_NAME_COMMAND = Layout("CFE_ES_AppNameCmd_Payload_t", [("Application", "char[20]")])
APP_RELOAD_COMMAND = Layout("CFE_ES_AppReloadCmd_Payload_t", [("Application", "char[20]"), ("AppFileName", "char[64]")])
OVER_WRITE_SYS_LOG_COMMAND = Layout("CFE_ES_OverWriteSysLogCmd_Payload_t", [("Mode", "u32")])
POOL_COMMAND = Layout("CFE_ES_SendMemPoolStatsCmd_Payload_t", [("Application", "char[20]"), ("PoolHandle", "u32")])
