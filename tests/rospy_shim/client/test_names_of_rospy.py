"""Every public name of rospy 1.15 and of its modules exists, with its arguments; each missing one has a reason."""

from __future__ import annotations

import json
import textwrap
from pathlib import Path

from tests.rospy_shim.missions import run_nodes

RECORD = Path(__file__).parents[2] / "data" / "rospy_names.json"

TCP = "connections over TCP; messages go over the Software Bus"
SERVER = "the XML-RPC server of a node; the master asks the node itself"
THREADS = "the thread that registers a node with a master"
ABSENT = {
    "impl.init.start_node": SERVER,
    "impl.registration.RegManager": THREADS,
    "impl.tcpros.get_tcpros_handler": TCP,
    "impl.tcpros.init_tcpros": TCP,
    "impl.tcpros_base.TCPROSServer": TCP,
    "impl.tcpros_base.TCPROSTransport": TCP,
    "impl.tcpros_base.TCPROSTransportProtocol": TCP,
    "impl.tcpros_base.TCPServer": TCP,
    "impl.tcpros_base.get_tcpros_server_address": TCP,
    "impl.tcpros_base.init_tcpros_server": TCP,
    "impl.tcpros_base.recv_buff": TCP,
    "impl.tcpros_base.start_tcpros_server": TCP,
    "impl.tcpros_pubsub.QueuedConnection": TCP,
    "impl.tcpros_pubsub.TCPROSHandler": TCP,
    "impl.tcpros_pubsub.TCPROSPub": TCP,
    "impl.tcpros_pubsub.TCPROSSub": TCP,
    "impl.tcpros_pubsub.check_if_still_publisher": TCP,
    "impl.tcpros_pubsub.robust_connect_subscriber": TCP,
    "impl.tcpros_service.TCPROSServiceClient": TCP,
    "impl.tcpros_service.TCPService": TCP,
    "impl.tcpros_service.service_connection_handler": TCP,
    "rosconsole.print_function": "what `from __future__ import print_function` leaves behind",
    "topics.Poller": TCP,
}

WALK = """
import importlib, inspect, json
import rospy

def shape(value):
    try:
        parameters = inspect.signature(value).parameters.values()
    except (TypeError, ValueError):
        return "no signature"
    found = [each.name + ("=" if each.default is not each.empty else "") for each in parameters if each.kind < 2]
    return found + [{2: "*", 4: "**"}[each.kind] + each.name for each in parameters if each.kind in (2, 4)]

record = json.load(open("names.json"))
wrong, absent = {}, []
for module, names in record.items():
    place = rospy if module == "rospy" else importlib.import_module("rospy." + module)
    for name, wanted in names.items():
        full = name if module == "rospy" else module + "." + name
        if not hasattr(place, name):
            absent.append(full)
        elif wanted is not None and shape(getattr(place, name)) != wanted:
            wrong[full] = [shape(getattr(place, name)), wanted]
json.dump({"wrong": wrong, "absent": sorted(absent)}, open("found.json", "w"))
"""


def test_names_and_arguments(tmp_path: Path) -> None:
    (tmp_path / "names.json").write_text(RECORD.read_text(encoding="utf-8"), encoding="utf-8")
    run = run_nodes(tmp_path, {"PROBE": WALK})
    assert (tmp_path / "found.json").is_file(), "\n".join(run.lines)
    found = json.loads((tmp_path / "found.json").read_text(encoding="utf-8"))
    assert found["absent"] == sorted(ABSENT)
    assert found["wrong"] == {}


def test_rospy_has_no_name_that_ros_lacks(tmp_path: Path) -> None:
    source = """
    import rospy, types
    names = [name for name in dir(rospy) if not name.startswith("_")]
    modules = [name for name in names if isinstance(getattr(rospy, name), types.ModuleType)]
    print(*modules)
    print(*sorted(set(names) - set(modules)))
    print(rospy.timer.TimerEvent.__name__, rospy.core.logerror == rospy.logerr, rospy.client.TIMEOUT_READY)
    import rospy.numpy_msg
    print(callable(rospy.numpy_msg.numpy_msg))
    """
    result = run_nodes(tmp_path, {"NODE": textwrap.dedent(source)})
    recorded = json.loads(RECORD.read_text(encoding="utf-8"))["rospy"]
    assert result.printed["NODE"] == [
        "client core exceptions impl msg msproxy names rostime service timer topics",
        " ".join(sorted(recorded)),
        "TimerEvent True 15.0",
        "True",
    ]


def test_import_of_rospy_imports_its_message_packages(tmp_path: Path) -> None:
    source = """
    import rospy, std_msgs, roscpp, rosgraph_msgs
    print(std_msgs.msg.Bool().data, roscpp.srv.Empty()._type, rosgraph_msgs.msg.Log.ERROR)
    """
    result = run_nodes(tmp_path, {"NODE": textwrap.dedent(source)})
    assert result.printed["NODE"] == ["False roscpp/Empty 8"]


def test_key_error_has_the_requested_parameter_name(tmp_path: Path) -> None:
    source = """
    import rospy
    rospy.init_node("node")
    for function in (rospy.get_param, rospy.get_param_cached, rospy.delete_param):
        for name in ("~own", "near/by", "/far"):
            try:
                function(name)
            except KeyError as error:
                print(*error.args)
    """
    result = run_nodes(tmp_path, {"NODE": textwrap.dedent(source)})
    assert result.printed["node"] == ["~own", "near/by", "/far"] * 3


def test_import_rospy_shows_the_modules_of_rospy_impl(tmp_path: Path) -> None:
    source = """
    import rospy
    print(rospy.impl.rosout.RosOutHandler.__module__, rospy.impl.registration.Registration.PUB)
    print([name for name in dir(rospy.impl) if not name.startswith("_")])
    """
    result = run_nodes(tmp_path, {"NODE": textwrap.dedent(source)})
    modules = "init masterslave paramserver registration rosout simtime statistics tcpros tcpros_base tcpros_pubsub"
    assert result.printed["NODE"] == [
        "rospy.impl.rosout pub",
        str([*modules.split(), "tcpros_service", "transport", "validators"]),
    ]


def test_sentinel_for_no_default_can_be_passed_on(tmp_path: Path) -> None:
    asks = """
        import rospy
        rospy.init_node("asks")

        def value_of(name, default=rospy.client._unspecified):
            return rospy.get_param(name, default)

        print(value_of("absent", 3), hasattr(rospy, "_unspecified"))
        print(isinstance(rospy.get_param("absent", rospy.client._Unspecified()), rospy.client._Unspecified))
        try:
            value_of("absent")
        except KeyError as error:
            print(error)
    """
    assert run_nodes(tmp_path, {"ASKS": asks}).printed["asks"] == ["3 False", "True", "'absent'"]
