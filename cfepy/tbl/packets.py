"""The messages of Table Services, commands and telemetry, each declared with its layout (cfe_tbl_msg.h).

It also has the records of a registry dump file and of the critical table registry.
"""

from __future__ import annotations

from cfepy.msg import (
    NO_PAYLOAD,
    SYS_TIME,
    Command,
    Layout,
    Telemetry,
    ValueNames,
    local_cmd_topic_id_to_msg_id,
    local_tlm_topic_id_to_msg_id,
)

CMD_MID = local_cmd_topic_id_to_msg_id(0x04)
SEND_HK_MID = local_cmd_topic_id_to_msg_id(0x0C)
HK_TLM_MID = local_tlm_topic_id_to_msg_id(0x04)
REG_TLM_MID = local_tlm_topic_id_to_msg_id(0x0C)

INACTIVE_BUFFER = 0
ACTIVE_BUFFER = 1
"""The image in a dump or validate command (CFE_TBL_BufferSelect_Enum_t)."""

FULL_NAME_SIZE = 40
PATH_SIZE = 64
OWNER_NAME_SIZE = 20

_FULL_NAME = f"char[{FULL_NAME_SIZE}]"
_PATH = f"char[{PATH_SIZE}]"
_OWNER = f"char[{OWNER_NAME_SIZE}]"

BUFFERS = ValueNames("u16", INACTIVE=0, ACTIVE=1)
"""CFE_TBL_BufferSelect_Enum_t."""

_LOAD = Layout("CFE_TBL_LoadCmd_Payload_t", [("LoadFilename", _PATH)])
_DUMP = Layout(
    "CFE_TBL_DumpCmd_Payload_t", [("ActiveTableFlag", BUFFERS), ("TableName", _FULL_NAME), ("DumpFilename", _PATH)]
)
_VALIDATE = Layout("CFE_TBL_ValidateCmd_Payload_t", [("ActiveTableFlag", BUFFERS), ("TableName", _FULL_NAME)])
_TABLE_NAME = Layout("CFE_TBL_ActivateCmd_Payload_t", [("TableName", _FULL_NAME)])
_DUMP_REGISTRY = Layout("CFE_TBL_DumpRegistryCmd_Payload_t", [("DumpFilename", _PATH)])
NOTIFY_COMMAND = Layout("CFE_TBL_NotifyCmd_Payload_t", [("Parameter", "u32")])
"""The payload that `CFE_TBL_NotifyByMessage` sends to an owner."""

HOUSEKEEPING = Layout(
    "CFE_TBL_HousekeepingTlm_Payload_t",
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
    "CFE_TBL_TblRegPacket_Payload_t",
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
    "CFE_TBL_RegDumpRec_t",
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


CRITICAL_RECORD = Layout(
    "CFE_TBL_CritRegRec_t",
    [
        ("CDSHandle", "u32"),
        ("FileTime", SYS_TIME),
        ("TimeOfLastUpdate", SYS_TIME),
        ("LastFileLoaded", _PATH),
        ("Name", _FULL_NAME),
        ("TableLoadedOnce", "bool"),
    ],
)


def _command(name: str, code: int, payload: Layout, text: str) -> Command:
    return Command(f"CFE_TBL_{name}", CMD_MID, code, payload, text)


NOOP = _command("NOOP", 0, NO_PAYLOAD, "Report the version of Table Services in an event.")
RESET_COUNTERS = _command("RESET_COUNTERS", 1, NO_PAYLOAD, "Set the command and validation counters to zero.")
LOAD = _command("LOAD", 2, _LOAD, "Read a table file into the inactive image of its table.")
DUMP = _command("DUMP", 3, _DUMP, "Write the active (1) or inactive (0) image of a table to a file.")
VALIDATE = _command("VALIDATE", 4, _VALIDATE, "Validate the active (1) or inactive (0) image of a table.")
ACTIVATE = _command("ACTIVATE", 5, _TABLE_NAME, "Let a table's owner switch to the validated inactive image.")
DUMP_REGISTRY = _command("DUMP_REGISTRY", 6, _DUMP_REGISTRY, "Write the registry of all tables to a file.")
SEND_REGISTRY = _command("SEND_REGISTRY", 7, _TABLE_NAME, "Send a table's registry entry with the next housekeeping.")
DELETE_CDS = _command("DELETE_CDS", 8, _TABLE_NAME, "Delete the CDS block of a critical table without an owner.")
ABORT_LOAD = _command("ABORT_LOAD", 9, _TABLE_NAME, "Abort a load.")
SEND_HK = Command("CFE_TBL_SEND_HK", SEND_HK_MID, text="Send housekeeping; also writes the dumps that are ready.")

COMMANDS: tuple[Command, ...] = (
    NOOP,
    RESET_COUNTERS,
    LOAD,
    DUMP,
    VALIDATE,
    ACTIVATE,
    DUMP_REGISTRY,
    SEND_REGISTRY,
    DELETE_CDS,
    ABORT_LOAD,
    SEND_HK,
)

HK_TLM = Telemetry("CFE_TBL_HK_TLM", HK_TLM_MID, HOUSEKEEPING, "Counters, and the tables last validated and loaded.")
REG_TLM = Telemetry("CFE_TBL_REG_TLM", REG_TLM_MID, REGISTRY_PACKET, "The registry entry of one table.")
TELEMETRY: tuple[Telemetry, ...] = (HK_TLM, REG_TLM)
