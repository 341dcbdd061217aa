"""Nodes in C++ that end: the report of a launch file, and exit statuses."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from cfepy.cli.main import main
from dev.roscfe.building import needs_cpp

pytestmark = [needs_cpp, pytest.mark.slow]

MANIFEST = """<package format="2"><name>brief</name><version>1.0.0</version><description>brief</description>
<maintainer email="a@b.c">a</maintainer><license>Apache-2.0</license><depend>roscpp</depend></package>
"""
NODE = """
#include <cstdlib>

#include <ros/ros.h>

int main(int argc, char **argv)
{
  ros::init(argc, argv, "brief", ros::init_options::AnonymousName);
  ros::NodeHandle own("~");
  ROS_INFO("%s begins", ros::this_node::getName().c_str());
  ros::Duration(own.param("seconds", 0.5)).sleep();
  const int status = own.param("status", 0);
  if (own.param("exits", false))
  {
    exit(status);
  }
  ros::shutdown();
  return status;
}
"""
LAUNCH = """<launch>
  <node pkg="brief" type="brief" name="one" {one}><param name="status" value="{status}"/></node>
  <node pkg="brief" type="brief" name="two"><param name="seconds" value="{seconds}"/></node>
</launch>
"""


@pytest.fixture
def package(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setenv("ROS_PACKAGE_PATH", str(tmp_path))
    folder = tmp_path / "brief"
    folder.mkdir()
    (folder / "package.xml").write_text(MANIFEST, encoding="utf-8")
    (folder / "CMakeLists.txt").write_text("project(brief)\nadd_executable(brief brief.cpp)\n", encoding="utf-8")
    (folder / "brief.cpp").write_text(NODE, encoding="utf-8")
    return folder


def launched(package: Path, one: str, status: int = 0, seconds: float = 60.0) -> int:
    (package / "brief.launch").write_text(LAUNCH.format(one=one, status=status, seconds=seconds), encoding="utf-8")
    return main(["launch", str(package / "brief.launch"), "--for", "10"])


def test_respawning_node_is_started_again(package: Path, capfd: pytest.CaptureFixture[str]) -> None:
    assert launched(package, 'respawn="true" respawn_delay="1.0"', status=3) == 0
    shown = capfd.readouterr().out
    said = shown.count("launch: one ended with exit status 3 and is restarted")
    assert 3 <= said <= 6
    assert shown.count("[/one] [ INFO]") in (said, said + 1)
    assert shown.count("[/two] [ INFO]") == 1


def test_end_of_a_required_node_ends_the_run(package: Path, capfd: pytest.CaptureFixture[str]) -> None:
    assert launched(package, 'required="true"', status=2) == 1
    shown = capfd.readouterr().out
    assert "launch: one ended with exit status 2; it is required, so the run ends" in shown
    assert "ended, exit status 2" in shown
    assert "\n1.0" in shown


def test_run_ends_with_its_nodes(package: Path, capfd: pytest.CaptureFixture[str]) -> None:
    assert launched(package, "", seconds=1.0) == 0
    shown = capfd.readouterr().out
    assert shown.count("ended, exit status 0") == 2
    assert "\n1.5" in shown  # virtual seconds, of which 0.55 are the boot


def test_exit_status_of_one_node_is_the_status_of_the_command(package: Path) -> None:
    for status in ("0", "4"):
        for exits in ("false", "true"):
            assert main(["node", "brief", "brief", f"_status:={status}", f"_exits:={exits}"]) == int(status)


def test_anonymous_node_gets_a_generated_name(package: Path, capfd: pytest.CaptureFixture[str]) -> None:
    assert main(["node", "brief", "brief"]) == 0
    assert re.search(r"\]: /brief_\d{18,19} begins", capfd.readouterr().out)
    assert main(["node", "brief", "brief", "__name:=given", "_status:=1"]) == 1
    assert "]: /given begins" in capfd.readouterr().out
