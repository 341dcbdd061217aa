"""A small mission in C++ that receives truncated packets from a foreign sender."""

from __future__ import annotations

import struct

from dev.convert.small_missions import node

ONESUB, ALLSUBS, MASTER = 0x080E, 0x080D, 0x08FC
EMPTY_LIST = bytes.fromhex("080dc0000015") + bytes(18) + b"\xff\xff\xff\xff"
"""28 bytes that say to be a list of 4,294,967,295 subscriptions."""
TARGET = """
#include <ros/ros.h>
#include <std_msgs/String.h>
#include <std_srvs/SetBool.h>
#include <tf2_ros/buffer.h>
#include <tf2_ros/transform_listener.h>

static int heard, served;

static void hear(const std_msgs::String &) { ++heard; }

static bool serve(std_srvs::SetBool::Request &, std_srvs::SetBool::Response &)
{
  ++served;
  return true;
}

int main(int argc, char **argv)
{
  ros::init(argc, argv, "target");
  ros::NodeHandle nh;
  tf2_ros::Buffer buffer;
  tf2_ros::TransformListener listener(buffer);
  ros::Publisher kept = nh.advertise<std_msgs::String>("kept", 1, true), out = nh.advertise<std_msgs::String>("out", 1);
  ros::Subscriber in = nh.subscribe("in", 4, hear);
  ros::ServiceServer server = nh.advertiseService("set", serve);
  ros::ServiceClient client = nh.serviceClient<std_srvs::SetBool>("other");
  std_msgs::String text;
  text.data = "text";
  kept.publish(text);
  double value = 0.0;
  bool worked = true;
  nh.getParamCached("/value", value); // which takes memory for the name
  ros::spinOnce();
  for (int i = 1; ros::ok(); ++i)
  {
    for (int tick = 0; tick < 10; ++tick)
    {
      ros::spinOnce();
      out.publish(text);
      ros::WallDuration(0.1).sleep();
    }
    nh.getParamCached("/value", value);
    std_srvs::SetBool call;
    worked = worked && client.call(call);
    ROS_INFO("alive %d, calls worked %d, value %d", i, worked, static_cast<int>(value));
  }
}
"""
HELPER = """
#include <ros/ros.h>
#include <std_msgs/String.h>
#include <std_srvs/SetBool.h>

static int heard;

static void hear(const std_msgs::String &) { ++heard; }
static bool serve(std_srvs::SetBool::Request &, std_srvs::SetBool::Response &) { return true; }

int main(int argc, char **argv)
{
  ros::init(argc, argv, "helper");
  ros::NodeHandle nh;
  ros::ServiceServer server = nh.advertiseService("other", serve);
  ros::Subscriber out = nh.subscribe("out", 4, hear);
  while (ros::ok())
  {
    for (int tick = 0; tick < 20; ++tick)
    {
      ros::spinOnce();
      ros::WallDuration(0.05).sleep();
    }
    ROS_INFO("heard %d", heard);
  }
}
"""
SOURCES = {"target.cpp": TARGET, "helper.cpp": HELPER}
LAUNCH = '<param name="value" value="7.0"/>' + node("helper") + node("target")


def packet_of(msg_id: int, payload: bytes, flags: int = 0xC0, sequence: int = 0) -> bytes:
    """Return a packet with a payload behind the six bytes of its primary header."""
    return struct.pack(">HBBH", msg_id, flags, sequence, len(payload) - 1) + payload
