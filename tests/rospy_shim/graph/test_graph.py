"""The parts of the ROS side without a mission: names, parameters, MsgIds, segments, the module on the host."""

from __future__ import annotations

import pytest

from cfepy.status import UsageError
from rospy_shim.client.params import marshalled
from rospy_shim.graph.graph import Graph
from rospy_shim.graph.msg_ids import FIRST_MSG_ID, LAST_MSG_ID, msg_id_of
from rospy_shim.parameters.tree import ParameterTree
from rospy_shim.types import names
from rospy_shim.types.config import RosConfig, TopicConfig
from rospy_shim.types.exceptions import ROSException
from rospy_shim.types.transport import Assembler, segments


def test_msg_ids_are_stable_and_in_range() -> None:
    found = {name: msg_id_of(name) for name in (f"/topic{number}" for number in range(500))}
    assert all(FIRST_MSG_ID <= msg_id <= LAST_MSG_ID for msg_id in found.values())
    assert (msg_id_of("/joint_states"), msg_id_of("/chatter"), msg_id_of("/rosout")) == (0x0CF4, 0x0FB4, 0x0900)


def test_collision_names_both_topics_and_the_remedy() -> None:
    by_id: dict[int, str] = {}
    pair = None
    for number in range(5000):
        name = f"/topic{number}"
        other = by_id.setdefault(msg_id_of(name), name)
        if other != name:
            pair = other, name
            break
    assert pair is not None
    graph = Graph(RosConfig())
    graph.topic(pair[0])
    free = msg_id_of(pair[0]) + 1
    with pytest.raises(
        UsageError, match=rf'{pair[0]} and {pair[1]} .*graph --lock.*"{pair[1]}: {{msg_id: 0x{free:04X}}}"'
    ):
        graph.topic(pair[1])


def test_pinned_topics() -> None:
    graph = Graph(RosConfig(topics={"/a": TopicConfig("/a", 0x0ABC, raw=True)}))
    assert (graph.topic("/a").msg_id, graph.topic("/a").raw) == (0x0ABC, True)


@pytest.mark.parametrize(
    ("name", "resolved"),
    [
        ("a", "/lab/a"),
        ("/a/", "/a"),
        ("~a", "/lab/node/a"),
        ("a//b", "/lab/a/b"),
        ("~", "/lab/node/"),
        ("", "/lab/"),
        ("from", "/lab/to"),
        ("~own", "/elsewhere"),
        ("/", "/"),
    ],
)
def test_names_are_resolved(name: str, resolved: str) -> None:
    own = names.Names(["script", "from:=to", "~own:=/elsewhere", "__ns:=lab", "_param:=1"], {})
    own.give("node")
    assert own.name == "/lab/node"
    assert own.resolve_name(name) == resolved


def test_names_of_other_nodes_and_helper_functions_resolve() -> None:
    own = names.Names(["script"], {"ROS_NAMESPACE": "/env"})
    own.give("node")
    assert (own.get_name(), own.get_namespace()) == ("/env/node", "/env/")
    assert own.resolve_name("q", "/ns/other") == "/ns/q"
    assert own.resolve_name("~q", "/ns/other") == "/ns/other/q"
    assert names.scoped_name("/probe_node", "/probe_node/x") == "probe_node/x"
    assert names.canonicalize_name("/a//b/") == "/a/b"
    assert names.program_arguments(["s", "a:=b", "--x", "_p:=1"]) == ["s", "--x"]
    assert names.command_line_params(["_p:=1", "__name:=n", "a:=b"]) == {"p": "1"}


@pytest.mark.parametrize(
    ("name", "caller_id", "resolved"),
    [("~foo", "/", "/foo"), ("~/foo", "/ns/node", "/foo"), ("~foo//bar/", "/ns/node", "/ns/node/foo/bar")],
)
def test_private_names_of_other_nodes_resolve(name: str, caller_id: str, resolved: str) -> None:
    assert names.Names(["script"], {}).resolve_name(name, caller_id) == resolved


