"""`python3 -m dev.record.ros_names FILE`: records the public names of ROS's Python libraries, with their arguments.

The program runs in the Python that has ROS, imports each package in a process of its own, and writes the names as JSON.
The test of these names runs this file in a node, so both sides look in the same way. It imports only the standard
library.
"""

from __future__ import annotations
import __future__

import argparse
import contextlib
import importlib
import inspect
import json
import lzma
import os
import pkgutil
import subprocess
import sys
import tempfile
import types
from pathlib import Path
from typing import Any

PACKAGES = (
    *("PyKDL", "actionlib", "bondpy", "cv_bridge", "diagnostic_updater", "dynamic_reconfigure", "genmsg", "genpy"),
    *("message_filters", "resource_retriever", "rosbag", "rosgraph", "roslaunch", "roslib", "roslz4", "rosmsg"),
    *("rosnode", "rosparam", "rospkg", "rospy", "rosservice", "rostest", "rostopic", "rosunit", "sensor_msgs"),
    *("tf", "tf2_geometry_msgs", "tf2_kdl", "tf2_py", "tf2_ros", "tf2_sensor_msgs", "tf_conversions"),
)
"""Packages with code."""
MESSAGES = (
    *("actionlib", "actionlib_msgs", "bond", "diagnostic_msgs", "dynamic_reconfigure", "geometry_msgs", "map_msgs"),
    *("move_base_msgs", "nav_msgs", "pcl_msgs", "roscpp", "rosgraph_msgs", "sensor_msgs", "shape_msgs", "std_msgs"),
    *("std_srvs", "stereo_msgs", "tf", "tf2_msgs", "topic_tools", "trajectory_msgs", "visualization_msgs"),
)
"""Packages with messages and services."""
INSTANCES = {
    "rospy.Publisher": "rospy.Publisher('a', String, queue_size=1)",
    "rospy.Subscriber": "rospy.Subscriber('a', String, print)",
    "rospy.Service": "rospy.Service('s', Empty, print)",
    "rospy.ServiceProxy": "rospy.ServiceProxy('s', Empty)",
    "rospy.Timer": "rospy.Timer(rospy.Duration(100), print)",
    "rospy.timer.TimerEvent": "rospy.timer.TimerEvent(1, 2, 3, 4, 5)",
    "rospy.Rate": "rospy.Rate(10)",
    "rospy.Time": "rospy.Time(1)",
    "rospy.Duration": "rospy.Duration(1)",
    "rospy.AnyMsg": "rospy.AnyMsg()",
    "rospy.SubscribeListener": "rospy.SubscribeListener()",
    "rospy.get_master": "rospy.get_master()",
    "rospy.ServiceException": "rospy.ServiceException('a')",
    "rospy.TransportInitError": "rospy.exceptions.TransportInitError('a')",
    "rospy.ROSInterruptException": "rospy.ROSInterruptException('a')",
    "genpy.Time": "genpy.Time(1)",
    "genpy.SerializationError": "genpy.SerializationError('a')",
    "std_msgs.Header": "Header()",
    "std_msgs.String": "String('a')",
    "std_srvs.Empty": "Empty()",
    "rosgraph.Master": "rosgraph.Master('/a')",
    "rosbag.Bag": "rosbag.Bag('made.bag', 'w')",
    "rosbag.BagMessage": "rosbag.bag.BagMessage('a', 1, 2)",
    "rosbag.ROSBagException": "rosbag.ROSBagException('a')",
    "rospkg.RosPack": "rospkg.RosPack()",
    "rospkg.Manifest": "rospkg.Manifest()",
    "rospkg.ResourceNotFound": "rospkg.ResourceNotFound('a')",
    "roslaunch.Node": "roslaunch.core.Node('a', 'b')",
    "tf.Transformer": "tf.Transformer()",
    "tf.TransformListener": "tf.TransformListener()",
    "tf.TransformBroadcaster": "tf.TransformBroadcaster()",
    "tf2_ros.Buffer": "tf2_ros.Buffer()",
    "tf2_ros.TransformListener": "tf2_ros.TransformListener(tf2_ros.Buffer())",
    "tf2_ros.TransformBroadcaster": "tf2_ros.TransformBroadcaster()",
    "tf2_ros.StaticTransformBroadcaster": "tf2_ros.StaticTransformBroadcaster()",
    "tf2_ros.LookupException": "tf2_ros.LookupException('a')",
    "tf2_ros.Stamped": "tf2_ros.Stamped(PointStamped(), rospy.Time(1), 'a')",
    "actionlib.SimpleActionClient": "actionlib.SimpleActionClient('act', TestAction)",
    "actionlib.ActionClient": "actionlib.ActionClient('act', TestAction)",
    "actionlib.SimpleActionServer": "actionlib.SimpleActionServer('act', TestAction, print, False)",
    "actionlib.ActionServer": "actionlib.ActionServer('act', TestAction, print, print, False)",
    "actionlib.GoalIDGenerator": "actionlib.GoalIDGenerator()",
    "actionlib.ClientGoalHandle": "actionlib.ActionClient('act', TestAction).send_goal(TestGoal())",
    "message_filters.SimpleFilter": "message_filters.SimpleFilter()",
    "message_filters.Subscriber": "message_filters.Subscriber('a', String)",
    "message_filters.Cache": "message_filters.Cache(message_filters.SimpleFilter())",
    "message_filters.TimeSynchronizer": "message_filters.TimeSynchronizer([message_filters.SimpleFilter()], 1)",
    "message_filters.ApproximateTimeSynchronizer": "ApproximateTimeSynchronizer([SimpleFilter()], 1, 1)",
    "diagnostic_updater.Updater": "diagnostic_updater.Updater()",
    "diagnostic_updater.FrequencyStatus": "FrequencyStatus(FrequencyStatusParam({'min': 1, 'max': 2}))",
    "diagnostic_updater.TimeStampStatus": "diagnostic_updater.TimeStampStatus()",
    "diagnostic_updater.DiagnosticStatusWrapper": "diagnostic_updater.DiagnosticStatusWrapper()",
    "bondpy.Bond": "bondpy.bondpy.Bond('a', 'b')",
    "cv_bridge.CvBridge": "cv_bridge.CvBridge()",
    "PyKDL.Vector": "PyKDL.Vector(1, 2, 3)",
    "PyKDL.Rotation": "PyKDL.Rotation()",
    "PyKDL.Frame": "PyKDL.Frame()",
    "PyKDL.Twist": "PyKDL.Twist()",
}
"""Objects of classes from which users derive, or that they get, made in a node with a master."""
_IMPORTS = """
import PyKDL, actionlib, bondpy.bondpy, cv_bridge, diagnostic_updater, genpy
import message_filters, rosbag, rosgraph, roslaunch, rospkg, rospy, tf, tf2_ros
from actionlib.msg import TestAction, TestGoal
from diagnostic_updater import FrequencyStatus, FrequencyStatusParam
from message_filters import ApproximateTimeSynchronizer, SimpleFilter
from geometry_msgs.msg import PointStamped
from std_msgs.msg import Header, String
from std_srvs.srv import Empty
"""
TABLE = Path(__file__).parents[2] / "rospy_shim" / "public_names.txt"
PORT = 11791  # of the master while instances are recorded
_SKIPPED = ("test", "__main__")
_PLAIN = (int, float, str, bytes, bool, type(None), tuple, list, dict)
_HOMES = {"_functools": "functools", "_io": "io", "_operator": "operator", "_queue": "queue", "_thread": "threading"}
_NAMES = {"allocate_lock": "Lock"}
_OF_MESSAGES = ("_buff", "_connection_header", "_full_text", "_get_types", "_has_header", "_md5sum", "_type")
"""Private names of messages that programs use."""


