"""The distributions of ROS that a node finds installed: rospy, genpy and the libraries, with their versions.

A node looks for them with `importlib.metadata` or `pkg_resources`; for other distributions it gets the host's answers.
Versions are ROS Noetic's (index.ros.org).
"""

from __future__ import annotations

import importlib
import importlib.metadata
import re
from pathlib import Path
from types import ModuleType
from typing import Any

from cfepy.nodes.made_modules import proxy

_RELEASES = {
    "0.6.0": "genmsg",
    "0.6.16": "genpy",
    "0.7.7": "tf2-geometry-msgs tf2-kdl tf2-py tf2-ros tf2-sensor-msgs",
    "1.4.0": "rospkg",
    "1.7.3": "dynamic-reconfigure",
    "1.8.6": "bondpy",
    "1.11.0": "diagnostic-updater",
    "1.12.7": "resource-retriever",
    "1.13.1": "sensor-msgs",
    "1.13.2": "tf tf-conversions",
    "1.14.0": "actionlib",
    "1.15.8": "roslib rosunit",
    "1.16.0": "message-filters rosbag rosgraph roslaunch roslz4 rosmsg rosnode rosparam rospy rosservice rostest"
    " rostopic",
    "1.16.2": "cv-bridge",
}
VERSIONS = {name: version for version, names in _RELEASES.items() for name in names.split()}


class RosDistribution(importlib.metadata.Distribution):
    """A distribution without a file.

    Args:
        name: normalised, as in `VERSIONS`.
    """

    def __init__(self, name: str) -> None:
        self._text = f"Metadata-Version: 2.1\nName: {name}\nVersion: {VERSIONS[name]}\n"

    def read_text(self, filename: str) -> str | None:
        """Return its metadata; there is no other text."""
        return self._text if filename == "METADATA" else None

    def locate_file(self, path: Any) -> Path:
        """Return where a file of it would be."""
        return Path(path)


def metadata_module() -> ModuleType:
    """Return `importlib.metadata` of a node."""

    def distribution(distribution_name: str) -> importlib.metadata.Distribution:
        name = _normal(distribution_name)
        return RosDistribution(name) if name in VERSIONS else importlib.metadata.distribution(distribution_name)

    def distributions(**options: Any) -> list[importlib.metadata.Distribution]:
        return [*map(RosDistribution, VERSIONS), *importlib.metadata.distributions(**options)]

    return proxy(
        importlib.metadata,
        distribution=distribution,
        distributions=distributions,
        metadata=lambda distribution_name: distribution(distribution_name).metadata,
        version=lambda distribution_name: distribution(distribution_name).version,
    )


def pkg_resources_module() -> ModuleType:
    """Return `pkg_resources` of a node.

    Raises:
        ModuleNotFoundError: the host has no setuptools, or one without it.
    """
    host: Any = importlib.import_module("pkg_resources")

    def get_distribution(dist: Any) -> Any:
        name = _normal(dist) if isinstance(dist, str) else ""
        if name not in VERSIONS:
            return host.get_distribution(dist)
        return host.Distribution(project_name=name, version=VERSIONS[name])

    def require(*requirements: Any) -> list[Any]:
        found: list[Any] = []
        for wanted in host.parse_requirements(requirements):
            ours = _normal(wanted.project_name) in VERSIONS
            found += [get_distribution(wanted.project_name)] if ours else host.require(str(wanted))
        return found

    return proxy(host, get_distribution=get_distribution, require=require)


def _normal(name: str) -> str:
    return re.sub(r"[-_.]+", "-", name).lower()
