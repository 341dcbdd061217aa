"""The topics that each node of ROS 2 has by itself: /rosout with its log, /parameter_events with its parameters.

A program publishes them only while another program of ROS 2 subscribes. So they cost nothing otherwise, and /rosout of
ROS 1, which has another type, stays free for nodes of ROS 1 in the same mission.
"""

from __future__ import annotations

from collections import deque
from typing import Any, NamedTuple, Protocol

from rclpy_shim.seam.matching import Quality
from rclpy_shim.seam.topic_ends import TopicReader, TopicWriter

ROSOUT, PARAMETER_EVENTS = "/rosout", "/parameter_events"
LOG, PARAMETER_EVENT = "rcl_interfaces/Log", "rcl_interfaces/ParameterEvent"
DEPTH = 1000  # of both topics in rcl
LIFESPAN_NS = 10_000_000_000  # of a message on /rosout


class LogLine(NamedTuple):
    """One line of the log; `time_ns` is its ROS time in ns."""

    time_ns: int
    level: int
    name: str
    text: str
    file: str
    function: str
    line: int


class TopicOwner(Protocol):
    """The program whose topics they are."""

    graph: Any
    interfaces: Any

    def now_ns(self) -> int:
        """Return ROS's time in ns."""

    def own_writer(self, name: str, data_class: Any, quality: Quality) -> TopicWriter:
        """Make a publisher that is not connected yet."""


class OwnTopics:
    """/rosout and /parameter_events of one program.

    Args:
        program: the program.
    """

    def __init__(self, program: TopicOwner) -> None:
        self._program = program
        self._lines: deque[LogLine] = deque(maxlen=DEPTH)
        self._rosout: TopicWriter | None = None
        self._events: TopicWriter | None = None

    def log(self, line: LogLine) -> None:
        """Publish a line on /rosout, and keep it for subscriptions that come later."""
        self._lines.append(line)
        if self._rosout is not None:
            self._rosout.send(self._message(line))
        elif _is_read(self._program, ROSOUT):
            self.open_rosout()

    def open_rosout(self) -> None:
        """Publish /rosout from now on, with the lines of the last 10 s."""
        if self._rosout is not None or not self._lines:
            return
        self._rosout = writer = self._writer(ROSOUT, LOG, is_kept=True)
        begin = self._program.now_ns() - LIFESPAN_NS
        for line in self._lines:
            if line.time_ns >= begin:
                writer.keep(self._message(line))
        writer.connect()
        for subscription in () if writer.topic is None else writer.topic.subscriptions[:]:
            if isinstance(subscription, TopicReader):
                writer.give_latched(subscription)

    def tell_parameters(self, event: Any) -> None:
        """Publish an event on /parameter_events if a program of ROS 2 subscribes.

        Args:
            event: makes the message, rcl_interfaces/ParameterEvent.
        """
        if self._events is None:
            if not _is_read(self._program, PARAMETER_EVENTS):
                return
            self._events = self._writer(PARAMETER_EVENTS, PARAMETER_EVENT, is_kept=False)
            self._events.connect()
        self._events.send(event())

    def _writer(self, name: str, type_name: str, *, is_kept: bool) -> TopicWriter:
        quality = Quality(depth=DEPTH, is_kept=is_kept)
        return self._program.own_writer(name, self._program.interfaces.message_class(type_name), quality)

    def _message(self, line: LogLine) -> Any:
        message = self._program.interfaces.message_class(LOG)()
        message.stamp.sec, message.stamp.nanosec = divmod(line.time_ns, 10**9)
        message.level, message.name, message.msg = line.level, line.name, line.text
        message.file, message.function, message.line = line.file, line.function, line.line
        return message


def _is_read(program: TopicOwner, name: str) -> bool:
    topic = program.graph.topics.get(name)
    return topic is not None and any(isinstance(each, TopicReader) for each in topic.subscriptions)
