"""Results of a run: everything that the driver and the node printed, as plain comparable values."""

from __future__ import annotations

import json
import re
from collections.abc import Iterable
from itertools import groupby
from typing import Any, NamedTuple

from dev.convert.stimulus.script import SECONDS
from dev.corpus.likeness import lines as log_lines
from rospy_shim.types.genpy import Duration, Message, Time
from rospy_shim.types.msgs import Library

MARK = "@ "
UNORDERED = ("visualization_msgs/InteractiveMarkerUpdate", "visualization_msgs/InteractiveMarkerInit")
"""Their arrays come in the order of a hash table."""
NEAR_S = 1000
"""A time that is no further than this from the first step is one of now."""
CUT = 120
"""Of a line of the log: the console of cfepy is no wider."""


_OF_TF2 = re.compile(r"^(Warning|Error): +(.*)\n +at line \d+ in \S+$", re.MULTILINE)
_LEVELS = {"Warning": " WARN", "Error": "ERROR"}


class Outcome(NamedTuple):
    """Results of a run.

    Attributes:
        parts: lists of observations in order, by subject, such as "topic /chatter".
        failed: whether the node ended with an error (True) or without (False); None if it kept running.
        begun_ns: start time of the node.
        base: the second of the first step.
        note: why there is nothing to compare.
    """

    parts: dict[str, list[Any]]
    failed: bool | None
    begun_ns: int = 0
    base: int = 0
    note: str = ""


def outcome_of(
    told: Iterable[str], printed: Iterable[str], library: Library, failed: bool | None, begun_ns: int = 0
) -> Outcome:
    """Return the results of a run.

    Args:
        told: lines of the driver.
        printed: lines of the node.
        library: library of the types.
        failed, begun_ns: see `Outcome`.
    """
    lines = list(told)
    rows = [json.loads(line[len(MARK) :]) for line in lines if line.startswith(MARK)]
    base = next((row[1] for row in rows if row[0] == "base"), None)
    graph = next((row[1:] for row in rows if row[0] == "graph"), None)
    if base is None or graph is None:
        others = [line for line in lines if not line.startswith(MARK)]
        return Outcome({}, failed, note=f"the driver failed: {'; '.join(others[-3:])}")
    parts: dict[str, list[Any]] = {"log": log_of(printed)}
    for name, known in zip(("publishes", "subscribes"), graph, strict=False):
        parts[name] = sorted(f"{topic} {kind}" for topic, kind in known.items())
    parts["serves"] = graph[2]
    for row in rows:
        match row:
            case ["message", topic, kind, data, _]:
                parts.setdefault(f"topic {topic}", []).append(plain(of_bytes(library, kind, data), base))
            case ["answer" | "served" as what, name, kind, data]:
                found = plain(of_bytes(library, kind, data), base) if kind else data
                parts.setdefault(f"{what} {name}", []).append(found)
    for name, seen in parts.items():
        if name.startswith("topic "):
            number(seen)
    return Outcome(parts, failed, begun_ns, base)


def of_bytes(library: Library, kind: str, data: str) -> Message:
    """Return a message from its bytes."""
    made = library.message_class(kind)()
    made.deserialize(bytes.fromhex(data))
    return made


def plain(value: Any, base: int) -> Any:
    """Return plain data. Times count from the first step, and times that belong to no step compare equal."""
    if isinstance(value, Message):
        found = {name: plain(getattr(value, name), base) for name in value.__slots__}
        if value._type in UNORDERED:
            found |= {name: sorted(each, key=str) for name, each in found.items() if isinstance(each, list)}
        return found
    if isinstance(value, Time):
        since_ns = value.to_nsec() - base * 10**9
        if abs(since_ns) > NEAR_S * 10**9:
            return f"time {value.secs}.{value.nsecs:09}"
        return f"step {since_ns / 1e9}" if since_ns % 10**7 == 0 and 0 <= since_ns <= SECONDS * 1e9 else "now"
    if isinstance(value, Duration):
        return f"duration {value.to_nsec()}"
    if isinstance(value, bytes):
        return value.hex()
    if isinstance(value, (list, tuple)):
        return [plain(each, base) for each in value]
    return value if isinstance(value, (float, int, str)) and value == value else repr(value)


def number(seen: list[Any]) -> None:
    """Headers are numbered from the first one that was seen."""
    first = None
    for message in seen:
        header = message.get("header")
        if isinstance(header, dict) and "seq" in header:
            first = int(header["seq"]) if first is None else first
            header["seq"] = int(header["seq"]) - first


def log_of(printed: Iterable[str]) -> list[str]:
    """Return the output of a node without times. log4cxx writes a question mark for each non-ASCII byte.

    Warnings and errors of tf2 bypass the log and name a line of a file. On cfepy they are log lines.
    """
    text = _OF_TF2.sub(lambda found: f"[{_LEVELS[found[1]]}] [t]: {found[2]}", "\n".join(printed))
    kept = ("".join(map(_plain_letter, line))[:CUT] for line in log_lines(text))
    return [line for line, _ in groupby(kept)]


def _plain_letter(letter: str) -> str:
    return letter if letter < "\x80" else "?" * len(letter.encode("utf-8", "surrogateescape"))
