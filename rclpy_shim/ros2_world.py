"""The world of ROS 2 for one program of a mission: environment, command line, modules, and refusals.

A mission's `RosRuntime` asks `Ros2World` when it starts a program of ROS 2; `rospy_shim.types.worlds` decides which
programs those are. Packages that cfepy does not have for ROS 2 yet are refused by name.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rclpy_shim.interfaces import Interfaces
from rclpy_shim.seam.ros2_program import Ros2Program
from rospy_shim.library_parts import STAND_INS
from rospy_shim.types.msgs import OnDisk, Packages

if TYPE_CHECKING:
    from cfepy.nodes import Factory, NodeConfig

LIBRARIES = Path(__file__).parent / "libraries"
SEAM = "rclpy._seam"
ENVIRONMENT = {
    "AMENT_PREFIX_PATH": "/opt/ros/jazzy",
    "ROS_DISTRO": "jazzy",
    "ROS_PYTHON_VERSION": "3",
    "ROS_VERSION": "2",
}
"""The variables that the set-up file of ROS 2 sets."""
OF_ROS_1 = ("ROS_ETC_DIR", "ROS_MASTER_URI", "ROS_ROOT")
"""Variables of ROS 1 that a program of ROS 2 does not have."""
NOT_YET = (
    *("ament_index_python", "cv_bridge", "launch", "launch_ros", "rosbag2_py", "rosidl_runtime_py"),
    *("sensor_msgs_py", "tf2_geometry_msgs", "tf_transformations"),
)
"""Packages of ROS 2 that cfepy does not have yet; those of ROS 1 with these names do not fit."""


class Ros2World:
    """ROS 2 as a `RosRuntime` uses it.

    Attributes:
        library_paths: folders of the libraries.
        fallback_paths: folders of replacements for packages that may not be installed.
        node_class: class of a program.
    """

    library_paths = (LIBRARIES,)
    fallback_paths = (STAND_INS,)
    node_class = Ros2Program

    def environment(self, ros1: Mapping[str, str]) -> dict[str, str]:
        """Return the environment of a program.

        Args:
            ros1: the environment that a node of ROS 1 has.
        """
        return {**{name: value for name, value in ros1.items() if name not in OF_ROS_1}, **ENVIRONMENT}

    def command_line(self, config: NodeConfig) -> list[str]:
        """Return the arguments of a program, with its names, remappings and parameters after `--ros-args`."""
        rules = [f"{source}:={target}" for source, target in config.remap.items()]
        if config.name:
            rules.append(f"__node:={config.name}")
        if config.namespace != "/":
            rules.append(f"__ns:={config.namespace}")
        found = [word for rule in rules for word in ("-r", rule)]
        for name, value in _flat(config.params).items():
            found += ["-p", f"{name}:={_written(value)}"]
        return [*config.args, *(["--ros-args", *found] if found else [])]

    def library_names(self) -> frozenset[str]:
        """Return the names of the libraries, such as "rclpy"."""
        return frozenset(place.parent.name for place in LIBRARIES.glob("*/__init__.py"))

    def types_near(self, packages: Packages, environ: Mapping[str, str]) -> Interfaces:
        """Return the message types of a program.

        Args:
            packages: the packages near the program.
            environ: its environment variables.
        """
        return Interfaces([OnDisk(packages)], environ)

    def refusal(self, name: str) -> str:
        """Return why a program cannot import a module; see `refusal`."""
        return refusal(name)

    def finder(self, program: Ros2Program) -> Callable[[str], Factory | None]:
        """Return the finder of the program's modules: the seam, message packages, and packages that are refused.

        Packages near the program whose code is in a folder of their name (ament_python) are added to its path.
        """
        packages = program.packages
        folders = [(name, folder) for name in packages.names() for folder in packages.folders(name)[:1]]
        code = [str(folder) for name, folder in folders if (folder / name / "__init__.py").is_file()]
        program.universe.importer.path[1:1] = code

        def find(name: str) -> Factory | None:
            top, _, rest = name.partition(".")
            if name == SEAM:
                return lambda universe: program.module()
            if why := "" if top in NOT_YET and program.universe.importer.has_own(top) else refusal(name):
                kind = ImportError if top == "rospy" else ModuleNotFoundError
                raise kind(why, name=name)
            if top == "rclpy":
                return None
            if not rest and program.universe.importer.has_own(name):
                return None
            module = program.interfaces.module(name)
            return None if module is None else lambda universe: module

        return find


def refusal(name: str) -> str:
    """Return why a program cannot import a module of ROS; empty if nothing refuses it.

    Args:
        name: full name of the module.
    """
    top, _, rest = name.partition(".")
    if top == "rospy":
        return "a program of ROS 2 cannot import rospy; use two nodes, or write `ros: 1` for it in mission.yaml"
    place = LIBRARIES.joinpath(top, *rest.split("."))
    is_there = not rest or place.with_suffix(".py").is_file() or (place / "__init__.py").is_file()
    if top in NOT_YET or (top == "rclpy" and name != SEAM and not is_there):
        return f"cfepy does not have {name} for nodes of ROS 2 yet; docs/how_to/run_a_ros2_node.md lists what works"
    return ""


def _flat(params: Mapping[str, Any], prefix: str = "") -> dict[str, Any]:
    found: dict[str, Any] = {}
    for name, value in params.items():
        if isinstance(value, Mapping):
            found |= _flat(value, f"{prefix}{name}.")
        else:
            found[prefix + name] = value
    return found


def _written(value: Any) -> str:
    import json

    return json.dumps(value)
