"""Tracebacks that nodes print, read from the console."""

from __future__ import annotations

import rospy_shim
from cfepy.exploration.failures import TracebackReader
from cfepy.exploration.verdict import RAISED, Failure

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


def read(text: str, node: str = "arm") -> list[Failure]:
    reader = TracebackReader()
    for line in text.strip().splitlines():
        reader.take(f"[{node}] {line}", 5)
    return reader.found


def test_the_place_is_the_innermost_line_that_is_no_library() -> None:
    (failure,) = read(ONE)
    assert (failure.kind, failure.who, failure.text, failure.at_ns) == (RAISED, "arm", "ValueError: no (arm.py:12)", 5)
    assert failure.detail.splitlines()[0] == "Traceback (most recent call last):"


def test_an_exception_is_told_by_type_and_line() -> None:
    (failure,) = read(ONE)
    assert [each.group == failure.group for each in read(ONE.replace(": no", ": not left"))] == [True]
    assert [each.group == failure.group for each in read(ONE.replace("ValueError", "KeyError"))] == [False]
    assert [each.group == failure.group for each in read(ONE.replace("line 12", "line 13"))] == [False]


def test_rospy_is_a_library_too() -> None:
    text = ONE.replace("ValueError: no", f'  File "{rospy_shim.__file__}", line 7, in call\n    raise\nValueError: no')
    assert [failure.text for failure in read(text)] == ["ValueError: no (arm.py:12)"]


def test_of_a_chain_the_last_counts() -> None:
    assert [failure.text for failure in read(CHAIN)] == ["KeyError: 'x' (arm.py:14)"]


def test_lines_of_two_nodes_may_be_mixed() -> None:
    reader = TracebackReader()
    for line in ONE.strip().splitlines():
        for node in ("one", "two"):
            reader.take(f"[{node}] {line}", 0)
    assert [failure.who for failure in reader.found] == ["one", "two"]


def test_other_lines_are_no_tracebacks() -> None:
    assert read("all is well\nValueError: no") == []
