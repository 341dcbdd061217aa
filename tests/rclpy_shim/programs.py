"""ROS 2 programs for the tests: a body behind common first lines, run alone in a mission."""

from __future__ import annotations

from pathlib import Path

from rospy_shim.types.config import NodeConfig
from tests.rospy_shim.missions import run_nodes

HEAD = """
import rclpy, time, warnings
from rclpy.parameter import Parameter
from std_msgs.msg import String
rclpy.init()
def attempt(function, *args, **options):
    try:
        return function(*args, **options)
    except Exception as error:
        print(type(error).__name__, "|", str(error).split(chr(10))[0])
"""


def printed(body: str, folder: Path, config: NodeConfig | None = None, seconds: float = 3.0) -> list[str]:
    """Return the lines that a program prints.

    Args:
        body: the program behind `HEAD`.
        folder: an empty folder.
        config: its entry in a mission file.
        seconds: virtual time before it is asked to end.
    """
    run = run_nodes(folder, {"A": HEAD + body}, nodes={"A": config} if config is not None else None, seconds=seconds)
    assert run.finished
    return [line for lines in run.printed.values() for line in lines]
