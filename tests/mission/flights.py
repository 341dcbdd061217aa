"""Small missions for tests: a startup script, and the sources of its apps and nodes."""

from __future__ import annotations

import textwrap
from pathlib import Path


def write_mission(folder: Path, startup: str, **sources: str) -> str:
    """Write a mission's files.

    Args:
        folder: folder of the mission.
        startup: the startup script.
        sources: file stem to Python source (with the test's indentation); `mission_yaml` is the mission file.

    Returns:
        The argument for `Mission`.
    """
    for stem, source in sources.items():
        name = "mission.yaml" if stem == "mission_yaml" else f"{stem}.py"
        (folder / name).write_text(textwrap.dedent(source), encoding="utf-8")
    (folder / "startup.scr").write_text(textwrap.dedent(startup), encoding="utf-8")
    return str(folder)
