"""A small package of ROS nodes in C++, with a launch file that uses groups, arguments, parameters and remaps."""

from __future__ import annotations

from pathlib import Path

PACKAGE = """<package format="2"><name>ping</name><version>1.0.0</version><description>ping</description>
  <maintainer email="a@b.c">a</maintainer><license>Apache-2.0</license><depend>roscpp</depend>
  <depend>std_msgs</depend><export><nodelet plugin="${prefix}/nodelets.xml"/></export></package>
"""
NODELETS = """<library path="lib/libfilters">
  <class name="ping/Doubler" type="ping::Doubler" base_class_type="nodelet::Nodelet"/></library>
"""
DOUBLER = """
#include <nodelet/nodelet.h>
#include <ping/Beat.h>
#include <pluginlib/class_list_macros.h>

namespace ping
{
class Doubler : public nodelet::Nodelet
{
  void onInit() override
  {
    pub_ = getPrivateNodeHandle().advertise<ping::Beat>("out", 4);
    sub_ = getNodeHandle().subscribe("in", 4, &Doubler::heard, this);
  }
  void heard(const ping::Beat::ConstPtr &message)
  {
    NODELET_INFO("doubling %d", message->number);
    ping::Beat twice = *message;
    twice.number *= 2;
    pub_.publish(twice);
  }
  ros::Publisher pub_;
  ros::Subscriber sub_;
};
}
PLUGINLIB_EXPORT_CLASS(ping::Doubler, nodelet::Nodelet)
"""
CMAKE = """
cmake_minimum_required(VERSION 3.0.2)
project(ping)
find_package(catkin REQUIRED COMPONENTS roscpp std_msgs message_generation)
add_message_files(FILES Beat.msg)
generate_messages(DEPENDENCIES std_msgs)
include_directories(include ${catkin_INCLUDE_DIRS})
add_library(words src/words.cpp)
foreach(each sender hearer)
  add_executable(${each} src/${each}.cpp)
  target_link_libraries(${each} words ${catkin_LIBRARIES})
endforeach()
add_library(filters src/doubler.cpp)
target_compile_definitions(sender PRIVATE GREETING="beat")
"""
WORDS_H = """
#pragma once
#include <string>
std::string word_of(int number);
"""
WORDS = """
#include "ping/words.h"
std::string word_of(int number) { return number % 2 ? "odd" : "even"; }
"""
SENDER = """
#include <ping/Beat.h>
#include <ping/words.h>
#include <ros/ros.h>

int main(int argc, char **argv)
{
  ros::init(argc, argv, "sender");
  ros::NodeHandle nh, own("~");
  double hz;
  own.param("hz", hz, 1.0);
  std::string prefix;
  nh.param<std::string>("/prefix", prefix, "none");
  ros::Publisher pub = nh.advertise<ping::Beat>("beat", 4);
  ros::Rate rate(hz);
  for (int number = 0; ros::ok(); ++number)
  {
    ping::Beat message;
    message.number = number;
    message.word = prefix + "-" + GREETING + "-" + word_of(number) + (argc > 1 ? argv[1] : "");
    pub.publish(message);
    ros::spinOnce();
    rate.sleep();
  }
}
"""
HEARER = """
#include <ping/Beat.h>
#include <ros/ros.h>

void heard(const ping::Beat::ConstPtr &message)
{
  ROS_INFO("heard %d %s", message->number, message->word.c_str());
}

int main(int argc, char **argv)
{
  ros::init(argc, argv, "hearer");
  ros::NodeHandle nh;
  ros::Subscriber sub = nh.subscribe("beat", 4, heard);
  ros::spin();
  return 0;
}
"""
LAUNCH = """
<launch>
  <arg name="hz" default="10"/>
  <param name="prefix" value="plain"/>
  <group ns="arm">
    <node pkg="ping" type="sender" name="left" args="!">
      <param name="hz" value="$(arg hz)"/>
      <remap from="beat" to="/pulse"/>
    </node>
    <node pkg="ping" type="hearer" name="ear" output="screen">
      <remap from="beat" to="/pulse"/>
    </node>
  </group>
</launch>
"""
PYTHON_HEARER = """#!/usr/bin/env python3
import rospy
from ping.msg import Beat

rospy.init_node("script")
rospy.Subscriber("/pulse", Beat, lambda message: rospy.loginfo("python heard %s", message.word))
rospy.spin()
"""
PULSE_TEST = """#!/usr/bin/env python3
import unittest

import rospy
import rostest
from ping.msg import Beat


class Pulse(unittest.TestCase):
    def test_pulse(self):
        rospy.init_node("pulse")
        self.assertIn("beat", rospy.wait_for_message("/pulse", Beat, timeout=5).word)


rostest.rosrun("ping", "pulse", Pulse)
"""
FILES = {
    "package.xml": PACKAGE,
    "CMakeLists.txt": CMAKE,
    "msg/Beat.msg": "int32 number\nstring word\n",
    "include/ping/words.h": WORDS_H,
    "nodelets.xml": NODELETS,
    "src/doubler.cpp": DOUBLER,
    "src/words.cpp": WORDS,
    "src/sender.cpp": SENDER,
    "src/hearer.cpp": HEARER,
    "launch/ping.launch": LAUNCH,
    "launch/both.launch": '<launch><include file="$(find ping)/launch/ping.launch"/>'
    '<node pkg="ping" type="script.py" name="script"/></launch>\n',
    "launch/nodelet.launch": """<launch>
  <include file="$(find ping)/launch/ping.launch"/>
  <node pkg="nodelet" type="nodelet" name="manager" args="manager"/>
  <node pkg="nodelet" type="nodelet" name="twice" args="load ping/Doubler manager">
    <remap from="in" to="/pulse"/>
  </node>
</launch>
""",
    "launch/ping.test": """<launch>
  <include file="$(find ping)/launch/ping.launch"/>
  <test pkg="ping" type="test_pulse.py" test-name="pulse" time-limit="20"/>
</launch>
""",
    "scripts/test_pulse.py": PULSE_TEST,
    "scripts/script.py": PYTHON_HEARER,
}


def ping_package(folder: Path) -> Path:
    """Write the package into a folder. Returns its path."""
    package = folder / "ping"
    for name, text in FILES.items():
        (package / name).parent.mkdir(parents=True, exist_ok=True)
        (package / name).write_text(text, encoding="utf-8")
    return package
