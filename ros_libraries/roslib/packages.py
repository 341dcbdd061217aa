"""roslib.packages: folders of packages, and files in them."""

from __future__ import annotations

import os
import stat
from collections.abc import Callable, Mapping
from typing import Any

import rospkg
from rospkg import MANIFEST_FILE
from rospkg.common import PACKAGE_FILE
from rospkg.environment import ROS_PACKAGE_PATH, ROS_ROOT

__all__ = [
    "MANIFEST_FILE",
    "PACKAGE_FILE",
    "ROS_PACKAGE_PATH",
    "ROS_ROOT",
    "InvalidROSPkgException",
    "MultipleNodesException",
    "ROSPkgException",
    "find_node",
    "find_resource",
    "get_dir_pkg",
    "get_pkg_dir",
    "get_pkg_subdir",
    "list_pkgs_by_path",
    "resource_file",
]

SRC_DIR = "src"


class ROSPkgException(Exception):
    """Base of the errors of packages."""


class InvalidROSPkgException(ROSPkgException):
    """There is no such package, or it is broken."""


class MultipleNodesException(ROSPkgException):
    """Two nodes of a package have one name."""


def get_dir_pkg(d: str) -> tuple[str | None, str | None]:
    """Return the folder and name of the package that a folder lies in, or None twice."""
    folder = os.path.realpath(d)
    while not any(os.path.exists(os.path.join(folder, name)) for name in (MANIFEST_FILE, PACKAGE_FILE)):
        if os.path.dirname(folder) == folder:
            return None, None
        folder = os.path.dirname(folder)
    return folder, os.path.basename(folder)


def get_pkg_dir(
    package: str, required: bool = True, ros_root: str | None = None, ros_package_path: str | None = None
) -> str | None:
    """Return the folder of a package.

    Args:
        package: its name.
        required: raise if there is none; otherwise return None.
        ros_root: accepted.
        ros_package_path: folders to search; by default those of the node.

    Raises:
        InvalidROSPkgException: there is no such package.
    """
    try:
        return _rospack(ros_package_path).get_path(package)
    except rospkg.ResourceNotFound:
        if not required:
            return None
        path = os.environ.get(ROS_PACKAGE_PATH) if ros_package_path is None else ros_package_path
        text = f"Cannot locate installation of package {package}: ROS_ROOT[{ros_root}] ROS_PACKAGE_PATH[{path}]"
        raise InvalidROSPkgException(text) from None


def _rospack(path: str | None) -> rospkg.RosPack:
    return rospkg.RosPack() if path is None else rospkg.RosPack([each for each in path.split(os.pathsep) if each])


def get_pkg_subdir(
    package: str, subdir: str, required: bool = True, env: Mapping[str, str] | None = None
) -> str | None:
    """Return a folder in a package, and create it if it is missing.

    Args:
        package: name of the package.
        subdir: name of the folder.
        required: create it; raise if that fails.
        env: environment with ROS_PACKAGE_PATH.

    Raises:
        InvalidROSPkgException: there is no such package.
    """
    place = get_pkg_dir(package, required, ros_package_path=None if env is None else env.get(ROS_PACKAGE_PATH, ""))
    return None if place is None else _get_pkg_subdir_by_dir(place, subdir, required)


def _get_pkg_subdir_by_dir(
    package_dir: str, subdir: str, required: bool = True, env: Mapping[str, str] | None = None
) -> str:
    folder = os.path.join(package_dir, subdir)
    if required:
        os.makedirs(folder, exist_ok=True)
    return folder


def resource_file(package: str, subdir: str, resource_name: str) -> str:
    """Return the path of a file in a folder of a package, even if it does not exist.

    Raises:
        InvalidROSPkgException: there is no such package.
    """
    folder = get_pkg_subdir(package, subdir, False)
    if folder is None:
        raise InvalidROSPkgException(package)
    return os.path.join(folder, resource_name)


def list_pkgs_by_path(
    path: str, packages: list[str] | None = None, cache: dict[str, Any] | None = None, env: Any = None
) -> list[str]:
    """Return the names of the packages in a folder at any depth.

    Args:
        path: the folder.
        packages: takes the names as well.
        cache: takes the folders.
        env: accepted.
    """
    found = [] if packages is None else packages
    found.extend(each for each in rospkg.list_by_path(MANIFEST_FILE, path, cache) if each not in found)
    return found


# -- files -----------------------------------------------------------------------------------------------------------


def find_node(pkg: str, node_type: str, rospack: Any = None) -> list[str]:
    """Return paths of the executables of a package with a name.

    Args:
        pkg: name of the package.
        node_type: name of the executable.
        rospack: finds the package.

    Raises:
        rospkg.ResourceNotFound: there is no such package.
    """
    return find_resource(pkg, node_type, filter_fn=_executable_filter, rospack=rospack)


def find_resource(
    pkg: str, resource_name: str, filter_fn: Callable[[str], bool] | None = None, rospack: Any = None
) -> list[str]:
    """Return paths of the files of a package with a name.

    Args:
        pkg: name of the package.
        resource_name: name of the file.
        filter_fn: takes a path and returns whether it counts.
        rospack: finds the package.

    Raises:
        rospkg.ResourceNotFound: there is no such package.
    """
    return _find_resource((rospack or rospkg.RosPack()).get_path(pkg), resource_name, filter_fn)


def _find_resource(d: str, resource_name: str, filter_fn: Callable[[str], bool] | None = None) -> list[str]:
    found = []
    for folder, below, files in os.walk(d, followlinks=True):
        below[:] = sorted(each for each in below if not each.startswith("."))
        path = os.path.abspath(os.path.join(folder, resource_name))
        if resource_name in files and (filter_fn is None or filter_fn(path)):
            found.append(path)
    return found


def _executable_filter(test_path: str) -> bool:
    wanted = stat.S_IRUSR | stat.S_IXUSR
    return os.stat(test_path).st_mode & wanted == wanted