def test_arguments_of_the_program_are_separated_from_remappings() -> None:
    ros = ["a:=b", "/a:=/b", "~p:=1", "_x:=1", "__name:=n", "a/b:=c", "x:="]
    own = ["-bar:=baz", "--x=y:=z", ":=", ":=y", "9a:=b", "a-b:=c", "a b:=c"]
    assert names.program_arguments(["s", *ros, *own]) == ["s", *own]
    assert names.load_mappings([*ros, *own, "q:=r:=s"]) == {
        "a": "b",
        "/a": "/b",
        "~p": "1",
        "__name": "n",
        "a/b": "c",
    }


@pytest.mark.parametrize(
    ("caller_id", "name", "scoped"),
    [("/", "/name", "name"), ("/ns", "/ns/name", "ns/name"), ("/ns/node", "/ns/name", "name")],
)
def test_scoped_names(caller_id: str, name: str, scoped: str) -> None:
    assert names.scoped_name(caller_id, name) == scoped


@pytest.mark.parametrize("caller_id", ["", "name", "~name"])
def test_scoped_names_need_a_global_caller(caller_id: str) -> None:
    with pytest.raises(ROSException, match="caller_id must be global"):
        names.scoped_name(caller_id, "/name")


def test_parameter_tree() -> None:
    tree = ParameterTree({"a": {"b": (1, 2)}})
    assert tree.find("/a/b") == [1, 2]
    tree.set("/a/b/c", 1)
    assert tree.find("/a") == {"b": {"c": 1}}
    assert tree.search("/a/x/y", "b/c") == "/a/b/c"
    assert tree.search("/a", "nothing") is None
    assert tree.names() == ["/a/b/c"]
    tree.delete("/a/b")
    assert tree.find("/a/b") is ParameterTree.MISSING
    with pytest.raises(KeyError):
        tree.delete("/a/b")
    with pytest.raises(TypeError, match="root"):
        tree.set("/", 5)


def test_marshalling() -> None:
    assert marshalled({"a": (1, [True, 2.5]), "b": bytearray(b"x")}) == {"a": [1, [True, 2.5]], "b": b"x"}
    for value, error in ((None, TypeError), (1 << 31, OverflowError), ({1: 2}, TypeError), (object(), TypeError)):
        with pytest.raises(error):
            marshalled(value)


def test_segments_and_their_assembly() -> None:
    payload = bytes(range(256)) * 10
    packets = list(segments(0x0901, payload, 1000))
    assert [packet[2] >> 6 for packet in packets] == [1, 0, 2]
    assert all(len(packet) == int.from_bytes(packet[4:6], "big") + 7 for packet in packets)
    assembler = Assembler()
    whole = [assembler.add(packet, "me", index) for index, packet in enumerate(packets)]
    assert whole[:2] == [None, None]
    assert whole[2] is not None
    assert whole[2][16:] == payload


def test_missing_segment_loses_the_message() -> None:
    packets = list(segments(0x0901, bytes(2500), 1000))
    assembler = Assembler()
    assert [assembler.add(packets[index], "me", index) for index in (0, 2)] == [None, None]
    assert assembler.lost == 1
    assert [assembler.add(packets[index], "me", index) for index in (0, 0)] == [None, None]
    assert assembler.lost == 2


def test_segments_from_outside_follow_their_sequence_counts() -> None:
    packets = [bytearray(packet) for packet in segments(0x0901, bytes(2500), 1000)]
    for packet, count in zip(packets, (0x3FFE, 0x3FFF, 0), strict=True):
        packet[2:4] = (packet[2] << 8 | count).to_bytes(2, "big")
    assembler = Assembler()
    whole = [assembler.add(bytes(packet), "", None) for packet in packets]
    assert whole[2] is not None


def test_module_on_the_host_explains_how_to_run_a_node() -> None:
    import rospy_shim

    assert rospy_shim.Time(1.5) - rospy_shim.Duration(1) == rospy_shim.Time(0, 500_000_000)
    with pytest.raises(rospy_shim.ROSInitException, match="cfepy run"):
        rospy_shim.init_node("talker")
    with pytest.raises(rospy_shim.ROSInitException):
        rospy_shim.Time.now()
    with pytest.raises(AttributeError):
        rospy_shim.no_such_name  # noqa: B018
