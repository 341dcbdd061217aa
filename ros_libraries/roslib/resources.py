"""roslib.resources: names of the files in a folder of a package."""

from __future__ import annotations

import os
from collections.abc import Callable

import rospkg

from roslib.names import resource_name
from roslib.packages import get_pkg_dir

Filter = Callable[[str], bool]
"""Takes a path and says whether the file counts."""


def list_package_resources(
    package: str, include_depends: bool, subdir: str, rfilter: Filter = os.path.isfile
) -> list[str]:
    """Return the names of the files in a folder of a package.

    Args:
        package: its name.
        include_depends: also files of its dependencies, with the packages' names.
        subdir: the folder.
        rfilter: which files count.

    Raises:
        InvalidROSPkgException: there is no such package.
    """
    found = _files(get_pkg_dir(package), package, subdir, rfilter, package)
    if include_depends:
        for name in rospkg.RosPack().get_depends(package, implicit=False):
            found += _files(get_pkg_dir(name, required=False), name, subdir, rfilter, package)
    return found


def _files(place: str | None, package: str, subdir: str, rfilter: Filter, seen_from: str) -> list[str]:
    folder = os.path.join(place or "", subdir)
    if place is None or not os.path.isdir(folder):
        return []
    names = sorted(name for name in os.listdir(folder) if rfilter(os.path.join(folder, name)))
    return [resource_name(package, name, my_pkg=seen_from) for name in names]
