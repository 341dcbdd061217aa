"""The node `play` of package rosbag: publishes the messages of bags, as fast as they were recorded (`rosbag play`).

Messages are published as their recorded bytes. Bags are played by the clock of the computer, which is virtual. With
`--clock`, the time in the bags is published on /clock, for nodes with `use_sim_time`. Imports rospy and the modules
beside it.
"""

from __future__ import annotations

import argparse
import heapq
import os
import sys
import threading
import time
from collections.abc import Iterator, Sequence
from typing import Any

import rospy
from rosbag_storage.play_options import PlayParser
from rosgraph_msgs.msg import Clock
from std_srvs.srv import SetBool, SetBoolResponse

from ._raw import publisher_of
from .bag import Bag

NS_PER_S = 1_000_000_000
POLL_S = 0.1  # interval of checks for subscribers, and while playing is paused


def _time(ns: int) -> Any:
    """Return a time exact to the nanosecond.

    Seconds in a float are less exact, and would leave out the last message.
    """
    return rospy.Time(*divmod(ns, NS_PER_S))


class Player:
    """Plays bags.

    Args:
        options: see `PlayParser`.
    """

    def __init__(self, options: argparse.Namespace) -> None:
        self._options = options
        self._bags = [self._opened(name) for name in options.bags]
        chunks = [chunk for bag in self._bags for chunk in bag.__all_chunks__() if chunk.connection_counts]
        first = min((chunk.start for chunk in chunks), default=0) + round(options.start * NS_PER_S)
        last = max((chunk.end for chunk in chunks), default=0)
        if options.duration is not None:
            last = min(last, first + round(options.duration * NS_PER_S))
        self._first, self._last = _time(first), _time(last)
        self._publishers: dict[tuple[str, str], Any] = {}
        self._clock = rospy.Publisher("/clock", Clock, queue_size=1) if options.clock else None
        self._tick_s = 1.0 / options.hz
        self._next_tick = 0.0
        self._origin = 0.0  # time of the computer at which the bags' first message is due
        self._paused = options.pause
        self._changed = threading.Condition()
        self._pause_service = rospy.Service("~pause_playback", SetBool, self._on_pause)

    def _opened(self, name: str) -> Bag:
        if not self._options.quiet:
            rospy.loginfo("Opening %s", name)
        return Bag(name)

    def run(self) -> None:
        """Play. Returns when all messages are played, or when the node is shut down."""
        self._advertise()
        time.sleep(self._options.delay)
        self._await_subscribers()
        while not rospy.is_shutdown():
            self._play_once()
            if not self._options.loop:
                break
        if self._options.keep_alive:
            rospy.spin()

    # -- publishing --------------------------------------------------------------------------------------------------

    def _advertise(self) -> None:
        topics = self._options.topics or None
        for bag in self._bags:
            for connection in bag._get_connections(topics):
                key = (connection.topic, connection.md5sum)
                if key not in self._publishers:
                    name = self._options.prefix + connection.topic
                    self._publishers[key] = publisher_of(name, connection, self._options.queue)

    def _await_subscribers(self) -> None:
        if self._options.wait_for_subscribers:
            while not rospy.is_shutdown() and not all(each.get_num_connections() for each in self._publishers.values()):
                time.sleep(POLL_S)

    def _messages(self) -> Iterator[Any]:
        """Yield (topic, raw parts, time) of all bags, by time, also of bags whose chunks overlap."""
        for bag in self._bags:
            bag.__contents__().sort()
        topics = self._options.topics or None
        found = [bag.read_messages(topics, self._first, self._last, raw=True) for bag in self._bags]
        return heapq.merge(*found, key=lambda message: message.timestamp)

    def _play_once(self) -> None:
        self._origin = self._next_tick = time.time()
        before = self._first
        for topic, (_, data, md5sum, _, _), stamp in self._messages():
            self._skip_gap(before, stamp)
            self._wait_until(stamp)
            if rospy.is_shutdown():
                return
            publisher = self._publishers[topic, md5sum]
            publisher.publish(publisher.data_class(data))
            before = stamp
        self._wait_until(self._last)

    # -- time --------------------------------------------------------------------------------------------------------

    def _due(self, stamp: Any) -> float:
        """Return the computer's time at which a time in the bags is due."""
        return float(self._origin + (stamp - self._first).to_sec() / self._options.rate)

    def _skip_gap(self, before: Any, stamp: Any) -> None:
        """Leave out a long time without messages."""
        most = self._options.skip_empty
        if most is not None and (stamp - before).to_sec() > most:
            self._origin -= (stamp - before).to_sec() / self._options.rate

    def _wait_until(self, stamp: Any) -> None:
        """Wait until a time in the bags is due, and publish the clock meanwhile."""
        while not rospy.is_shutdown():
            self._wait_while_paused()
            now, due = time.time(), self._due(stamp)
            if self._clock is not None and now >= self._next_tick:
                self._tell_clock(now)
            if now >= due or self._options.immediate:
                return
            time.sleep(min(due, self._next_tick if self._clock is not None else due) - now)

    def _tell_clock(self, now: float) -> None:
        assert self._clock is not None
        played = max(0.0, now - self._origin) * self._options.rate
        self._clock.publish(Clock(min(self._first + rospy.Duration.from_sec(played), self._last)))
        self._next_tick += self._tick_s
        if self._next_tick <= now:  # the computer is behind
            self._next_tick = now + self._tick_s

    def _on_pause(self, request: Any) -> Any:
        with self._changed:
            self._paused = request.data
            self._changed.notify_all()
        return SetBoolResponse(True, "Playback is now " + ("paused" if request.data else "resumed"))

    def _wait_while_paused(self) -> None:
        with self._changed:
            if not self._paused:
                return
            began = time.time()
            while self._paused and not rospy.is_shutdown():
                self._changed.wait(POLL_S)
            self._origin += time.time() - began
            self._next_tick = time.time()


def options_of(argv: Sequence[str]) -> argparse.Namespace:
    """Return the options of `rosbag play`."""
    parser = PlayParser(prog=os.path.basename(argv[0]), description="Play bags back.")
    return parser.parse_play(rospy.myargv(argv)[1:])


def main(argv: Sequence[str] | None = None) -> None:
    """Run the node."""
    options = options_of(list(sys.argv if argv is None else argv))
    rospy.init_node("play", anonymous=True)
    Player(options).run()


if __name__ == "__main__":
    main()
