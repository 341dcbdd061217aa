#!/usr/bin/env python3
"""Test node: bags whose chunks overlap or go back in time, while they are written, opened, appended to and indexed."""

from __future__ import annotations

import os
import random
import tempfile
from collections.abc import Callable
from typing import Any

import rosbag
import rospy
from genpy import Time
from std_msgs.msg import Int32, String

LIVES = 6
LAST = 60  # of the times, in tenths of a second


def at(tenths: int) -> Time:
    return Time(tenths // 10, tenths % 10 * 100_000_000)


def shown(entry: Any) -> str:
    return "none" if entry is None else f"{entry.time.to_sec():.1f}/{entry.chunk_pos}+{entry.offset}"


def tell(what: str, act: Callable[[], Any]) -> None:
    """Print the result or the error of a call."""
    try:
        outcome = act()
    except Exception as error:
        outcome = f"{type(error).__name__} {error}"
    print(f"result: {what}: {outcome!r}")


class Life:
    """The life of a bag, by a seed."""

    def __init__(self, seed: int) -> None:
        self.chance = random.Random(seed)
        self.name = f"life{seed}.bag"
        self.count = 0

    def run(self) -> None:
        options = {
            "compression": self.chance.choice(["none", "none", "bz2"]),
            "chunk_threshold": self.chance.choice([0, 60, 150, 400]),
        }
        for mode, messages in (("w", 10), ("a", 4)):
            with rosbag.Bag(self.name, mode, **options) as bag:
                for _ in range(messages):
                    self.write(bag)
                    if self.chance.random() < 0.15:
                        self.ask(bag)
        with rosbag.Bag(self.name, skip_index=self.chance.random() < 0.3) as bag:
            self.ask(bag)
            self.ask_for_entries(bag)
        with rosbag.Bag(self.name, "a") as bag:
            tell("reindex", lambda: list(bag.reindex()))
            self.ask(bag)
            self.ask_for_entries(bag)

    def write(self, bag: rosbag.Bag) -> None:
        self.count += 1
        topic, time = self.chance.choice(["/a", "/b", "/c"]), at(self.chance.randrange(LAST))
        bag.write(topic, Int32(self.count) if topic == "/b" else String(f"m{self.count}"), time)

    def range(self) -> tuple[Any, Any]:
        start, end = (self.chance.choice([None, at(self.chance.randrange(LAST))]) for _ in range(2))
        return start, end

    def ask(self, bag: rosbag.Bag) -> None:
        topics = self.chance.choice([None, "/a", ["/a", "/c"]])
        start, end = self.range()
        tell("times", lambda: (bag.get_start_time(), bag.get_end_time()))
        tell("counts", lambda: (bag.get_message_count(), bag.get_message_count("/a"), bag._uncompressed_size))
        tell("topics", lambda: [tuple(each) for each in bag.get_type_and_topic_info().topics.values()])
        tell("text", lambda: str(bag))
        tell("yaml", lambda: bag._get_yaml_info())
        tell("all", lambda: [(each.message.data, each.timestamp.to_sec()) for each in bag.read_messages()])
        tell("some", lambda: [each.message.data for each in bag.read_messages(topics, start, end)])

    def ask_for_entries(self, bag: rosbag.Bag) -> None:
        start, end = self.range()
        time = at(self.chance.randrange(LAST))
        tell("entries", lambda: [shown(each) for each in bag._get_entries(None, start, end)])
        tell("reverse", lambda: [shown(each) for each in bag._get_entries_reverse(None, start, end)])
        tell("beside", lambda: (shown(bag._get_entry(time)), shown(bag._get_entry_after(time))))
        tell("chunks", lambda: [(each.start_time.to_sec(), each.end_time.to_sec()) for each in bag._chunks])


def main() -> None:
    rospy.init_node("overlapping_chunks")
    os.chdir(tempfile.mkdtemp())
    for seed in range(LIVES):
        try:
            Life(seed).run()
        except rosbag.ROSBagException as error:
            print(f"result: {seed} ended: {type(error).__name__} {error}")


if __name__ == "__main__":
    main()
