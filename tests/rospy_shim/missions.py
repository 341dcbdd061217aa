"""Small missions of ROS nodes for the tests: scripts as text or files, run for some virtual seconds."""

from __future__ import annotations

import shutil
import textwrap
from collections.abc import Mapping
from pathlib import Path
from typing import Any, NamedTuple

from cfepy.cli.run.outputs import SavedRunFiles
from cfepy.mission import Mission, MissionSpec
from cfepy.writing.console import Console
from rospy_shim.types.config import NodeConfig, RosConfig, TopicConfig


class Run(NamedTuple):
    """Results of a run: the output lines of nodes, everything on the console, the topics' rows, the digest."""

    printed: dict[str, list[str]]
    lines: list[str]
    topics: dict[str, Any]
    digest: str
    finished: bool


def run_nodes(
    folder: Path,
    scripts: Mapping[str, str | Path],
    *,
    seconds: float = 3.0,
    nodes: Mapping[str, NodeConfig] | None = None,
    topics: Mapping[str, TopicConfig] | None = None,
    params: Mapping[str, Any] | None = None,
    tasks: str = "thread",
    priorities: Mapping[str, int] | None = None,
    connection_delay_ns: int = 0,
) -> Run:
    """Run scripts as nodes; keys are their cFE names. Files that they write are on the computer afterwards.

    Args:
        folder: an empty folder to put the mission in.
        scripts: source text, or a file that is copied.
        seconds: virtual time before the nodes are asked to end.
        nodes: their entries in a mission file.
        topics: pinned MsgIds.
        params: global parameters.
        tasks: "thread" or "greenlet".
        priorities: priorities of the applications, 100 by default.
        connection_delay_ns: until a publisher and a subscriber are connected.
    """
    script_lines = []
    for app, source in scripts.items():
        name = f"{app.lower()}.py"
        if isinstance(source, Path):
            shutil.copy(source, folder / name)
        else:
            (folder / name).write_text(textwrap.dedent(source), encoding="utf-8")
        priority = (priorities or {}).get(app, 100)
        script_lines.append(f"CFE_APP, {name}, __main__, {app}, {priority}, 16384, 0x0, 1;\n")
    startup = folder / "startup.scr"
    startup.write_text("".join(script_lines) + "!\n", encoding="utf-8")
    ros = RosConfig(nodes or {}, topics or {}, params or {}, connection_delay_ns=connection_delay_ns)
    console = Console(quiet=True)
    spec = MissionSpec("test", folder, startup, None, "linux", ros)
    with Mission(spec, tasks=tasks, console=console, attachments=[SavedRunFiles(Path("/"))]) as mission:
        mission.run_for(seconds)
        mission.shut_down_nodes()
        rows = {row.name: row for row in mission.ros.topics()} if mission.ros is not None else {}
        finished = mission.ros is None or mission.ros.all_finished()
        return Run(_by_node(console.lines), list(console.lines), rows, mission.trace.digest(), finished)


def _by_node(lines: list[str]) -> dict[str, list[str]]:
    found: dict[str, list[str]] = {}
    for line in lines:
        if line.startswith("[") and "] " in line:
            name, _, text = line[1:].partition("] ")
            found.setdefault(name, []).append(text)
    return found
