"""Synchronizers: one message of each of several filters at a time, with equal or nearly equal stamps."""

from __future__ import annotations

import itertools
import threading
from collections.abc import Sequence
from typing import Any

import rospy

from ._filters import SimpleFilter, stamp_of
from ._match_record import MatchRecord

Queue = dict[Any, Any]
"""Messages of one filter by stamp, in the order in which they came."""


class TimeSynchronizer(SimpleFilter):
    """Passes on messages with the same stamp, one from each filter, as soon as the set is complete.

    Args:
        fs: the filters.
        queue_size: how many messages of each wait; the oldest stamp is dropped first.
        reset: forget a filter's messages when simulated time jumps back.
    """

    def __init__(self, fs: Sequence[SimpleFilter], queue_size: int, reset: bool = False) -> None:
        super().__init__()
        self.queue_size = queue_size
        self.lock = threading.Lock()
        self.enable_reset = reset
        self.connectInput(fs)

    def connectInput(self, fs: Sequence[SimpleFilter]) -> None:
        """Take the messages of some filters."""
        self.queues: list[Queue] = [{} for _ in fs]
        self.latest_stamps = [rospy.Time(0) for _ in fs]
        self.__record__ = MatchRecord(self, fs)
        self.input_connections = [
            each.registerCallback(self.add, queue, index)
            for index, (each, queue) in enumerate(zip(fs, self.queues, strict=True))
        ]

    def add(self, msg: Any, my_queue: Queue, my_queue_index: int | None = None) -> None:
        """A message came.

        Args:
            msg: the message.
            my_queue: of the filter that it came from.
            my_queue_index: that queue's place.
        """
        with self.lock:
            behind = self.__follow_clock__(my_queue, my_queue_index)
            self.__keep__(msg, msg.header.stamp, my_queue, my_queue_index)
            if behind:
                return
            for stamp in sorted(set(self.queues[0]).intersection(*self.queues[1:])):
                self.__emit__([stamp] * len(self.queues))

    def __follow_clock__(self, queue: Queue, index: int | None) -> bool:
        """Detect that simulated time jumped back. Returns whether other filters have yet to detect it."""
        if not self.enable_reset or rospy.rostime.is_wallclock():
            return False
        now = rospy.Time.now()
        if index is not None:
            if now < self.latest_stamps[index]:
                rospy.logdebug("Detected jump back in time. Clearing message filter queue")
                queue.clear()
            self.latest_stamps[index] = now
        return bool(max(self.latest_stamps) != now)

    def __keep__(self, msg: Any, stamp: Any, queue: Queue, index: int | None) -> None:
        queue[stamp] = msg
        self.__record__.count(index, stamp, self.queues)
        while len(queue) > self.queue_size:
            oldest = min(queue)
            del queue[oldest]
            self.__record__.drop(index, oldest)

    def __emit__(self, stamps: Sequence[Any]) -> None:
        """Pass on the messages with these stamps, one for each queue, and forget them."""
        self.__record__.matches += 1
        pairs = list(zip(self.queues, stamps, strict=True))
        self.signalMessage(*(queue[stamp] for queue, stamp in pairs))
        for queue, stamp in pairs:
            del queue[stamp]


class ApproximateTimeSynchronizer(TimeSynchronizer):
    """Passes on messages whose stamps differ by less than a slop, one from each filter.

    Args:
        fs: the filters.
        queue_size: how many messages of each wait.
        slop: in s.
        allow_headerless: use the time of arrival for messages without a header.
        reset: forget a filter's messages when simulated time jumps back.
    """

    def __init__(
        self,
        fs: Sequence[SimpleFilter],
        queue_size: int,
        slop: float,
        allow_headerless: bool = False,
        reset: bool = False,
    ) -> None:
        super().__init__(fs, queue_size, reset)
        self.slop = rospy.Duration.from_sec(slop)
        self.allow_headerless = allow_headerless
        self.last_added = rospy.Time()

    def add(self, msg: Any, my_queue: Queue, my_queue_index: int | None = None) -> None:
        """Add a message; see `TimeSynchronizer.add`."""
        stamp = stamp_of(msg, self.allow_headerless)
        if stamp is None:
            self.__record__.refuse(my_queue_index)
            return
        with self.lock:
            behind = self.__follow_clock__(my_queue, my_queue_index)
            self.__keep__(msg, stamp, my_queue, my_queue_index)
            self.__forget_the_future()
            if not behind:
                self.__match(stamp, my_queue_index)

    def __forget_the_future(self) -> None:
        now = rospy.Time.now()
        if now < self.last_added:
            rospy.loginfo("ApproximateTimeSynchronizer: Detected jump back in time. Clearing buffer.")
            for queue in self.queues:
                queue.clear()
        self.last_added = now

    def __match(self, stamp: Any, index: int | None) -> None:
        """Pass on the messages that lie nearest to a new one, if there is one in each of the other queues."""
        candidates = [self.__near(stamp, queue) for queue in self.queues]
        if index is not None:
            candidates[index] = [stamp]
        for stamps in itertools.product(*candidates):
            complete = all(each in queue for queue, each in zip(self.queues, stamps, strict=True))
            if complete and max(stamps) - min(stamps) < self.slop:
                self.__emit__(stamps)
                return

    def __near(self, stamp: Any, queue: Queue) -> list[Any]:
        """Return the stamps in a queue that differ by at most the slop, nearest first."""
        near = [each for each in queue if abs(each - stamp) <= self.slop]
        return sorted(near, key=lambda each: abs(each - stamp))
