"""A robot for foreign clients: its node, and the command that runs it with a viewers' server."""

from __future__ import annotations

import re
import signal
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

ROBOT = """
import actionlib
import rospy
from actionlib_tutorials.msg import FibonacciAction, FibonacciFeedback, FibonacciResult
from std_msgs.msg import Float64MultiArray, String, UInt8MultiArray
from std_srvs.srv import SetBool, Trigger

rospy.init_node("robot")

def count(goal):
    found = [0, 1]
    for _ in range(goal.order):
        found.append(found[-1] + found[-2])
        server.publish_feedback(FibonacciFeedback(found))
        rospy.sleep(0.01)
        if server.is_preempt_requested():
            server.set_preempted(FibonacciResult(found))
            return
    server.set_succeeded(FibonacciResult(found))

def switch(request):
    if not request.data:
        raise ValueError("off is not possible")
    return True, "on"

def ask(message):
    told.publish("client says: " + rospy.ServiceProxy("/by_client", Trigger)().message)

chatter = rospy.Publisher("/chatter", String, queue_size=100, latch=True)
chatter.publish("first")
numbers = rospy.Publisher("/numbers", Float64MultiArray, queue_size=1, latch=True)
numbers.publish(Float64MultiArray(data=[1.5, float("nan"), -2.0]))
octets = rospy.Publisher("/octets", UInt8MultiArray, queue_size=1, latch=True)
octets.publish(UInt8MultiArray(data=bytes([0, 1, 255])))
told = rospy.Publisher("/told", String, queue_size=10, latch=True)
rospy.Subscriber("/orders", String, lambda message: chatter.publish(message.data.upper()))
rospy.Subscriber("/ask", String, ask)
rospy.Service("/switch", SetBool, switch)
rospy.set_param("/speed", 3)
server = actionlib.SimpleActionServer("/fibonacci", FibonacciAction, count, auto_start=False)
server.start()
rospy.spin()
"""
PATIENCE_S = 60  # for a process of the host, until it has done the expected action


@contextmanager
def robot(folder: Path, *options: str, server: str = "--rosbridge") -> Iterator[int]:
    """Run the robot in real time. Yields the port of its server.

    Args:
        folder: folder for its script.
        options: further options of the command line.
        server: the option that starts a server.
    """
    script = folder / "robot.py"
    script.write_text(ROBOT, encoding="utf-8")
    command = [sys.executable, "-m", "cfepy", "node", str(script), "--realtime", server, "0", *options]
    with subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True) as process:
        assert process.stderr is not None
        try:
            line = process.stderr.readline()
            found = re.search(r"connects? to ws://127.0.0.1:(\d+)", line)
            assert found is not None, line + process.stderr.read()
            yield int(found[1])
        finally:
            process.send_signal(signal.SIGINT)
            try:
                _, rest = process.communicate(timeout=PATIENCE_S)
            finally:
                process.kill()
        assert process.returncode == 130, rest