def arguments_of(value: Any) -> list[str] | None:
    """Return the arguments of something callable as texts, None if Python does not know them."""
    try:
        parameters = list(inspect.signature(value).parameters.values())
    except (TypeError, ValueError):
        return None
    stars: dict[Any, str] = {inspect.Parameter.VAR_POSITIONAL: "*", inspect.Parameter.VAR_KEYWORD: "**"}
    found = []
    for each in parameters:
        text = stars.get(each.kind, "") + each.name
        if each.kind is inspect.Parameter.KEYWORD_ONLY:
            text = "only " + text
        if each.default is not each.empty:
            text += "=" + _default(each.default)
        found.append(text)
    return found


def _default(value: Any) -> str:
    """Return a default value as text: simple values themselves, of others only that there is one."""
    return repr(value) if type(value) in _PLAIN else "..."


def shape_of(value: Any) -> Any:
    """Return a description of a value: its kind, and its arguments or its content."""
    if isinstance(value, types.ModuleType):
        return "module"
    if isinstance(value, type):
        return {"class": arguments_of(value), "of": value.__module__}
    if type(value).__module__ == "__future__":
        return "future"
    if callable(value) and not hasattr(type(value), "__set_name__"):
        return {"function": arguments_of(value), "of": getattr(value, "__module__", None)}
    if isinstance(value, (int, float, str)) and len(str(value)) < 60 and "/usr" not in str(value):
        return {"value": repr(value)}
    return type(value).__name__ if isinstance(value, _PLAIN) else "object"


