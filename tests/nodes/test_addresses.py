"""Memory addresses of objects must not be visible, because they differ in each run."""

from __future__ import annotations

from pathlib import Path

import pytest

import cfepy
from cfepy.reading.texts import without_addresses

NODE = """
import logging
import sys
import rospy
from concurrent.futures import Future
from rosgraph_msgs.msg import Log
from std_msgs.msg import String

kept = [bytearray(size) for size in range(1, 5000, 7)]  # other places than in another run
rospy.init_node("node")
rospy.Subscriber("/rosout", Log, lambda log: print(log.msg))
print(Future(), file=sys.stderr)
print(object(), rospy.Rate(1))
rospy.loginfo("%s", Future())
rospy.sleep(0.1)
raise ValueError(object())
"""
APP = """
import os

def Main(cfe):
    kept = [bytearray(os.getpid() % 5000)]
    cfe.evs.register()
    cfe.evs.send_info(1, "%s", object())
    cfe.es.write_to_sys_log(f"{object()}")
    while cfe.es.run_loop():
        cfe.os.task_delay(100)
        raise ValueError(object())
"""


@pytest.mark.parametrize(
    ("text", "plain"),
    [
        ("<Future at 0x7f3709f8bb20 state=pending>", "<Future at 0x0 state=pending>"),
        ("<a at 0x55d0a1b2c3d0>, <b at 0X55d0a1b2c3d0>", "<a at 0x0>, <b at 0X55d0a1b2c3d0>"),
        ("reset at 0x1880", "reset at 0x1880"),
        ("it is 0x7f3709f8bb20", "it is 0x7f3709f8bb20"),
        ("at 0x7f3709f8bb20", "at 0x7f3709f8bb20"),  # no object's
        ("a table at 0x10802240a0", "a table at 0x10802240a0"),  # of a compiled application
        ("", ""),
    ],
)
def test_addresses_of_objects_are_removed(text: str, plain: str) -> None:
    assert without_addresses(text) == plain


@pytest.mark.parametrize("tasks", ["thread", "greenlet"])
def test_output_of_a_run_has_no_addresses(tasks: str, tmp_path: Path) -> None:
    (tmp_path / "node.py").write_text(NODE, encoding="utf-8")
    (tmp_path / "app.py").write_text(APP, encoding="utf-8")
    line = "CFE_APP, {}, {}, {}, 90, 16384, 0, 0;\n"
    startup = line.format("node", "__main__", "NODE") + line.format("app", "Main", "APP") + "!\n"
    (tmp_path / "startup.scr").write_text(startup, encoding="utf-8")
    digests = set()
    for _ in range(3):
        kept = [bytearray(100) for _ in range(len(digests) * 1000)]
        run = cfepy.run(tmp_path, seconds=1, tasks=tasks)
        digests.add(run.trace)
        assert sum(" at 0x0" in text for text in run.console) >= 6
        del kept
    assert len(digests) == 1
