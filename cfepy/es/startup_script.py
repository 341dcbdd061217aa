"""The startup script, cfe_es_startup.scr: the libraries and apps that a mission starts, read byte for byte as cFE does.

It replaces the reading half of CFE_ES_StartApplications and CFE_ES_ParseFileEntry. To cFE the file is a stream: blanks
and newlines are dropped, "," ends a field, ";" ends an entry, and the first "!" ends the file. There are no comments
before that. So entries often mean something else than their author intended. Every entry carries its first line number
and an explanation, in addition to the text of cFE's own system log.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from typing import NamedTuple

from cfepy.config.versions import DEFAULT_RELEASE, RELEASES
from cfepy.fs import FileCategory, parse_input_file_name
from cfepy.reading.suggestions import did_you_mean
from cfepy.status import CFE_ES_BAD_ARGUMENT, CFE_ES_ERR_APP_CREATE, CfeError

CFE_APP = "CFE_APP"
CFE_LIB = "CFE_LIB"
KINDS = (CFE_APP, CFE_LIB)

EXCEPTION_RESTART_APP = 0
EXCEPTION_PROC_RESTART = 1

MAX_TOKENS = 8
LONGEST = RELEASES[DEFAULT_RELEASE].longest_entry
MAX_NAME_LEN = 20
MAX_TASK_PRIORITY = 255

_ULONG_MAX = (1 << 64) - 1
_DROPPED = bytes([*range(0x21), *range(0x80, 0x100)])
"""Bytes that are not above " " as a signed char: blanks and control characters, and on x86 all bytes beyond ASCII."""

_NUMBER = re.compile(r"([+-]?)(0[xX][0-9a-fA-F]+|[0-9]+)")
_PLAIN_NUMBER = re.compile(r"0[xX][0-9a-fA-F]+|0|[1-9][0-9]*")
_PARSE = "CFE_ES_ParseFileEntry: "
_START = "CFE_ES_StartApplications: "


@dataclass(frozen=True, slots=True)
class StartupEntry:
    """A library or an app to start.

    Attributes:
        kind: CFE_APP or CFE_LIB.
        file: the file as written.
        path: the file with default directory and extension, as cFE names it: "/cf/hk.so".
        symbol: the entry function.
        name: its name in cFE.
        priority: 0 (most urgent) to 255.
        stack_size: bytes.
        exception_action: EXCEPTION_RESTART_APP or EXCEPTION_PROC_RESTART.
        number: number of the entry in the script, from 1; cFE calls it the file's line.
        line: the line of text where it begins, from 1.
        log_text: the line of cFE's system log before the start.
    """

    kind: str
    file: str
    path: str
    symbol: str
    name: str
    priority: int
    stack_size: int
    exception_action: int
    number: int
    line: int
    log_text: str


@dataclass(frozen=True, slots=True)
class BadLine:
    """An invalid entry, which starts nothing.

    Attributes:
        number: number of the entry in the script, from 1.
        line: the line of text where it begins, from 1.
        log_texts: the lines of cFE's system log.
        explanation: the mistake and the remedy.
        status: the result of CFE_ES_ParseFileEntry.
        source: the entry without blanks.
    """

    number: int
    line: int
    log_texts: tuple[str, ...]
    explanation: str
    status: int
    source: str


@dataclass(frozen=True, slots=True)
class Note:
    """A probable mistake in a script.

    Attributes:
        line: the line of text, from 1.
        explanation: the mistake and the remedy.
        is_warning: whether the entry starts an app or library nevertheless.
    """

    line: int
    explanation: str
    is_warning: bool = False


class _Raw(NamedTuple):
    number: int
    line: int
    text: str
    ended: bool
    dropped: bool


def parse(data: bytes, longest: int = LONGEST) -> Iterator[StartupEntry | BadLine]:
    """Yield the entries of a startup script in order, one result for each ";". It never fails.

    Args:
        data: the file.
        longest: maximum number of characters in an entry for this release of cFE.
    """
    for raw in _split(data):
        if raw.ended:
            yield _parse_entry(raw, longest)


def entries(data: bytes, longest: int = LONGEST) -> list[StartupEntry]:
    """Return the entries of a startup script that are valid, in order.

    Args:
        data: the file.
        longest: maximum number of characters in an entry for this release of cFE.
    """
    return [entry for entry in parse(data, longest) if isinstance(entry, StartupEntry)]


def check(data: bytes, longest: int = LONGEST) -> list[Note]:
    """Return all probable mistakes in a script, including those that cFE accepts silently.

    Args:
        data: the file.
        longest: maximum number of characters in an entry for this release of cFE.
    """
    found: list[Note] = []
    for raw in _split(data):
        found += [Note(raw.line, error) for error in _errors_in(raw, longest)]
        found += [Note(raw.line, text, is_warning=True) for text in _remarks(raw, longest)]
    return found


def strtoul(text: str) -> int:
    """Convert like C's strtoul with base 0 and 64 bits: "0x1F" is 31, "017" is 15, garbage is 0, overflow is the
    largest number.
    """
    match = _NUMBER.match(text)
    if match is None:
        return 0
    sign, digits = match.groups()
    value = min(_magnitude(digits), _ULONG_MAX)
    return -value & _ULONG_MAX if sign == "-" and value < _ULONG_MAX else value


def _magnitude(digits: str) -> int:
    if digits[:2] in ("0x", "0X"):
        return int(digits, 16)
    if digits[0] == "0":
        return int(re.split("[89]", digits)[0] or "0", 8)
    return int(digits)


def _split(data: bytes) -> Iterator[_Raw]:
    """Yield the entries of the script; a last one without ";" has `ended` False."""
    chunks = data.partition(b"!")[0].split(b";")
    line = 1
    for number, chunk in enumerate(chunks, 1):
        ended = number < len(chunks)
        text = chunk.translate(None, _DROPPED).decode("ascii")
        start = len(chunk) - len(chunk.lstrip(_DROPPED))
        if ended or text:
            yield _Raw(number, line + chunk.count(b"\n", 0, start), text, ended, not chunk.isascii())
        line += chunk.count(b"\n")


def _parse_entry(raw: _Raw, longest: int) -> StartupEntry | BadLine:
    tokens = raw.text.split(",")
    if len(tokens) > MAX_TOKENS or len(raw.text) > longest:
        return _malformed(raw, len(tokens), longest)
    if len(tokens) < MAX_TOKENS:
        return _too_few(raw, len(tokens))
    kind, file, symbol, name = tokens[:4]
    try:
        path = parse_input_file_name(file, FileCategory.DYNAMIC_MODULE)
    except CfeError as error:
        text = f"{_PARSE}Invalid ES Startup script file name: {file}"
        return _bad(raw, _wrong_file(error), text, error.status)
    if kind not in KINDS:
        text = f"{_PARSE}Unexpected EntryType {kind} in startup file."
        return _bad(raw, _wrong_kind(kind), text, CFE_ES_ERR_APP_CREATE)
    log_text = _loading(kind, path, name)
    if len(name) >= MAX_NAME_LEN:
        return _bad(raw, _wrong_name(name), log_text, CFE_ES_BAD_ARGUMENT)
    return StartupEntry(
        kind=kind,
        file=file,
        path=path,
        symbol=symbol[: MAX_NAME_LEN - 1],
        name=name,
        priority=min(strtoul(tokens[4]), MAX_TASK_PRIORITY),
        stack_size=strtoul(tokens[5]),
        exception_action=EXCEPTION_PROC_RESTART if strtoul(tokens[7]) else EXCEPTION_RESTART_APP,
        number=raw.number,
        line=raw.line,
        log_text=log_text,
    )


def _wrong_file(error: CfeError) -> str:
    return f"the file name cannot be used: {error.text}"


def _wrong_kind(kind: str) -> str:
    return f"the first field must be {CFE_APP} or {CFE_LIB}, not {kind!r}{did_you_mean(kind, KINDS, before='; ')}"


def _wrong_name(name: str) -> str:
    length = f"must have at most {MAX_NAME_LEN - 1} characters, not {len(name)}"
    return f"the name {name!r} {length}; cFE does not report this"


def _loading(kind: str, path: str, name: str) -> str:
    if kind == CFE_LIB:
        return f"{_PARSE}Loading shared library: {path}"
    return f"{_PARSE}Loading file: {path}, APP: {name}"


def _bad(raw: _Raw, explanation: str, log_text: str, status: int = CFE_ES_BAD_ARGUMENT) -> BadLine:
    return BadLine(raw.number, raw.line, (log_text,), explanation, status, raw.text)


def _malformed(raw: _Raw, tokens: int, longest: int) -> BadLine:
    """Return the error of an entry with too many fields or characters for cFE's buffers; cFE's log counts the commas as
    "tokens".
    """
    size = len(raw.text)
    text = f"{_START}**WARNING** File Line {raw.number} is malformed: {size} bytes, {tokens - 1} tokens."
    if tokens > MAX_TOKENS:
        return _bad(raw, f"the entry must have {MAX_TOKENS} fields, not {tokens}; check for a missing ';'", text)
    return _bad(raw, f"the entry must have at most {longest} characters without blanks, not {size}", text)


def _too_few(raw: _Raw, tokens: int) -> BadLine:
    text = f"{_PARSE}Invalid ES Startup file entry: {tokens}"
    reason = f"the entry must have {MAX_TOKENS} fields, not {tokens}"
    if raw.text.startswith(("#", "//", "/*")):
        reason += "; comments are only allowed after the '!' that ends the script"
    return _bad(raw, reason, text)


def _errors_in(raw: _Raw, longest: int) -> Iterator[str]:
    """Yield the reasons why an entry is invalid. cFE itself stops at the first one."""
    if not raw.ended:
        yield f"the last entry is ignored, because its ';' is missing: {raw.text}"
        return
    entry = _parse_entry(raw, longest)
    if not isinstance(entry, BadLine):
        return
    fields = raw.text.split(",")
    if len(fields) != MAX_TOKENS or len(raw.text) > longest:
        yield entry.explanation
        return
    kind, file, _, name = fields[:4]
    try:
        parse_input_file_name(file, FileCategory.DYNAMIC_MODULE)
    except CfeError as error:
        yield _wrong_file(error)
    if kind not in KINDS:
        yield _wrong_kind(kind)
    if len(name) >= MAX_NAME_LEN:
        yield _wrong_name(name)


def _remarks(raw: _Raw, longest: int) -> Iterator[str]:
    """Yield remarks on parts of an entry that cFE interprets differently than they are written."""
    if raw.dropped:
        yield "the entry has characters that are not ASCII; cFE ignores them"
    fields = raw.text.split(",")
    if not raw.ended or len(fields) != MAX_TOKENS or len(raw.text) > longest:
        return
    entry = _parse_entry(raw, longest)
    if isinstance(entry, StartupEntry):
        yield from _remarks_on_names(entry, fields)
    yield from _remarks_on_numbers(fields)


def _remarks_on_names(entry: StartupEntry, fields: list[str]) -> Iterator[str]:
    what = "application" if entry.kind == CFE_APP else "library"
    if not entry.name:
        yield (
            f"the name of the {what} is missing: cFE starts it, but no command can "
            "address it; write a name in the fourth field"
        )
    if entry.kind == CFE_APP and entry.symbol in ("", "NULL"):
        yield (
            f"the symbol is {entry.symbol!r}: the application never runs, and the start waits for it; "
            "write a function's name in the third field"
        )
    if len(fields[2]) >= MAX_NAME_LEN:
        yield f"the symbol {fields[2]!r} is cut to {entry.symbol!r}"


def _remarks_on_numbers(fields: list[str]) -> Iterator[str]:
    for what, field in (("priority", fields[4]), ("stack size", fields[5]), ("exception action", fields[7])):
        if not _PLAIN_NUMBER.fullmatch(field):
            yield f"invalid {what} {field!r}, which cFE reads as {strtoul(field)}; write a number, such as 60 or 0x3C"
    if strtoul(fields[4]) > MAX_TASK_PRIORITY:
        yield f"the priority {fields[4]} is cut to {MAX_TASK_PRIORITY}"
    if strtoul(fields[7]) > EXCEPTION_PROC_RESTART:
        yield f"the exception action {fields[7]} is taken as {EXCEPTION_PROC_RESTART}, a reset of the processor"
