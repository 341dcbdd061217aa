"""Launch files in a mission: their nodes beside those of the startup script, merged parameters, errors with
locations."""

from __future__ import annotations

import textwrap
from pathlib import Path

import pytest

from cfepy.mission import Mission, read_mission
from cfepy.mission.launch import spec_of
from cfepy.pilot.mission_check import check_mission
from cfepy.status import UsageError
from cfepy.writing.console import Console
from rospy_shim.types.config import NodeConfig

SAY = "import rospy\nrospy.init_node('say')\nprint(rospy.get_name(), rospy.get_param('/shared', None))\n"
LAUNCH = """
    <launch>
      <arg name="who" default="nobody"/>
      <param name="shared" value="of the launch file"/>
      <param name="only/here" value="1"/>
      <node pkg="pack" type="say.py" name="$(arg who)"/>
      <node pkg="pack" type="say.py" name="own"/>
      <node pkg="pack" type="binary" name="left_out"/>
    </launch>
    """


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """Return a mission of one node, OWN, with a package `pack` beside it."""
    pack = tmp_path / "pack"
    pack.mkdir()
    (pack / "package.xml").write_text("<package><name>pack</name></package>", encoding="utf-8")
    (pack / "say.py").write_text(SAY, encoding="utf-8")
    (pack / "nodes.launch").write_text(textwrap.dedent(LAUNCH), encoding="utf-8")
    (tmp_path / "own.py").write_text(SAY, encoding="utf-8")
    (tmp_path / "startup.scr").write_text("CFE_APP, own, __main__, OWN, 100, 16384, 0x0, 0;\n!\n", encoding="utf-8")
    return tmp_path


def fly(folder: Path) -> list[str]:
    console = Console(quiet=True)
    with Mission(str(folder), console=console) as mission:
        mission.run_for(2)
        assert not mission.over
    return [line for line in console.lines if line.startswith("[")]


def test_nodes_of_a_launch_file_run_with_the_nodes_of_the_mission(folder: Path) -> None:
    (folder / "mission.yaml").write_text(
        "launch: [{file: pack/nodes.launch, args: {who: somebody}}]\n", encoding="utf-8"
    )
    assert fly(folder) == [
        "[say] /say of the launch file",
        "[somebody] /somebody of the launch file",
        "[own] /own of the launch file",
    ]


def test_mission_file_overrides_the_launch_file(folder: Path) -> None:
    (folder / "mission.yaml").write_text(
        "launch: [pack/nodes.launch]\nparams: {shared: mine, only: {too: 2}}\n", encoding="utf-8"
    )
    spec = read_mission(str(folder))
    assert spec.ros.params["shared"] == "mine"
    assert spec.ros.params["only"] == {"here": 1, "too": 2}
    assert list(spec.ros.nodes) == ["NOBODY", "OWN2"]
    assert spec.startup_script.startswith(
        b"CFE_APP, own, __main__, OWN, 100, 16384, 0x0, 0;\nCFE_APP, NOBODY, __main__,"
    )
    (note,) = spec.notes
    assert "node /left_out is left out" in note


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("launch: [none.launch]", "mission.yaml:1: launch[0]: file not found: {folder}/none.launch"),
        ("launch: [{args: {a: 1}}]", "mission.yaml:1: launch[0]: missing file"),
        ("launch: [{file: a, arg: {}}]", "mission.yaml:1: launch[0].arg: unknown field"),
        ("launch: [bad.launch]", "bad.launch:1: <node>: missing 'pkg'"),
    ],
)
def test_errors_have_a_place(folder: Path, text: str, said: str) -> None:
    (folder / "mission.yaml").write_text(text, encoding="utf-8")
    (folder / "bad.launch").write_text('<launch><node name="n" type="t"/></launch>', encoding="utf-8")
    with pytest.raises(UsageError) as raised:
        read_mission(str(folder))
    assert said.format(folder=folder) in str(raised.value)
    (found,) = check_mission(str(folder))
    assert found.text in str(raised.value)


def test_mission_in_memory_has_room_for_its_nodes(tmp_path: Path) -> None:
    script = tmp_path / "idle.py"
    script.write_text("import rospy\nrospy.init_node('idle', anonymous=True)\nrospy.spin()\n", encoding="utf-8")
    nodes = {f"N{number}": NodeConfig(f"N{number}", script=script) for number in range(40)}
    with Mission(spec_of(script, nodes, {}), console=Console(quiet=True)) as mission:
        mission.run_for(2)
        assert len(mission.ros.graph.nodes) == 40
    assert not list(tmp_path.glob("*.scr"))


def test_a_burst_waits_as_on_a_pc(tmp_path: Path) -> None:
    """A thousand messages for a subscriber that has not handled the first of them."""
    script = tmp_path / "burst.py"
    script.write_text(
        "import rospy\nfrom std_msgs.msg import UInt32\nrospy.init_node('burst')\nseen = []\n"
        "rospy.Subscriber('t', UInt32, lambda message: seen.append(message.data))\n"
        "publisher = rospy.Publisher('t', UInt32, queue_size=1000)\n"
        "for number in range(1000):\n    publisher.publish(number)\n"
        "rospy.sleep(1)\nprint(seen == list(range(1000)))\n",
        encoding="utf-8",
    )
    console = Console(quiet=True)
    with Mission(spec_of(script, {"BURST": NodeConfig("BURST", script=script)}, {}), console=console) as mission:
        mission.run_for(3)
    assert "[burst] True" in console.lines
