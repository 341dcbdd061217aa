"""xmlrpc.client in a node: its own types and errors, and no servers except for the master and the nodes."""

from __future__ import annotations

from pathlib import Path

import pytest

from rospy_shim.types.config import NodeConfig
from tests.rospy_shim.missions import run_nodes


def test_types_and_errors_match_xmlrpc(tmp_path: Path) -> None:
    script = """
        import rospy, xmlrpc.client
        from xmlrpc.client import Binary, Fault, MultiCall, ServerProxy, Transport
        master = ServerProxy("http://cfepy:11311/")
        print(master.setParam("/x", "/data", Binary(b"\\x00\\xff")))
        value = master.getParam("/x", "/data")[2]
        print(type(value) is Binary, value.data, rospy.get_param("/data").data)
        for bad in (None, 2**31, object):
            try:
                master.setParam("/x", "/bad", bad)
            except (TypeError, OverflowError) as error:
                print(type(error).__name__)
        try:
            master.noSuchMethod("/x")
        except Fault as fault:
            print(fault.faultCode, fault.faultString)
        calls = MultiCall(master)
        calls.setParam("/x", "/a", 1)
        calls.getParam("/x", "/a")
        print([code for code, _, _ in calls()])
        class Patient(Transport):
            def make_connection(self, host):
                raise AssertionError("there is no connection")
        print(ServerProxy("http://cfepy:11311", transport=Patient()).getPid("/x")[0])
        plain = ServerProxy("http://name:word@localhost:11311", allow_none=True, use_builtin_types=True)
        print(plain.getParam("/x", "/data")[2])
        print(master, xmlrpc.client.loads(xmlrpc.client.dumps((1, "a"), "method")))
    """
    run = run_nodes(tmp_path, {"ASKS": script}, seconds=1)
    assert run.printed["ASKS"] == [
        "[1, 'parameter /data set', 0]",
        "True b'\\x00\\xff' b'\\x00\\xff'",
        "TypeError",
        "OverflowError",
        "TypeError",
        "1 <class 'Exception'>:method \"noSuchMethod\" is not supported",
        "[1, 1]",
        "1",
        "b'\\x00\\xff'",
        "<ServerProxy for cfepy:11311/> ((1, 'a'), 'method')",
    ]


def test_uris_without_a_server_are_refused(tmp_path: Path) -> None:
    script = """
        from xmlrpc.client import ServerProxy
        for uri in ("http://localhost:1", "http://cfepy:1234/", "http://cfepy"):
            try:
                ServerProxy(uri).getPid("/x")
            except ConnectionRefusedError as error:
                print(error.errno, error.strerror)
        try:
            ServerProxy("http://elsewhere:11311").getPid("/x")
        except OSError as error:
            print("OSError")
        try:
            ServerProxy("ftp://cfepy:11311")
        except OSError as error:
            print(error)
    """
    run = run_nodes(tmp_path, {"ASKS": script}, seconds=1)
    assert run.printed["ASKS"] == ["111 Connection refused"] * 3 + ["OSError", "unsupported XML-RPC protocol"]


def test_environment_names_the_master(tmp_path: Path) -> None:
    script = """
        import os, rosgraph
        print(os.environ["ROS_MASTER_URI"], rosgraph.is_master_online())
    """
    nodes = {"ASKS": NodeConfig("ASKS", env={"ROS_MASTER_URI": "http://robot:11399"})}
    run = run_nodes(tmp_path, {"ASKS": script, "OTHER": script}, seconds=1, nodes=nodes)
    assert run.printed == {"ASKS": ["http://robot:11399 True"], "OTHER": ["http://cfepy:11311 True"]}


@pytest.mark.parametrize("tasks", ["thread", "greenlet"])
def test_polling_loop_takes_time_and_is_deterministic(tmp_path: Path, tasks: str) -> None:
    if tasks == "greenlet":
        pytest.importorskip("greenlet")
    script = """
        import time
        from xmlrpc.client import ServerProxy
        master, start = ServerProxy("http://cfepy:11311"), time.time()
        while time.time() < start + 0.01:
            master.getPid("/x")
        print("done")
    """
    digests = []
    for name in ("one", "two"):
        folder = tmp_path / name
        folder.mkdir()
        run = run_nodes(folder, {"ASKS": script}, seconds=1, tasks=tasks)
        assert run.printed["ASKS"] == ["done"]
        digests.append(run.digest)
    assert digests[0] == digests[1]


def test_tool_in_the_folder_of_the_node_uses_the_client(tmp_path: Path) -> None:
    """This is a small form of such a source: a package of the node's own called rosnode, on the shipped rosgraph."""
    (tmp_path / "rosnode").mkdir()
    (tmp_path / "rosnode" / "__init__.py").write_text(
        "import rosgraph\nfrom xmlrpc.client import ServerProxy\n"
        "def names():\n    state = rosgraph.Master('/x').getSystemState()\n"
        "    return sorted({name for part in state for _, names in part for name in names})\n"
        "def ping(name):\n    return ServerProxy(rosgraph.Master('/x').lookupNode(name)).getPid('/x')[0]\n",
        encoding="utf-8",
    )
    script = """
        import rospy, rosnode
        rospy.init_node("asks")
        print(rosnode.names(), rosnode.ping("/asks"), hasattr(rosnode, "rosnode_ping"))
    """
    run = run_nodes(tmp_path, {"ASKS": script}, seconds=1)
    assert run.printed["asks"] == ["['/asks'] 1 False"]


def test_requests_take_time_so_that_a_loop_of_them_ends(tmp_path: Path) -> None:
    script = """
        import time
        from xmlrpc.client import ServerProxy
        master, begin, count = ServerProxy("http://cfepy:11311/"), time.time(), 0
        while time.time() < begin + 1:
            master.getPid("/x")
            count += 1
        print(500 < count <= 2000)
    """
    assert run_nodes(tmp_path, {"NODE": script}).printed["NODE"] == ["True"]
