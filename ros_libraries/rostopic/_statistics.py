"""Statistics of messages: rate, delay and size, as in `rostopic hz`, `delay` and `bw`."""

from __future__ import annotations

import math
import threading
import time
from collections.abc import Callable, Sequence
from typing import Any

import rospy

_MOST = 50000  # messages in a window without a limit

Figures = tuple[float, float, float, float, int]
"""A mean or a rate, least, most, standard deviation, number of messages."""


def _figures(values: Sequence[float]) -> tuple[float, float, float, float]:
    mean = sum(values) / len(values)
    deviation = math.sqrt(sum((value - mean) ** 2 for value in values) / len(values))
    return mean, min(values), max(values), deviation


class _Series:
    """Messages of one topic: the time of the first and the last one, and the intervals between them."""

    def __init__(self) -> None:
        self.first = -1.0
        self.last = 0.0
        self.shown = 0.0
        self.values: list[float] = []


class ROSTopicHz:
    """Rates of topics.

    Args:
        window_size: how many messages count; a negative number means very many.
        filter_expr: takes a message and returns whether it counts.
        use_wtime: use the wall clock.
    """

    def __init__(
        self, window_size: int, filter_expr: Callable[[Any], Any] | None = None, use_wtime: bool = False
    ) -> None:
        self.lock = threading.Lock()
        self.window_size = window_size if window_size >= 0 else _MOST
        self.filter_expr = filter_expr
        self.use_wtime = use_wtime
        self._series: dict[str | None, _Series] = {}

    def _of(self, topic: str | None) -> _Series:
        return self._series.setdefault(topic, _Series())

    @property
    def times(self) -> list[float]:
        """Times between messages, in seconds, when there is one topic."""
        return self._of(None).values

    def get_times(self, topic: str | None = None) -> list[float]:
        """Return times between messages, in seconds."""
        return self._of(topic).values

    def set_times(self, value: list[float], topic: str | None = None) -> None:
        """Put other times between messages in their place."""
        self._of(topic).values = value

    def get_msg_t0(self, topic: str | None = None) -> float:
        """Return the time of the first message; -1 before it."""
        return self._of(topic).first

    def set_msg_t0(self, value: float, topic: str | None = None) -> None:
        """Put another time of the first message in its place."""
        self._of(topic).first = value

    def get_msg_tn(self, topic: str | None = None) -> float:
        """Return the time of the last message."""
        return self._of(topic).last

    def set_msg_tn(self, value: float, topic: str | None = None) -> None:
        """Put another time of the last message in its place."""
        self._of(topic).last = value

    def get_last_printed_tn(self, topic: str | None = None) -> float:
        """Return the time of the message that was the last one when `get_hz` was called last."""
        return self._of(topic).shown

    def set_last_printed_tn(self, value: float, topic: str | None = None) -> None:
        """Put another one in its place."""
        self._of(topic).shown = value

    def callback_hz(self, m: Any, topic: str | None = None) -> None:
        """Count a message; callback for a subscriber."""
        if self.filter_expr is not None and not self.filter_expr(m):
            return
        with self.lock:
            now = time.time() if self.use_wtime else rospy.get_rostime().to_sec()
            series = self._of(topic)
            if now == 0:
                if series.values:
                    print("time has reset, resetting counters")
                    series.values = []
                return
            if series.first < 0 or series.first > now:
                series.first, series.values = now, []
            else:
                series.values.append(now - series.last)
            series.last = now
            if len(series.values) > self.window_size - 1:
                series.values.pop(0)

    def get_hz(self, topic: str | None = None) -> Figures | None:
        """Return the rate in 1/s; shortest, longest interval and standard deviation in s; number of messages.

        Returns:
            None if there is no new message.
        """
        series = self._of(topic)
        if not series.values or series.last == series.shown:
            return None
        with self.lock:
            mean, least, most, deviation = _figures(series.values)
            series.shown = series.last
            return 1.0 / mean if mean > 0 else 0.0, least, most, deviation, len(series.values) + 1

    def print_hz(self, topics: Sequence[str | None] = (None,)) -> None:
        """Print the rates of topics, a table for several."""
        found = [(topic, figures) for topic in topics if (figures := self.get_hz(topic)) is not None]
        if not found:
            print("no new messages")
        elif len(topics) == 1:
            rate, least, most, deviation, window = found[0][1]
            print(f"average rate: {rate:.3f}\n\t{_spread(least, most, deviation, window)}")
        else:
            rows = [[str(topic), *(f"{each:.4}" for each in row[:4]), str(row[4])] for topic, row in found]
            print(_table(["topic", "rate", "min_delta", "max_delta", "std_dev", "window"], rows))


