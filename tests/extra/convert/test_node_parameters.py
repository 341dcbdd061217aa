"""Parameters of nodes in C++ on cfepy: one parameter server, and the node's table, which the ground loads."""

from __future__ import annotations

import shutil
from collections.abc import Iterator
from pathlib import Path

import pytest

from cfepy.extra.convert.build import build_node, provided_packages
from cfepy.extra.convert.entry import NodeEntry, parameter_rows
from cfepy.extra.convert.packages import program_of, read_package
from cfepy.mission import Mission, read_mission
from cfepy.pilot.plan import built_node
from cfepy.tbl import TableImage, build
from cfepy.tbl.packets import ACTIVATE, LOAD, VALIDATE
from cfepy.writing.console import Console
from dev.roscfe.building import needs_cpp
from rospy_shim.parameters.table import pack
from rospy_shim.types.msgs import Packages, shipped

pytestmark = [needs_cpp, pytest.mark.slow]

MANIFEST = """<package format="2"><name>knobs</name><version>1.0.0</version><description>knobs</description>
<maintainer email="a@b.c">a</maintainer><license>Apache-2.0</license><depend>roscpp</depend></package>
"""
NODE = """
#include <ros/ros.h>

int main(int argc, char **argv)
{
  ros::init(argc, argv, "knob");
  ros::NodeHandle nh, own("~");
  ros::Rate rate(2);
  int ticks = 0;
  nh.getParam("/ticks", ticks);
  while (ros::ok())
  {
    std::string text, cached;
    own.getParam("text", text);
    own.getParamCached("text", cached);
    ROS_INFO("text %s %s", text.c_str(), cached.c_str());
    nh.setParam("/ticks", ++ticks);
    rate.sleep();
  }
}
"""
LAUNCH = '<launch><node pkg="knobs" type="knob" name="knob"><param name="text" value="{}"/></node></launch>\n'


@pytest.fixture
def package(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setenv("ROS_PACKAGE_PATH", str(tmp_path))
    folder = tmp_path / "knobs"
    folder.mkdir()
    (folder / "package.xml").write_text(MANIFEST, encoding="utf-8")
    (folder / "CMakeLists.txt").write_text("project(knobs)\nadd_executable(knob knob.cpp)\n", encoding="utf-8")
    (folder / "knob.cpp").write_text(NODE, encoding="utf-8")
    return folder


def table(params: dict[str, object]) -> bytes:
    rows = parameter_rows(params, "/knob")
    return build(TableImage("KNOB.Params", b"".join(map(pack, rows)), "parameters"))


@pytest.fixture
def launched(package: Path, tmp_path: Path) -> Iterator[Mission]:
    """A mission with the node in a launch file, and a table file for it."""
    folder = tmp_path / "mission"
    folder.mkdir()
    (folder / "startup.scr").write_text("!\n", encoding="utf-8")
    (folder / "mission.yaml").write_text("launch: [knob.launch]\n", encoding="utf-8")
    (folder / "knob.launch").write_text(LAUNCH.format("launch"), encoding="utf-8")
    params = read_mission(str(folder)).ros.params
    (folder / "knob.tbl").write_bytes(table({**params, "knob": {"text": "ground"}}))
    with Mission(read_mission(str(folder), build=built_node), console=Console(quiet=True)) as mission:
        yield mission


def texts(mission: Mission) -> list[str]:
    """Return the values that the node read last."""
    line = next(line for line in reversed(mission.console.lines) if "]: text " in line)
    return line.partition("text ")[2].removesuffix("\x1b[0m").split(" ")


def test_all_nodes_share_one_parameter_server(launched: Mission) -> None:
    launched.run_for(3)
    params = launched.ros.graph.params
    assert texts(launched) == ["launch", "launch"]
    assert params.find("/ticks") in (5, 6)
    params.set("/knob/text", "other")
    launched.run_for(1)
    assert texts(launched) == ["other", "other"]
    params.set("/knob", {"text": "third"})
    launched.run_for(1)
    assert texts(launched) == ["third", "third"]


def test_table_loaded_by_the_ground_updates_the_parameter_server(launched: Mission) -> None:
    launched.run_for(2)
    for packet in (
        LOAD.packet(LoadFilename="/cf/knob.tbl"),
        VALIDATE.packet(ActiveTableFlag=0, TableName="KNOB.Params"),
        ACTIVATE.packet(TableName="KNOB.Params"),
    ):
        launched.cfe.sb.transmit_msg(packet)
        launched.run_for(2)
    assert texts(launched) == ["ground", "ground"]
    assert launched.ros.graph.params.find("/knob/text") == "ground"


@pytest.mark.parametrize("there", ["{}", "{knob: {text: mission}}"])
def test_node_built_for_cfe_has_its_own_default_parameters(package: Path, tmp_path: Path, there: str) -> None:
    program = program_of(read_package(package, "knobs"), "knob", Packages(package / "x", {}), provided_packages())
    built = build_node(
        program, NodeEntry("KNOB", "knob", rows=parameter_rows({"knob": {"text": "own"}}, "/knob")), shipped()
    )
    folder = tmp_path / "mission"
    folder.mkdir()
    shutil.copy(built.library, folder / "knob.so")
    (folder / "startup.scr").write_text(
        f"CFE_APP, knob, {built.entry}, KNOB, 60, 65536, 0x0, 0;\n!\n", encoding="utf-8"
    )
    (folder / "mission.yaml").write_text(f"params: {there}\n", encoding="utf-8")
    with Mission(str(folder), console=Console(quiet=True)) as mission:
        mission.run_for(2)
        assert texts(mission) == (["own", "own"] if there == "{}" else ["mission", "mission"])
        assert mission.ros.graph.params.find("/knob/text") == texts(mission)[0]
