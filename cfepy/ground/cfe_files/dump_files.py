"""Files that cFE writes on command, as readable text; the subtype in the header gives the type of the records.

System log, exception and reset log, event log, applications, tasks, critical data store, routes, pipes, tables, and the
performance data of ES: which parts of the flight software were entered and left when, and their durations.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from typing import Any, NamedTuple

from cfepy.es import packets as es
from cfepy.es.packets import PERF_ENTRY, PERF_METADATA
from cfepy.evs import packets as evs
from cfepy.fs import CONTENT_ID, HEADER_SIZE, FileHeader, header, read_header
from cfepy.msg import TLM_HEADER_SIZE, Layout, get_msg_time
from cfepy.sb import packets as sb
from cfepy.status import CfeError, UsageError
from cfepy.tbl import packets as tbl
from cfepy.time import print_ as time_text
from cfepy.units import US_PER_S

Record = dict[str, Any]
FREE_FILTER = 0xFFFF
"""The event id of an unused filter (CFE_EVS_FREE_SLOT)."""
EXIT_BIT = 0x80000000
WHOLE_WORD = 1 << 32


class Column(NamedTuple):
    """A column of a record: title, path of the field, and format of the value."""

    title: str
    path: str
    text: Callable[[Any], str] = str


class DumpKind(NamedTuple):
    """A kind of file: its name, the size of a record in bytes, the reader of a record, and the columns to show."""

    name: str
    size: int
    read: Callable[[bytes], Record]
    columns: tuple[Column, ...]


@dataclass(slots=True)
class DumpFile:
    """A file that was read: its records, and the reason if it is incomplete.

    Attributes:
        lines: the lines of a system log.
        about: the metadata before the records of performance data.
        problem: why the file is incomplete; empty if it is complete.
    """

    kind: str
    header: FileHeader
    records: list[Record] = field(default_factory=list)
    columns: tuple[Column, ...] = ()
    lines: list[str] = field(default_factory=list)
    about: Record = field(default_factory=dict)
    problem: str = ""


# -- formats of values -------------------------------------------------------------------------------------------------
def hexadecimal(value: int) -> str:
    """Return a MsgId or another number in hexadecimal."""
    return f"0x{value:04X}"


def identifier(value: int) -> str:
    """Return a resource id."""
    return f"0x{value:08X}"


def yes(value: int) -> str:
    """Return a truth value, as short as possible."""
    return "yes" if value else "-"


def time_of(value: Record) -> str:
    """Return a time as cFE prints it."""
    return time_text((value["Seconds"], value["Subseconds"]))


def one_line(value: str) -> str:
    """Return a text that may have several lines."""
    return value.replace("\n", "\\n")


def named(*names: str) -> Callable[[Any], str]:
    """Return a format with the name of an enumeration's value, counted from 0."""
    return lambda value: names[value] if value < len(names) else str(value)


def filters(value: list[Record]) -> str:
    """Return the used event filters: id, mask, count."""
    used = (each for each in value if each["EventID"] != FREE_FILTER)
    return ", ".join(f"{each['EventID']}: 0x{each['Mask']:04X} ({each['Count']})" for each in used)


# -- the kinds ---------------------------------------------------------------------------------------------------------
def _event(data: bytes) -> Record:
    """Return a record of the event log: the packet as it was sent."""
    seconds, subseconds = get_msg_time(data)
    return {"Time": {"Seconds": seconds, "Subseconds": subseconds}, **evs.LONG_EVENT.unpack(data, TLM_HEADER_SIZE)}


def _plain(name: str, layout: Layout, *columns: Column) -> DumpKind:
    return DumpKind(name, layout.size, layout.unpack, columns)


