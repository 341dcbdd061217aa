"""Allowed differences between packets or files of NASA's cFE and ours: which fields, and why. All else is compared.

Time in the headers of packets and files is left out everywhere, and so is the sequence count of events. TIME of the
real cFE enters and leaves flywheel mode when the host is slow, with an event each time.
"""

from __future__ import annotations

import re
from collections import Counter
from functools import cache

from apps import ci_lab, sample_app, to_lab
from cfepy import msg
from cfepy.es import packets as es
from cfepy.evs import packets as evs
from cfepy.fs import HEADER_SIZE, header, read_header
from cfepy.msg import TLM_HEADER_SIZE, Layout, Telemetry
from cfepy.sb import packets as sb
from cfepy.status import CfeError
from cfepy.tbl import packets as tbl
from cfepy.time import packets as time

FLYWHEEL = {("CFE_TIME", 20), ("CFE_TIME", 21)}
BUILD = re.compile(rb"(cFS Versions: |Build |Version Info: |.*No-op |.*NOOP |.*[Nn]oop |.*Initialized)")
"""Events that tell versions of the build."""
VERSIONS = re.compile(rb"Version Info: ")
"""There is one for each module whose version the build knows."""
TELEMETRY: tuple[Telemetry, ...] = (
    *(*es.TELEMETRY, *evs.TELEMETRY, *sb.TELEMETRY, *tbl.TELEMETRY, *time.TELEMETRY),
    *(*ci_lab.TELEMETRY, *sample_app.TELEMETRY, *to_lab.TELEMETRY),
)
BLANKS = {
    ("CFE_SB", 15): re.compile(rb"(size=)\d+"),
    ("CFE_SB", 21): re.compile(rb"(MsgId\()0x[0-9a-f]+"),
    ("CFE_ES", 60): re.compile(rb"(will write )\d+"),
    ("CFE_ES", 68): re.compile(rb"(written:Size=)\d+(?:,EntryCount=\d+)?"),
    ("CFE_SB", 44): re.compile(rb"()\n"),
}
"""Rows of differences.md: NASA's texts have 0, or end with a line feed; and how often tasks ran."""
CI_LAB_HK = ci_lab.packets.HK_TLM
OF_TELEMETRY = {
    "CFE_ES_HK_TLM": {
        "CFECoreChecksum": "made from the C build",
        "PerfFilterMask.*|PerfTriggerMask.*": "a fault of NASA's housekeeping, see docs/reference/differences.md",
        "Perf(DataCount|DataStart|DataEnd|TriggerCount|State|DataToWrite)": "how often tasks ran",
        "SysLog(BytesUsed|Entries)": "the lines of the boot name the build",
    },
    "CFE_EVS_HK_TLM": {
        "MessageSendCounter|LogOverflowCounter|LogFullFlag": "flywheel events are counted",
        r"AppData\[[34]\]\.AppMessageSentCounter": "flywheel events of CFE_TIME, 4th in 7.0.0 and 5th in 7.0.1",
    },
    "CFE_SB_HK_TLM": {
        "NoSubscribersCounter": "the applications start on several processors",
        "MemInUse|UnmarkedMem": "the packet that is worked on is counted",
        "MsgLimitErrorCounter": "a host that stops for a moment; MsgSendErrorCounter is compared without them",
    },
    "CFE_SB_STATS_TLM": {
        ".*MemInUse|.*SBBuffersInUse": "the packet that is worked on is counted",
        r"PipeDepthStats.*QueueDepth": "what waits at this instant",
    },
    "CFE_TBL_HK_TLM": {"LastUpdateTime.*": "a time"},
    "CFE_TBL_REG_TLM": {".*Addr|.*Ptr": "an address", "TimeOfLastUpdate.*": "a time"},
    "CFE_ES_APP_TLM": {
        ".*Address|.*Addr|.*Size": "of the module in memory",
        "AppInfo.ExecutionCounter|ExecutionCounter": "how often tasks ran",
    },
    "CFE_TIME_HK_TLM": {
        "ClockStateFlags|ClockStateAPI": "flywheel mode",
        "(SecondsMET|SubsecsMET|MET.*|Seconds|Subsecs).*": "a time",
        "(STCF.*|SecondsSTCF|SubsecsSTCF)": "a time, once the clock was set",
    },
    "CFE_TIME_DIAG_TLM": {".*": "latches and counts of times"},
    "CFE_ES_MEMSTATS_TLM": {".*": "how much memory the bus uses"},
}
LAYOUTS: dict[int, Layout] = {
    header.SUBTYPE_ES_QUERYALL: es.APP_INFO,
    header.SUBTYPE_ES_QUERYALLTASKS: es.TASK_INFO,
    header.SUBTYPE_ES_CDS_REG: es.CDS_REG_DUMP_RECORD,
    header.SUBTYPE_TBL_REG: tbl.REGISTRY_RECORD,
    header.SUBTYPE_EVS_APPDATA: evs.APP_DATA_RECORD,
    header.SUBTYPE_SB_PIPEDATA: sb.PIPE_FILE_ENTRY,
    header.SUBTYPE_SB_ROUTEDATA: sb.ROUTING_FILE_ENTRY,
    header.SUBTYPE_SB_MAPDATA: sb.MAP_FILE_ENTRY,
    header.SUBTYPE_ES_ERLOG: es.ER_LOG_FILE_ENTRY,
}
OF_RECORDS = {
    header.SUBTYPE_ES_QUERYALL: {
        ".*Address|.*Addr|.*Size": "of the module in memory",
        "ExecutionCounter": "how often tasks ran",
    },
    header.SUBTYPE_ES_QUERYALLTASKS: {"ExecutionCounter": "how often tasks ran"},
    header.SUBTYPE_TBL_REG: {".*Addr|.*Ptr": "an address", "TimeOfLastUpdate.*": "a time"},
    header.SUBTYPE_EVS_APPDATA: {"EventCount": "flywheel events"},
    header.SUBTYPE_SB_PIPEDATA: {".*QueueDepth": "what waits at this instant", "SendErrors": "a host that stops"},
    header.SUBTYPE_SB_MAPDATA: {"Index": "which application subscribed first"},
    header.SUBTYPE_ES_ERLOG: {
        "BaseInfo.TimeCode.*": "a time",
        "BaseInfo.DebugVars.*": "which application ran last",
        "AppID": "a fault of NASA's, see docs/reference/differences.md",
        "ContextSize|Context.*": "registers",
    },
    header.SUBTYPE_SB_ROUTEDATA: {"MsgCnt": "how many messages went there"},
}
IN_ANY_ORDER = (header.SUBTYPE_SB_ROUTEDATA, header.SUBTYPE_SB_MAPDATA)
"""Files of routes: the applications subscribe as they come up, on several processors."""
ONLY_HEADERS = (header.SUBTYPE_ES_PERFDATA, header.SUBTYPE_EVS_EVENTLOG)
"""Files with the run of tasks; `same_log` compares the latter: what they begin with is compared."""
STAMP = re.compile(rb"^\d{4}-\d{3}-\d\d:\d\d:\d\d\.\d{5} ")
NOT_ALIKE = re.compile(rb"(Event Log restored), .*")
"""Lines of the system log with counts of events, to which the modules' versions belong."""
LAST_OF_NAME = 115
"""The last byte of the table's name in a dump. NASA's never sets it, nor the first two words; see differences.md."""
NO_BYTES = b"\xfc" + b"\xff" * 7
"""The size of a block of the CDS that lost its bytes; see docs/reference/differences.md."""
WITHOUT_SPARES = 28
"""Bytes of the housekeeping of the CI_LAB of 7.0.1."""
MOST_FLYWHEEL = 8
"""Events of flywheel mode that a log of 20 may have, at most."""
APP_NAME, EVENT_ID, TEXT = slice(16, 36), slice(36, 38), slice(48, 170)


