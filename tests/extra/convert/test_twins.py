"""Nodes in C++ and their twins in Python: unmodified roscpp code, compiled for cFE, publishes the same as rospy
code."""

from __future__ import annotations

import pytest

from dev.convert.twin_flights import PACKAGES, fly
from dev.roscfe.building import needs_cpp
from rospy_shim.master.switchboard import ROUND_TRIP_NS

pytestmark = [needs_cpp, pytest.mark.slow]
LATER_US = {"twin_params": ROUND_TRIP_NS // 1000}
"""How much later rospy's messages arrive: get_param_cached asks the master by a request, roscfe over the bus."""


@pytest.mark.parametrize("package", PACKAGES)
def test_node_and_its_twin_in_python_publish_the_same(package: str) -> None:
    compiled = fly(package, python=False)
    assert compiled.messages
    later = LATER_US.get(package, 0)
    in_python = [each._replace(time=each.time - later) for each in fly(package, python=True).messages]
    assert compiled.messages == in_python
    other_tasks = fly(package, python=False, tasks="greenlet")
    assert (other_tasks.messages, other_tasks.digest) == (compiled.messages, compiled.digest)
