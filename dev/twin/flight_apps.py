"""Ground commands of NASA's flight applications: MsgIds, function codes, and the fields behind the header.

docs/how_to/c_apps.md builds the same releases. A field is `name:format` in the letters of `struct`; `-` is padding.
"""

from __future__ import annotations

from typing import NamedTuple


class Field(NamedTuple):
    """A field of a payload."""

    name: str
    format: str


class FlightCommand(NamedTuple):
    """A command by its function code."""

    code: int
    name: str
    fields: tuple[Field, ...]


class FlightApp(NamedTuple):
    """An application's commands and telemetry.

    Attributes:
        commands_mid: MsgId of ground commands.
        housekeeping_mid: MsgId of the housekeeping request.
        wakeup_mid: MsgId of a scheduler's wakeup; 0 if there is none.
        telemetry: MsgIds that it sends.
    """

    name: str
    commands_mid: int
    housekeeping_mid: int
    wakeup_mid: int
    telemetry: tuple[int, ...]
    commands: tuple[FlightCommand, ...]


def _commands(text: str) -> tuple[FlightCommand, ...]:
    rows = (line.split() for line in text.strip().splitlines())
    return tuple(
        FlightCommand(int(code), name, tuple(Field(*field.split(":")) for field in fields))
        for code, name, *fields in rows
    )


