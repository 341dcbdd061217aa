"""ROS's libraries have the same public names here as on ROS 1, none less and none more, with the same arguments.

`python3 -m dev.record.ros_names` recorded ROS's modules, classes, messages and instances. The same program looks at
cfepy's, in nodes. Each exception has its reason.
"""

from __future__ import annotations

import json
import lzma
from collections.abc import Iterator
from fnmatch import fnmatchcase
from pathlib import Path
from typing import Any

import pytest

from rospy_shim.types.config import NodeConfig
from tests.rospy_shim.missions import run_nodes

ROOT = Path(__file__).parents[2]
PROGRAM = ROOT / "dev" / "record" / "ros_names.py"
RECORD = ROOT / "tests" / "data" / "ros_names.json.xz"
NODES = 25  # of a mission

TCP = "connections over TCP, and their servers; messages go over the Software Bus"
KDL = "PyKDL's own code has no dynamics, and numbers in place of the enumeration's objects"
OTHER = "other computers, processes and servers of roslaunch; everything is in one mission"
TOOL = "inner functions of a command; the command itself works"
OLD = "code of distributions before catkin, or of coverage"
INSIDE = "inner functions, tables and state of the original's code"
BUILD = "what a build at compile time needs; cfepy makes the classes at the import"
FOREIGN = "a package that only the type of a field of another field names"
GENMSG = "roslib's classes are genmsg's and rospkg's, whose interface includes roslib's"
DECORATED = "the original hides its arguments behind a decorator"
INSTANCE = "attributes of instances on ROS, of the class or calculated here"

LESS = {
    "PyKDL.*": KDL,
    "tf_conversions.*": KDL,
    "actionlib.goal_id_generator.s_goalcount*": INSIDE,
    "actionlib.SimpleActionServer.need_to_terminate": INSIDE,
    "actionlib.SimpleActionServer.terminate_mutex": INSIDE,
    "bondpy.BondSM_sm": INSIDE,
    "bondpy.bondpy.BondSM_sm": INSIDE,
    "bondpy.Bond.*": INSIDE,
    "cv_bridge.boost.cv_bridge_boost.CV_MAT_*Wrap": INSIDE,
    "cv_bridge.CvBridge.*": INSIDE,
    "dynamic_reconfigure.cfg": "an example for tests",
    "dynamic_reconfigure.cfg.TestConfig": "an example for tests",
    "dynamic_reconfigure.parameter_generator*.LINEDEBUG": BUILD,
    "dynamic_reconfigure.parameter_generator*.id": BUILD,
    "dynamic_reconfigure.parameter_generator_catkin.ParameterGenerator.*": BUILD,
    "genmsg.template_tools": BUILD,
    "genpy.generator.NUMPY_DTYPE": INSIDE,
    "genpy.genpy_main.usage": TOOL,
    "map_msgs.*.geometry_msgs": FOREIGN,
    "nav_msgs.srv.std_msgs": FOREIGN,
    "sensor_msgs.srv.std_msgs": FOREIGN,
    "tf.msg.std_msgs": FOREIGN,
    "resource_retriever.r": INSIDE,
    "rosbag.migration": "rules for bags of old message types",
    "rosbag.bag.ComparableMixin": INSIDE,
    "rosbag.bag.found_lz4": INSIDE,
    "rosbag.rosbag_main.*": TOOL,
    "rosgraph.impl.graph.logger": INSIDE,
    "rosgraph.network.SIOCGIF*": INSIDE,
    "rosgraph.network.logger": INSIDE,
    "rosgraph.network.python3": INSIDE,
    "rosgraph.roslogging.renew_latest_logdir": "log files are written by the mission",
    "rosgraph.roslogging.RospyLogger.findCaller": INSIDE,
    "rosgraph.xmlrpc.ForkingXMLRPCServer": OTHER,
    "roslaunch.*": OTHER,
    "roslib.manifestlib": OLD,
    "roslib.stack_manifest": OLD,
    "roslib.gentools.compute_md5_v1": OLD,
    "roslib.launcher.get_depends": OLD,
    "roslib.manifest.VersionControl": OLD,
    "roslib.msgs.*": OLD,
    "roslib.names.*_CHARS_P": INSIDE,
    "roslib.network.*": INSIDE,
    "roslib.packages.PIPE": INSIDE,
    "roslib.resources.list_package_resources_by_dir": OLD,
    "roslib.rospack.*": OLD,
    "roslib.scriptutil.deprecated": INSIDE,
    "roslib.srvs.get_pkg_srv_specs": OLD,
    "rosmsg.*": TOOL,
    "rosnode.CONNECTION_PATTERN": TOOL,
    "rosparam.pattern": INSIDE,
    "rosparam.represent_foo": INSIDE,
    "rospkg.distro.*": OLD,
    "rospkg.manifest.[A-Z]*": INSIDE,
    "rospkg.os_detect": "questions about the host",
    "rospkg.rospack.InvalidStack": OLD,
    "rospkg.rospack.parse_stack_file": OLD,
    "rospkg.rosversion": TOOL,
    "rospkg.stack": OLD,
    "rospy.core.Logging*": INSIDE,
    "rospy.impl.init.*": TCP,
    "rospy.impl.masterslave.*": TCP,
    "rospy.impl.registration.RegManager": TCP,
    "rospy.impl.tcpros*": TCP,
    "rospy.Service.*": TCP,
    "rospy.ServiceProxy.*": TCP,
    "rospy.topics.Poller": TCP,
    "rospy.topics.QueuedConnection": TCP,
    "rospy.topics.get_tcpros_handler": TCP,
    "rospy.topics.Topic.unregister": INSIDE,
    "rostest.*": TOOL,
    "rosunit.*": TOOL,
    "tf.tfwtf": "a plugin of roswtf",
}
"""Names that ROS has and cfepy has not."""

