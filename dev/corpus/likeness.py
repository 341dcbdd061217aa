"""Compare two runs of a node: everything but times, numbers of the host, and nondeterministic order must be equal.

A topic that is published repeatedly at a rate counts as the sequence of its different messages. Times are left out, and
floats count to six digits.
"""

from __future__ import annotations

import hashlib
import json
import re
from collections.abc import Iterable
from itertools import groupby
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from dev.corpus.verdict import Outcome

_COLOUR = re.compile(r"\x1b\[[0-9;]*m")
_STAMP = re.compile(r"\[(\d{9,10}\.\d+)(, \d+\.\d+)?\]")
_TIME = re.compile(r"\b\d{9,10}\.\d+\b")
_LISTED = re.compile(r"\['Traceback \(most recent call last\):.*, (?:'|\")(.*?)\\n(?:'|\")\]")
_ANONYMOUS = re.compile(r"_\d+_\d{12,13}(?!\d)")
_THREAD = re.compile(r"\bThread-\d+")
_ADDRESS = re.compile(r"0x[0-9a-f]{5,}")
_PLACE = re.compile(r"(?<![\w.])/[\w./+-]*/([\w.-]+\.py)")
_FRAMES = re.compile(r"^Traceback \(most recent call last\):\n(?:[ \t].*\n|\n)*", re.MULTILINE)


def messages(found: Iterable[Any]) -> list[Any]:
    """Return the messages of a topic without their times. Equal consecutive messages count once."""
    return [message for message, _ in groupby(plain(message) for message in found)]


def lines(text: str) -> list[str]:
    """Return a node's output without colours, times, addresses, folders and frames. Equal lines in a row count once."""
    kept = (_without_times(line) for line in _FRAMES.sub("Traceback: ", text).splitlines())
    return [line for line, _ in groupby(line for line in kept if line.strip())]


def digest(thing: Any) -> str:
    """Return a digest of eight digits."""
    return hashlib.sha256(json.dumps(thing, sort_keys=True).encode()).hexdigest()[:8]


def differences(one: Outcome, other: Outcome) -> dict[str, tuple[Any, Any]]:
    """Return the differences, by subject, with both values."""
    pairs: dict[str, tuple[Any, Any]] = {
        "status": (one.status, other.status),
        "ended itself": (one.ended_itself, other.ended_itself),
        "printed": (lines(one.out), lines(other.out)),
    }
    for name in ("kinds", "services", "answers", "params", "stimulus failed"):
        pairs[name] = (plain(one.remarks.get(name)), plain(other.remarks.get(name)))
    for topic in sorted({*one.messages, *other.messages}):
        pairs[f"{topic} messages"] = (messages(one.messages.get(topic, ())), messages(other.messages.get(topic, ())))
    found = {name: pair for name, pair in pairs.items() if pair[0] != pair[1]}
    for topic in sorted({*one.counts, *other.counts}):
        counts = one.counts.get(topic, 0), other.counts.get(topic, 0)
        if abs(counts[0] - counts[1]) > max(2, 0.15 * max(counts)):
            found[f"{topic} count"] = counts
    return found


def plain(value: Any) -> Any:
    """Return plain data without times."""
    if isinstance(value, dict):
        if value.keys() == {"secs", "nsecs"}:
            return "time" if value["secs"] > 1_000_000 else value
        return {_without_times(str(name)): plain(item) for name, item in value.items() if name != "seq"}
    if isinstance(value, list):
        return [plain(item) for item in value]
    if isinstance(value, str):
        return _without_times(value)
    return float(f"{value:.6g}") if isinstance(value, float) else value


def _without_times(text: str) -> str:
    for pattern, mark in (
        (_COLOUR, ""),
        (_STAMP, "[t]"),
        (_TIME, "t"),
        (_THREAD, "Thread-n"),
        (_ANONYMOUS, "_n"),
        (_LISTED, r"[Traceback: \1]"),
        (_ADDRESS, "0x0"),
        (_PLACE, r"\1"),
    ):
        text = pattern.sub(mark, text)
    return text.rstrip()