@cache
def _masked_cells(layout: Layout, patterns: tuple[str, ...]) -> tuple[tuple[int, int], ...]:
    return tuple(
        (cell.offset, cell.size)
        for cell in layout.cells()
        if any(re.fullmatch(pattern, cell.path) for pattern in patterns)
    )


def _masked(layout: Layout, patterns: dict[str, str], data: bytes) -> bytes:
    left = bytearray(data)
    for offset, size in _masked_cells(layout, tuple(patterns)):
        if offset + size <= len(left):
            left[offset : offset + size] = bytes(size)
    return bytes(left)


@cache
def _declared() -> dict[int, Telemetry]:
    return {each.msg_id: each for each in TELEMETRY}


def is_event(packet: bytes) -> bool:
    """Return whether a packet is an event, long or short."""
    return msg.get_msg_id(packet) in (evs.LONG_EVENT_MSG_MID, evs.SHORT_EVENT_MSG_MID)


def of_packet(packet: bytes) -> bytes | None:
    """Return the compared content of a packet, or None to leave it out."""
    declared = _declared().get(msg.get_msg_id(packet)) if len(packet) > 6 else None
    if declared is CI_LAB_HK and len(packet) == WITHOUT_SPARES:
        packet = _with_spares(packet)
    if declared is None or len(packet) != declared.length:
        return packet  # something that went up and was sent on
    if is_event(packet):
        source = (
            packet[APP_NAME].partition(b"\0")[0].decode(errors="replace"),
            int.from_bytes(packet[EVENT_ID], "little"),
        )
        if source in FLYWHEEL:
            return None
        found = BUILD.match(packet[TEXT])
        text = found[0] if found else packet[TEXT]
        if source in BLANKS:
            text = BLANKS[source].sub(rb"\1", text).rstrip(b"\0")
        return packet[:2] + packet[4:6] + packet[12:48] + text
    if declared is sb.ALLSUBS_TLM:
        return packet[:2] + packet[4:6] + _subscriptions(packet)
    if declared is sb.HK_TLM:
        packet = _without_limit_errors(packet)
    if declared is evs.HK_TLM:
        packet = _without_unused_entries(packet)
    patterns = OF_TELEMETRY.get(declared.name, {})
    return packet[:2] + packet[4:6] + _masked(declared.payload, patterns, packet[TLM_HEADER_SIZE:])


