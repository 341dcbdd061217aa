"""rospkg: ROS packages on disk, their folders and manifests (docs.ros.org/en/independent/api/rospkg).

A node sees the packages near its script, those on ROS_PACKAGE_PATH and those in the share folders of CMAKE_PREFIX_PATH.
"""

from __future__ import annotations

from rospkg.common import MANIFEST_FILE, PACKAGE_FILE, STACK_FILE, ResourceNotFound
from rospkg.environment import (
    get_etc_ros_dir,
    get_log_dir,
    get_ros_home,
    get_ros_package_path,
    get_ros_paths,
    get_ros_root,
    get_test_results_dir,
    on_ros_path,
)
from rospkg.manifest import InvalidManifest, Manifest, parse_manifest_file
from rospkg.rospack import (
    RosPack,
    RosStack,
    expand_to_packages,
    get_package_name,
    get_stack_version_by_dir,
    list_by_path,
)

__all__ = [
    "MANIFEST_FILE",
    "PACKAGE_FILE",
    "STACK_FILE",
    "InvalidManifest",
    "Manifest",
    "ResourceNotFound",
    "RosPack",
    "RosStack",
    "expand_to_packages",
    "get_etc_ros_dir",
    "get_log_dir",
    "get_package_name",
    "get_ros_home",
    "get_ros_package_path",
    "get_ros_paths",
    "get_ros_root",
    "get_stack_version_by_dir",
    "get_test_results_dir",
    "list_by_path",
    "on_ros_path",
    "parse_manifest_file",
]
__version__ = "1.4.0"  # the release that has these functions
