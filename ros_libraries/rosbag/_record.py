"""The node `record` of package rosbag: topics into bags (wiki.ros.org/rosbag/Commandline, `rosbag record`).

Messages are stored unchanged, with the time of their arrival. Imports rospy and the modules beside it.
"""

from __future__ import annotations

import argparse
import os
import re
import sys
import threading
import time
from collections.abc import Sequence
from typing import Any

import rospy

from .bag import Bag, Compression

LOOK_S = 1.0  # between two looks for new topics
MB = 1 << 20
UNITS = {"s": 1, "m": 60, "h": 3600}


class Recorder:
    """Records topics until the node shuts down, or until there is enough.

    Args:
        options: see `options_of`.
    """

    def __init__(self, options: argparse.Namespace) -> None:
        self._options = options
        self._lock = threading.Lock()
        self._subscribers: dict[str, Any] = {}
        self._counts: dict[str, int] = {}
        self._latched: dict[tuple[str, str], Any] = {}
        self._bag: Bag | None = None
        self._made: list[str] = []
        self._began: Any = None
        self._stamp = ""
        self.done = False

    def run(self) -> None:
        """Record. Returns when the node is to end."""
        rospy.on_shutdown(self.close)
        self._stamp = time.strftime("%Y-%m-%d-%H-%M-%S", time.localtime())
        with self._lock:
            self._open()
        while not rospy.is_shutdown() and not self.done:
            self._look()
            time.sleep(LOOK_S)
        self.close()

    # -- topics ------------------------------------------------------------------------------------------------------

    def _look(self) -> None:
        """Subscribe to new topics that are to be recorded."""
        for topic in self._wanted():
            if topic not in self._subscribers:
                self._say("Subscribing to %s", topic)
                self._subscribers[topic] = rospy.Subscriber(topic, rospy.AnyMsg, self._take, callback_args=topic)

    def _wanted(self) -> list[str]:
        options = self._options
        given = [rospy.resolve_name(topic) for topic in options.topics]
        if not (options.all or options.regex):
            return given
        found = [topic for topic, _ in rospy.get_published_topics()]
        if options.exclude:
            found = [topic for topic in found if not re.search(options.exclude, topic)]
        if options.all:
            return found
        return [topic for topic in found if any(re.fullmatch(each, topic) for each in options.topics)]

    def _take(self, message: Any, topic: str) -> None:
        with self._lock:
            if self._bag is None or self._has_enough(topic):
                return
            now = rospy.Time.now()
            self._split_if_due(now)
            header = message._connection_header
            if header.get("latching") == "1":
                self._latched[topic, header.get("callerid", "")] = message
            self._write(topic, message, now)

    def _write(self, topic: str, message: Any, now: Any) -> None:
        header = message._connection_header
        parts = (header["type"], message._buff, header["md5sum"], rospy.AnyMsg)
        assert self._bag is not None
        self._bag.write(topic, parts, now, raw=True, connection_header=header)

    def _has_enough(self, topic: str) -> bool:
        """Count a message. Returns whether it exceeds the limit."""
        count = self._counts[topic] = self._counts.get(topic, 0) + 1
        limit = self._options.limit
        if limit and count >= limit and topic in self._subscribers:
            self._subscribers[topic].unregister()
            self.done = all(self._counts.get(each, 0) >= limit for each in self._subscribers)
        return bool(limit) and count > limit

    # -- files -------------------------------------------------------------------------------------------------------

    def _name(self) -> str:
        options = self._options
        if options.output_name:
            stem = options.output_name.removesuffix(".bag")
        else:
            stem = f"{options.output_prefix}_{self._stamp}" if options.output_prefix else self._stamp
        return f"{stem}_{len(self._made)}.bag" if options.split else f"{stem}.bag"

    def _open(self) -> None:
        name = self._name()
        self._say("Recording to '%s'.", name)
        self._made.append(name)
        threshold = self._options.chunksize * 1024
        self._bag = Bag(f"{name}.active", "w", self._options.compression, threshold)
        self._began = None

    def _split_if_due(self, now: Any) -> None:
        options = self._options
        self._began = now if self._began is None else self._began
        assert self._bag is not None
        is_big = bool(options.size) and self._bag.size > options.size * MB
        is_long = bool(options.duration) and (now - self._began).to_sec() > options.duration
        if not (is_big or is_long):
            return
        if not options.split:
            self.done = True
            return
        self._finish()
        if options.max_splits and len(self._made) > options.max_splits - 1:
            os.remove(self._made[-options.max_splits])
        self._open()
        self._began = now
        if options.repeat_latched:
            for (topic, _), message in self._latched.items():
                self._write(topic, message, now)

    def _finish(self) -> None:
        bag, self._bag = self._bag, None
        if bag is not None:
            bag.close()
            os.replace(f"{self._made[-1]}.active", self._made[-1])

    def close(self) -> None:
        """End the bag, which then gets its name."""
        with self._lock:
            self._finish()

    def _say(self, text: str, *values: Any) -> None:
        if not self._options.quiet:
            rospy.loginfo(text, *values)