def home_of(value: Any, module: str) -> str | None:
    """Return where a module has a value from: a module, or "module:name"; None for its own values and for data."""
    if isinstance(value, types.ModuleType):
        return value.__name__
    if type(value).__module__ == "__future__":
        return "__future__:" + next(name for name in __future__.all_feature_names if getattr(__future__, name) == value)
    owner, name = getattr(value, "__module__", None), getattr(value, "__name__", None)
    if not isinstance(owner, str) or owner == module or name is None:
        return None
    *parts, last = owner.split(".")
    owner = _HOMES.get(owner) or (".".join(parts) if parts and last.startswith("_") else owner)
    for each in (name, _NAMES.get(name)):
        if each is not None and getattr(sys.modules.get(owner), each, None) is value:
            return f"{owner}:{each}"
    return None


def names_of(place: Any) -> list[str]:
    """Return the public names that a place shows."""
    return [name for name in dir(place) if not name.startswith("_") or name in _OF_MESSAGES]


def members_of(kind: type) -> dict[str, Any]:
    """Return the names of a class, with their descriptions."""
    found = {}
    for name in names_of(kind):
        owner = next((base for base in kind.__mro__ if name in vars(base)), kind)
        if owner.__module__.partition(".")[0] in sys.stdlib_module_names - {"builtins"}:
            continue  # which differs between versions of Python
        static = inspect.getattr_static(kind, name, None)
        if isinstance(static, types.MemberDescriptorType):
            continue  # an attribute of instances
        if isinstance(static, (property, types.GetSetDescriptorType)):
            found[name] = "property"
        elif name == "_full_text":
            found[name] = "str"
        else:
            found[name] = shape_of(getattr(kind, name, None))
    return found


def contents_of(module: types.ModuleType) -> dict[str, Any]:
    """Return the names of a module and of the classes that it defines."""
    names, homes, classes = {}, {}, {}
    for name in names_of(module):
        try:
            value = getattr(module, name)
        except AttributeError:
            continue  # something that cfepy lacks
        names[name] = shape_of(value)
        homes[name] = home_of(value, module.__name__)
        if isinstance(value, type) and value.__module__ == module.__name__:
            classes[name] = members_of(value)
    star = getattr(module, "__all__", None)
    return {"star": None if star is None else sorted(star), "names": names, "homes": homes, "classes": classes}


def package_of(name: str, modules: list[str] | None) -> dict[str, Any]:
    """Return the names that a package shows after its import, and the contents of its modules.

    Args:
        name: of the package.
        modules: full names of its modules; None for all that its folder has.
    """
    package = importlib.import_module(name)
    contents: dict[str, Any] = {name: contents_of(package)}  # before others are imported, which then shows them
    if modules is None:
        with contextlib.redirect_stderr(sys.stdout):
            found = pkgutil.walk_packages(getattr(package, "__path__", []), name + ".", onerror=lambda _: None)
            modules = [each.name for each in found if _is_public(each.name)]
    for each in modules:
        try:
            contents[each] = contents_of(importlib.import_module(each))
        except (ImportError, AttributeError) as error:
            contents[each] = {"raises": type(error).__name__}
    return contents


def _is_public(module: str) -> bool:
    parts = module.split(".")
    if parts[1] in ("msg", "srv") and len(parts) > 2:
        return False
    return not any(part.startswith("_") or part in _SKIPPED for part in parts[1:])


def messages_of(name: str) -> dict[str, Any]:
    """Return the contents of a package's modules of messages and services."""
    found = {}
    for part in ("msg", "srv"):
        with contextlib.suppress(ImportError):
            module = importlib.import_module(f"{name}.{part}")
            contents = contents_of(module)
            kinds = {each: getattr(module, each) for each, shape in contents["names"].items() if "class" in shape}
            contents["classes"] = {each: members_of(kind) for each, kind in kinds.items()}
            found[module.__name__] = contents
    return found


