"""Calls of services whose server ends, or whose own application is to end: they return, and say that they failed."""

from __future__ import annotations

from pathlib import Path

import pytest

from cfepy.es.packets import STOP_APP
from tests.convert.small_missions import node, said_by, small_mission
from tests.roscfe.building import needs_cpp

pytestmark = [needs_cpp, pytest.mark.slow]

SERVER = """
#include <cstdlib>

#include <ros/ros.h>
#include <std_srvs/Trigger.h>

static bool serve(std_srvs::Trigger::Request &, std_srvs::Trigger::Response &)
{
  double seconds = 3600.0;
  bool   exits   = false;
  ros::param::get("~seconds", seconds);
  ros::param::get("~exits", exits);
  ros::WallDuration(seconds).sleep();
  if (exits)
    exit(3);
  return true;
}

int main(int argc, char **argv)
{
  ros::init(argc, argv, "server");
  ros::NodeHandle nh;
  ros::ServiceServer server = nh.advertiseService("serve", serve);
  ros::spin();
}
"""
CALLER = """
#include <ros/ros.h>
#include <std_msgs/Empty.h>
#include <std_srvs/Trigger.h>

static void hear(const std_msgs::Empty &) {}

int main(int argc, char **argv)
{
  ros::init(argc, argv, "caller");
  ros::NodeHandle nh;
  ros::Subscriber ticks = nh.subscribe("ticks", 10, hear);
  ros::Publisher out = nh.advertise<std_msgs::Empty>("ticks", 10);
  auto tick = [&](const ros::TimerEvent &) { out.publish(std_msgs::Empty()); };
  ros::Timer timer = nh.createTimer(ros::Duration(0.1), tick);
  ros::AsyncSpinner spinner(1);
  spinner.start();
  ros::service::waitForService("serve");
  ros::ServiceClient client = nh.serviceClient<std_srvs::Trigger>("serve", true);
  ROS_INFO("valid %d", client.isValid());
  std_srvs::Trigger call;
  ROS_INFO("calls");
  const bool good = client.call(call);
  ROS_INFO("answered %d, valid %d, ok %d", good, client.isValid(), ros::ok());
  ros::WallDuration(1.5).sleep();
  ROS_INFO("service there %d", ros::service::exists("serve", false));
  ROS_INFO("waited %d", ros::service::waitForService("serve", ros::Duration(0.5)));
}
"""
SOURCES = {"server.cpp": SERVER, "caller.cpp": CALLER}
LAUNCH = node("server") + node("caller")
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


def test_call_fails_when_its_own_application_is_to_end(tmp_path: Path) -> None:
    with small_mission(tmp_path, SOURCES, LAUNCH) as mission:
        mission.run_for(2)
        mission.cfe.sb.transmit_msg(STOP_APP.packet(Application="CALLER"))
        mission.run_for(2)
        assert said_by(mission, "caller")[2] == "answered 0, valid 1, ok 0"


WAITER = """
#include <ros/ros.h>

int main(int argc, char **argv)
{
  ros::init(argc, argv, "waiter");
  ros::NodeHandle nh;
  ROS_INFO("waits");
  ROS_INFO("waited %d", ros::service::waitForService("never"));
}
"""


def test_wait_for_a_service_ends_with_the_application(tmp_path: Path) -> None:
    with small_mission(tmp_path, {"waiter.cpp": WAITER}, node("waiter")) as mission:
        mission.run_for(2)
        mission.cfe.sb.transmit_msg(STOP_APP.packet(Application="WAITER"))
        mission.run_for(2)
        assert said_by(mission, "waiter") == ["waits", "waited 0"]
