"""rospkg.common: names of manifest files, and the error of missing packages."""

from __future__ import annotations

from collections.abc import Sequence

PACKAGE_FILE = "package.xml"
MANIFEST_FILE = "manifest.xml"
STACK_FILE = "stack.xml"
ROS_STACK = "ros"


class ResourceNotFound(Exception):
    """There is no such package or stack.

    Args:
        msg: its name.
        ros_paths: the folders that were searched.
    """

    def __init__(self, msg: str, ros_paths: Sequence[str] | None = None) -> None:
        super().__init__(msg)
        self.ros_paths = ros_paths

    def __str__(self) -> str:
        places = [f"ROS path [{number}]={path}" for number, path in enumerate(self.ros_paths or ())]
        return "\n".join([str(self.args[0]), *places])
