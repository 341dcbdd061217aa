"""The two graphs with which the tools of ROS are compared, a pair for each module of tests."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

from tests.extra.ros_host.graphs import PYTHON, TALKER, RosGraph, cfepy_run, joining, mission_of, rosmaster, started


@pytest.fixture(scope="module")
def real(tmp_path_factory: pytest.TempPathFactory) -> Iterator[RosGraph]:
    """Nothing but ROS."""
    with rosmaster(tmp_path_factory.mktemp("real")) as graph, started([PYTHON, str(TALKER)], graph.environ):
        graph.wait_for("rostopic list", "/orders")
        graph.wait_for("rosservice list", "/things")
        yield graph


@pytest.fixture(scope="module", params=["serve", "join"])
def mission(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Iterator[RosGraph]:
    """A mission and its master, or a mission that has joined Debian's."""
    folder = tmp_path_factory.mktemp("mission")
    if request.param == "join":
        with rosmaster(folder) as graph, started(joining(folder, graph)):
            graph.wait_for("rosservice list", "/things")
            yield graph
        return
    with started(cfepy_run(mission_of(folder), "--ros-master", "serve:0")) as process:
        assert process.stdout is not None
        line = next(each for each in process.stdout if "ROS_MASTER_URI=" in each)
        graph = RosGraph(line.strip().rpartition("=")[2], folder)
        graph.wait_for("rosservice list", "/things")
        yield graph
