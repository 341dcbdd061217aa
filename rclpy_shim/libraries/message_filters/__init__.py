"""message_filters of ROS 2: subscribers, a cache, and synchronizers of messages by their stamps."""

from __future__ import annotations

import itertools
import threading
from collections.abc import Callable, Sequence
from typing import Any

from rclpy.clock import ROSClock
from rclpy.duration import Duration
from rclpy.logging import LoggingSeverity, get_logger
from rclpy.time import Time

_NO_STAMP = (
    'can not use message filters messages without timestamp infomation when "allow_headerless" is disabled. auto'
    ' assign ROSTIME to headerless messages once enabling constructor option of "allow_headerless".'
)


class SimpleFilter:
    """Base of the filters."""

    def __init__(self) -> None:
        self.callbacks: dict[int, tuple[Callable[..., Any], tuple[Any, ...]]] = {}

    def registerCallback(self, cb: Callable[..., Any], *args: Any) -> int:
        """Add a function that gets the messages of the filter, and further arguments. Returns its number."""
        number = len(self.callbacks)
        self.callbacks[number] = (cb, args)
        return number

    def signalMessage(self, *msg: Any) -> None:
        """Pass messages on."""
        for callback, arguments in self.callbacks.values():
            callback(*msg, *arguments)


class Subscriber(SimpleFilter):
    """Passes on the messages of a topic.

    Args:
        args: node, message class and name of the topic, and further arguments of `Node.create_subscription`.
        kwargs: its options; the quality of service has a depth of 10 unless `qos_profile` is given.
    """

    def __init__(self, *args: Any, **kwargs: Any) -> None:
        super().__init__()
        self.node, self.topic = args[0], args[2]
        kwargs.setdefault("qos_profile", 10)
        self.sub = self.node.create_subscription(*args[1:], self.callback, **kwargs)

    def callback(self, msg: Any) -> None:
        """Take a message."""
        self.signalMessage(msg)

    def getTopic(self) -> Any:
        """Return the topic as it was given."""
        return self.topic

    def __getattr__(self, key: str) -> Any:
        return self.sub.__getattribute__(key)


def _stamp_of(msg: Any, logger_name: str, allow_headerless: bool) -> Time | None:
    """Return the stamp of a message, or the present time if it has none and may; otherwise warn and return None."""
    if hasattr(msg, "header") and hasattr(msg.header, "stamp"):
        stamp = msg.header.stamp
        return stamp if hasattr(stamp, "nanoseconds") else Time.from_msg(stamp)
    if allow_headerless:
        return ROSClock().now()
    logger = get_logger(logger_name)
    logger.set_level(LoggingSeverity.INFO)
    logger.warning(_NO_STAMP)
    return None


class Cache(SimpleFilter):
    """Keeps the last messages, in the order in which they came.

    Args:
        f: the filter.
        cache_size: number of messages.
        allow_headerless: messages without a header get the present time.
    """

    def __init__(self, f: SimpleFilter, cache_size: int = 1, allow_headerless: bool = False) -> None:
        super().__init__()
        self.connectInput(f)
        self.cache_size = cache_size
        self.cache_msgs: list[Any] = []
        self.cache_times: list[Time] = []
        self.allow_headerless = allow_headerless

    def connectInput(self, f: SimpleFilter) -> None:
        """Take messages from a filter."""
        self.incoming_connection = f.registerCallback(self.add)

    def add(self, msg: Any) -> None:
        """Take a message."""
        stamp = _stamp_of(msg, "message_filters_cache", self.allow_headerless)
        if stamp is None:
            return
        self.cache_times.append(stamp)
        self.cache_msgs.append(msg)
        if len(self.cache_msgs) > self.cache_size:
            del self.cache_msgs[0], self.cache_times[0]
        self.signalMessage(msg)

    def _chosen(self, accepts: Callable[[Time], bool]) -> list[Any]:
        return [msg for msg, time in zip(self.cache_msgs, self.cache_times, strict=True) if accepts(time)]

    def getInterval(self, from_stamp: Time, to_stamp: Time) -> list[Any]:
        """Return the messages of an interval of time."""
        assert from_stamp <= to_stamp
        return self._chosen(lambda time: from_stamp <= time <= to_stamp)

    def getElemAfterTime(self, stamp: Time) -> Any:
        """Return the first message at or after a time, or None."""
        return next(iter(self._chosen(lambda time: time >= stamp)), None)

    def getElemBeforeTime(self, stamp: Time) -> Any:
        """Return the last message at or before a time, or None."""
        return next(reversed(self._chosen(lambda time: time <= stamp)), None)

    def getLastestTime(self) -> Time | None:
        """Return the stamp of the last message, or None."""
        return self.cache_times[-1] if self.cache_times else None

    def getOldestTime(self) -> Time | None:
        """Return the stamp of the oldest message, or None."""
        return self.cache_times[0] if self.cache_times else None

    def getLast(self) -> Any:
        """Return the last message, or None."""
        latest = self.getLastestTime()
        return None if latest is None else self.getElemAfterTime(latest)