def _spread(least: float, most: float, deviation: float, window: int) -> str:
    return f"min: {least:.3f}s max: {most:.3f}s std dev: {deviation:.5f}s window: {window}"


def _table(header: list[str], rows: list[list[str]]) -> str:
    widths = [max(map(len, column)) for column in zip(header, *rows, strict=True)]
    title = "   ".join(name.center(width) for name, width in zip(header, widths, strict=True))
    body = ["   ".join(cell.ljust(width) for cell, width in zip(row, widths, strict=True)) for row in rows]
    return "\n".join([title, "=" * (sum(widths) + 3 * (len(widths) - 1)), *body, ""])


class ROSTopicDelay:
    """Age of messages at their arrival, by the time in their header.

    Args:
        window_size: how many messages count; a negative number means very many.
    """

    def __init__(self, window_size: int) -> None:
        self.lock = threading.Lock()
        self.window_size = window_size if window_size >= 0 else _MOST
        self.msg_t0 = -1.0
        self.msg_tn = 0.0
        self.last_msg_tn = 0.0
        self.delays: list[float] = []

    def callback_delay(self, msg: Any) -> None:
        """Count a message; callback for a subscriber."""
        if not msg._has_header:
            rospy.logerr("msg does not have header")
            return
        with self.lock:
            now = rospy.get_rostime().to_sec()
            if now == 0:
                if self.delays:
                    print("time has reset, resetting counters")
                    self.delays = []
                return
            if self.msg_t0 < 0 or self.msg_t0 > now:
                self.msg_t0, self.delays = now, []
            else:
                self.delays.append(now - msg.header.stamp.to_sec())
            self.msg_tn = now
            if len(self.delays) > self.window_size - 1:
                self.delays.pop(0)

    def get_delay(self) -> Figures | None:
        """Return mean, least, largest delay, standard deviation in s; number of messages.

        None if there is no new message.
        """
        if self.msg_tn == self.last_msg_tn or not self.delays:
            return None
        with self.lock:
            self.last_msg_tn = self.msg_tn
            return (*_figures(self.delays), len(self.delays) + 1)

    def print_delay(self) -> None:
        """Print the delays."""
        if not self.delays:
            return
        found = self.get_delay()
        if found is None:
            print("no new messages")
        else:
            print(f"average delay: {found[0]:.3f}\n\t{_spread(*found[1:])}")


class ROSTopicBandwidth:
    """How many bytes come.

    Args:
        window_size: how many messages count.
    """

    def __init__(self, window_size: int | None = 100) -> None:
        self.lock = threading.Lock()
        self.window_size = window_size or 100
        self.times: list[float] = []
        self.sizes: list[int] = []

    def callback(self, data: Any) -> None:
        """Count a message, given as an AnyMsg; callback for a subscriber."""
        with self.lock:
            self.times.append(time.time())
            self.sizes.append(len(data._buff))
            if len(self.times) > self.window_size:
                self.times.pop(0)
                self.sizes.pop(0)

    def _get_bw(self) -> tuple[float, float, int, int, int] | None:
        """Return bytes per second; mean, least, largest size; number of messages. None before the second message."""
        if len(self.times) < 2:
            return None
        with self.lock:
            count, total = len(self.times), sum(self.sizes)
            rate = total / (time.time() - self.times[0])
            return rate, total / count, min(self.sizes), max(self.sizes), count

    def print_bw(self) -> None:
        """Print the bytes per second."""
        found = self._get_bw()
        if found is None:
            return
        unit, scale = ("B", 1) if found[0] < 1e3 else ("KB", 1e3) if found[0] < 1e6 else ("MB", 1e6)
        rate, mean, least, most = (f"{each / scale:.2f}{unit}" for each in found[:4])
        print(f"average: {rate}/s\n\tmean: {mean} min: {least} max: {most} window: {found[4]}")
