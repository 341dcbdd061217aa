"""`cfepy check` lists the packages that nodes and applications import and that are not installed."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from types import MappingProxyType

import pytest

from cfepy.cli.main import main
from cfepy.pilot import check_mission
from cfepy.pilot.mission_check.missing_imports import DISTRIBUTIONS, OF_PYTHON_2, OF_ROS, imports_of
from tests.mission.flights import write_mission

STARTUP = "CFE_APP, node, __main__, NODE, 50, 65536, 0x0, 0;"
APP = "CFE_APP, heater, HEATER_Main, HEATER, 50, 16384, 0x0, 0;\n!"


def texts(node: str, folder: Path, modules: Mapping[str, str] = MappingProxyType({})) -> list[str]:
    """Return the problems of a node beside some modules, as file:line: text."""
    for name, text in {"node": node, **modules}.items():
        path = folder / f"{name}.py"
        path.parent.mkdir(exist_ok=True)
        path.write_text(text, encoding="utf-8")
    found = check_mission(str(folder / "node.py"))
    return [f"{each.file.name}:{each.line}: {'warning: ' if each.is_warning else ''}{each.text}" for each in found]


@pytest.mark.parametrize(
    ("line", "problem"),
    [
        ("import nonesuch", "the package nonesuch is not installed; pip install nonesuch"),
        ("import nonesuch.part as n", "the package nonesuch is not installed; pip install nonesuch"),
        ("from nonesuch.part import *", "the package nonesuch is not installed; pip install nonesuch"),
        ("import Queue", "Queue is a module of Python 2; import queue"),
        ("import sys\nif sys.version_info.major == 2:\n    import urllib2", ""),
        ("import smach", "the ROS package smach is not installed; put its source on ROS_PACKAGE_PATH"),
        ("if 1 > 0:\n    import nonesuch", "the package nonesuch is not installed; pip install nonesuch"),
        ("class A:\n    import nonesuch", "the package nonesuch is not installed; pip install nonesuch"),
        (
            "try:\n    import nonesuch\nfinally:\n    pass",
            "the package nonesuch is not installed; pip install nonesuch",
        ),
        ("try:\n    import nonesuch\nexcept KeyError:\n    pass", "the package nonesuch is not installed"),
        ("import os, json.decoder, numpy.linalg, rospy, genpy, tf2_ros, std_msgs, PIL", ""),
        ("import rospy.impl, rospy_shim", ""),
        ("from dynamic_reconfigure.server import Server", ""),
        ("try:\n    import nonesuch\nexcept ImportError:\n    pass", ""),
        ("try:\n    import nonesuch\nexcept (OSError, ModuleNotFoundError):\n    pass", ""),
        ("try:\n    import nonesuch\nexcept:\n    pass", ""),
        ("import typing\nif typing.TYPE_CHECKING:\n    import nonesuch", ""),
    ],
)
def test_import_of_a_node(line: str, problem: str, tmp_path: Path) -> None:
    found = texts(f"{line}\n", tmp_path)
    assert len(found) == bool(problem)
    assert not problem or problem in found[0]


PYTHON_2 = (
    "sys.version_info.major == 2",
    "sys.version_info[0] < 3",
    "sys.version_info < (3,)",
    "sys.version_info[:2] <= (2, 7)",
    "version_info[0] == 2",
    "sys.version[0] == '2'",
    "int(sys.version[0]) < 3",
    "sys.version.startswith('2.')",
    "sys.hexversion < 0x03000000",
    "six.PY2",
    "not six.PY3",
    "PY2",
    "IS_OLD",
    "six.PY2 and unknown",
    "unknown and six.PY2",
)
PYTHON_3 = (*(f"not ({each})" for each in PYTHON_2), "sys.version_info >= (3, 0)", "six.PY3", "PY3", "unknown or PY3")
HEAD = "import sys\nfrom sys import version_info\nIS_OLD = version_info[0] == 2\n"


@pytest.mark.parametrize(
    "source",
    [
        *(f"if {each}:\n    import urllib2\nelse:\n    import urllib" for each in PYTHON_2),
        *(f"if {each}:\n    import urllib\nelse:\n    import urllib2" for each in PYTHON_3),
        *(f"if unknown:\n    pass\nelif {each}:\n    import urllib2" for each in PYTHON_2[:3]),
        *(f"if {each}:\n    pass\nelif unknown:\n    import urllib2" for each in PYTHON_3[-4:]),
        "def fetch():\n    if sys.version_info[0] == 2:\n        import urllib2",
    ],
)
def test_import_for_python_2_alone_is_accepted(source: str, tmp_path: Path) -> None:
    path = tmp_path / "node.py"
    path.write_text(f"{HEAD}{source}\n", encoding="utf-8")
    assert "urllib2" not in {each.name for each in imports_of(path, [])}


@pytest.mark.parametrize(
    "source",
    [
        *(f"if {each}:\n    import urllib2" for each in PYTHON_3),
        *(f"if {each}:\n    pass\nelse:\n    import urllib2" for each in PYTHON_2),
        *(
            f"if {each}:\n    import urllib2"
            for each in ("unknown", "len(sys.argv) > 1", "sys.version_info[0] == 2 or unknown", "sys.version_info[9]")
        ),
        "PY2 = unknown()\nif PY2:\n    import urllib2",
        "DEBUG = False\nif DEBUG:\n    import urllib2",
    ],
)
def test_import_that_may_run_is_reported(source: str, tmp_path: Path) -> None:
    path = tmp_path / "node.py"
    path.write_text(f"{HEAD}{source}\n", encoding="utf-8")
    assert "urllib2" in {each.name for each in imports_of(path, [])}


def test_import_within_a_function_is_a_warning(tmp_path: Path) -> None:
    [found] = texts("def plot():\n    import nonesuch\n", tmp_path)
    assert found.startswith("node.py:2: warning: the package nonesuch is not installed")
    assert found.endswith("a run fails when it calls this function")


def test_imports_of_modules_beside_the_node_are_followed(tmp_path: Path) -> None:
    found = texts(
        "import helper\nfrom parts import near\n",
        tmp_path,
        {
            "helper": "import nonesuch\nimport node\n",
            "parts/__init__": "",
            "parts/near": "from . import far\nfrom .far import more\n",
            "parts/far": "import other_nonesuch\nmore = 1\n",
            "parts/unused": "import unused_nonesuch\n",
        },
    )
    assert [each.partition(";")[0] for each in found] == [
        "helper.py:1: the package nonesuch is not installed",
        "far.py:1: the package other_nonesuch is not installed",
    ]


def test_modules_that_import_each_other_are_read_once(tmp_path: Path) -> None:
    (tmp_path / "a.py").write_text("import b, x\n", encoding="utf-8")
    (tmp_path / "b.py").write_text("import a, y\n", encoding="utf-8")
    assert {each.name for each in imports_of(tmp_path / "a.py", [str(tmp_path)])} == {"a", "b", "x", "y"}


def test_messages_of_a_package_beside_the_node_count_as_installed(tmp_path: Path) -> None:
    (tmp_path / "my_msgs/msg").mkdir(parents=True)
    (tmp_path / "my_msgs/package.xml").write_text("<package><name>my_msgs</name></package>", encoding="utf-8")
    (tmp_path / "my_msgs/msg/Level.msg").write_text("float64 value\n", encoding="utf-8")
    assert texts("import my_msgs\nimport my_msgs.msg\nfrom my_msgs.msg import Level\n", tmp_path) == []


def test_command_ends_with_one_line_for_pip(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "node.py").write_text("import serial_nonesuch\nimport b_nonesuch, smach\n", encoding="utf-8")
    assert main(["check", str(tmp_path / "node.py")]) == 1
    lines = capsys.readouterr().out.splitlines()
    assert lines[-2:] == ["install the missing packages: pip install b_nonesuch serial_nonesuch", "3 problems found"]


def test_application_and_node_of_a_mission(tmp_path: Path) -> None:
    heater = "import app_nonesuch\n\ndef HEATER_Main(cfe):\n    pass\n"
    write_mission(tmp_path, f"{STARTUP}\n{APP}", node="import node_nonesuch\n", heater=heater)
    found = check_mission(str(tmp_path))
    assert [each.package for each in found if each.package] == ["app_nonesuch", "node_nonesuch"]


def test_tables_name_things_once() -> None:
    assert not OF_PYTHON_2.keys() & DISTRIBUTIONS.keys()
    assert not OF_ROS & {*DISTRIBUTIONS, *OF_PYTHON_2}


ROS2_NODE = """import rclpy
from rclpy.node import Node
import message_filters, tf2_ros
from example_interfaces.action import Fibonacci
from example_interfaces.srv import AddTwoInts
from std_msgs.msg import String
rclpy.init()
"""


def test_node_of_ros2_gets_its_libraries_and_messages_from_a_run(tmp_path: Path) -> None:
    assert texts(ROS2_NODE, tmp_path) == []


@pytest.mark.parametrize(
    ("line", "problem"),
    [
        ("from std_msgs.msg import Strin", "package std_msgs has no msg Strin; did you mean String"),
        ("from example_interfaces.srv import Add", "package example_interfaces has no srv Add"),
        ("from nonesuch_msgs.msg import A", "unknown message package nonesuch_msgs"),
        ("import rospy", "node.py:1: a program of ROS 1 cannot import rclpy"),
        ("# ament\nimport rospy", "node.py:3: a program of ROS 2 cannot import rospy"),
        ("import launch_ros", "cfepy does not have launch_ros for nodes of ROS 2 yet"),
        ("import rclpy.nonesuch", "cfepy does not have rclpy.nonesuch for nodes of ROS 2 yet"),
        ("import nonesuch", "the package nonesuch is not installed; pip install nonesuch"),
    ],
)
def test_import_that_a_node_of_ros2_cannot_have_is_a_problem(line: str, problem: str, tmp_path: Path) -> None:
    if "ament" in line:
        manifest = "<package><name>a</name><depend>rclpy</depend></package>"
        (tmp_path / "package.xml").write_text(manifest, encoding="utf-8")
    (found,) = texts(f"import rclpy\n{line}\n", tmp_path)
    assert (problem if problem.startswith("node.py:") else f"node.py:2: {problem}") in found
