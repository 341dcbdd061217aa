"""Answers of ROS's own tools about a node in C++, compared with a node in Python."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from cfepy.cli.main import main
from dev.convert.ping import ping_package
from dev.roscfe.building import needs_cpp

pytestmark = [needs_cpp, pytest.mark.slow]

SERVER = """
#include <ping/Beat.h>
#include <ping/Count.h>
#include <ros/ros.h>

bool count(ping::Count::Request &, ping::Count::Response &) { return true; }

int main(int argc, char **argv)
{
  ros::init(argc, argv, "server");
  ros::NodeHandle nh;
  ros::ServiceServer server = nh.advertiseService("count", count);
  ros::Publisher pub = nh.advertise<ping::Beat>("beat", 4);
  ros::spin();
}
"""
ASKER = """#!/usr/bin/env python3
import sys
import rospy, rosservice, rosnode
from ping.msg import Beat
from ping.srv import Count
rospy.init_node("asker")
ear = rospy.Subscriber("/beat", Beat)
own = rospy.Service("/own", Count, lambda request: None)
rospy.wait_for_service("/count")
rospy.sleep(1)
for name in ("/count", "/own"):
    uri = rosservice.get_service_uri(name)
    print(rosservice.get_service_type(name), rosservice.get_service_args(name))
    print(sorted(rosservice.get_service_headers(name, uri).items())[1:])
    sys.stdout.flush()
print(sorted(rosservice.rosservice_find("ping/Count")))
print(rosnode.rosnode_ping("/server", max_count=1))
rosnode.rosnode_info("/server")
"""
LAUNCH = """<launch><node pkg="ping" type="sender" name="server" output="screen"/>
<node pkg="ping" type="asker.py" name="asker" output="screen"/></launch>
"""


@pytest.fixture
def launch(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> str:
    monkeypatch.setenv("ROS_PACKAGE_PATH", str(tmp_path))
    package = ping_package(tmp_path)
    (package / "srv").mkdir()
    (package / "srv/Count.srv").write_text("int32 first\nint32 last\n---\nint32 sum\n", encoding="utf-8")
    (package / "src/sender.cpp").write_text(SERVER, encoding="utf-8")
    (package / "scripts/asker.py").write_text(ASKER, encoding="utf-8")
    (package / "scripts/asker.py").chmod(0o755)
    (package / "launch/asked.launch").write_text(LAUNCH, encoding="utf-8")
    return str(package / "launch/asked.launch")


def test_ros_tools_query_a_node_in_cpp_at_its_uri(launch: str, capfd: pytest.CaptureFixture[str]) -> None:
    assert main(["launch", launch, "--for", "3"]) == 0
    shown = capfd.readouterr().out
    said = [line.removeprefix("[asker] ") for line in shown.splitlines() if line.startswith("[asker] ")]
    assert said[0] == said[2] == "ping/Count first last"
    assert said[1] == said[3].replace("/own", "/count")
    assert said[4] == "['/count', '/own']"
    assert "True" in said
    assert " * /count" in said
    assert "    * to: /asker" in said


def test_service_command_describes_a_service_in_cpp(launch: str, capfd: pytest.CaptureFixture[str]) -> None:
    assert main(["rosservice", "info", launch, "/count", "--for", "2"]) == 0
    node, uri, kind, fields = capfd.readouterr().out.splitlines()
    assert (node, kind, fields) == ("Node: /server", "Type: ping/Count", "Args: first last")
    port = uri.removeprefix("URI: rosrpc://cfepy:")
    assert port.isdigit()
    assert main(["rosservice", "list", launch, "--for", "2", "--json", "-"]) == 0
    found = {each["service"]: each for each in json.loads(capfd.readouterr().out)}
    assert found["/count"]["args"] == ["first", "last"]
