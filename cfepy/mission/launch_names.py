"""The names of launch files, and how to find one from a user's words; `cfepy.mission.launch` reads them."""

from __future__ import annotations

import os
from pathlib import Path

from cfepy.reading.input_files import beginning_of

STARTUP_SCRIPT = "startup.scr"
MISSION_FILE = "mission.yaml"
WITHOUT_LAUNCH = f"missing `launch:`, because there is no {STARTUP_SCRIPT} beside it; name your launch files there"
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


def is_alone(path: Path) -> bool:
    """Return whether a path is a mission file without a startup script beside it: its launch files are the mission."""
    if path.name != MISSION_FILE or not os.path.isfile(path):
        return False
    script = path.parent / STARTUP_SCRIPT
    if not os.path.isfile(script):
        return True
    beginning_of(script, 1)  # a journal has the opened files: a replay needs the script beside the mission file, too
    return False


def is_mission_folder(folder: Path) -> bool:
    """Return whether a folder is a mission: it has a startup script, or a mission file without one."""
    return os.path.isfile(folder / STARTUP_SCRIPT) or is_alone(folder / MISSION_FILE)


def mission_file_of(script: Path) -> Path | None:
    """Return the mission file that belongs to a startup script or a launch file; None if there is none.

    A launch file has the `mission.yaml` beside it, unless a startup script there has it.
    """
    if script.suffix in LAUNCH_FILES:
        return script.parent / MISSION_FILE if is_alone(script.parent / MISSION_FILE) else None
    candidates = (script.with_suffix(".yaml"), script.parent / MISSION_FILE)
    return next((path for path in candidates if os.path.isfile(path)), None)
