"""Nodes in the profile strict on cfepy: profile, arena and capacities come from the mission file."""

from __future__ import annotations

from pathlib import Path

import pytest

from cfepy.cli.main import main
from dev.convert.ping import ping_package
from dev.roscfe.building import needs_cpp

pytestmark = [needs_cpp, pytest.mark.slow]

TALKER = """#!/usr/bin/env python3
import rospy
from ping.msg import Beat

rospy.init_node("script")
talker = rospy.Publisher("/pulse", Beat, queue_size=9)
rospy.sleep(1.0)
for word in ("as long as it can", "as long as it can be", "a text that is longer than the others", "short"):
    talker.publish(word=word)
    rospy.sleep(0.1)
"""
WRITER = """
#include <ping/Beat.h>
#include <ros/ros.h>

int main(int argc, char **argv)
{
  ros::init(argc, argv, "writer");
  ros::NodeHandle nh;
  ros::Publisher pub = nh.advertise<ping::Beat>("beat", 4);
  ros::Duration(0.5).sleep();
  ping::Beat message;
  message.word = "twelve signs";
  pub.publish(message);
  message.word = "more than twelve";
  pub.publish(message);
}
"""
LAUNCH = """<launch>
  <node pkg="ping" type="hearer" name="ear"><remap from="beat" to="/pulse"/></node>
  <node pkg="ping" type="{talker}" name="talker"><remap from="beat" to="/pulse"/></node>
</launch>
"""
MISSION = """launch: [all.launch]
cpp_nodes:
  profile: strict
  arena_bytes: {arena}
  capacities:
    ping/Beat: {{word: {word}}}
"""


@pytest.fixture
def mission(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Return a mission's folder, beside the package ping, whose sender writes two texts."""
    package = ping_package(tmp_path)
    monkeypatch.setenv("ROS_PACKAGE_PATH", str(tmp_path))
    (package / "scripts/talker.py").write_text(TALKER, encoding="utf-8")
    (package / "scripts/talker.py").chmod(0o755)
    (package / "src/sender.cpp").write_text(WRITER, encoding="utf-8")
    folder = tmp_path / "mission"
    folder.mkdir()
    (folder / "startup.scr").write_text("!\n", encoding="utf-8")
    return folder


def fill(folder: Path, talker: str = "talker.py", arena: int = 65536, word: int = 20) -> str:
    (folder / "all.launch").write_text(LAUNCH.format(talker=talker), encoding="utf-8")
    (folder / "mission.yaml").write_text(MISSION.format(arena=arena, word=word), encoding="utf-8")
    return str(folder)


def test_message_beyond_its_capacity_is_refused(mission: Path, capfd: pytest.CaptureFixture[str]) -> None:
    assert main(["run", fill(mission), "--for", "3"]) == 1  # an event of the type ERROR
    shown = capfd.readouterr().out
    assert shown.count("/ear: refused 61 bytes on /pulse: no message of its type, or one beyond its capacities") == 1
    heard = [
        line.partition("heard 0 ")[2].removesuffix("\x1b[0m") for line in shown.splitlines() if "]: heard 0 " in line
    ]
    assert heard == ["as long as it can", "as long as it can be", "short"]


def test_text_beyond_its_capacity_ends_the_writing_node(mission: Path, capfd: pytest.CaptureFixture[str]) -> None:
    assert main(["run", fill(mission, "sender", word=12), "--for", "3"]) == 1
    shown = capfd.readouterr().out
    assert "heard 0 twelve signs" in shown
    assert "more than twelve" not in shown
    assert "a text is too long for a field of a message: 12 at most, 16 wanted" in shown


def test_a_small_arena_ends_the_node(mission: Path, capfd: pytest.CaptureFixture[str]) -> None:
    assert main(["run", fill(mission, arena=4096), "--for", "1"]) == 1
    assert "the node's arena is full" in capfd.readouterr().out


def test_a_mistake_in_the_mission_file_ends_the_run(mission: Path, capfd: pytest.CaptureFixture[str]) -> None:
    fill(mission)
    file = mission / "mission.yaml"
    file.write_text(file.read_text(encoding="utf-8").replace("word:", "wort:"), encoding="utf-8")
    assert main(["run", str(mission), "--for", "1"]) == 2
    error = "mission.yaml:6: cpp_nodes.capacities.ping/Beat.wort: unknown field of ping/Beat; did you mean word?"
    assert error in capfd.readouterr().err
    assert main(["check", str(mission)]) == 1
    assert capfd.readouterr().out.count(error) == 1


def test_the_check_counts_with_the_capacities(mission: Path, capfd: pytest.CaptureFixture[str]) -> None:
    package, hearer = str(mission.parent / "ping"), "hearer: beat (ping/Beat): 8 x {0} = {1} bytes"
    assert main(["convert", "check", package, "--cpp-nodes", fill(mission, word=20)]) == 0
    assert hearer.format(32, 256) in capfd.readouterr().out
    assert main(["convert", "check", package, "--cpp-nodes", fill(mission, arena=4096, word=1000)]) == 1
    shown = capfd.readouterr().out
    assert hearer.format("1,012", "8,096") in shown
    place = "mission/mission.yaml:4: 8,096 bytes of messages in an arena of 4,096: "
    assert place in shown
    assert "strict: " in shown


def test_the_folder_for_cfe_has_both(mission: Path, capfd: pytest.CaptureFixture[str]) -> None:
    made = mission.parent / "made"
    launch = str(mission / "all.launch")
    assert main(["convert", launch, "--cpp-nodes", fill(mission, "sender", word=12), "-o", str(made)]) == 0
    assert "roscfe::FixedString<12>" in (made / "roscfe/msg/ping/Beat.h").read_text(encoding="utf-8")
    assert "\n    target_compile_definitions(${ROSCFE_LIBRARY} PRIVATE ROSCFE_ARENA_BYTES=65536)\n" in (
        (made / "roscfe/roscfe.cmake").read_text(encoding="utf-8")
    )
    capfd.readouterr()
    assert main(["run", str(made / "mission"), "--for", "3"]) == 1  # the mission in it is built in the same way
    assert "12 at most, 16 wanted" in capfd.readouterr().out


def test_launch_file_is_built_with_the_options_of_the_command_line(
    mission: Path, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    fill(mission, "sender", word=12)
    launch, journal = str(mission / "all.launch"), str(mission / "run.journal")
    assert main(["launch", launch, "--for", "3"]) == 0
    assert "12 at most" not in capfd.readouterr().out  # of the profile host
    assert main(["launch", launch, "--cpp-nodes", "pool", "--for", "3"]) == 0
    assert "12 at most" not in capfd.readouterr().out
    monkeypatch.chdir(mission.parent)
    said = ["--cpp-nodes", "mission/mission.yaml"]
    assert main(["launch", launch, *said, "--for", "3", "--console", "--record", journal]) == 1
    assert "12 at most, 16 wanted" in capfd.readouterr().out
    assert main(["check", launch, "--cpp-nodes", "tight"]) == 2
    assert "unknown profile 'tight'; expected host, pool, strict" in capfd.readouterr().err
    (mission / "mission.yaml").unlink()
    monkeypatch.chdir(mission)
    assert main(["replay", journal]) == 1  # the same run, which has a problem
    assert "the same run as" in capfd.readouterr().err