KINDS = {
    header.SUBTYPE_ES_ERLOG: _plain(
        "exception and reset log",
        es.ER_LOG_FILE_ENTRY,
        Column("time", "BaseInfo.TimeCode", time_of),
        Column("by", "BaseInfo.LogEntryType", named("-", "core", "application")),
        Column("reset", "BaseInfo.ResetType", named("-", "processor", "power-on", "app restart")),
        Column("subtype", "BaseInfo.ResetSubtype"),
        Column("resets", "BaseInfo.ProcessorResetCount"),
        Column("most", "BaseInfo.MaxProcessorResetCount"),
        Column("AppId", "AppID", identifier),
        Column("description", "BaseInfo.Description"),
    ),
    header.SUBTYPE_ES_QUERYALL: _plain(
        "applications",
        es.APP_INFO,
        Column("id", "ResourceId", identifier),
        Column("type", "Type", named("-", "core", "external", "library")),
        Column("name", "Name"),
        Column("entry point", "EntryPoint"),
        Column("file", "FileName"),
        Column("stack", "StackSize"),
        Column("priority", "Priority"),
        Column("exception", "ExceptionAction", named("restart app", "reset")),
        Column("main task", "MainTaskName"),
        Column("cycles", "ExecutionCounter"),
        Column("children", "NumOfChildTasks"),
    ),
    header.SUBTYPE_ES_QUERYALLTASKS: _plain(
        "tasks",
        es.TASK_INFO,
        Column("id", "TaskId", identifier),
        Column("task", "TaskName"),
        Column("application", "AppName"),
        Column("AppId", "AppId", identifier),
        Column("priority", "Priority"),
        Column("stack", "StackSize"),
        Column("cycles", "ExecutionCounter"),
    ),
    header.SUBTYPE_ES_CDS_REG: _plain(
        "critical data store",
        es.CDS_REG_DUMP_RECORD,
        Column("handle", "Handle", identifier),
        Column("size", "Size"),
        Column("table", "Table", yes),
        Column("name", "Name"),
    ),
    header.SUBTYPE_TBL_REG: _plain(
        "tables",
        tbl.REGISTRY_RECORD,
        Column("name", "Name"),
        Column("size", "Size"),
        Column("CRC", "Crc", hexadecimal),
        Column("users", "NumUsers"),
        Column("loaded", "TableLoadedOnce", yes),
        Column("pending", "LoadPending", yes),
        Column("double", "DoubleBuffered", yes),
        Column("dump only", "DumpOnly", yes),
        Column("critical", "CriticalTable", yes),
        Column("owner", "OwnerAppName"),
        Column("updated", "TimeOfLastUpdate", time_of),
        Column("last file", "LastFileLoaded"),
    ),
    header.SUBTYPE_EVS_APPDATA: _plain(
        "event settings of applications",
        evs.APP_DATA_RECORD,
        Column("application", "AppName"),
        Column("active", "ActiveFlag", yes),
        Column("types", "EventTypesActiveFlag", hexadecimal),
        Column("sent", "EventCount"),
        Column("squelched", "SquelchedCount"),
        Column("filters: id: mask (count)", "Filters", filters),
    ),
    header.SUBTYPE_EVS_EVENTLOG: DumpKind(
        "event log",
        TLM_HEADER_SIZE + evs.LONG_EVENT.size,
        _event,
        (
            Column("time", "Time", time_of),
            Column("application", "PacketID.AppName"),
            Column("type", "PacketID.EventType", named("-", "DEBUG", "INFO", "ERROR", "CRITICAL")),
            Column("id", "PacketID.EventID"),
            Column("message", "Message", one_line),
        ),
    ),
    header.SUBTYPE_SB_PIPEDATA: _plain(
        "pipes",
        sb.PIPE_FILE_ENTRY,
        Column("id", "PipeId", identifier),
        Column("pipe", "PipeName"),
        Column("application", "AppName"),
        Column("depth", "MaxQueueDepth"),
        Column("now", "CurrentQueueDepth"),
        Column("peak", "PeakQueueDepth"),
        Column("send errors", "SendErrors"),
        Column("options", "Opts"),
    ),
    header.SUBTYPE_SB_ROUTEDATA: _plain(
        "routes",
        sb.ROUTING_FILE_ENTRY,
        Column("MsgId", "MsgId", hexadecimal),
        Column("pipe", "PipeName"),
        Column("application", "AppName"),
        Column("enabled", "State", yes),
        Column("messages", "MsgCnt"),
    ),
    header.SUBTYPE_SB_MAPDATA: _plain(
        "map of MsgIds", sb.MAP_FILE_ENTRY, Column("MsgId", "MsgId", hexadecimal), Column("route", "Index")
    ),
}


