"""The messages of Table Services: message ids, function codes and payload layouts (cfe_tbl_msg.h).

Also the record of a registry dump file. Imports only cfepy.msg.
"""

from __future__ import annotations

from cfepy.msg import Layout, local_cmd_topic_id_to_msg_id, local_tlm_topic_id_to_msg_id

CMD_MID = local_cmd_topic_id_to_msg_id(0x04)
SEND_HK_MID = local_cmd_topic_id_to_msg_id(0x0C)
HK_TLM_MID = local_tlm_topic_id_to_msg_id(0x04)
REG_TLM_MID = local_tlm_topic_id_to_msg_id(0x0C)

NOOP_CC = 0
RESET_COUNTERS_CC = 1
LOAD_CC = 2
DUMP_CC = 3
VALIDATE_CC = 4
ACTIVATE_CC = 5
DUMP_REGISTRY_CC = 6
SEND_REGISTRY_CC = 7
DELETE_CDS_CC = 8
ABORT_LOAD_CC = 9

INACTIVE_BUFFER = 0
ACTIVE_BUFFER = 1
"""Which image a dump or validate command means (CFE_TBL_BufferSelect_Enum_t)."""

FULL_NAME_SIZE = 40
PATH_SIZE = 64
OWNER_NAME_SIZE = 20

_FULL_NAME = f"char[{FULL_NAME_SIZE}]"
_PATH = f"char[{PATH_SIZE}]"
_OWNER = f"char[{OWNER_NAME_SIZE}]"

SYS_TIME = Layout("CFE_TIME_SysTime", [("Seconds", "u32"), ("Subseconds", "u32")])

FILE_COMMAND = Layout("CFE_TBL_LoadCmd_Payload", [("Filename", _PATH)])
"""LOAD and DUMP_REGISTRY."""

NAME_COMMAND = Layout("CFE_TBL_ActivateCmd_Payload", [("TableName", _FULL_NAME)])
"""ACTIVATE, SEND_REGISTRY, DELETE_CDS and ABORT_LOAD."""

DUMP_COMMAND = Layout(
    "CFE_TBL_DumpCmd_Payload", [("ActiveTableFlag", "u16"), ("TableName", _FULL_NAME), ("DumpFilename", _PATH)]
)
VALIDATE_COMMAND = Layout("CFE_TBL_ValidateCmd_Payload", [("ActiveTableFlag", "u16"), ("TableName", _FULL_NAME)])
NOTIFY_COMMAND = Layout("CFE_TBL_NotifyCmd_Payload", [("Parameter", "u32")])

HOUSEKEEPING = Layout(
    "CFE_TBL_HousekeepingTlm_Payload",
    [
        ("CommandCounter", "u8"),
        ("CommandErrorCounter", "u8"),
        ("NumTables", "u16"),
        ("NumLoadPending", "u16"),
        ("ValidationCounter", "u16"),
        ("LastValCrc", "u32"),
        ("LastValStatus", "i32"),
        ("ActiveBuffer", "bool"),
        ("LastValTableName", _FULL_NAME),
        ("SuccessValCounter", "u8"),
        ("FailedValCounter", "u8"),
        ("NumValRequests", "u8"),
        ("NumFreeSharedBufs", "u8"),
        ("ByteAlignPad1", "u8"),
        ("MemPoolHandle", "u32"),
        ("LastUpdateTime", SYS_TIME),
        ("LastUpdatedTable", _FULL_NAME),
        ("LastFileLoaded", _PATH),
        ("LastFileDumped", _PATH),
        ("LastTableLoaded", _FULL_NAME),
    ],
)

REGISTRY_PACKET = Layout(
    "CFE_TBL_TblRegPacket_Payload",
    [
        ("Size", "u64"),
        ("Crc", "u32"),
        ("ActiveBufferAddr", "u64"),
        ("InactiveBufferAddr", "u64"),
        ("ValidationFuncPtr", "u64"),
        ("TimeOfLastUpdate", SYS_TIME),
        ("FileTime", SYS_TIME),
        ("TableLoadedOnce", "bool"),
        ("LoadPending", "bool"),
        ("DumpOnly", "bool"),
        ("DoubleBuffered", "bool"),
        ("Name", _FULL_NAME),
        ("LastFileLoaded", _PATH),
        ("OwnerAppName", _OWNER),
        ("Critical", "bool"),
        ("ByteAlign4", "u8"),
    ],
)

REGISTRY_RECORD = Layout(
    "CFE_TBL_RegDumpRec",
    [
        ("Size", "u64"),
        ("TimeOfLastUpdate", SYS_TIME),
        ("NumUsers", "u32"),
        ("LoadInProgress", "i32"),
        ("FileTime", SYS_TIME),
        ("Crc", "u32"),
        ("ValidationFunc", "bool"),
        ("TableLoadedOnce", "bool"),
        ("LoadPending", "bool"),
        ("DumpOnly", "bool"),
        ("DoubleBuffered", "bool"),
        ("Name", _FULL_NAME),
        ("LastFileLoaded", _PATH),
        ("OwnerAppName", _OWNER),
        ("CriticalTable", "bool"),
    ],
)


def sys_time(time: tuple[int, int]) -> dict[str, int]:
    """A time (seconds, subseconds of 2**-32 s) as the fields of SYS_TIME."""
    return {"Seconds": time[0], "Subseconds": time[1]}
