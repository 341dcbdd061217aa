"""The names of launch files, and how to find one from a user's words; `cfepy.mission.launch` reads them."""

from __future__ import annotations

import os
from pathlib import Path

LAUNCH_FILES = (".launch", ".test", ".xml")


def launch_file_of_package(text: str) -> Path | None:
    """Return the launch file for a package and a name in it, separated by a blank, as in roslaunch.

    Args:
        text: such as "demo robot.launch".

    Returns:
        The file, or None if the text does not have this form.

    Raises:
        UsageError: if there is no such package, or no such file in it.
    """
    package, blank, name = text.partition(" ")
    if not blank or "/" in package or not name.endswith(LAUNCH_FILES):
        return None
    from rospy_shim.roslaunch.launch_plan import launch_file

    return launch_file(package, name, Path.cwd() / name, os.environ)


def files_near(path: Path, suffixes: tuple[str, ...]) -> list[str]:
    """Return the files with some suffixes in the folder of a path, written like the path."""
    try:
        return [str(each) for each in sorted(path.parent.iterdir()) if each.suffix in suffixes]
    except OSError:
        return []
