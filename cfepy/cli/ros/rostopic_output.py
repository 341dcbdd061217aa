"""The output formats of `cfepy rostopic`: those of rostopic's echo, hz, bw and delay, and JSON."""

from __future__ import annotations

import importlib
import math
from collections.abc import Callable, Iterable, Sequence
from itertools import pairwise
from typing import Any, TextIO

from cfepy.cli.json_output import json_text
from cfepy.ground import MessageDecoder, plain, steps_of, value_at
from cfepy.mission import TopicMessage
from cfepy.status import UsageError
from cfepy.units import NS_PER_S


class Echo:
    """Shows messages as `rostopic echo` does.

    Args:
        stream: the output.
        name: the topic, with or without a field after it.
        style: "text", "json" or "csv".
        is_wanted: returns whether to show a message.
        hides: fields to omit from the text: "array", "str".
    """

    def __init__(
        self, stream: TextIO, name: str, style: str, is_wanted: Callable[[Any], Any], hides: Sequence[str] = ()
    ) -> None:
        self._stream, self._name, self._style, self._is_wanted = stream, name.rstrip("/"), style, is_wanted
        self._hides = tuple(hides)
        self._decoder = MessageDecoder()
        self._has_head = False

    def show(self, message: TopicMessage) -> bool:
        """Show a message. Returns False if it is not wanted."""
        decoded = self._decoder.decode(message)
        try:
            value = value_at(decoded, steps_of(self._name.removeprefix(message.topic)))
        except LookupError:
            return False
        if not self._is_wanted(decoded):
            return False
        show = {"text": self._text, "json": self._json, "csv": self._csv}[self._style]
        show(message, value)
        return True

    def _text(self, message: TopicMessage, value: Any) -> None:
        strify = importlib.import_module("rospy_shim.types.genpy.strify").strify_message
        text = strify(value, field_filter=self._shown_fields) if self._hides else strify(value)
        self._stream.write(f"{text}\n---\n")

    def _shown_fields(self, value: Any) -> list[str]:
        """Return the names of the fields that are not hidden."""
        hidden = {"array": lambda kind: kind.endswith("]"), "str": lambda kind: kind == "string"}
        pairs = zip(value.__slots__, value._slot_types, strict=True)
        return [name for name, kind in pairs if not any(hidden[each](kind) for each in self._hides)]

    def _json(self, message: TopicMessage, value: Any) -> None:
        record = {"topic": message.topic, "at": message.at_ns / NS_PER_S, "time": _seconds(message.stamp_ns)}
        self._stream.write(json_text({**record, "message": plain(value)}, default=list) + "\n")

    def _csv(self, message: TopicMessage, value: Any) -> None:
        cells = list(flat(value, "field"))
        if not self._has_head:
            self._has_head = True
            self._stream.write(",".join(["%time", *(name for name, _ in cells)]) + "\n")
        stamp = message.at_ns if message.stamp_ns is None else message.stamp_ns
        self._stream.write(",".join([str(stamp), *(text for _, text in cells)]) + "\n")


def flat(value: Any, name: str) -> Iterable[tuple[str, str]]:
    """Yield the numbers and texts in a message, with their names, for a table."""
    if hasattr(value, "to_nsec"):
        yield name, str(value.to_nsec())
    elif hasattr(value, "_slot_types"):
        for each in value.__slots__:
            yield from flat(getattr(value, each), f"{name}.{each}")
    elif isinstance(value, list | tuple | bytes):
        for number, each in enumerate(value):
            yield from flat(each, f"{name}{number}")
    else:
        yield name, str(int(value)) if isinstance(value, bool) else str(value)


def _seconds(ns: int | None) -> float | None:
    return None if ns is None else ns / NS_PER_S


# -- numbers -----------------------------------------------------------------------------------------------------------


