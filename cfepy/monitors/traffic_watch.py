"""Bus traffic of a run, by pipe: number of messages, first and last time, and latency.

The first half second of operation does not count: nodes find each other then, and queued messages come all at once.
"""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass

from cfepy.mission import Mission, Processor
from cfepy.monitors.observer import Observer, Sent
from cfepy.rtos import Task
from cfepy.sb import Pipe
from cfepy.units import NS_PER_S

SETTLE_NS = NS_PER_S // 2
SILENCE = 2.0  # number of periods of the observed rate without a message, at the end, that count as silence


@dataclass(slots=True)
class Arrivals:
    """Messages of one MsgId that were taken out of one pipe; times in virtual ns."""

    count: int = 0
    first_ns: int = 0
    last_ns: int = 0
    latency_ns: int = 0
    longest_ns: int = 0

    def add(self, sent_ns: int, at_ns: int) -> None:
        """Count a message."""
        if not self.count:
            self.first_ns = at_ns
        self.count += 1
        self.last_ns = at_ns
        self.latency_ns += at_ns - sent_ns
        self.longest_ns = max(self.longest_ns, at_ns - sent_ns)

    def rate_hz(self, end_ns: int) -> float:
        """Return messages per second, from first to last, or to the end of the run if they stopped before it."""
        if self.count < 2:
            return 0.0
        span_ns = self.last_ns - self.first_ns
        period_ns = span_ns / (self.count - 1)
        if end_ns - self.last_ns > SILENCE * period_ns:
            span_ns = end_ns - self.first_ns
        return (self.count - 1) * NS_PER_S / span_ns if span_ns else 0.0


class TrafficWatch(Observer):
    """Measures messages once the mission is OPERATIONAL and has settled, until the end of the run.

    Attributes:
        arrivals: times of arrival, by MsgId and pipe name.
        sent: how many messages were sent, by MsgId.
        lost: how many messages a pipe refused or dropped, by MsgId.
        end_ns: virtual time of the end of the run.
    """

    def __init__(self) -> None:
        super().__init__()
        self.arrivals: dict[int, dict[str, Arrivals]] = {}
        self.sent: Counter[int] = Counter()
        self.lost: Counter[int] = Counter()
        self.end_ns = 0
        self._is_over = False
        self._processor: Processor

    def begin(self, mission: Mission) -> None:
        super().begin(mission)
        self.arrivals.clear()
        self.sent.clear()
        self.lost.clear()

    def power_up(self, processor: Processor) -> None:
        super().power_up(processor)
        self._processor = processor

    def _counts(self, at_ns: int) -> bool:
        booted_ns = self._processor.booted
        return booted_ns is not None and at_ns >= booted_ns + SETTLE_NS and not self._is_over

    def on_send(self, sent: Sent, packet: bytes | bytearray) -> None:
        self.sent[sent.msg_id] += self._counts(sent.at_ns)

    def on_drop(self, msg_id: int, pipe: Pipe, why: str, at_ns: int) -> None:
        self.lost[msg_id] += self._counts(at_ns)

    def on_receive(self, sent: Sent | None, pipe: Pipe, task: Task, at_ns: int) -> None:
        if sent is not None and self._counts(sent.at_ns):
            self.arrivals.setdefault(sent.msg_id, {}).setdefault(pipe.name, Arrivals()).add(sent.at_ns, at_ns)

    def conclude(self) -> None:
        self._is_over = True
        self.end_ns = self._kernel.now