def _with_spares(packet: bytes) -> bytes:
    """Return housekeeping of the CI_LAB of 7.0.1 with the spare bytes that the one of 7.0.0 and ours have."""
    flags, counts = packet[TLM_HEADER_SIZE : TLM_HEADER_SIZE + 4], packet[TLM_HEADER_SIZE + 4 :]
    size = (CI_LAB_HK.length - 7).to_bytes(2, "big")
    return packet[:4] + size + packet[6:TLM_HEADER_SIZE] + flags + bytes(8) + counts + bytes(4)


def _without_limit_errors(packet: bytes) -> bytes:
    """Return housekeeping of SB without the count of messages that met a message limit."""
    errors = TLM_HEADER_SIZE + sb.HOUSEKEEPING.offsets["MsgSendErrorCounter"]
    limits = TLM_HEADER_SIZE + sb.HOUSEKEEPING.offsets["MsgLimitErrorCounter"]
    return packet[:errors] + bytes([packet[errors] - packet[limits] & 0xFF]) + packet[errors + 1 :]


def _without_unused_entries(packet: bytes) -> bytes:
    """Return housekeeping of EVS without unused entries. NASA's clears only the first of them."""
    size = evs.APP_TLM.size
    for at in range(TLM_HEADER_SIZE + evs.HOUSEKEEPING.offsets["AppData"], len(packet), size):
        if not any(packet[at : at + size]):
            return packet[:at].ljust(len(packet), b"\0")
    return packet