class Hz:
    """The rate of messages (`rostopic hz`).

    Args:
        window: how many of the newest messages to count; None is all.
    """

    def __init__(self, window: int | None) -> None:
        self._window = window
        self._times: list[int] = []

    def show(self, message: TopicMessage) -> bool:
        """Take a message."""
        self._times.append(message.at_ns)
        return True

    def values(self) -> dict[str, float]:
        """Return rate in Hz; min, max and std_dev of the periods in s; window. Empty with less than two messages."""
        times = self._times if self._window is None else self._times[-self._window :]
        return {} if len(times) < 2 else _periods([(later - earlier) / NS_PER_S for earlier, later in pairwise(times)])

    def text(self) -> str:
        """Return the values in the format of rostopic."""
        return _rate_text("average rate", self.values(), "rate")


class Delay:
    """The age of messages on arrival, by the stamp in their header (`rostopic delay`); arguments as for `Hz`."""

    def __init__(self, window: int | None) -> None:
        self._window = window
        self._delays: list[float] = []
        self._decoder = MessageDecoder()

    def show(self, message: TopicMessage) -> bool:
        """Take a message.

        Raises:
            UsageError: it has no header.
        """
        decoded = self._decoder.decode(message)
        if not decoded._has_header:
            raise UsageError("the messages of this topic have no header", file=message.topic)
        if message.stamp_ns is not None:
            self._delays.append((message.stamp_ns - decoded.header.stamp.to_nsec()) / NS_PER_S)
        return True

    def values(self) -> dict[str, float]:
        """Return delay, min, max and std_dev in s; window. Empty without messages."""
        delays = self._delays if self._window is None else self._delays[-self._window :]
        if not delays:
            return {}
        mean = sum(delays) / len(delays)
        return {"delay": mean, **_spread(delays, mean), "window": len(delays)}

    def text(self) -> str:
        """Return the values in the format of rostopic."""
        return _rate_text("average delay", self.values(), "delay")


class Bandwidth:
    """The bytes per second (`rostopic bw`); arguments as for `Hz`."""

    def __init__(self, window: int | None) -> None:
        self._window = window
        self._seen: list[tuple[int, int]] = []

    def show(self, message: TopicMessage) -> bool:
        """Take a message."""
        self._seen.append((message.at_ns, len(message.data)))
        return True

    def values(self) -> dict[str, float]:
        """Return bandwidth in bytes/s; mean, min and max size in bytes; window. Empty with less than two messages."""
        seen = self._seen if self._window is None else self._seen[-self._window :]
        if len(seen) < 2 or seen[0][0] == seen[-1][0]:
            return {}
        sizes = [size for _, size in seen]
        total = sum(sizes)
        rate = total / ((seen[-1][0] - seen[0][0]) / NS_PER_S)
        return {
            "bandwidth": rate,
            "mean": total / len(sizes),
            "min": min(sizes),
            "max": max(sizes),
            "window": len(sizes),
        }

    def text(self) -> str:
        """Return the values in the format of rostopic."""
        values = self.values()
        if not values:
            return "no new messages"
        unit, size = next((each for each in (("B", 1e3), ("KB", 1e6)) if values["bandwidth"] < each[1]), ("MB", 1e9))
        bandwidth, mean, least, most = (
            f"{values[name] / (size / 1e3):.2f}{unit}" for name in ("bandwidth", "mean", "min", "max")
        )
        return f"average: {bandwidth}/s\n\tmean: {mean} min: {least} max: {most} window: {values['window']}"


Meter = Hz | Delay | Bandwidth


def _periods(periods: list[float]) -> dict[str, float]:
    mean = sum(periods) / len(periods)
    rate = 1.0 / mean if mean > 0 else 0.0
    return {"rate": rate, **_spread(periods, mean), "window": len(periods) + 1}


def _spread(values: list[float], mean: float) -> dict[str, float]:
    deviation = math.sqrt(sum((value - mean) ** 2 for value in values) / len(values))
    return {"min": min(values), "max": max(values), "std_dev": deviation}


def _rate_text(title: str, values: dict[str, float], name: str) -> str:
    if not values:
        return "no new messages"
    spread = f"min: {values['min']:.3f}s max: {values['max']:.3f}s std dev: {values['std_dev']:.5f}s"
    return f"{title}: {values[name]:.3f}\n\t{spread} window: {values['window']}"
