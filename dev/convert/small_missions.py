"""Missions of one small package with nodes in C++, whose sources a test gives as texts."""

from __future__ import annotations

import os
from collections.abc import Mapping
from pathlib import Path
from types import MappingProxyType
from unittest.mock import patch

import yaml

from cfepy.extra.convert import build_for_flight
from cfepy.mission import Mission, read_mission
from cfepy.writing.console import Console

PACKAGE = "small"
ARENA_BYTES = 1 << 22
"""Enough for a buffer of transforms and a few topics."""
MANIFEST = f"""<package format="2"><name>{PACKAGE}</name><version>1.0.0</version><description>small</description>
<maintainer email="a@b.c">a</maintainer><license>Apache-2.0</license><depend>roscpp</depend>
<depend>std_msgs</depend><depend>std_srvs</depend></package>
"""


def write_package(folder: Path, sources: Mapping[str, str]) -> Path:
    """Write the package.

    Args:
        folder: folder for the package; it must be in ROS_PACKAGE_PATH.
        sources: texts of programs, by the names of their files, such as "talker.cpp" and "talker.py".

    Returns:
        The folder of the package.
    """
    package = folder / PACKAGE
    package.mkdir()
    (package / "package.xml").write_text(MANIFEST, encoding="utf-8")
    programs = [name.removesuffix(".cpp") for name in sources if name.endswith(".cpp")]
    made = "".join(f"add_executable({each} {each}.cpp)\n" for each in programs)
    (package / "CMakeLists.txt").write_text(f"project({PACKAGE})\n{made}", encoding="utf-8")
    for name, text in sources.items():
        (package / name).write_text(text, encoding="utf-8")
        (package / name).chmod(0o755)
    return package


def small_mission(
    folder: Path,
    sources: Mapping[str, str],
    launch: str,
    profile: str = "host",
    capacities: Mapping[str, Mapping[str, int]] = MappingProxyType({}),
) -> Mission:
    """Return the mission of a launch file, not started yet.

    Args:
        folder: an empty folder.
        sources: see `write_package`.
        launch: content of the launch file.
        profile: profile of the nodes in C++.
        capacities: the most items of each list, by message type and field.
    """
    write_package(folder, sources)
    (folder / "startup.scr").write_text("!\n", encoding="utf-8")
    (folder / "all.launch").write_text(f"<launch>{launch}</launch>\n", encoding="utf-8")
    cpp = {
        "profile": profile,
        "arena_bytes": ARENA_BYTES,
        "capacities": {name: dict(capacities[name]) for name in capacities},
    }
    content = yaml.safe_dump({"launch": ["all.launch"], "cpp_nodes": cpp})
    (folder / "mission.yaml").write_text(content, encoding="utf-8")
    with patch.dict(os.environ, {"ROS_PACKAGE_PATH": str(folder)}):
        spec = read_mission(str(folder), build=build_for_flight)
    assert not spec.notes, spec.notes
    return Mission(spec, console=Console(quiet=True))


def node(name: str, program: str = "", inside: str = "") -> str:
    """Return the tag of a node. Its program has the node's name unless `program` is given."""
    return f'<node pkg="{PACKAGE}" type="{program or name}" name="{name}" output="screen">{inside}</node>'


def said_by(mission: Mission, name: str) -> list[str]:
    """Return the log lines of a node, without names and times."""
    lines = [line for line in mission.console.lines if line.startswith(f"[/{name}] [")]
    return [line.partition("]: ")[2].removesuffix("\x1b[0m") for line in lines]
