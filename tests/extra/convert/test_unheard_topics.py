"""Topics of nodes in C++ without a subscriber: bags, watches and external subscribers see them."""

from __future__ import annotations

from pathlib import Path
from shutil import rmtree
from typing import Any

import pytest

from cfepy.mission import Mission, MissionSpec, TopicMessage, TopicWatch
from cfepy.writing.console import Console
from dev.convert.small_missions import node, said_by, small_mission
from dev.roscfe.building import needs_cpp

pytestmark = [needs_cpp, pytest.mark.slow]

TALKER = """
#include <geometry_msgs/PointStamped.h>
#include <ros/ros.h>
#include <std_msgs/String.h>

int main(int argc, char **argv)
{
  ros::init(argc, argv, "talker");
  ros::NodeHandle nh;
  ros::Publisher chatter = nh.advertise<std_msgs::String>("chatter", 10);
  ros::Publisher kept = nh.advertise<std_msgs::String>("kept", 1, true);
  ros::Publisher points = nh.advertise<geometry_msgs::PointStamped>("points", 10);
  std_msgs::String text;
  text.data = "kept";
  kept.publish(text);
  ros::Rate rate(10);
  for (int i = 0; ros::ok(); ++i)
  {
    text.data = "hello world " + std::to_string(i);
    chatter.publish(text);
    points.publish(geometry_msgs::PointStamped());
    if (i % 10 == 9)
      ROS_INFO("%d published, %u subscribers", i + 1, chatter.getNumSubscribers());
    ros::spinOnce();
    rate.sleep();
  }
}
"""
MD5 = "992ce8a1687cec8c8bd883ec73ca41d1"  # of std_msgs/String


class WayOut:
    """Keeps the messages for external nodes."""

    def __init__(self) -> None:
        self.heard: list[tuple[str, str, str]] = []

    def message(self, topic: str, publisher: str, subscriber: str, payload: bytes) -> None:
        """A message for an outside subscriber."""
        self.heard.append((topic, publisher, payload[4:].decode()))


@pytest.fixture(params=["host", "strict"])
def profile(request: pytest.FixtureRequest) -> str:
    return str(request.param)


@pytest.fixture
def spec(tmp_path: Path, profile: str) -> MissionSpec:
    """The mission of the talker alone."""
    talker = TALKER if profile == "host" else TALKER.replace('"hello world " + std::to_string(i)', '"hello"')
    with small_mission(tmp_path, {"talker.cpp": talker}, node("talker"), profile) as mission:
        return mission.spec


def flown(spec: MissionSpec, *watches: Any) -> Mission:
    """Return the mission, watched."""
    return Mission(spec, console=Console(quiet=True), attachments=list(watches))


def digest(mission: Mission) -> str:
    """Of four seconds."""
    with mission:
        mission.run_for(4)
        return mission.finish()


def test_watch_sees_messages_without_a_subscriber_and_changes_no_trace(spec: MissionSpec) -> None:
    seen: list[TopicMessage] = []
    assert digest(flown(spec)) == digest(flown(spec, TopicWatch(seen.append)))
    count = {topic: [each for each in seen if each.topic == topic] for topic in ("/chatter", "/kept", "/points")}
    assert [len(each) for each in count.values()] == [35, 1, 35]
    first = count["/chatter"][0]
    assert first.header["callerid"] == "/talker"
    assert (first.header["type"], first.header["md5sum"]) == ("std_msgs/String", MD5)
    assert (first.header["latching"], count["/kept"][0].header["latching"]) == ("0", "1")
    assert count["/kept"][0].data == b"\x04\0\0\0kept"
    assert [int.from_bytes(each.data[:4], "little") for each in count["/points"]] == list(range(35))


def test_external_subscriber_receives_from_a_node_in_cpp(spec: MissionSpec) -> None:
    """As rostopic and rosbridge subscribe: between two pieces of the run, with an outlet for a pipe."""
    with flown(spec) as mission:
        mission.run_for(2)
        ros, out = mission.ros, WayOut()
        assert ros is not None
        ros.outside.way_out = out
        for name in ("/rostopic", "/another"):
            for topic in ("/chatter", "/kept"):
                assert (
                    ros.outside.do("subscribe", topic, name, "http://here:1/", "std_msgs/String", MD5, "/talker") == ""
                )
        mission.run_for(1.2)
        heard = [each for each in out.heard if each[0] == "/chatter"]
        assert 20 <= len(heard) <= 26
        assert heard[0][1] == "/talker"
        assert heard[0][2].startswith("hello")
        assert [each for each in out.heard if each[0] == "/kept"] == [("/kept", "/talker", "kept")] * 2
        assert said_by(mission, "talker")[-1].endswith("2 subscribers")
        for name in ("/rostopic", "/another"):
            ros.outside.do("subscribe no more", "/chatter", name, "/talker")
        mission.run_for(0.2)
        count = len(out.heard)
        mission.run_for(2)
        assert len(out.heard) == count
        assert said_by(mission, "talker")[-1].endswith("0 subscribers")


def test_external_subscriber_may_subscribe_before_the_node_starts(spec: MissionSpec) -> None:
    with flown(spec) as mission:
        mission.run_for(0.5)
        ros, out = mission.processor.begin_ros(), WayOut()
        ros.outside.way_out = out
        assert ros.outside.do("subscribe", "/chatter", "/rostopic", "http://here:1/", "*", "*", "/talker") == ""
        mission.run_for(2)
        assert len(out.heard) == 20


def test_message_without_a_subscriber_is_in_the_digest(tmp_path: Path) -> None:
    digests = []
    for text in ("hello", "hello", "jello"):
        folder = tmp_path / "mission"  # the same each time: a node's path is in the digest
        folder.mkdir()
        with small_mission(folder, {"talker.cpp": TALKER.replace("hello", text)}, node("talker")) as mission:
            digests.append(digest(flown(mission.spec)))
        rmtree(folder)
    assert digests[0] == digests[1] != digests[2]
