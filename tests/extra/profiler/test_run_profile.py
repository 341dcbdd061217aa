"""Profiles: their stacks, their files, and the owners of code."""

from __future__ import annotations

import json
import sysconfig
from collections import Counter
from pathlib import Path
from types import CodeType

import pytest

from cfepy.extra.profiler.flame_files import flame_text
from cfepy.extra.profiler.profile_option import COLLAPSED
from cfepy.extra.profiler.run_profile import RunProfile, code_owner
from cfepy.extra.profiler.stack_sampler import StackSampler
from cfepy.extra.profiler.task_times import HOST, TaskLabel, TaskTimes, TimedTasks
from cfepy.rtos import Task
from cfepy.sb import bus

ROOT = Path(bus.__file__).parents[2]
ARM = TaskLabel("ARM", "ARM.main")


def function(name: str, file: str) -> CodeType:
    return compile("0", file, "exec").replace(co_name=name, co_qualname=name)


KERNEL = function("Kernel._main", str(ROOT / "cfepy/rtos/kernel.py"))
CALLBACK = function("Arm.on_state", "/missions/arm.py")
PUBLISH = function("Publisher.publish", str(ROOT / "rospy_shim/client/topics.py"))
SEND = function("SoftwareBus.transmit_msg", str(ROOT / "cfepy/sb/bus.py"))
WRAPPED = function("release", str(ROOT / "cfepy/extra/profiler/task_times.py"))


@pytest.fixture
def profile() -> RunProfile:
    times = TaskTimes()
    times.times |= {HOST: 50, ARM: 900, TaskLabel("", "timer"): 10}
    times.switch_ns = 40
    seen = {ARM: Counter({(KERNEL, CALLBACK, PUBLISH, SEND, WRAPPED): 2, (KERNEL, CALLBACK): 1})}
    return RunProfile.of(times, seen, 3)


def test_time_of_a_task_is_divided_among_its_stacks(profile: RunProfile) -> None:
    assert profile.stacks[ARM] == {(CALLBACK, PUBLISH, SEND): 600, (CALLBACK,): 300}
    assert profile.owners() == {"SB, Software Bus": 600, "arm.py": 300}
    assert profile.apps() == {"ARM": 900, "": 10}
    (row,) = profile.callbacks()
    assert row == ("ARM", "Arm.on_state", "arm.py:1", 900)


def test_speedscope_file_adds_up_to_the_wall_time(profile: RunProfile) -> None:
    document = json.loads(flame_text("x.json", profile, "demo"))
    (shown,) = document["profiles"]
    assert (shown["type"], shown["unit"], shown["startValue"], shown["endValue"]) == ("sampled", "nanoseconds", 0, 1000)
    assert sum(shown["weights"]) == profile.times.wall_ns == 1000
    frames = [each["name"] for each in document["shared"]["frames"]]
    stacks = [[frames[index] for index in stack] for stack in shown["samples"]]
    assert ["ARM", "ARM.main", "Arm.on_state", "Publisher.publish", "SoftwareBus.transmit_msg"] in stacks
    assert ["(task switches)"] in stacks
    assert len(stacks) == len(shown["weights"])
    assert {"name": "Arm.on_state", "file": "/missions/arm.py", "line": 1} in document["shared"]["frames"]


@pytest.mark.parametrize("suffix", COLLAPSED)
def test_collapsed_stacks_have_a_line_each(profile: RunProfile, suffix: str) -> None:
    profile.times.times[ARM] = 900
    profile.stacks[ARM] = {stack: wall_ns * 1000 for stack, wall_ns in profile.stacks[ARM].items()}
    lines = flame_text(f"x{suffix}", profile, "demo").splitlines()
    assert "ARM;ARM.main;Arm.on_state (arm.py:1) 300" in lines
    assert lines[-1] == "(display, ports, pace) 0"


@pytest.mark.parametrize(
    ("file", "owner"),
    [
        (str(ROOT / "cfepy/sb/bus.py"), "SB, Software Bus"),
        ("cfepy/rtos/kernel.py", "kernel"),
        (str(ROOT / "cfepy/ground/series.py"), "cfepy, ground"),
        (str(ROOT / "cfepy/trace.py"), "cfepy"),
        (str(ROOT / "rospy_shim/client/topics.py"), "rospy"),
        (str(ROOT / "rospy_shim/types/msgs/classes.py"), "messages of ROS"),
        (str(ROOT / "rospy_shim/runtime.py"), "ROS in cfepy"),
        (str(ROOT / "apps/hk/app.py"), "apps/hk"),
        (str(ROOT / "ros_libraries/tf2_ros/buffer.py"), "ros_libraries/tf2_ros"),
        (str(ROOT / "rclpy_shim/libraries/tf2_ros/buffer.py"), "rclpy_shim/tf2_ros"),
        (str(ROOT / "rclpy_shim/libraries/rclpy/executors.py"), "ROS 2 in cfepy"),
        (sysconfig.get_paths()["stdlib"] + "/json/decoder.py", "Python's standard library"),
        ("<frozen importlib._bootstrap>", "Python's standard library"),
        ("<string>", "generated code of messages"),
        ("/env/lib/python3.11/site-packages/numpy/linalg/_linalg.py", "numpy"),
        ("/usr/lib/python3/dist-packages/six.py", "six"),
        ("/home/me/catkin/src/robot/scripts/drive", "drive"),
    ],
)
def test_owner_of_a_file(file: str, owner: str) -> None:
    assert code_owner(file) == owner


def test_sampler_takes_the_stack_of_the_running_task_only() -> None:
    import threading

    timed = TimedTasks()
    timed.host_ident = threading.get_ident()
    sampler = StackSampler(timed)
    sampler.take()
    assert sampler.count == 0
    timed.times.arrive(ARM, Task("ARM.main", 1, None, 50))
    sampler.take()
    timed.times.leave()
    sampler.take()
    assert sampler.count == 1
    (stack,) = sampler.stacks()[ARM]
    assert [code.co_name for code in stack][-2:] == ["test_sampler_takes_the_stack_of_the_running_task_only", "take"]
