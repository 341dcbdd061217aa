"""Nodes in C++ and their twins in Python: unmodified roscpp code, compiled for cFE, publishes the same as rospy
code."""

from __future__ import annotations

import pytest

from dev.convert.twin_flights import PACKAGES, fly
from dev.roscfe.building import needs_cpp

pytestmark = [needs_cpp, pytest.mark.slow]


@pytest.mark.parametrize("package", PACKAGES)
def test_node_and_its_twin_in_python_publish_the_same(package: str) -> None:
    compiled = fly(package, python=False)
    assert compiled.messages
    assert compiled.messages == fly(package, python=True).messages
    other_tasks = fly(package, python=False, tasks="greenlet")
    assert (other_tasks.messages, other_tasks.digest) == (compiled.messages, compiled.digest)
