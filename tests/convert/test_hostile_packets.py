"""Packets of a stranger, sent to what a node in C++ hears: it ignores what is none of its kind, and works on."""

from __future__ import annotations

import random
import struct
from collections.abc import Iterator
from pathlib import Path

import pytest

from cfepy.mission import Mission
from tests.convert.small_missions import node, said_by, small_mission
from tests.roscfe.building import needs_cpp

pytestmark = [needs_cpp, pytest.mark.slow]

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
WITHOUT_PARAMETER = TARGET.replace('nh.getParamCached("/value", value)', "value = 7.0")
"""In the profile strict: to ask for a kept parameter again, after a notice, takes memory."""
LAUNCH = '<param name="value" value="7.0"/>' + node("helper") + node("target")


@pytest.fixture(params=["host", "pool", "strict"])
def mission(request: pytest.FixtureRequest, tmp_path: Path) -> Iterator[Mission]:
    sources = {**SOURCES, "target.cpp": WITHOUT_PARAMETER} if request.param == "strict" else SOURCES
    with small_mission(tmp_path, sources, LAUNCH, request.param) as flown:
        flown.run_for(3)
        assert said_by(flown, "target")[-1].startswith("alive ")
        yield flown


def send(mission: Mission, packet: bytes) -> None:
    """Send a packet as it is."""
    mission.cfe.sb.transmit_msg(packet, False)


def packet_of(msg_id: int, payload: bytes, flags: int = 0xC0, sequence: int = 0) -> bytes:
    """A packet with a payload behind the six bytes of its primary header."""
    return struct.pack(">HBBH", msg_id, flags, sequence, len(payload) - 1) + payload


def one_subscription(msg_id: int, pipe: int, kind: int = 0, priority: int = 0) -> bytes:
    """A report as the Software Bus makes one."""
    return packet_of(ONESUB, bytes(10) + struct.pack("<B3xIBBxxI", kind, msg_id, priority, 0, pipe))


def works(mission: Mission) -> None:
    """The nodes go on, and messages and calls get through."""
    before = {name: len(said_by(mission, name)) for name in ("target", "helper")}
    mission.run_for(5)
    target, helper = said_by(mission, "target")[before["target"] :], said_by(mission, "helper")[before["helper"] :]
    assert len(target) >= 3
    assert all(line.endswith("calls worked 1, value 7") for line in target), target
    counts = [int(line.split()[-1]) for line in helper]
    assert counts[-1] - counts[0] >= 10
    assert not any("ended" in line or "was allocated" in line for line in mission.console.lines if "TARGET" in line)


def ignored(mission: Mission) -> list[str]:
    """Events that say of a packet that it was ignored."""
    return [line for line in mission.console.lines if "/target: ignored " in line]


def test_list_that_ends_before_its_count_is_ignored(mission: Mission) -> None:
    for _ in range(3):
        send(mission, EMPTY_LIST)
        mission.run_for(0.5)
    works(mission)
    (line,) = ignored(mission)
    assert "/target: ignored 28 bytes on 0x080D: no report of subscriptions; told once" in line


def test_reports_that_end_early_are_ignored(mission: Mission) -> None:
    for size in range(1, 30):
        send(mission, packet_of(ONESUB, b"\xff" * size))
        send(mission, packet_of(ALLSUBS, b"\xff" * size))
    for entries in (0, 1, 2, 20, 21, 255, 0xFFFF, 0x80000000):
        send(mission, packet_of(ALLSUBS, bytes(10) + struct.pack("<III", 1, 1, entries) + b"\xff" * 12))
        mission.run_for(0.1)
    works(mission)
    assert len(ignored(mission)) == 1


def test_made_up_subscriptions_take_no_memory(mission: Mission) -> None:
    route = next(each for each in mission.processor.cfe.sb.routes.values() if each.active)
    pipe = route.active[0].pipe.pipe_id
    for number in range(2500):
        send(mission, one_subscription(0x1A00 + number, pipe))
        send(mission, one_subscription(0x1A00 + number, 0xFF000000 + number))
        if number % 20 == 0:
            mission.run_for(0.02)
    works(mission)
    told = [line for line in mission.console.lines if "/target: more than 512 subscriptions" in line]
    assert len(told) == 1


def test_requests_and_answers_that_end_early_are_ignored(mission: Mission) -> None:
    ros = mission.ros
    assert ros is not None
    ids = {name: ros.graph.ids.of_service(name) for name in ("/set", "/other")}
    for size in range(1, 24):
        for msg_id in (ids["/set"] | 0x1000, ids["/other"], MASTER):
            for flags in (0xC0, 0x40, 0x00, 0x80):
                send(mission, packet_of(msg_id, bytes(size), flags))
        mission.run_for(0.3)
    works(mission)
    assert 1 <= len(ignored(mission)) <= 2


def test_notice_of_a_long_parameter_takes_no_memory(mission: Mission) -> None:
    """A notice is an answer of the ROS application with the number 0, and the name of a parameter."""
    send(mission, packet_of(MASTER, bytes(10) + bytes(5) + b"/value/" + b"x" * 2000))
    send(mission, packet_of(MASTER, bytes(10) + bytes(5)))
    works(mission)


def test_random_packets_change_nothing(mission: Mission) -> None:
    ros = mission.ros
    assert ros is not None
    draw = random.Random(7)
    topics = [ros.graph.topics[name].msg_id for name in ("/in", "/tf", "/tf_static")]
    services = [ros.graph.ids.of_service("/set") | 0x1000, ros.graph.ids.of_service("/other"), MASTER]
    forged = [packet_of(ALLSUBS, bytes(10) + struct.pack("<III", segment, 1, 20) + bytes(256)) for segment in (1, 2, 9)]
    for _ in range(400):
        msg_id = draw.choice([ALLSUBS, *topics, *services])
        size = draw.choice([1, 2, 6, 9, 10, 11, 15, 22, 30, 100, 1000, 2000])
        payload = bytearray(draw.randbytes(size))
        if draw.random() < 0.5:
            payload[:10] = bytes(min(size, 10))  # addressed to nobody else
        send(mission, packet_of(msg_id, bytes(payload), draw.choice((0xC0, 0x40, 0x00, 0x80)), draw.randrange(256)))
        if draw.random() < 0.1:
            send(mission, draw.choice(forged))
        if draw.random() < 0.2:
            mission.run_for(0.05)
    works(mission)
