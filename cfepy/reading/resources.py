"""Paths of the files included in cfepy (boards, missions, apps, ROS packages) and of cfepy itself.

In a source checkout they are next to the package, in an installed wheel under cfepy/share.
"""

from __future__ import annotations

import os
import sys
from pathlib import Path

from cfepy.status import UsageError


def shipped(kind: str) -> Path:
    """Return the directory of one kind of shipped files.

    Args:
        kind: "apps", "boards", "missions", "ros_packages", or "roscfe", the interface library for nodes in C++.

    Raises:
        UsageError: if this installation does not have the directory.
    """
    package = Path(__file__).resolve().parents[1]
    places = [package / "share" / kind, package.parent / kind]
    for place in places:
        if place.is_dir():
            return place
    looked = " nor ".join(str(place) for place in places)
    raise UsageError(f"{kind} missing in this installation of cfepy: neither {looked} exists; install cfepy again")


def import_path() -> str:
    """Return the PYTHONPATH for a process that must find cfepy, however this process found it."""
    return os.pathsep.join(path for path in sys.path if path) or os.curdir


def python_command() -> tuple[str, ...]:
    """Return the start of a command line that runs a module of cfepy in another Python; pass `import_path` to it.

    The working directory is not on its path (-P), because a file there may have the name of a Python module.
    """
    return (sys.executable, "-P")
