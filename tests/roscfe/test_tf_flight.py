"""Nodes in C++ and in Python exchange transforms on one bus."""

from __future__ import annotations

import re
import shutil
from pathlib import Path

import pytest

from cfepy.cli.main import main

NODES = Path(__file__).with_name("tf_nodes")
MANIFEST = """<package format="2"><name>where</name><version>1.0.0</version><description>where</description>
  <maintainer email="a@b.c">a</maintainer><license>Apache-2.0</license><depend>roscpp</depend><depend>tf</depend>
  <depend>tf2_ros</depend><depend>tf2_geometry_msgs</depend><depend>message_filters</depend></package>
"""
CMAKE = """
cmake_minimum_required(VERSION 3.0.2)
project(where)
find_package(catkin REQUIRED COMPONENTS roscpp tf tf2_ros tf2_geometry_msgs message_filters)
catkin_package()
foreach(each tell hear)
  add_executable(${each} src/${each}.cpp)
  target_link_libraries(${each} ${catkin_LIBRARIES})
endforeach()
"""
LAUNCH = """<launch>
  <node pkg="where" type="tell" name="tell"/>
  <node pkg="where" type="hear" name="hear" output="screen"/>
  <node pkg="where" type="script.py" name="script" output="screen"/>
</launch>
"""


def package(folder: Path) -> Path:
    """Write a package of the nodes. Returns its launch file."""
    for name in ("src", "scripts", "launch"):
        (folder / "where" / name).mkdir(parents=True)
    for source in NODES.iterdir():
        shutil.copy(source, folder / "where" / ("src" if source.suffix == ".cpp" else "scripts"))
    (folder / "where/package.xml").write_text(MANIFEST, encoding="utf-8")
    (folder / "where/CMakeLists.txt").write_text(CMAKE, encoding="utf-8")
    launch = folder / "where/launch/where.launch"
    launch.write_text(LAUNCH, encoding="utf-8")
    return launch


@pytest.mark.slow
def test_nodes_in_cpp_and_python_exchange_transforms(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setenv("ROS_PACKAGE_PATH", str(tmp_path))
    assert main(["launch", str(package(tmp_path)), "--for", "3"]) == 0
    shown = capfd.readouterr().out
    said = {line.split("]: ", 1)[1] for line in shown.splitlines() if "INFO] [" in line}
    assert {
        "waited 1, lag under 0.06 1, height 0.5",
        '"nowhere" passed to lookupTransform argument source_frame does not exist. ',
        "arm 1 3 in base_link",
        "never: 0 canTransform: source_frame nowhere does not exist.. canTransform returned after",
        "python: 2 0.5",
    } <= said, shown
    # The filter lets a point through with the transform after it, each one, in their order.
    points = [float(each) for each in re.findall(r"seen (\S+) in /map, stamp kept 1", shown)]
    assert points == list(map(float, range(int(points[0]), int(points[0]) + len(points))))
    assert len(points) > 40