LC = FlightApp(
    "LC",
    0x18A4,
    0x18A5,
    0x18A6,
    (0x8A7,),
    _commands("""
        0 NOOP
        1 RESET
        2 SET_LC_STATE NewLCState:H Padding:H
        3 SET_AP_STATE APNumber:H NewAPState:H
        4 SET_AP_PERM_OFF APNumber:H Padding:H
        5 RESET_AP_STATS APNumber:H Padding:H
        6 RESET_WP_STATS WPNumber:H Padding:H
    """),
)
DS = FlightApp(
    "DS",
    0x18BB,
    0x18BC,
    0,
    (0x8B8, 0x8B9, 0x8BA),
    _commands("""
        0 NOOP
        1 RESET_COUNTERS
        2 SET_APP_STATE EnableState:H Padding:H
        3 SET_FILTER_FILE Value:I FilterParmsIndex:H FileTableIndex:H
        4 SET_FILTER_TYPE Value:I FilterParmsIndex:H FilterType:H
        5 SET_FILTER_PARMS Value:I FilterParmsIndex:H Algorithm_N:H Algorithm_X:H Algorithm_O:H
        6 SET_DEST_TYPE FileTableIndex:H FileNameType:H
        7 SET_DEST_STATE FileTableIndex:H EnableState:H
        8 SET_DEST_PATH FileTableIndex:H Padding:H Pathname:64s
        9 SET_DEST_BASE FileTableIndex:H Padding:H Basename:20s
        10 SET_DEST_EXT FileTableIndex:H Padding:H Extension:8s
        11 SET_DEST_SIZE FileTableIndex:H Padding:H MaxFileSize:I
        12 SET_DEST_AGE FileTableIndex:H Padding:H MaxFileAge:I
        13 SET_DEST_COUNT FileTableIndex:H Padding:H SequenceCount:I
        14 CLOSE_FILE FileTableIndex:H Padding:H
        15 GET_FILE_INFO
        16 ADD_MID Value:I
        17 REMOVE_MID Value:I
        18 CLOSE_ALL
    """),
)
MD = FlightApp(
    "MD",
    0x1890,
    0x1891,
    0x1892,
    (0x890, 0x891, 0x892, 0x893, 0x894),
    _commands("""
        0 NOOP
        1 RESET_CNTRS
        2 START_DWELL TableMask:H Padding:H
        3 STOP_DWELL TableMask:H Padding:H
        4 JAM_DWELL TableId:H EntryId:H FieldLength:H DwellDelay:H Offset:Q SymName:64s
        5 SET_SIGNATURE TableId:H Padding:H Signature:32s
    """),
)
CF = FlightApp(
    "CF",
    0x18B3,
    0x18B4,
    0x18B5,
    (0x8B0, 0x8B3, 0x8C2, 0x8C3),
    _commands("""
        0 NOOP
        1 RESET dword:I
        2 TX_FILE cfdp_class:B keep:B chan_num:B priority:B dest_id:I src_filename:64s dst_filename:64s
        3 PLAYBACK_DIR cfdp_class:B keep:B chan_num:B priority:B dest_id:I src_filename:64s dst_filename:64s
        4 FREEZE dword:I
        5 THAW dword:I
        6 SUSPEND ts:I eid:I chan:B spare:3s
        7 RESUME ts:I eid:I chan:B spare:3s
        8 CANCEL ts:I eid:I chan:B spare:3s
        9 ABANDON ts:I eid:I chan:B spare:3s
        10 SET_PARAM value:I key:B chan_num:B spare:2s
        11 GET_PARAM key:B chan_num:B
        15 WRITE_QUEUE type:B chan:B queue:B spare:B filename:64s
        16 ENABLE_DEQUEUE dword:I
        17 DISABLE_DEQUEUE dword:I
        18 ENABLE_DIR_POLLING dword:I
        19 DISABLE_DIR_POLLING dword:I
        21 PURGE_QUEUE dword:I
        22 ENABLE_ENGINE
        23 DISABLE_ENGINE
    """),
)
HK = FlightApp(
    "HK",
    0x189A,
    0x189B,
    0x189C,
    (0x89B, 0x89C, 0x89D, 0x89E, 0x89F),
    _commands("""
        0 NOOP
        1 RESET_COUNTERS
    """),
)
SC = FlightApp(
    "SC",
    0x18A9,
    0x18AA,
    0x18AB,
    (0x8AA,),
    _commands("""
        0 NOOP
        1 RESET_COUNTERS
        2 START_ATS AtsNum:H Padding:H
        3 STOP_ATS
        4 START_RTS RtsNum:H Padding:H
        5 STOP_RTS RtsNum:H Padding:H
        6 DISABLE_RTS RtsNum:H Padding:H
        7 ENABLE_RTS RtsNum:H Padding:H
        8 SWITCH_ATS
        9 JUMP_ATS NewTime:I
        10 CONTINUE_ATS_ON_FAILURE ContinueState:B -:1x Padding:H
        11 APPEND_ATS AtsNum:H Padding:H
        12 MANAGE_TABLE Parameter:I
        13 START_RTS_GRP FirstRtsNum:H LastRtsNum:H
        14 STOP_RTS_GRP FirstRtsNum:H LastRtsNum:H
        15 DISABLE_RTS_GRP FirstRtsNum:H LastRtsNum:H
        16 ENABLE_RTS_GRP FirstRtsNum:H LastRtsNum:H
    """),
)
HS = FlightApp(
    "HS",
    0x18AE,
    0x18AF,
    0x18B0,
    (0x8AD,),
    _commands("""
        0 NOOP
        1 RESET
        2 ENABLE_APP_MON
        3 DISABLE_APP_MON
        4 ENABLE_EVENT_MON
        5 DISABLE_EVENT_MON
        6 ENABLE_ALIVENESS
        7 DISABLE_ALIVENESS
        8 RESET_RESETS_PERFORMED
        9 SET_MAX_RESETS MaxResets:H Padding:H
        10 ENABLE_CPU_HOG
        11 DISABLE_CPU_HOG
    """),
)
FM = FlightApp(
    "FM",
    0x188C,
    0x188D,
    0,
    (0x88A, 0x88B, 0x88C, 0x88D, 0x88E),
    _commands("""
        0 NOOP
        1 RESET_COUNTERS
        2 COPY_FILE Overwrite:H Source:64s Target:64s
        3 MOVE_FILE Overwrite:H Source:64s Target:64s
        4 RENAME_FILE Source:64s Target:64s
        5 DELETE_FILE Filename:64s
        7 DELETE_ALL_FILES Directory:64s
        8 DECOMPRESS_FILE Source:64s Target:64s
        9 CONCAT_FILES Source1:64s Source2:64s Target:64s
        10 GET_FILE_INFO Filename:64s FileInfoCRC:I
        11 GET_OPEN_FILES
        12 CREATE_DIRECTORY Directory:64s
        13 DELETE_DIRECTORY Directory:64s
        14 GET_DIR_LIST_FILE Directory:64s Filename:64s GetSizeTimeMode:B Spare01:3s
        15 GET_DIR_LIST_PKT Directory:64s DirListOffset:I GetSizeTimeMode:B Spare01:3s
        16 MONITOR_FILESYSTEM_SPACE
        17 SET_TABLE_STATE TableEntryIndex:I TableEntryState:I
        19 SET_PERMISSIONS FileName:64s Mode:I
    """),
)
MM = FlightApp(
    "MM",
    0x1888,
    0x1889,
    0,
    (0x887,),
    _commands("""
        0 NOOP
        1 RESET
        2 PEEK DataSize:Q MemType:I -:4x Offset:Q SymName:64s
        3 POKE DataSize:Q MemType:I Data:I Padding2:4s -:4x Offset:Q SymName:64s
        4 LOAD_MEM_WID NumOfBytes:B Padding:3s Crc:I Offset:Q SymName:64s DataArray:200s
        5 LOAD_MEM_FROM_FILE FileName:64s
        6 DUMP_MEM_TO_FILE MemType:I NumOfBytes:I Offset:Q SymName:64s FileName:64s
        7 DUMP_IN_EVENT MemType:I NumOfBytes:B Padding:3s Offset:Q SymName:64s
        8 FILL_MEM MemType:I NumOfBytes:I FillPattern:I Padding:4s Offset:Q SymName:64s
        9 LOOKUP_SYM SymName:64s
        10 SYMTBL_TO_FILE FileName:64s
        11 ENABLE_EEPROM_WRITE Bank:I
        12 DISABLE_EEPROM_WRITE Bank:I
    """),
)
CS = FlightApp(
    "CS",
    0x189F,
    0x18A0,
    0x18A1,
    (0x8A4,),
    _commands("""
        0 NOOP
        1 RESET
        2 ONE_SHOT Address:Q Size:I MaxBytesPerCycle:I
        3 CANCEL_ONE_SHOT
        4 ENABLE_ALL_CS
        5 DISABLE_ALL_CS
        6 ENABLE_CFE_CORE
        7 DISABLE_CFE_CORE
        8 REPORT_BASELINE_CFE_CORE
        9 RECOMPUTE_BASELINE_CFE_CORE
        10 ENABLE_OS
        11 DISABLE_OS
        12 REPORT_BASELINE_OS
        13 RECOMPUTE_BASELINE_OS
        14 ENABLE_EEPROM
        15 DISABLE_EEPROM
        16 REPORT_BASELINE_EEPROM EntryID:I
        17 RECOMPUTE_BASELINE_EEPROM EntryID:I
        18 ENABLE_ENTRY_EEPROM EntryID:I
        19 DISABLE_ENTRY_EEPROM EntryID:I
        20 GET_ENTRY_ID_EEPROM Address:Q
        21 ENABLE_MEMORY
        22 DISABLE_MEMORY
        23 REPORT_BASELINE_MEMORY EntryID:I
        24 RECOMPUTE_BASELINE_MEMORY EntryID:I
        25 ENABLE_ENTRY_MEMORY EntryID:I
        26 DISABLE_ENTRY_MEMORY EntryID:I
        27 GET_ENTRY_ID_MEMORY Address:Q
        28 ENABLE_TABLES
        29 DISABLE_TABLES
        30 REPORT_BASELINE_TABLE Name:40s
        31 RECOMPUTE_BASELINE_TABLE Name:40s
        32 ENABLE_NAME_TABLE Name:40s
        33 DISABLE_NAME_TABLE Name:40s
        34 ENABLE_APPS
        35 DISABLE_APPS
        36 REPORT_BASELINE_APP Name:20s
        37 RECOMPUTE_BASELINE_APP Name:20s
        38 ENABLE_NAME_APP Name:20s
        39 DISABLE_NAME_APP Name:20s
    """),
)
FLIGHT_APPS = (LC, DS, MD, CF, HK, SC, HS, FM, MM, CS)
