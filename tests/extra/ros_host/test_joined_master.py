"""A mission that joins a ROS master; the master is rosmaster's API on an empty graph, in a thread of the test."""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any
from xmlrpc.client import ServerProxy
from xmlrpc.server import SimpleXMLRPCServer

import pytest

from cfepy.extra.ros_host import JoinedMaster, joined_master
from cfepy.extra.ros_host.joined_master import PUBLISHER, MasterState, RosEntry
from cfepy.extra.ros_host.world import OwnGraph
from cfepy.nodes import RosConfig
from cfepy.status import UsageError
from rospy_shim.graph.graph import Graph
from rospy_shim.master.master_api import MasterApi
from rospy_shim.master.xmlrpc_calls import call
from tests.extra.ros_host.peers import CALLER, STRING, TALKER, Joined, OutsideSpeaker, joined

NOBODY = "http://127.0.0.1:1/"


class RosMaster:
    """A master that can be killed and started again."""

    def __init__(self) -> None:
        self._server = SimpleXMLRPCServer(("127.0.0.1", 0), logRequests=False, use_builtin_types=True)
        self._server.register_instance(self)
        self.uri = f"http://127.0.0.1:{self._server.server_address[1]}/"
        self._thread = threading.Thread(target=self._server.serve_forever, kwargs={"poll_interval": 0.01})
        self.meanwhile: Callable[[], object] = lambda: None  # done once, when the next look has been answered
        self.looks = 0
        self.restart(1)
        self._thread.start()

    def restart(self, pid: int) -> None:
        """It has forgotten everything, and is another process."""
        self._pid = pid
        self.api = MasterApi(Graph(RosConfig()), self.uri)

    def _dispatch(self, method: str, arguments: tuple[Any, ...]) -> Any:
        answer = (1, "", self._pid) if method == "getPid" else call(self.api, method, arguments)
        if method == "getSystemState":
            meanwhile, self.meanwhile = self.meanwhile, lambda: None
            meanwhile()
            self.looks += 1
        return answer

    def close(self) -> None:
        if not self._thread.is_alive():
            return
        self._server.shutdown()
        self._server.server_close()
        self._thread.join()


@pytest.fixture
def master(monkeypatch: pytest.MonkeyPatch) -> Iterator[RosMaster]:
    monkeypatch.setattr(joined_master, "LOOK_S", 0.0)  # it is asked whenever the last question was answered
    found = RosMaster()
    yield found
    found.close()


@contextmanager
def joining(folder: Path, master: RosMaster) -> Iterator[Joined]:
    with joined(folder, {"TALKER": TALKER}, world=lambda host: JoinedMaster(host, master.uri)) as run:
        run.run_while(lambda: not is_registered(master))
        yield run


def is_registered(master: RosMaster) -> bool:
    """Return whether the master knows all of the mission. Its services come last."""
    return ["/talker/set_logger_level", ["/talker"]] in state(master)[2]


def state(master: RosMaster) -> Any:
    return master.api.getSystemState(CALLER)[2]


def test_the_missions_nodes_register_and_leave(tmp_path: Path, master: RosMaster) -> None:
    with joining(tmp_path, master) as run:
        publishers, _, services = state(master)
        assert ["/chatter", ["/talker"]] in publishers
        assert ["/talker/get_loggers", ["/talker"]] in services
        uri = master.api.lookupNode(CALLER, "/talker")[2]
        assert run.ask(uri, "getName", CALLER)[2] == "/talker"
        assert run.told[0] == f"joined the ROS master at {master.uri}"
    assert state(master) == [[], [], []]


def test_mission_learns_of_external_publishers(tmp_path: Path, master: RosMaster) -> None:
    master.api.registerPublisher("/other", "/far", "std_msgs/String", NOBODY)
    with joining(tmp_path, master) as run:
        registry = run.mission.ros.switchboard.master.registry
        run.run_while(lambda: "/far" not in registry.publishers())
        assert registry.publishers()["/far"] == {"/other": NOBODY}
        master.api.unregisterPublisher("/other", "/far", NOBODY)
        run.run_while(lambda: "/far" in registry.publishers())


def test_restarted_master_gets_all_registrations_again(tmp_path: Path, master: RosMaster) -> None:
    with joining(tmp_path, master) as run:
        run.mission.ros.graph.params.set("/ours", 5)
        run.run_while(lambda: master.api.getParam(CALLER, "/ours")[2] != 5)
        master.restart(2)
        run.run_while(lambda: not is_registered(master))
        run.run_while(lambda: master.api.getParam(CALLER, "/ours")[2] != 5)
        assert any("is back" in line for line in run.told)


def test_parameters_are_synchronized_in_both_directions(tmp_path: Path, master: RosMaster) -> None:
    master.api.setParam(CALLER, "/before", {"a": 1})
    with joining(tmp_path, master) as run:
        params = run.mission.ros.graph.params
        assert params.find("/before/a") == 1
        own = run.host.world._own
        assert run.ask(own.uri, "paramUpdate", "/master", "/later/", [1, 2])[0] == 1
        run.run_while(lambda: params.find("/later") != [1, 2])
        run.ask(own.uri, "paramUpdate", "/master", "/later/", {})
        run.run_while(lambda: params.find("/later") is not params.MISSING)


def test_node_ignores_registrations_of_a_former_node_of_its_name(tmp_path: Path, master: RosMaster) -> None:
    """The mission's node starts after the query to the master, whose answer has a dead node of that name."""
    with joining(tmp_path, master) as run:
        run.host.seen = OwnGraph({}, [], [], [], {}, {})
        left = MasterState(1, [RosEntry(PUBLISHER, "/chatter", "/talker")], {}, {"/talker": NOBODY}, {})
        run.host.world._found(left, None)
        run.run_while(lambda: not is_registered(master))
        assert not run.heard("shutdown request")


def test_announced_publisher_stays_when_an_older_query_lacks_it(tmp_path: Path, master: RosMaster) -> None:
    with joining(tmp_path, master) as run:
        mouth = OutsideSpeaker(run, "/orders", is_known=False)
        talker = run.host.node_uri("/talker")

        def come() -> None:
            master.api.registerPublisher(CALLER, "/orders", STRING["type"], mouth.uri)
            with ServerProxy(talker) as node:
                node.publisherUpdate("/master", "/orders", [mouth.uri])

        master.meanwhile = come
        mouth.connect()
        looks = master.looks
        run.run_while(lambda: master.looks < looks + 3 or not run.host.counts.rows())
        (row,) = run.host.counts.rows()
        assert (row["name"], row["connections"], mouth.is_waited_for) == ("/orders", 1, False)
        mouth.close()


def test_missing_master_is_reported_before_the_run(tmp_path: Path, master: RosMaster) -> None:
    master.close()
    with pytest.raises(UsageError, match="no ROS master answers"), joining(tmp_path, master):
        pass
