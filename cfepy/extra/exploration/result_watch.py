"""The results of a run that must not depend on the schedule, as the mission file selects them.

A result is kept as a digest and a short text, because the reference travels with each trial and must be small.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from hashlib import blake2b
from typing import Any, NamedTuple

from cfepy.attachment import Attachment
from cfepy.ground import plain
from cfepy.mission import Mission, MissionSpec, matches
from cfepy.monitors import Heard, MessageWatch, demands_of, short, unknown_packets
from cfepy.monitors.selected_results import (
    ANY_ORDER,
    COUNT,
    FILE,
    LAST,
    OF_MESSAGES,
    OUTPUT,
    SEQUENCE,
    SelectedResult,
)
from cfepy.sb import SoftwareBus
from cfepy.status import OsalError, UsageError

NONE = "none"


class Result(NamedTuple):
    """A result: its name, a digest of all of it, and a short text for the user."""

    name: str
    digest: str
    text: str


class ResultWatch(Attachment):
    """Collects the selected results of a run.

    Args:
        spec: the mission.

    Raises:
        UsageError: the mission has no such packet.
    """

    def __init__(self, spec: MissionSpec) -> None:
        self._selected = demands_of(spec).results
        self._messages: dict[tuple[str, str], list[str]] = {}
        self._found: list[Result] = []
        self._mission: Mission | None = None
        names = [each.name for each in self._selected if each.compare in OF_MESSAGES]
        packets = tuple(each.name for each in self._selected if each.is_of_packet)
        topics = tuple(name for name in names if name not in packets)
        try:
            self._watch = MessageWatch(spec, self._take, topics, packets)
        except UsageError as error:
            raise unknown_packets(spec, "results", [(name, name) for name in packets]) or error from None

    def bus(self, base: type[SoftwareBus]) -> type[SoftwareBus]:
        return self._watch.bus(base)

    def begin(self, mission: Mission) -> None:
        self._mission = mission
        self._watch.begin(mission)

    def conclude(self) -> None:
        """Collect the results. Messages during the shutdown of the nodes do not count."""
        self._found = [result for each in self._selected for result in self._results_of(each)]

    def results(self) -> tuple[Result, ...]:
        """Return all results in the order of the mission file; the results of a pattern by topic."""
        return tuple(self._found)

    def _take(self, heard: Heard) -> None:
        for each in self._selected:
            if each.compare in OF_MESSAGES and _is_of(each, heard.topic):
                kept = self._messages.setdefault((each.name, heard.topic), [])
                text = "" if each.compare == COUNT else _message_text(heard, each.ignore)
                if each.compare == LAST:
                    kept.clear()
                kept.append(text)

    def _results_of(self, selected: SelectedResult) -> Iterator[Result]:
        if selected.compare == FILE:
            yield _result(f"{selected.name} (file)", self._file(selected.name))
        elif selected.compare == OUTPUT:
            yield _result(f"{selected.name} (output)", self._output(selected.name))
        else:
            found = sorted((topic, texts) for (name, topic), texts in self._messages.items() if name == selected.name)
            for topic, texts in found or [(selected.name, [])]:
                yield _of_messages(topic, selected.compare, texts)

    def _file(self, path: str) -> list[str]:
        assert self._mission is not None
        try:
            node = self._mission.files.find(path)
        except OsalError:
            node = None
        return [NONE] if node is None else [bytes(node.data).decode("latin-1")]

    def _output(self, app: str) -> list[str]:
        """Return the lines that a node wrote; they begin with its name."""
        assert self._mission is not None
        config = self._mission.spec.ros.nodes.get(app)
        prefix = f"[{config.name if config is not None and config.name else app}] "
        return [line.removeprefix(prefix) for line in self._mission.console.lines if line.startswith(prefix)]


def digest_of(results: Sequence[Result]) -> str:
    """Return one digest of all results; empty when there are none."""
    return _digest([f"{each.name}={each.digest}" for each in results]) if results else ""


def differences(reference: Sequence[Result], found: Sequence[Result]) -> Iterator[tuple[str, str]]:
    """Yield (name, text) of each result that differs from the reference."""
    expected = {each.name: each for each in reference}
    for each in found:
        other = expected.pop(each.name, None)
        if other is None or other.digest != each.digest:
            yield each.name, f"{each.text}; under fifo {NONE if other is None else other.text}"
    for name, other in expected.items():
        yield name, f"{NONE}; under fifo {other.text}"


def _is_of(selected: SelectedResult, topic: str) -> bool:
    return selected.name == topic or (selected.name.startswith(("/", "*")) and matches(topic, (selected.name,)))


def _of_messages(topic: str, compare: str, texts: list[str]) -> Result:
    name = f"{topic} ({compare})"
    if compare == COUNT:
        return Result(name, str(len(texts)), f"{len(texts)} messages")
    if compare == LAST:
        return _result(name, texts or [NONE])
    result = _result(name, sorted(texts) if compare == ANY_ORDER else texts)
    last = f", the last is {short_text(texts[-1])}" if texts and compare == SEQUENCE else ""
    return result._replace(text=f"{len(texts)} messages{last} ({result.digest[:8]})")


def _result(name: str, texts: list[str]) -> Result:
    return Result(name, _digest(texts), short_text("; ".join(texts) or NONE))


def short_text(text: str) -> str:
    """Return a text, cut off if it is long."""
    return short(_Bare(text))


class _Bare(str):
    """A text whose `repr` has no quotes."""

    def __repr__(self) -> str:
        return str(self)


def _digest(texts: Sequence[str]) -> str:
    return blake2b("\0".join(texts).encode("utf-8", "surrogatepass"), digest_size=16).hexdigest()


def _message_text(heard: Heard, ignore: tuple[str, ...]) -> str:
    """Return a message as text, without the ignored fields."""
    try:
        values = plain(heard.msg)
    except UsageError as error:
        return str(error)
    return _shown(values, ignore, "")


def _shown(value: Any, ignore: tuple[str, ...], path: str) -> str:
    if isinstance(value, dict):
        items = ((f"{path}.{name}" if path else str(name), name, item) for name, item in value.items())
        return ", ".join(
            f"{name}: {_nested(item, ignore, inner)}" for inner, name, item in items if not _ignored(inner, ignore)
        )
    if isinstance(value, list | tuple):
        return f"[{', '.join(_nested(item, ignore, path) for item in value)}]"
    return repr(value)


def _nested(value: Any, ignore: tuple[str, ...], path: str) -> str:
    shown = _shown(value, ignore, path)
    return f"{{{shown}}}" if isinstance(value, dict) else shown


def _ignored(path: str, ignore: tuple[str, ...]) -> bool:
    """Return True if a field is ignored, by its path or the end of its path."""
    return any(path == each or path.endswith(f".{each}") for each in ignore)