def instances() -> dict[str, Any]:
    """Return the public names of the instances, in a new node."""
    place: dict[str, Any] = {}
    exec(_IMPORTS, place)
    place["rospy"].init_node("names", disable_signals=True)
    return {name: _names_of_instance(text, place) for name, text in INSTANCES.items()}


def _names_of_instance(text: str, place: dict[str, Any]) -> list[str]:
    try:
        return names_of(eval(text, place))
    except Exception as error:
        return [f"{type(error).__name__}: {error}"]


def main() -> None:
    """Record all packages, or print the contents of one."""
    parser = argparse.ArgumentParser(prog="python -m dev.record.ros_names", description=__doc__.partition("\n")[0])
    parser.add_argument("file", metavar="FILE", help="the file to write, tests/data/ros_names.json.xz")
    parser.add_argument("--package", help="only this one")
    parser.add_argument("--instances", action="store_true", help="only instances, with a master that runs")
    parser.add_argument("--messages", action="store_true", help="its messages and services")
    parser.add_argument("--modules", metavar="NAMES", help="a file with the names of its modules, as JSON")
    asked = parser.parse_args()
    if asked.instances:
        Path(asked.file).write_text(json.dumps(instances()), encoding="utf-8")
        os._exit(0)  # some of the instances have threads that do not end
    if asked.package is not None:
        known = asked.modules and json.loads(Path(asked.modules).read_text(encoding="utf-8"))[asked.package]
        found = messages_of(asked.package) if asked.messages else package_of(asked.package, known)
        Path(asked.file).write_text(json.dumps(found), encoding="utf-8")
        return
    record: dict[str, Any] = {"packages": {}, "messages": {}}
    for part, names, option in (("packages", PACKAGES, []), ("messages", MESSAGES, ["--messages"])):
        for name in names:
            with tempfile.TemporaryDirectory() as folder:
                record[part][name] = _in_own_process(name, option, Path(folder))
    record["instances"] = _with_master()
    with lzma.open(asked.file, "wt", encoding="utf-8") as out:
        json.dump(record, out, indent=0, sort_keys=True)
    TABLE.write_text("".join(_lines(record["packages"])), encoding="utf-8")


def _in_own_process(name: str, option: list[str], folder: Path) -> Any:
    """Return the contents of a package, found by a new process.

    Args:
        name: of the package.
        option: of the program.
        folder: empty; it gets a manifest, which the package may look for at its import, and Debian has none.
    """
    tags = {"name": name, "version": "1.0.0", "description": "none", "license": "none"}
    texts = "".join(f"<{tag}>{text}</{tag}>" for tag, text in tags.items())
    manifest = f'<package>{texts}<maintainer email="a@example.org">none</maintainer></package>'
    (folder / name).mkdir()
    (folder / name / "package.xml").write_text(manifest, encoding="utf-8")
    command = [sys.executable, __file__, str(folder / "found"), "--package", name, *option]
    environment = {**os.environ, "ROS_PACKAGE_PATH": f"{folder}:/usr/share"}
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL, cwd="/", env=environment)
    return json.loads((folder / "found").read_text(encoding="utf-8"))


def _with_master() -> Any:
    """Return the names of instances, found by a new process with a master of its own."""
    with tempfile.TemporaryDirectory() as folder:
        environment = {**os.environ, "ROS_MASTER_URI": f"http://localhost:{PORT}", "ROS_LOG_DIR": folder}
        master = subprocess.Popen(["rosmaster", "--core", "-p", str(PORT)], env=environment, stdout=subprocess.DEVNULL)
        try:
            command = [sys.executable, __file__, f"{folder}/found", "--instances"]
            subprocess.run(command, check=True, stdout=subprocess.DEVNULL, cwd=folder, env=environment)
            return json.loads(Path(folder, "found").read_text(encoding="utf-8"))
        finally:
            master.terminate()
            master.wait()


def _lines(packages: dict[str, Any]) -> list[str]:
    """Return the lines of the table of names, which cfepy reads: a module, and the names that it shows."""
    found = [
        "# Public names of the modules of ROS's libraries, and where they import those from that are not their own."
        " `python3 -m dev.record.ros_names` writes this file.\n"
    ]
    for package in packages.values():
        for module, contents in package.items():
            if "names" in contents and (module == "rospy.msg" or not module.endswith((".msg", ".srv"))):
                homes = contents["homes"]
                names = (f"{name}={homes[name]}" if homes[name] else name for name in contents["names"])
                found.append(f"{module}: {' '.join(names)}\n")
    return found


if __name__ == "__main__":
    main()
