"""A small mission in C++ with a slow service, and a node that calls it."""

from __future__ import annotations

from dev.convert.small_missions import node

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
  std::printf("answered %d, valid %d, ok %d\\n", good, client.isValid(), ros::ok());
  ros::WallDuration(1.5).sleep();
  ROS_INFO("service there %d", ros::service::exists("serve", false));
  ROS_INFO("waited %d", ros::service::waitForService("serve", ros::Duration(0.5)));
}
"""
SOURCES = {"server.cpp": SERVER, "caller.cpp": CALLER}
LAUNCH = node("server") + node("caller")