def duration_of(text: str) -> float:
    """Return seconds of "10", "10s", "5m" or "1h", for argparse."""
    unit = UNITS.get(text[-1:])
    return float(text) if unit is None else float(text[:-1]) * unit


def options_of(argv: Sequence[str]) -> argparse.Namespace:
    """Return the options of `rosbag record`. Transport options are accepted."""
    parser = argparse.ArgumentParser(prog=os.path.basename(argv[0]), description="Record topics into a bag.")
    parser.add_argument("topics", nargs="*", metavar="TOPIC")
    for flag, text in (
        ("-a --all", "record all topics"),
        ("-e --regex", "the topics are regular expressions"),
        ("-q --quiet", "say nothing"),
        ("--split", "begin another bag when one is big or long enough"),
        ("--repeat-latched", "write latched messages into each bag"),
        ("--tcpnodelay", "without effect"),
        ("--udp", "without effect"),
    ):
        parser.add_argument(*flag.split(), action="store_true", help=text)
    parser.add_argument("-x", "--exclude", metavar="REGEX", help="leave out topics that match")
    parser.add_argument("-o", "--output-prefix", metavar="PREFIX", help="put this before the date in the bag's name")
    parser.add_argument("-O", "--output-name", metavar="NAME", help="name of the bag")
    parser.add_argument("--max-splits", type=int, metavar="N", help="keep the newest N bags")
    parser.add_argument("--size", type=int, metavar="MB", help="size of a bag")
    parser.add_argument("--duration", type=duration_of, metavar="TIME", help='length of a bag in s, or like "5m", "1h"')
    parser.add_argument("-b", "--buffsize", type=int, metavar="MB", help="without effect")
    parser.add_argument("--chunksize", type=int, default=768, metavar="KB", help="size of a chunk (default: 768)")
    parser.add_argument("-l", "--limit", type=int, default=0, metavar="N", help="messages of each topic")
    kinds = parser.add_mutually_exclusive_group()
    kinds.add_argument("-j", "--bz2", dest="compression", action="store_const", const=Compression.BZ2)
    kinds.add_argument("--lz4", dest="compression", action="store_const", const=Compression.LZ4)
    parser.set_defaults(compression=Compression.NONE)
    options = parser.parse_intermixed_args(rospy.myargv(argv)[1:])
    if not options.topics and not options.all:
        parser.error("You must specify a topic name or else use the '-a' option.")
    if options.output_prefix and options.output_name:
        parser.error("Can't set both prefix and name.")
    if options.split and not (options.size or options.duration):
        parser.error("Split specified without giving a maximum duration or size")
    return options


def main(argv: Sequence[str] | None = None) -> None:
    """Run the node."""
    options = options_of(list(sys.argv if argv is None else argv))
    rospy.init_node("record", anonymous=True)
    Recorder(options).run()


if __name__ == "__main__":
    main()
