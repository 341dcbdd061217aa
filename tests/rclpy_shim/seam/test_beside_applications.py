"""A publisher of ROS 1, a subscription of ROS 2 and a Python application of cFE on one topic."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

pytestmark = pytest.mark.slow
TALKER = """
import rospy
from std_msgs.msg import Int32
rospy.init_node("talker")
pub = rospy.Publisher("/count", Int32, queue_size=5)
for turn in range(5):
    rospy.sleep(0.2)
    pub.publish(turn)
"""
LISTENER = """
import rclpy
from std_msgs.msg import Int32
rclpy.init()
node = rclpy.create_node("listener")
pub = node.create_publisher(Int32, "double", 10)
node.create_subscription(Int32, "count", lambda message: pub.publish(Int32(data=2 * message.data)), 10)
node.create_subscription(Int32, "triple", lambda message: node.get_logger().info(f"heard {message.data}"), 10)
try:
    rclpy.spin(node)
except KeyboardInterrupt:
    pass
"""
APP = """
from cfepy.msg import Layout, Telemetry

DOUBLE = Telemetry("DOUBLE", 0x0902, Layout("Int32", [("data", "i32")]), "From ROS 2.")
TRIPLE = Telemetry("TRIPLE", 0x0903, Layout("Int32", [("data", "i32")]), "To ROS 2.")


def APP_Main(cfe):
    cfe.evs.register()
    pipe = cfe.sb.create_pipe(10, "APP")
    cfe.sb.subscribe(DOUBLE.msg_id, pipe)
    while cfe.es.run_loop():
        packet = cfe.sb.receive_buffer(pipe, 500)
        if packet is not None:
            cfe.sb.transmit_msg(TRIPLE.packet(data=DOUBLE.read(packet)["data"] // 2 * 3))
    cfe.es.exit_app()
"""
STARTUP = """CFE_APP, app, APP_Main, APP, 80, 16384, 0x0, 0;
CFE_APP, listener.py, __main__, LISTENER, 100, 65536, 0x0, 0;
CFE_APP, talker.py, __main__, TALKER, 100, 65536, 0x0, 0;
!
"""
TOPICS = "topics:\n  /count: {msg_id: 0x0901}\n  /double: {msg_id: 0x0902}\n  /triple: {msg_id: 0x0903}\n"


def flown(folder: Path, tasks: str, hash_seed: str) -> tuple[list[str], str]:
    """Return the lines of the listener, and the digest."""
    command = [sys.executable, "-m", "cfepy", "run", str(folder), "--for", "3", "--tasks", tasks]
    environ = {**os.environ, "PYTHONHASHSEED": hash_seed}
    done = subprocess.run(command, capture_output=True, text=True, env=environ, check=True)
    lines = done.stdout.splitlines()
    heard = [line.rpartition(": ")[2] for line in lines if line.startswith("[listener]")]
    return heard, next(line for line in lines if line.startswith("trace: "))


def test_mixed_mission_is_the_same_with_each_context_and_hash_seed(tmp_path: Path) -> None:
    for name, text in (
        ("talker.py", TALKER),
        ("listener.py", LISTENER),
        ("app.py", APP),
        ("startup.scr", STARTUP),
        ("mission.yaml", TOPICS),
    ):
        (tmp_path / name).write_text(text, encoding="utf-8")
    runs = [flown(tmp_path, *each) for each in (("thread", "0"), ("thread", "1"), ("greenlet", "7"))]
    assert runs[0][0] == [f"heard {3 * turn}" for turn in range(5)]
    assert runs[1] == runs[0]
    assert runs[2] == runs[0]