def fields_that_differ(ours: bytes, theirs: bytes) -> str:
    """Return the differing fields of two packets of a MsgId, as `of_packet` leaves them: path, our bytes, NASA's.

    Other packets give "".
    """
    declared = _declared().get(int.from_bytes(ours[:2], "big"))
    if declared is None or ours[:4] != theirs[:4] or len(ours) != 4 + declared.payload.size:
        return ""
    cells = ((each.path, slice(4 + each.offset, 4 + each.offset + each.size)) for each in declared.payload.cells())
    return ", ".join(
        f"{path} {ours[at].hex()} is {theirs[at].hex()} in NASA's" for path, at in cells if ours[at] != theirs[at]
    )


def _subscriptions(packet: bytes) -> bytes:
    """Return the entries that are in use, in any order: applications subscribe as they come up."""
    fields = sb.ALLSUBS_TLM.read(packet)
    used = sorted(each["MsgId"] for each in fields["Entry"][: fields["Entries"]])
    return repr((fields["PktSegment"], fields["TotalSegments"], fields["Entries"], used)).encode()


def of_file(data: bytes) -> bytes:
    """Return the compared content of a written file."""
    try:
        head = read_header(data)
    except CfeError:  # whatever it is, it is compared as it stands
        return data
    left = bytearray(data)
    left[24:32] = bytes(8)  # when it was made
    if head.subtype == header.SUBTYPE_TBL_IMG:
        left[HEADER_SIZE : HEADER_SIZE + 8] = bytes(8)[: len(left) - HEADER_SIZE]
        left[LAST_OF_NAME : LAST_OF_NAME + 1] = b"\0"[: len(left) - LAST_OF_NAME]
        return bytes(left[: HEADER_SIZE - 32]) + _text(left[HEADER_SIZE - 32 : HEADER_SIZE]) + bytes(left[HEADER_SIZE:])
    begin = bytes(left[: HEADER_SIZE - 32]) + _text(left[HEADER_SIZE - 32 : HEADER_SIZE])
    if head.subtype in ONLY_HEADERS:
        return begin
    if head.subtype == header.SUBTYPE_ES_SYSLOG:
        return begin + b"\n".join(log_lines(data[HEADER_SIZE:]))
    layout = LAYOUTS.get(head.subtype)
    if layout is None:
        return bytes(left)
    body, size = data[HEADER_SIZE:], layout.size
    if head.subtype == header.SUBTYPE_ES_CDS_REG:
        body = body.replace(NO_BYTES, bytes(8))
    records = [
        _masked(layout, OF_RECORDS.get(head.subtype, {}), body[at : at + size]) for at in range(0, len(body), size)
    ]
    if head.subtype in IN_ANY_ORDER:
        records.sort()
    return begin + b"".join(records)


def log_lines(text: bytes) -> list[bytes]:
    """Return the lines of a system log, without the times at their beginning."""
    lines = (STAMP.sub(b"", line) for line in text.rstrip(b"\0").split(b"\n"))
    return [NOT_ALIKE.sub(rb"\1", line) for line in lines]


def _text(field: bytes | bytearray) -> bytes:
    """Return a text up to its NUL. In NASA's headers, the bytes behind it come from the stack."""
    return bytes(field).partition(b"\0")[0].ljust(len(field), b"\0")


def logged(data: bytes) -> list[bytes]:
    """Return the events of an event log in comparable form."""
    size = TLM_HEADER_SIZE + evs.LONG_EVENT.size
    events = (of_packet(data[at : at + size]) for at in range(HEADER_SIZE, len(data), size))
    return [each for each in events if each is not None and not VERSIONS.search(each)]


def same_log(ours: bytes, theirs: bytes) -> bool:
    """Return whether two event logs agree, as far as flywheel events leave room for it.

    Flywheel events take entries, so other events may be missing. The order of two applications is nondeterministic.
    """
    mine, real = logged(ours), logged(theirs)
    both = Counter(mine) & Counter(real)
    return of_file(ours) == of_file(theirs) and both.total() >= min(len(mine), len(real)) - MOST_FLYWHEEL


def is_log(data: bytes) -> bool:
    """Return whether a file is an event log."""
    return len(data) > HEADER_SIZE and int.from_bytes(data[4:8], "big") == header.SUBTYPE_EVS_EVENTLOG
