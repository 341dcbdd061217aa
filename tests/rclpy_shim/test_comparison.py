"""The comparison of printed lines with the real rclpy (`python -m dev.ros2`)."""

from __future__ import annotations

import json

from dev.ros2.__main__ import MISSIONS, Program, normal, verdict


def test_times_and_traces_of_the_end_are_left_out() -> None:
    lines = [
        "[INFO] [316533801.550004000] [talker]: Publishing: 1",
        "Traceback (most recent call last):",
        '  File "x.py"',
        "",
    ]
    assert normal(lines) == ["[INFO] [time] [talker]: Publishing: 1"]


def test_outputs_are_equal_if_one_goes_on() -> None:
    assert verdict([["a", "b"], ["c"]], [["c", "d"], ["a"]]) == "equal: 2 lines"


def test_first_difference_is_named() -> None:
    assert verdict([["a", "b"]], [["a", "x"]]) == "node 1 differs after 1 lines: `b`, and `x` on rclpy"
    assert verdict([[]], [["a"]]) == "node 1 differs after 0 lines: `(nothing)`, and `a` on rclpy"


def test_package_that_the_real_one_lacks_is_named() -> None:
    assert verdict([["a"]], [["missing: x_msgs"]]) == "not compared: the real one lacks x_msgs"


def test_missions_name_programs_of_listed_commits() -> None:
    table = json.loads(MISSIONS.read_text(encoding="utf-8"))
    programs = [Program.parse(text) for _, texts in table["missions"] for text in texts]
    assert {program.repository for program in programs} == set(table["commits"])
    assert all(program.path.endswith(".py") for program in programs)