MORE = {
    "PyKDL.Joint.None": KDL,
    "PyKDL.Rotation.m": KDL,
    "PyKDL.Vector.v": KDL,
    "actionlib.ActionClient.ActionResultType": INSIDE,
    "dynamic_reconfigure.parameter_generator_catkin.ParameterGenerator.generated": BUILD,
    "genpy.generator.Special.*": INSTANCE,
    "rosgraph.xmlrpc.ThreadingXMLRPCServer.allow_reuse_address": INSIDE,
    "rospy.impl.masterslave.ROSHandler.uri": INSTANCE,
    "rospy.timer.Rate.*": INSTANCE,
    "rospy.topics.*.impl": INSTANCE,
    "rostopic.ROSTopicHz.times": INSTANCE,
}
"""Names that cfepy has and ROS has not."""

OTHERWISE = {
    "PyKDL.Joint.*": KDL,
    "roslaunch.Process": OTHER,
    "roslaunch.parent.ROSLaunchParent": OTHER,
    "roslaunch.pmon.Process": OTHER,
    "roslib.gentools.get_*dependencies": GENMSG,
    "roslib.manifest.*": GENMSG,
    "roslib.msgs.*": GENMSG,
    "roslib.scriptutil.*": DECORATED,
    "rospy.impl.masterslave.ROSHandler.*": DECORATED,
    "rosservice.rosservicemain": "its default is the command line",
    "rostest.unitrun": DECORATED,
}
"""Names with other arguments or values."""

ELSEWHERE = {
    "dynamic_reconfigure.parameter_generator*": BUILD,
    "roslib.*": GENMSG,
    "rospy.*.NullHandler": "logging's, which does the same",
    "rospy.impl.init.RosStreamHandler": "one class for both modules",
    "tf.transformations.Arcball": INSIDE,
}
"""Classes that name another module as their own."""


def the_record() -> dict[str, Any]:
    """Return ROS's names."""
    with lzma.open(RECORD, "rt", encoding="utf-8") as file:
        found: dict[str, Any] = json.load(file)
    return found


def the_names_here(folder: Path, recorded: dict[str, Any]) -> dict[str, Any]:
    """Return cfepy's names, looked up by the program in nodes, one for each package."""
    modules = {name: [each for each in package if each != name] for name, package in recorded["packages"].items()}
    asked = [("packages", name, ("--modules", "modules.json")) for name in recorded["packages"]]
    asked += [("messages", name, ("--messages",)) for name in recorded["messages"]]
    found: dict[str, Any] = {"packages": {}, "messages": {}}
    for first in range(0, len(asked), NODES):
        place = folder / str(first)
        place.mkdir()
        (place / "modules.json").write_text(json.dumps(modules), encoding="utf-8")
        nodes = {f"N{number}": each for number, each in enumerate(asked[first : first + NODES])}
        configs = {
            app: NodeConfig(app, args=(f"{kind}.{name}.json", "--package", name, *options))
            for app, (kind, name, options) in nodes.items()
        }
        run = run_nodes(place, dict.fromkeys(nodes, PROGRAM), nodes=configs)
        for kind, name, _ in nodes.values():
            file = place / f"{kind}.{name}.json"
            assert file.is_file(), "\n".join(run.lines)
            found[kind][name] = json.loads(file.read_text(encoding="utf-8"))
    return found


