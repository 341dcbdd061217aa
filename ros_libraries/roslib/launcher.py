"""roslib.launcher: makes the code of rosbuild packages importable. Code of catkin packages already is."""

from __future__ import annotations

import importlib.util
import os
import sys

import rospkg

from roslib import _definitions  # type: ignore[attr-defined]  # made for the node, which knows its message types

_bootstrapped: list[str] = []


def load_manifest(package_name: str, bootstrap_version: str = "0.7") -> None:
    """Put the code folders of a package and of its dependencies into sys.path.

    Args:
        package_name: the package.
        bootstrap_version: accepted.

    Raises:
        rospkg.ResourceNotFound: there is no such package: on disk, as a library, or with messages.
    """
    if package_name in _bootstrapped:
        return
    packages = rospkg.RosPack()
    if package_name in packages.list():
        _add_code(packages, package_name)
    elif package_name not in _definitions.packages() and importlib.util.find_spec(package_name) is None:
        raise rospkg.ResourceNotFound(package_name, ros_paths=packages.get_ros_paths())
    _bootstrapped.append(package_name)


def _add_code(packages: rospkg.RosPack, package_name: str) -> None:
    if packages.get_manifest(package_name).is_catkin:
        return
    try:
        needed = packages.get_depends(package_name)
    except (rospkg.InvalidManifest, rospkg.ResourceNotFound):
        needed = []
    for name in [*needed, package_name]:
        folders = _code_folders(packages, name) if name in packages.list() else []
        sys.path[:0] = [folder for folder in folders if folder not in sys.path]


def _code_folders(packages: rospkg.RosPack, name: str) -> list[str]:
    manifest, place = packages.get_manifest(name), packages.get_path(name)
    if manifest.is_catkin:
        return []
    exported = [path for paths in manifest.get_export("python", "path") for path in paths.split(":")]
    usual = [os.path.join(place, folder) for folder in ("src", "lib")]
    return exported or [folder for folder in usual if os.path.isdir(folder)]
