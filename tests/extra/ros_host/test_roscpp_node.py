"""A node in C++, built with Debian's roscpp, and one of the mission: topics, services, parameters, and an end."""

from __future__ import annotations

import shutil
import subprocess
from pathlib import Path

import pytest

from tests.extra.ros_host.graphs import HAS_ROS, RosGraph, cfepy_run, rosmaster, started

SOURCE = Path(__file__).with_name("peer.cpp")
HEADERS = ("ros/ros.h", "std_msgs/String.h", "std_srvs/SetBool.h")
LIBRARIES = ("roscpp", "rosconsole", "roscpp_serialization", "rostime", "pthread")
HAS_ROSCPP = bool(shutil.which("g++")) and all((Path("/usr/include") / each).exists() for each in HEADERS)
NODE = """
import rospy
from std_msgs.msg import String
from std_srvs.srv import SetBool
rospy.init_node("mission")
rospy.set_param("/given", "by the mission")
rospy.Subscriber("/answers", String, lambda message: print("heard", message.data))
questions = rospy.Publisher("/questions", String, queue_size=1)
rospy.Service("/mission/turn", SetBool, lambda request: (request.data, "by the mission"))
rospy.wait_for_service("/turn")
print("called", rospy.ServiceProxy("/turn", SetBool)(True).message)
rate = rospy.Rate(20)
while not rospy.is_shutdown():
    questions.publish("a question")
    rate.sleep()
"""

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(
        not (HAS_ROS and HAS_ROSCPP), reason="Debian's roscpp is not installed (libroscpp-dev and others)"
    ),
]


@pytest.fixture(scope="module")
def peer(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The node, built."""
    made = tmp_path_factory.mktemp("peer") / "peer"
    libraries = [f"-l{each}" for each in LIBRARIES]
    subprocess.run(["g++", "-O1", "-o", str(made), str(SOURCE), *libraries], check=True, capture_output=True)
    return made


@pytest.mark.parametrize("way", ["serve", "join"])
def test_nodes_of_roscpp_and_the_mission_communicate(way: str, peer: Path, tmp_path: Path) -> None:
    if way == "join":
        with rosmaster(tmp_path) as graph:
            speak(peer, tmp_path, graph.environ["ROS_MASTER_URI"])
    else:
        speak(peer, tmp_path, "serve:0")


def speak(peer: Path, folder: Path, master: str) -> None:
    """Run both once. Each expected line arrives, or the test's process is aborted."""
    (folder / "node.py").write_text(NODE, encoding="utf-8")
    (folder / "startup.scr").write_text("CFE_APP, node.py, __main__, NODE, 100, 16384, 0x0, 0;\n!\n", encoding="utf-8")
    with started(cfepy_run(folder, "--ros-master", master)) as mission:
        assert mission.stdout is not None
        told = next(line for line in mission.stdout if "ROS_MASTER_URI=" in line or "joined the ROS master" in line)
        uri = told.strip().rpartition("=")[2] if master == "serve:0" else master
        graph = RosGraph(uri, folder)
        with started([str(peer)], graph.environ) as outside:
            assert outside.stdout is not None
            wanted = {"called turned", "heard a question of C++"}
            while wanted:
                line = next(mission.stdout).strip()
                wanted = {each for each in wanted if not line.endswith(each)}
            called = next(line for line in outside.stdout if line.startswith("called"))
            assert called == "called 1 by the mission, given by the mission\n"
            assert "/cpp_peer" in graph.run("rosnode list")
            graph.run("rosnode kill /cpp_peer")
            assert outside.wait(60) == 0
