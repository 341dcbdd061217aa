"""What launch files are called, and where the words of a user find one; `cfepy.mission.launch` reads them."""

from __future__ import annotations

import os
from pathlib import Path

LAUNCH_FILES = (".launch", ".test", ".xml")


def launch_file_of_package(text: str) -> Path | None:
    """The launch file that a package and its name in the package mean, with a blank between them, as roslaunch has it.

    Args:
        text: such as "demo robot.launch".

    Returns:
        None when the text looks like something else.

    Raises:
        UsageError: there is no such package, or no such file in it.
    """
    package, blank, name = text.partition(" ")
    if not blank or "/" in package or not name.endswith(LAUNCH_FILES):
        return None
    from rospy_shim.roslaunch.launch_plan import launch_file

    return launch_file(package, name, Path.cwd() / name, os.environ)


def files_near(path: Path, suffixes: tuple[str, ...]) -> list[str]:
    """The files of some kind in the folder of a path, as they would be written in its place."""
    try:
        return [str(each) for each in sorted(path.parent.iterdir()) if each.suffix in suffixes]
    except OSError:
        return []
