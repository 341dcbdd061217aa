"""Small missions for suites that `pytester` runs, and the commands that they print."""

from __future__ import annotations

import os
import re
import shlex
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import numpy as np  # noqa: F401  # imported here, or each suite would import it anew
import pytest

import cfepy.testing.strategies  # noqa: F401  # the same
from cfepy.pilot.plan import NODE, RunPlan
from cfepy.testing import Flight

ROOT = Path(__file__).parents[2]
AS_WRITTEN = ("-p", "no:cacheprovider", "-p", "no:randomly")
"""Options of a suite within a test: its tests in the order in which they stand, and nothing kept."""
NODE_LINE = "CFE_APP, {name}.py, __main__, {app}, 100, 65536, 0x0, 0;\n"


@pytest.fixture(autouse=True)
def at_a_desk(monkeypatch: pytest.MonkeyPatch) -> None:
    """Suites are run as by a person: on a CI server pytest's summary has the whole texts of the failures again."""
    for name in ("CI", "BUILD_NUMBER"):
        monkeypatch.delenv(name, raising=False)


TALKER = """
import rospy
from std_msgs.msg import Int32
from std_srvs.srv import Trigger, TriggerResponse


def reset(request):
    global number
    number = 0
    return TriggerResponse(success=True, message="from 0")


number = 0
rospy.init_node("talker")
publisher = rospy.Publisher("count", Int32, queue_size=10)
rospy.Subscriber("jump", Int32, lambda message: publisher.publish(message.data))
rospy.Service("reset", Trigger, reset)
print("talking")
while not rospy.is_shutdown():
    number += rospy.get_param("~step", 1)
    publisher.publish(number)
    rospy.sleep(0.1)
"""

RACY = """
import threading

import rospy
from std_msgs.msg import Int32


def add():
    global total
    for _ in range(3):
        before = total
        rospy.get_param("/step", 1)
        total = before + 1


total = 0
rospy.init_node("racy")
publisher = rospy.Publisher("total", Int32, queue_size=10, latch=True)
threads = [threading.Thread(target=add) for _ in range(2)]
for thread in threads:
    thread.start()
for thread in threads:
    thread.join()
publisher.publish(total)
print("total", total)
rospy.spin()
"""

Suite = Callable[..., pytest.RunResult]


def write_mission(folder: Path, **nodes: str) -> Path:
    """Return a mission of ROS nodes: their programs by name."""
    folder.mkdir()
    lines = [NODE_LINE.format(name=name, app=name.upper()) for name in nodes]
    (folder / "startup.scr").write_text("".join(lines) + "!\n", encoding="utf-8")
    for name, text in nodes.items():
        (folder / f"{name}.py").write_text(text, encoding="utf-8")
    return folder


@pytest.fixture(scope="session")
def loaded(tmp_path_factory: pytest.TempPathFactory) -> None:
    """Load every module that a mission needs, because pytester unloads those that a suite imports."""
    folder = write_mission(tmp_path_factory.mktemp("loaded") / "talk", talker=TALKER, racy=RACY)
    for tasks in ("thread", "greenlet"):
        with Flight(RunPlan((str(folder),), tasks=tasks)) as flight:
            flight.run_for(1)
            flight.publish("/jump", data=1)
            assert flight.call_service("/reset").success
            assert not flight.results.problems
    launched = tmp_path_factory.mktemp("launched")
    (launched / "mission.yaml").write_text("launch: [none.launch]\n", encoding="utf-8")
    (launched / "none.launch").write_text("<launch/>\n", encoding="utf-8")
    for plan in (RunPlan((str(folder / "racy.py"),), NODE), RunPlan((str(launched),))):
        with Flight(plan) as flight:
            flight.run_for(1)


@pytest.fixture
def missions(pytester: pytest.Pytester, loaded: None) -> Path:
    """The folder of a suite, with the missions `talk` and `race` in it."""
    write_mission(pytester.path / "talk", talker=TALKER)
    write_mission(pytester.path / "race", racy=RACY)
    return pytester.path


@pytest.fixture
def suite(pytester: pytest.Pytester, missions: Path) -> Suite:
    """Runs the text of a test file in this process, with options."""

    def run(text: str, *options: str) -> pytest.RunResult:
        pytester.makepyfile(test_it=text)
        return pytester.runpytest_inprocess("-p", "cfepy.testing.plugin", *AS_WRITTEN, *options)

    return run


def told_command(result: pytest.RunResult) -> str:
    """Return the last command that a run prints for its repetition."""
    found = re.findall(r"to reproduce: (pytest .*)", result.stdout.str())
    assert found, result.stdout.str()
    return str(found[-1])


def given_verbatim(command: str, folder: Path) -> subprocess.CompletedProcess[str]:
    """Give a command to a shell exactly as printed."""
    bin_folder = str(Path(sys.executable).parent)
    env = {**os.environ, "PATH": os.pathsep.join([bin_folder, os.environ["PATH"]]), "PYTHONPATH": str(ROOT)}
    env |= {"PYTEST_PLUGINS": "cfepy.testing.plugin", "PYTEST_ADDOPTS": "-p no:randomly", "COLUMNS": "300"}
    assert shlex.split(command)[0] == "pytest"
    return subprocess.run(command, shell=True, cwd=folder, env=env, capture_output=True, text=True, check=False)
