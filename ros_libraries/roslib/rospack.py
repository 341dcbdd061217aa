"""roslib.rospack: dependencies as in the command `rospack`."""

from __future__ import annotations

from collections.abc import Sequence

import rospkg


def rospack_depends_1(pkg: str) -> Sequence[str]:
    """Return the names of a package's direct dependencies."""
    return rospkg.RosPack().get_depends(pkg, implicit=False)


def rospack_depends(pkg: str) -> Sequence[str]:
    """Return the names of the packages that a package depends on, also by way of others."""
    return rospkg.RosPack().get_depends(pkg)


def rospack_depends_on_1(pkg: str) -> Sequence[str]:
    """Return the names of the packages that depend on a package themselves."""
    return rospkg.RosPack().get_depends_on(pkg, implicit=False)


def rospack_depends_on(pkg: str) -> Sequence[str]:
    """Return the names of the packages that depend on a package, also by way of others."""
    return rospkg.RosPack().get_depends_on(pkg)


def rospack_plugins(pkg: str) -> list[tuple[str, str]]:
    """Return the package and file of each plugin for a package."""
    packages = rospkg.RosPack()
    return [
        (name, file)
        for name in packages.get_depends_on(pkg, implicit=False)
        for file in packages.get_manifest(name).get_export(pkg, "plugin")
    ]