def comparable(shape: Any, recorded: Any) -> Any:
    """Return the description of a value without parts that always differ, for a name that ROS described as `recorded`.

    That is the module of a function, the value of the interpreter's version, and arguments of C code.
    """
    if not isinstance(shape, dict) or not isinstance(recorded, dict):
        return shape
    kind = next(iter({"class", "function"} & recorded.keys()), "value")
    if kind != "value" and recorded[kind] is None:
        return "callable" if {"class", "function"} & shape.keys() else shape
    of = recorded.get("of") or ""
    return kind if kind in shape and not of.startswith(OURS) else {kind: shape.get(kind)}


OURS = ("actionlib", "bond", "cv_bridge", "d", "gen", "message_filters", "ros", "sensor_msgs", "std_", "tf")
"""How names of ROS's modules begin, unlike those of the standard library of another version."""


def contents(module: dict[str, Any]) -> Iterator[tuple[str, dict[str, Any]]]:
    """Yield the names of a module, and the names of each of its classes."""
    yield "", module["names"]
    for name, members in module["classes"].items():
        yield f".{name}", members


def differences(recorded: dict[str, Any], here: dict[str, Any]) -> Iterator[tuple[str, str]]:
    """Yield kinds and names of the differences."""
    for kind in ("packages", "messages"):
        for package, modules in recorded[kind].items():
            for name, module in modules.items():
                if "raises" in module:
                    continue
                if "raises" in here[kind][package].get(name, {"raises": ""}):
                    yield "less", name
                    continue
                yield from _of_module(name, module, here[kind][package][name])


def _of_module(name: str, recorded: dict[str, Any], here: dict[str, Any]) -> Iterator[tuple[str, str]]:
    mine = dict(contents(here))
    for part, names in contents(recorded):
        own = mine.get(part, names)  # a class that is missing or of another module is one difference
        for each in names.keys() ^ own.keys():
            full = f"{name}{part}.{each}"
            if each in names:
                yield "less", full
            elif own[each] != "module":
                yield "more", full
        for each in names.keys() & own.keys():
            theirs, ours = names[each], own[each]
            if comparable(theirs, theirs) != comparable(ours, theirs):
                yield "otherwise", f"{name}{part}.{each}"
            elif _owner(theirs).startswith(OURS) and _owner(ours) != _owner(theirs):
                yield "elsewhere", f"{name}{part}.{each}"


def _owner(shape: Any) -> str:
    """Return the module that a class names as its own; "" for anything else."""
    return str(shape["of"]) if isinstance(shape, dict) and "class" in shape else ""


def unexplained(found: set[str], reasons: dict[str, str]) -> tuple[list[str], list[str]]:
    """Return the names without a reason, and the reasons without a name."""
    without = sorted(name for name in found if not any(fnmatchcase(name, pattern) for pattern in reasons))
    return without, [pattern for pattern in reasons if not any(fnmatchcase(name, pattern) for name in found)]


@pytest.mark.slow
def test_modules_classes_and_messages_have_the_names_of_ros(tmp_path: Path) -> None:
    pytest.importorskip("lz4")
    recorded = the_record()
    found: dict[str, set[str]] = {"less": set(), "more": set(), "otherwise": set(), "elsewhere": set()}
    for kind, name in differences(recorded, the_names_here(tmp_path, recorded)):
        found[kind].add(name)
    for kind, name in _of_instances(tmp_path, recorded["instances"]):
        found[kind].add(name)
    reasons = {"less": LESS, "more": MORE, "otherwise": OTHERWISE, "elsewhere": ELSEWHERE}
    assert {kind: unexplained(names, reasons[kind]) for kind, names in found.items()} == dict.fromkeys(found, ([], []))


def _of_instances(folder: Path, recorded: dict[str, list[str]]) -> Iterator[tuple[str, str]]:
    place = folder / "instances"
    place.mkdir()
    config = NodeConfig("NAMES", args=("found.json", "--instances"))
    run = run_nodes(place, {"NAMES": PROGRAM}, nodes={"NAMES": config})
    file = place / "found.json"
    assert file.is_file(), "\n".join(run.lines)
    here = json.loads(file.read_text(encoding="utf-8"))
    for name, attributes in recorded.items():
        yield from (("less", f"{name}.{each}") for each in attributes if each not in here[name])
        yield from (("more", f"{name}.{each}") for each in here[name] if each not in attributes)