# -- reading -----------------------------------------------------------------------------------------------------------
def read_dump(data: bytes, file: str) -> DumpFile:
    """Return the contents of a file written by cFE; for an incomplete or damaged one, the records up to there.

    Args:
        data: its bytes.
        file: its name, for errors.

    Raises:
        UsageError: if it is not a file of cFE, or of an unsupported kind.
    """
    try:
        head = read_header(data)
    except CfeError as error:
        raise UsageError(f"is not a cFE file: {error.text}; give a file that cFE wrote", file=file) from None
    if head.content_type != CONTENT_ID:
        text = f'is not a cFE file: it begins with {data[:4].hex(" ")}, not with "cFE1"; give a file that cFE wrote'
        raise UsageError(text, file=file)
    body = data[HEADER_SIZE:]
    if head.subtype == header.SUBTYPE_ES_SYSLOG:
        text = body.partition(b"\0")[0].decode("utf-8", "replace")
        return DumpFile("system log", head, lines=text.removesuffix("\n").split("\n"))
    if head.subtype == header.SUBTYPE_ES_PERFDATA:
        about, records, problem = read_perf_data(body)
        return DumpFile("performance data", head, records, about=about, problem=problem)
    if head.subtype == header.SUBTYPE_TBL_IMG:
        raise UsageError(f"is a table file; `cfepy tbl show {file}` shows it", file=file)
    if head.subtype not in KINDS:
        raise UsageError(f"unknown subtype {head.subtype} of a cFE file", file=file)
    kind = KINDS[head.subtype]
    count, rest = divmod(len(body), kind.size)
    dump = DumpFile(kind.name, head, columns=kind.columns)
    try:
        for at in range(0, count * kind.size, kind.size):
            dump.records.append(kind.read(body[at : at + kind.size]))
    except CfeError as error:
        dump.problem = f"is damaged: record {len(dump.records)} cannot be read: {error.text}"
        return dump
    if rest:
        dump.problem = f"is truncated: record {count} has {rest} of {kind.size} bytes"
    return dump


def value_at(record: Record, path: str) -> Any:
    """Return the value of a field, "BaseInfo.TimeCode"."""
    value: Any = record
    for name in path.split("."):
        value = value[name]
    return value


@dataclass(slots=True)
class Timing:
    """Durations of a part of the code, from each entry to its exit.

    Attributes:
        taken_us: durations in us.
        open: times in us of entries without an exit yet.
        unpaired: number of exits without an entry.
    """

    taken_us: list[float] = field(default_factory=list)
    open: list[float] = field(default_factory=list)
    unpaired: int = 0


def read_perf_data(body: bytes) -> tuple[dict[str, Any], list[dict[str, Any]], str]:
    """Return the metadata, the entries in order of time, and the errors in the file.

    Args:
        body: data after the file header.
    """
    if len(body) < PERF_METADATA.size:
        return {}, [], f"is truncated: the metadata have {len(body)} of {PERF_METADATA.size} bytes"
    about = PERF_METADATA.unpack(body)
    if about["Endian"]:
        return about, [], "was written by a big-endian processor; cfepy reads only little-endian performance data"
    entries = body[PERF_METADATA.size :]
    count, rest = divmod(len(entries), PERF_ENTRY.size)
    records = [_record(PERF_ENTRY.unpack(entries, number * PERF_ENTRY.size), about) for number in range(count)]
    problem = ""
    if rest or count < about["DataCount"]:
        problem = f"is truncated: it has {count} of {about['DataCount']} entries"
    return about, records, problem


def _record(entry: dict[str, int], about: dict[str, Any]) -> dict[str, Any]:
    rollover = about["TimerLow32Rollover"] or WHOLE_WORD
    ticks = entry["TimerUpper32"] * rollover + entry["TimerLower32"]
    time_us = ticks * US_PER_S / (about["TimerTicksPerSecond"] or US_PER_S)
    return {"Id": entry["Data"] & ~EXIT_BIT, "IsExit": bool(entry["Data"] & EXIT_BIT), "TimeUs": time_us}


def timings(records: Iterable[dict[str, Any]]) -> dict[int, Timing]:
    """Return durations from entry to exit, by id; a nested entry with the same id is left first."""
    found: dict[int, Timing] = {}
    for record in records:
        timing = found.setdefault(record["Id"], Timing())
        if not record["IsExit"]:
            timing.open.append(record["TimeUs"])
        elif timing.open:
            timing.taken_us.append(record["TimeUs"] - timing.open.pop())
        else:
            timing.unpaired += 1
    return dict(sorted(found.items()))
