"""rospy.impl.statistics: subscribers measure if the parameter /enable_statistics is true (wiki.ros.org/Topics).

Each connection has a window of messages. Once a second, or more or less often depending on the number of messages, its
figures are published on /statistics as rosgraph_msgs/TopicStatistics.
"""

from __future__ import annotations

from itertools import pairwise
from math import sqrt
from typing import Any

import rospy
from rosgraph_msgs.msg import TopicStatistics

__all__ = ["ConnectionStatisticsLogger", "SubscriberStatisticsLogger", "sqrt"]

_NOT_MEASURED = ("/clock", "/statistics")


class SubscriberStatisticsLogger:
    """Measures all connections of a subscriber.

    Args:
        subscriber: has the topic's name.
    """

    def __init__(self, subscriber: Any) -> None:
        self.subscriber_name: str = subscriber.name
        self.connections: dict[str, ConnectionStatisticsLogger] = {}
        self.read_parameters()

    @classmethod
    def is_enabled(cls) -> bool:
        """Return True if subscribers measure."""
        return bool(rospy.get_param("/enable_statistics", False))

    def read_parameters(self) -> None:
        """Read the limits of windows: numbers of messages, and lengths in s."""
        self.min_elements = rospy.get_param("/statistics_window_min_elements", 10)
        self.max_elements = rospy.get_param("/statistics_window_max_elements", 100)
        self.min_window = rospy.get_param("/statistics_window_min_size", 4)
        self.max_window = rospy.get_param("/statistics_window_max_size", 64)

    def callback(self, msg: Any, publisher: str, stat_bytes: int) -> None:
        """Count a message that arrived.

        Args:
            msg: the message.
            publisher: name of the node that sent it.
            stat_bytes: number of bytes received from that node so far.
        """
        if self.subscriber_name in _NOT_MEASURED:
            return
        logger = self.connections.get(publisher)
        if logger is None:
            logger = ConnectionStatisticsLogger(self.subscriber_name, rospy.get_name(), publisher)
            self.connections[publisher] = logger
        logger.callback(self, msg, stat_bytes)

    def shutdown(self) -> None:
        """Stop measuring."""
        for logger in self.connections.values():
            logger.shutdown()
        self.connections.clear()


class ConnectionStatisticsLogger:
    """Measures one connection.

    Args:
        topic: the topic's name.
        subscriber: name of the receiving node.
        publisher: name of the sending node.
    """

    def __init__(self, topic: str, subscriber: str, publisher: str) -> None:
        self.topic = topic
        self.subscriber = subscriber
        self.publisher = publisher
        self.pub = rospy.Publisher("/statistics", TopicStatistics, queue_size=10)
        self.last_pub_time = rospy.Time(0)
        self.pub_frequency = 1.0  # Hz
        self._last_seq = 0
        self._bytes = self._bytes_before = 0
        self._begin_window(rospy.Time.now())

    def _begin_window(self, start: Any) -> None:
        self.window_start = start
        self._ages: list[float] = []  # s
        self._arrivals: list[float] = []  # s
        self._dropped = 0
        self._bytes_before = self._bytes

    def callback(self, subscriber_statistics_logger: SubscriberStatisticsLogger, msg: Any, stat_bytes: int) -> None:
        """Count a message that arrived; see `SubscriberStatisticsLogger.callback`."""
        now = rospy.Time.now()
        self._arrivals.append(now.to_sec())
        self._bytes = stat_bytes
        if msg._has_header:
            self._ages.append((now - msg.header.stamp).to_sec())
            self._dropped += msg.header.seq != self._last_seq + 1
            self._last_seq = msg.header.seq
        if (now - self.last_pub_time).to_sec() > 1 / self.pub_frequency:
            self.last_pub_time = now
            self.sendStatistics(subscriber_statistics_logger)

    def sendStatistics(self, subscriber_statistics_logger: SubscriberStatisticsLogger) -> None:
        """Publish the figures of the window, and begin the next one."""
        now = rospy.Time.now()
        message = TopicStatistics(topic=self.topic, node_pub=self.publisher, node_sub=self.subscriber)
        message.window_start, message.window_stop = self.window_start, now
        message.delivered_msgs, message.dropped_msgs = len(self._arrivals), self._dropped
        message.traffic = self._bytes - self._bytes_before
        periods = [after - before for before, after in pairwise(self._arrivals)]
        message.period_mean, message.period_stddev, message.period_max = _figures(periods)
        message.stamp_age_mean, message.stamp_age_stddev, message.stamp_age_max = _figures(self._ages)
        self.pub.publish(message)
        self._adjust(subscriber_statistics_logger, len(self._arrivals))
        self._begin_window(now)

    def _adjust(self, limits: SubscriberStatisticsLogger, number: int) -> None:
        """Shorten the windows if this one had too many messages, and lengthen them if it had too few."""
        length = 1 / self.pub_frequency
        if number > limits.max_elements and length / 2 >= limits.min_window:
            self.pub_frequency *= 2
        if number < limits.min_elements and length * 2 <= limits.max_window:
            self.pub_frequency /= 2

    def shutdown(self) -> None:
        """Stop measuring."""
        self.pub.unregister()


def _figures(values: list[float]) -> tuple[Any, Any, Any]:
    """Return the mean, the standard deviation and the maximum of times in s, as Durations."""
    if not values:
        return rospy.Duration(0), rospy.Duration(0), rospy.Duration(0)
    mean = sum(values) / len(values)
    deviation = sqrt(sum((value - mean) ** 2 for value in values) / len(values))
    return rospy.Duration(mean), rospy.Duration(deviation), rospy.Duration(max(values))
