"""Tracebacks of nodes, parsed from the console."""

from __future__ import annotations

import rospy_shim
from cfepy.mission import RaisedError, TracebackReader
from cfepy.pilot import Failure, FailureKind
from cfepy.rtos import TaskExit

ONE = """
Traceback (most recent call last):
  File "/m/arm.py", line 12, in move
    self.go()
  File "/usr/lib/python3/dist-packages/numpy/core.py", line 3, in go
ValueError: no
"""
CHAIN = f"""{ONE}
During handling of the above exception, another exception occurred:

Traceback (most recent call last):
  File "/m/arm.py", line 14, in move
KeyError: 'x'
"""


def read(text: str, node: str = "arm") -> list[RaisedError]:
    reader = TracebackReader()
    for line in text.strip().splitlines():
        reader.take(f"[{node}] {line}", 5)
    return reader.found


def group_of(text: str) -> str:
    (error,) = read(text)
    return Failure(FailureKind.RAISED, error.who, error.text, cause=error.cause).group


def test_place_of_an_error_is_the_innermost_line_outside_libraries() -> None:
    (error,) = read(ONE)
    assert (error.who, error.text, error.at_ns) == ("arm", "ValueError: no (arm.py:12)", 5)
    assert error.detail.splitlines()[0] == "Traceback (most recent call last):"


def test_error_is_grouped_by_type_and_line() -> None:
    group = group_of(ONE)
    assert group_of(ONE.replace(": no", ": not left")) == group
    assert group_of(ONE.replace("ValueError", "KeyError")) != group
    assert group_of(ONE.replace("line 12", "line 13")) != group


def test_rospy_counts_as_a_library() -> None:
    text = ONE.replace("ValueError: no", f'  File "{rospy_shim.__file__}", line 7, in call\n    raise\nValueError: no')
    assert [error.text for error in read(text)] == ["ValueError: no (arm.py:12)"]


def test_last_error_of_a_chain_counts() -> None:
    assert [error.text for error in read(CHAIN)] == ["KeyError: 'x' (arm.py:14)"]


def test_mixed_lines_of_two_nodes_are_separated() -> None:
    reader = TracebackReader()
    for line in ONE.strip().splitlines():
        for node in ("one", "two"):
            reader.take(f"[{node}] {line}", 0)
    assert [error.who for error in reader.found] == ["one", "two"]


def test_other_lines_are_not_tracebacks() -> None:
    assert read("all is well\nValueError: no") == []


def test_ctrl_c_that_ends_a_node_is_not_an_error() -> None:
    assert read(ONE.replace("ValueError: no", "KeyboardInterrupt")) == []


def test_error_while_ctrl_c_ends_a_node_counts_and_leaves_earlier_ones() -> None:
    chain = CHAIN.replace("ValueError: no", "KeyboardInterrupt")
    assert [error.text for error in read(ONE + chain)] == ["ValueError: no (arm.py:12)", "KeyError: 'x' (arm.py:14)"]


def test_end_of_a_task_and_errors_while_it_unwinds_are_not_errors() -> None:
    end = f"{TaskExit.__module__}.{TaskExit.__name__}"
    assert read(ONE.replace("ValueError: no", end)) == []
    unwound = CHAIN.replace("ValueError: no", end)
    assert [error.text for error in read(ONE + unwound + ONE)] == ["ValueError: no (arm.py:12)"] * 2
