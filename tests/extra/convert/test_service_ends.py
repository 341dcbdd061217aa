"""Service calls whose server or whose own application ends: they return and report a failure."""

from __future__ import annotations

from pathlib import Path

import pytest

from cfepy.es.packets import STOP_APP
from dev.convert.service_ends import LAUNCH, SOURCES
from dev.convert.small_missions import node, said_by, small_mission
from dev.roscfe.building import needs_cpp

pytestmark = [needs_cpp, pytest.mark.slow]

GONE = ["valid 1", "calls", "answered 0, valid 0, ok 1", "service there 0", "waited 0"]


def test_call_fails_when_its_server_exits(tmp_path: Path) -> None:
    inside = '<param name="seconds" value="1.0"/><param name="exits" value="true"/>'
    with small_mission(tmp_path, SOURCES, node("server", inside=inside) + node("caller")) as mission:
        mission.run_for(6)
        assert said_by(mission, "caller") == GONE


def test_call_fails_when_its_server_is_stopped(tmp_path: Path) -> None:
    with small_mission(tmp_path, SOURCES, LAUNCH) as mission:
        mission.run_for(2)
        mission.cfe.sb.transmit_msg(STOP_APP.packet(Application="SERVER"))
        mission.run_for(10)
        assert said_by(mission, "caller") == GONE


def test_call_fails_when_its_own_application_must_end(tmp_path: Path) -> None:
    with small_mission(tmp_path, SOURCES, LAUNCH) as mission:
        mission.run_for(2)
        mission.cfe.sb.transmit_msg(STOP_APP.packet(Application="CALLER"))
        mission.run_for(2)
        assert said_by(mission, "caller") == ["valid 1", "calls"]  # the log has ended
        assert "[/caller] answered 0, valid 1, ok 0" in mission.console.lines


WAITER = """
#include <ros/ros.h>

int main(int argc, char **argv)
{
  ros::init(argc, argv, "waiter");
  ros::NodeHandle nh;
  ROS_INFO("waits");
  std::printf("waited %d\\n", ros::service::waitForService("never")); // the log has ended
}
"""


def test_wait_for_a_service_ends_with_the_application(tmp_path: Path) -> None:
    with small_mission(tmp_path, {"waiter.cpp": WAITER}, node("waiter")) as mission:
        mission.run_for(2)
        mission.cfe.sb.transmit_msg(STOP_APP.packet(Application="WAITER"))
        mission.run_for(2)
        assert said_by(mission, "waiter") == ["waits"]
        assert "[/waiter] waited 0" in mission.console.lines
