"""Sources of cFE 6: the headers for them, and names that cFE 7 does not have any more.

The sources are compiled with `headers/cfe6.h` in front (-include), which gives the names of cFE 6 on the functions of
cFE 7. The release is an option and is never guessed, because header structures and some functions differ.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

from cfepy.reading.input_files import text_limited
from cfepy.reading.input_limits import CMAKE_BYTES
from cfepy.reading.suggestions import expected
from cfepy.status import UsageError

CFE_6 = {"6.5": 65, "6.7": 67, "6.8": 68}
"""Releases that `--cfe` accepts, and their CFEPY_CFE_6."""
FOLDER = "cfe6"
"""The folder of the headers that only cFE 6 has, in the folder of the compiler."""
OPTION = "--cfe"
ADVICE, BUILD_WITH = "It uses names of cFE 6", "Build it with "
"""The beginnings of two sentences about a source that the compiler refused."""
REMOVED_TEXT = "was removed: "
_BOTH = "--cfe 6.5 (cFE 6.0 to 6.5) or --cfe 6.7 (cFE 6.6 and 6.7)"
_BETWEEN = f"{OPTION} 6.8"
_MOST_NAMED = 5
_LAST_OLD, _LAST = 5, 7
_SHARED = ("public_inc", "platform_inc", "mission_inc", "inc", "src")

_USES = re.compile(
    r"\b(?:CFE_SB_(?:Msg_t|MsgPtr_t|(?:TLM|CMD)_HDR_SIZE|InitMsg|RcvMsg|SendMsg|GetMsgId|GetCmdCode|SetCmdCode"
    r"|GetTotalMsgLength|MsgHdrSize|ZeroCopyGetPtr|Default_Qos)|CFE_ES_(?:APP_RUN|RegisterApp|RegisterChildTask)"
    r"|CFE_EVS_(?:INFORMATION|BINARY_FILTER)|CCSDS_(?:PriHdr_t|CmdPkt_t|TlmPkt_t|RD_\w+|WR_\w+)|OS_TaskRegister"
    r"|OS_creat|OS_opendir)\b"
    r"|\"(?:network_includes|ccsds|cfe_\w+_events|osapi-os-\w+)\.h\""
)
"""Names that show sources of cFE 6."""
_ALSO = ("boolean", "osalbool", "TRUE", "FALSE", "OS_PACK", "os_dirp_t")
"""Names of cFE 6 that others use, too; they show cFE 6 only where the compiler does not know them."""
_ONLY_65 = re.compile(r"\b(?:CFE_ES_RUNSTATUS_\w+|PriHdr|SecHdr)\b")
_ONLY_67 = re.compile(
    r"\b(?:SpacePacket|CFE_SB_(?:MsgIdToValue|ValueToMsgId|MsgId_Equal)|CFE_EVS_Event(?:Type|Filter)_\w+"
    r"|CFE_ES_RunStatus_\w+|OS_FILESTAT_\w+|OS_Directory\w+|CFE_(?:MISSION|PLATFORM)_(?:ES|EVS|SB|TBL|TIME)_\w+)\b"
)
_ONLY_68 = re.compile(
    r"\b(?:CFE_MSG_(?:Init|GetMsgId|CommandHeader_t|TelemetryHeader_t)|CFE_SB_(?:Buffer_t|ReceiveBuffer|TransmitMsg))\b"
)
"""Names of cFE 7 that cFE 6.8 has as well. Sources with them and with names of cFE 6 are of that time."""
_MSGID_FUNCTIONS = (
    "CFE_SB_(?:Subscribe(?:Ex|Local)?|Unsubscribe(?:Local)?|MsgIdToValue|IsValidMsgId)"
    "|CFE_MSG_(?:Init|SetMsgId|GetTypeFromMsgId)|CFE_TBL_NotifyByMessage"
)
_MSGID_IS_NUMBER = re.compile(
    rf"incompatible type for argument \d+ of '(?:{_MSGID_FUNCTIONS})'|'CFE_SB_MsgId_t'[^\n]* to a variable of type"
    r"|(?:invalid operands to binary|incompatible types when)[^\n]*'CFE_SB_MsgId_t'"
    r"|cfe_(?:msg|resourceid)_api\.h: No such file"
)
"""Messages of a compiler about sources in which a MsgId is a number, or that include a header of that time."""
_NOT_CODE = re.compile(r"//[^\n]*|/\*.*?\*/", re.DOTALL)
_QUOTED = re.compile(r"'(\w+)'|([\w-]+\.h): No such file")
_MESSAGE = re.compile(r"^[^\n]*(?:error|warning): [^\n]*$", re.MULTILINE)

_SHELL = "cFE 7 has no shell commands; leave this code out"
_SENDER = "cFE 7 does not record the sender of a message; put it into the packet"
_REPORTS = (
    "cFE 7 has other structures for reports of subscriptions; use CFE_SB_SingleSubscriptionTlm_t or "
    "CFE_SB_AllSubscriptionsTlm_t"
)
_GZIP = "cFE 7 does not decompress files; load them uncompressed"
_INTERRUPTS = "OSAL 7 has no functions for interrupts and exceptions; leave the call out, or use the PSP"
_PRIVATE = "this header is private to cFE; use the public functions of cfe.h"
_EXTENDED = "extended headers need a build of cFE 7 of their own; use headers of 6 bytes"
REMOVED: Sequence[tuple[re.Pattern[str], str]] = tuple(
    (re.compile(rf"\b(?:{pattern})"), advice)
    for pattern, advice in (
        (
            r"CFE_(?:MISSION_|PLATFORM_)?ES_(?:SHELL|Shell|ERR_SHELL|MAX_SHELL|DEFAULT_SHELL)\w*\b|CFE_FS_(?:ES_SHELL|SubType_ES_SHELL)\w*\b",
            _SHELL,
        ),
        (r"CFE_SB_(?:GetLastSenderId|SenderId_t|LSTSNDER_\w+)\b", _SENDER),
        (r"CFE_SB_(?:PrevSubMsg|SubRprtMsg)_(?:Payload_)?t\b", _REPORTS),
        (r"CFE_FS_(?:Decompress|IsGzFile|GetUncompressedFile|GZIP_\w+)\b", _GZIP),
        (
            r"OS_(?:ExcAttachHandler|ExcEnable|ExcDisable|FPUExc\w+|Int(?:AttachHandler|SetMask|GetMask|Ack))\b",
            _INTERRUPTS,
        ),
        (r"OS_ShMem\w+\b", "OSAL 7 has no shared memory; use a table, a queue or a memory pool"),
        (r"OS_SocketClose\b", "OSAL 7 has OS_close for sockets, too; use it"),
        (r"CFE_ES_ProcessCoreException\b", "cFE 7 leaves exceptions to the PSP; leave the call out"),
        (
            r"CCSDS_(?:APIDQHdr_t|APIDqualifiers_t|(?:RD|WR)_(?:EDS_VER|ENDIAN|PLAYBACK|SUBSYSTEM_ID|SYSTEM_ID))\b",
            _EXTENDED,
        ),
        (
            r"(?:cfe_private|cfe_es_global|cfe_es_apps|cfe_(?:es|evs|sb|tbl|time)_(?:priv|task|internal|utils)"
            r"|cfe_psp_configdata|cfe_platform_private)\.h\b",
            _PRIVATE,
        ),
    )
)
"""Names without a counterpart in cFE 7, with advice."""


@dataclass(frozen=True, slots=True)
class RemovedName:
    """A name in a source that cFE 7 has no counterpart for.

    Attributes:
        file: the source.
        line: from 1.
        name: the name.
        advice: the replacement.
    """

    file: Path
    line: int
    name: str
    advice: str

    @property
    def text(self) -> str:
        """The name and the advice."""
        return f"{self.name} {REMOVED_TEXT}{self.advice}"

    def __str__(self) -> str:
        return f"{self.file}:{self.line}: error: {self.text}"


def check_release(release: str | None) -> None:
    """Check the value of `--cfe`.

    Raises:
        UsageError: it is no release that cfepy has headers for.
    """
    if release is not None and release not in CFE_6:
        raise UsageError(f"unknown release {release!r}; {expected(release, list(CFE_6))}", field=OPTION)


def option_of(numbers: Sequence[str]) -> str | None:
    """Return the option for a release of cFE, such as ("6", "7", "0"); None if cfepy has no headers for it.

    6.7.99 are the development versions after cFE 6.7, until 7.0.0-rc4.
    """
    if not all(each.isdecimal() for each in numbers) or numbers[0] != "6" or int(numbers[1]) > _LAST:
        return None
    if int(numbers[1]) == _LAST and numbers[2:3] == ["99"]:
        return _BETWEEN
    return f"{OPTION} {'6.5' if int(numbers[1]) <= _LAST_OLD else '6.7'}"


def cfe6_flags(release: str, folder: Path) -> list[str]:
    """Return the compiler's flags for sources of cFE 6.

    Args:
        release: a key of `CFE_6`.
        folder: the folder of cfepy's headers.
    """
    header = folder / "cfepy" / "cfe6.h"
    return [f"-DCFEPY_CFE_6={CFE_6[release]}", f"-I{folder / FOLDER}", "-include", str(header)]


def neighbour_headers(folder: Path) -> list[str]:
    """Return flags for the headers of all neighbours of an application, searched last.

    The builds of cFE 6 copy the headers of all applications into one folder.

    Args:
        folder: the application's folder.
    """
    here = folder.resolve()
    rooms = dict.fromkeys((here.parent, here.parent.parent / "apps", here.parent.parent / "libs"))
    neighbours = [each for room in rooms if room.is_dir() for each in sorted(room.iterdir()) if each != here]
    found = (each / "fsw" / name for each in neighbours for name in _SHARED)
    return [f"-idirafter{each}" for each in found if each.is_dir()]


def removed_names(files: Iterable[Path]) -> Iterator[RemovedName]:
    """Yield the names of sources that cFE 7 has no counterpart for: the first place in each file."""
    for file in files:
        text = _code_of(file)
        for pattern, advice in REMOVED:
            found = pattern.search(text)
            if found is not None:
                yield RemovedName(file, text.count("\n", 0, found.start()) + 1, found.group(), advice)


def used_names(files: Iterable[Path]) -> tuple[str, Path, int] | None:
    """Return the first name of cFE 6 in sources, its file and its line; None if there is none."""
    for file in files:
        text = _code_of(file)
        found = _USES.search(text)
        if found is not None:
            return found.group().strip('"'), file, text.count("\n", 0, found.start()) + 1
    return None


def is_name_of_cfe_6(name: str) -> bool:
    """Return True if only cFE 6 has a name."""
    return _USES.fullmatch(name) is not None


def advice_about(unknown: Sequence[str], files: Iterable[Path]) -> str:
    """Return the line about names of cFE 6 that the compiler did not know in sources."""
    return f"({ADVICE}: {', '.join(unknown)}. {BUILD_WITH}{advised_option(files)}.)"


def advised_option(files: Iterable[Path]) -> str:
    """Return the option that sources of cFE 6 need, or both if their names do not tell."""
    text = "\n".join(map(_code_of, files))
    if _ONLY_68.search(text):
        return _BETWEEN
    if _ONLY_67.search(text):
        return "--cfe 6.7"
    return "--cfe 6.5" if _ONLY_65.search(text) else _BOTH


def shows_cfe_6(output: str) -> list[str]:
    """Return the names of cFE 6 that a compiler did not know.

    Args:
        output: its output, in English.
    """
    found = []
    if _MSGID_IS_NUMBER.search(output):
        found.append("a MsgId as a number")
    for line in _MESSAGE.findall(output):
        for name, header in _QUOTED.findall(line):
            if name and (name in _ALSO or is_name_of_cfe_6(name)):
                found.append(name)
            elif header and _USES.fullmatch(f'"{header}"'):
                found.append(header)
    return list(dict.fromkeys(found))[:_MOST_NAMED]


def removed_in(output: str, files: Iterable[Path]) -> list[RemovedName]:
    """Return the removed names of sources that a compiler did not know, with their places and advice."""
    unknown = {each for pair in _QUOTED.findall("\n".join(_MESSAGE.findall(output))) for each in pair if each}
    return [each for each in removed_names(files) if each.name in unknown]


def _code_of(file: Path) -> str:
    """Return a source without comments, with the same lines; empty if it cannot be read."""
    try:
        text = text_limited(file, CMAKE_BYTES, "replace")
    except (OSError, UsageError):
        return ""
    return _NOT_CODE.sub(lambda each: "\n" * each.group().count("\n"), text)