class TimeSynchronizer(SimpleFilter):
    """Passes on sets of messages, one of each filter, with the same stamp.

    Args:
        fs: the filters.
        queue_size: number of messages of each filter that wait for the others.
    """

    def __init__(self, fs: Sequence[SimpleFilter], queue_size: int) -> None:
        super().__init__()
        self.connectInput(fs)
        self.queue_size = queue_size
        self.lock = threading.Lock()

    def connectInput(self, fs: Sequence[SimpleFilter]) -> None:
        """Take messages from filters."""
        self.queues: list[dict[int, Any]] = [{} for _ in fs]
        pairs = enumerate(zip(fs, self.queues, strict=True))
        self.input_connections = [each.registerCallback(self.add, queue, index) for index, (each, queue) in pairs]

    def _put(self, stamp: Time, msg: Any, my_queue: dict[int, Any]) -> None:
        my_queue[stamp.nanoseconds] = msg
        while len(my_queue) > self.queue_size:
            del my_queue[min(my_queue)]

    def add(self, msg: Any, my_queue: dict[int, Any], my_queue_index: int | None = None) -> None:
        """Take a message of one filter."""
        with self.lock:
            self._put(Time.from_msg(msg.header.stamp), msg, my_queue)
            common = set.intersection(*(set(queue) for queue in self.queues))
            for stamp in sorted(common):
                self.signalMessage(*[queue[stamp] for queue in self.queues])
                for queue in self.queues:
                    del queue[stamp]


class ApproximateTimeSynchronizer(TimeSynchronizer):
    """Passes on sets of messages whose stamps are close.

    Args:
        fs: the filters.
        queue_size: number of messages of each filter that wait for the others.
        slop: time in s in which all stamps of a set must lie.
        allow_headerless: messages without a header get the present time.
    """

    def __init__(
        self, fs: Sequence[SimpleFilter], queue_size: int, slop: float, allow_headerless: bool = False
    ) -> None:
        super().__init__(fs, queue_size)
        self.slop = Duration(seconds=slop)
        self.allow_headerless = allow_headerless

    def add(self, msg: Any, my_queue: dict[int, Any], my_queue_index: int | None = None) -> None:
        """Take a message of one filter. A set must lie within less than the slop."""
        stamp = _stamp_of(msg, "message_filters_approx", self.allow_headerless)
        if stamp is None:
            return
        with self.lock:
            self._put(stamp, msg, my_queue)
            now, slop = stamp.nanoseconds, self.slop.nanoseconds
            near = [
                sorted((each for each in queue if abs(each - now) <= slop), key=lambda each: abs(each - now))
                for index, queue in enumerate(self.queues)
                if index != my_queue_index
            ]
            for chosen in itertools.product(*near) if all(near) else ():
                stamps = list(chosen)
                if my_queue_index is not None:
                    stamps.insert(my_queue_index, now)
                pairs = list(zip(self.queues, stamps, strict=True))
                if max(stamps) - min(stamps) < slop and all(each in queue for queue, each in pairs):
                    self.signalMessage(*[queue[each] for queue, each in pairs])
                    for queue, each in pairs:
                        del queue[each]
                    break
