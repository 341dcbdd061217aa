"""Commands and housekeeping of nodes in C++, and their marks in the performance log."""

from __future__ import annotations

import struct
from pathlib import Path

import pytest

import cfepy
from cfepy.flight import Flight
from dev.roscfe.building import needs_cpp

pytestmark = [needs_cpp, pytest.mark.slow]

MANIFEST = """<package format="2"><name>hearing</name><version>1.0.0</version><description>hearing</description>
<maintainer email="a@b.c">a</maintainer><license>Apache-2.0</license><depend>roscpp</depend><depend>std_msgs</depend>
<depend>std_srvs</depend></package>
"""
NODE = """
#include <ros/ros.h>
#include <std_msgs/UInt32.h>
#include <std_srvs/Empty.h>

static void hear(const std_msgs::UInt32 &message) { ROS_INFO("heard %u", message.data); }
static bool answer(std_srvs::Empty::Request &, std_srvs::Empty::Response &) { return true; }

int main(int argc, char **argv)
{
  ros::init(argc, argv, "hearing");
  ros::NodeHandle node;
  ros::Publisher own = node.advertise<std_msgs::UInt32>("own", 1);
  ros::Subscriber three = node.subscribe("numbers", 3, hear);
  ros::ServiceServer service = node.advertiseService("answer", answer);
  for (;;)
  {
    ros::Duration(1.0).sleep(); // messages come meanwhile, and wait
    if (!ros::ok())
    {
      return 0;
    }
    own.publish(std_msgs::UInt32());
    ros::spinOnce();
  }
}
"""
LAUNCH = '<launch><node pkg="hearing" type="hearing" name="hearing" output="screen"/></launch>\n'
MISSION = """launch: [{file: hearing.launch}]
cpp_nodes:
  ground:
    /hearing: {msg_id: 0x0A10, performance_id: 40}
"""
HOUSEKEEPING = 0x0A10
PACKET = struct.Struct("<BB2x10I")
FIELDS = (
    *("command_counter", "command_error_counter", "received", "dropped", "bad", "sent", "not_sent"),
    *("callbacks_waiting", "calls_waiting", "arena_bytes", "arena_used", "late_allocations"),
)
EXIT = 1 << 31
NOOP, RESET_COUNTERS, SEND_HOUSEKEEPING = 0, 1, 2


def command(code: int, more: bytes = b"") -> bytes:
    """Return a packet with a command of the node."""
    return struct.pack(">HHHBB", HOUSEKEEPING | 0x1000, 0xC000, 1 + len(more), code, 0) + more


@pytest.fixture
def mission(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    folder = tmp_path / "hearing"
    folder.mkdir()
    monkeypatch.setenv("ROS_PACKAGE_PATH", str(tmp_path))
    for name, text in (
        ("package.xml", MANIFEST),
        ("CMakeLists.txt", "project(hearing)\nadd_executable(hearing hearing.cpp)\n"),
        ("hearing.cpp", NODE),
        ("hearing.launch", LAUNCH),
        ("startup.scr", "!\n"),
        ("mission.yaml", MISSION),
    ):
        (folder / name).write_text(text, encoding="utf-8")
    return folder


def packets(flight: Flight) -> list[dict[str, int]]:
    """Return the values of all packets of housekeeping so far."""
    sent = flight.log.packets.get(HOUSEKEEPING, [])
    return [dict(zip(FIELDS, PACKET.unpack(each.packet[16:]), strict=True)) for each in sent]


def housekeeping(flight: Flight) -> dict[str, int]:
    """Ask the node for its housekeeping, and return the values of the packet."""
    before = len(packets(flight))
    flight.send(command(SEND_HOUSEKEEPING))
    flight.run_for(1.5)
    (values,) = packets(flight)[before:]
    return values


def test_node_counts_its_commands(mission: Path) -> None:
    with cfepy.boot(mission) as flight:
        flight.run_until_operational()
        flight.send(command(NOOP))
        flight.expect_event("HEARING", 9, "/hearing: no-op command")
        flight.send(command(99))
        flight.expect_event("HEARING", 9, "/hearing: command with an unknown code: code 99, 8 bytes")
        flight.send(command(NOOP, b"\0\0"))
        flight.expect_event("HEARING", 9, "/hearing: command with a wrong length: code 0, 10 bytes")
        values = housekeeping(flight)
        assert (values["command_counter"], values["command_error_counter"]) == (1, 2)
        flight.send(command(RESET_COUNTERS))
        flight.expect_event("HEARING", 9, "/hearing: counters reset")
        values = housekeeping(flight)
        assert (values["command_counter"], values["command_error_counter"], values["received"]) == (0, 0, 0)


def test_housekeeping_counts_messages_and_lost_ones(mission: Path) -> None:
    with cfepy.boot(mission) as flight:
        flight.run_until(3.1)
        for number in range(5):
            flight.publish("/numbers", data=number)
        flight.send(command(SEND_HOUSEKEEPING))
        flight.run_for(0.2)
        values = packets(flight)[-1]
        assert (values["received"], values["dropped"], values["callbacks_waiting"]) == (5, 2, 3)
        flight.run_for(1.0)  # the node spins
        values = housekeeping(flight)
        assert (values["received"], values["dropped"], values["callbacks_waiting"]) == (5, 2, 0)
        assert (values["bad"], values["not_sent"], values["arena_bytes"]) == (0, 0, 0)


def test_performance_log_has_the_marks_of_a_node(mission: Path) -> None:
    with cfepy.boot(mission) as flight:
        flight.run_until_operational()
        flight.send("CFE_ES_START_PERF_DATA", TriggerMode=0)
        flight.run_for(3.0)
        entries = [entry[0] for entry in flight.mission.cfe.es.perf_log.data.entries]
    is_exit = [bool(entry & EXIT) for entry in entries if entry & ~EXIT == 40]
    assert len(is_exit) > 4
    assert is_exit == [bool(turn % 2) != is_exit[0] for turn in range(len(is_exit))]


def test_node_without_an_entry_has_no_commands(mission: Path) -> None:
    (mission / "mission.yaml").write_text("launch: [{file: hearing.launch}]\n", encoding="utf-8")
    with cfepy.boot(mission) as flight:
        flight.run_until_operational()
        flight.send(command(NOOP))
        flight.expect_no_event("HEARING", 9)
        flight.send(command(SEND_HOUSEKEEPING))
        flight.run_for(2.0)
        assert packets(flight) == []
