"""Fly one scenario: a mission of the node, its helpers and the observer, in its own folder."""

from __future__ import annotations

import json
import os
import shutil
import time
from pathlib import Path
from string import ascii_uppercase
from typing import Any

from cfepy.cli.run.outputs import SavedRunFiles
from cfepy.mission import Mission, MissionSpec
from cfepy.writing.console import Console
from dev.corpus.scenarios import Program, Scenario
from dev.corpus.sources import Sources
from dev.corpus.verdict import Outcome
from rospy_shim.runtime import RosRuntime
from rospy_shim.types.config import NodeConfig, RosConfig

NODE, OBSERVER = "NODE", "OBSERVER"
STEP_S = 0.25
STAND_INS = Path(__file__).with_name("stand_ins")  # packages that nodes expect on their computers
BAGS = Path(__file__).parents[2] / "tests/data/bags"
LONGEST_S = 60.0  # limit in virtual time for a stimulus, or for a node that ends without being asked
SHUTDOWN_S = 6.0  # from being asked to end until it counts as stuck
_ENTRY = "CFE_APP, {file}, __main__, {app}, {priority}, 16384, 0x0, 0;\n"
_PRIORITIES = {OBSERVER: 90}  # so that its services exist before a node asks for them; the others have 100


class Flight:
    """One scenario's run.

    Args:
        scenario: the scenario to fly.
        sources: locates the nodes.
        folder: an empty folder. Scripts appear in it under short names, because a line of a startup script is short.
        tasks: "thread" or "greenlet".
    """

    def __init__(self, scenario: Scenario, sources: Sources, folder: Path, tasks: str = "thread") -> None:
        self._scenario = scenario
        self._sources = sources
        self._folder = folder
        self._tasks = tasks

    def run(self) -> Outcome:
        """Run it to its end."""
        begun = time.perf_counter()
        console = Console(quiet=True)
        spec = self._prepare()
        written = SavedRunFiles(Path("/"), os.path.realpath(self._folder))  # where the nodes think that it is
        with Mission(spec, tasks=self._tasks, console=console, attachments=[written]) as mission:
            ended_itself = self._watch(mission)
            if not ended_itself:
                _graph(mission).begin_shutdown("the scenario is over", NODE)
                self._run_until(mission, lambda: NODE in _graph(mission).ended, SHUTDOWN_S)
            (self._folder / "end").touch()
            self._run_until(mission, lambda: OBSERVER in _graph(mission).ended, SHUTDOWN_S)
            ended = dict(_graph(mission).ended)
        names = {
            app: end.name for app, end in _graph(mission).ended.items()
        }  # including nodes that only the end of the run stopped
        return self._outcome(ended, names, console.lines, ended_itself, time.perf_counter() - begun)

    # -- before ------------------------------------------------------------------------------------------------------

    def _prepare(self) -> MissionSpec:
        scenario, folder = self._scenario, self._folder
        told = {"observe": scenario.observe, "stimulus": scenario.stimulus}
        (folder / "scenario.json").write_text(json.dumps({**told, "seconds": scenario.seconds}), encoding="utf-8")
        for name in ("observer.py", "driving.py"):
            shutil.copy(Path(__file__).with_name(name), folder / name)
        programs = {f"HELPER{number}": helper for number, helper in enumerate(scenario.helpers)}
        programs[NODE] = scenario.node
        files = {OBSERVER: "observer.py", **{app: self._place(app, program) for app, program in programs.items()}}
        startup = folder / "startup.scr"
        startup.write_text("".join(map(_line, files, files.values())) + "!\n", encoding="utf-8")
        nodes = {app: self._config(app, program) for app, program in programs.items()}
        nodes[OBSERVER] = NodeConfig(OBSERVER, args=(str(folder),), env=self._environment())
        params: dict[str, Any] = {}
        for name, value in scenario.params.items():
            _put(params, name.strip("/").split("/"), value)
        return MissionSpec(scenario.id, folder, startup, None, "linux", RosConfig(nodes, {}, params))

    def _place(self, app: str, program: Program) -> str:
        """Place the node's package in the mission's folder. Returns the script's path there."""
        package, script = self._sources.script(program)
        link = app[0].lower() + app.strip(ascii_uppercase)
        (self._folder / link).symlink_to(package)
        return f"{link}/{script}"

    def _config(self, app: str, program: Program) -> NodeConfig:
        mine = app == NODE
        places = {"@TMP": str(self._folder), "@REF": str(BAGS)}
        args = tuple(_replaced(argument, places) for argument in program.argv)
        return NodeConfig(
            app,
            namespace=self._scenario.namespace if mine else "/",
            args=args,
            env=self._environment(),
            keys=self._scenario.keys if mine else None,
        )

    def _environment(self) -> dict[str, str]:
        folders = [str(self._sources.folder(repo)) for repo in self._scenario.repos]
        return {
            "HOME": str(self._folder),
            "PYTHONPATH": str(STAND_INS),
            "ROS_PACKAGE_PATH": os.pathsep.join(folders),
            "TERM": "xterm",
        }

    # -- meanwhile ---------------------------------------------------------------------------------------------------

    def _watch(self, mission: Mission) -> bool:
        """Run until the scenario is over. Returns whether the node ended before that without being asked."""
        done = os.path.realpath(self._folder / "done")
        self._run_until(mission, lambda: mission.run_files is not None and mission.run_files.exists(done), LONGEST_S)
        if self._scenario.ends_itself:
            self._run_until(mission, lambda: NODE in _graph(mission).ended, LONGEST_S)
        return NODE in _graph(mission).ended

    @staticmethod
    def _run_until(mission: Mission, over: Any, seconds: float) -> None:
        end = mission.kernel.now + round(seconds * 1e9)
        while not over() and mission.kernel.now < end:
            mission.run_for(STEP_S)

    # -- afterwards --------------------------------------------------------------------------------------------------

    def _outcome(
        self, ended: dict[str, Any], names: dict[str, str], lines: list[str], ended_itself: bool, wall_s: float
    ) -> Outcome:
        result = self._folder / "result.json"
        failure = {"stimulus failed": next((line for line in lines if "Error" in line), "the observer did not end")}
        nothing: dict[str, Any] = {"N": {}, "T": {}, "R": failure, "rate": {}}
        seen = json.loads(result.read_text(encoding="utf-8")) if result.is_file() else nothing
        files = {f"@TMP/{path.name}": path.stat().st_size for path in self._folder.iterdir() if path.is_file()}
        helpers = [app for app in names if app not in (NODE, OBSERVER)]
        return Outcome(
            counts=seen["N"],
            messages=seen["T"],
            remarks=seen["R"],
            rates=seen["rate"],
            status=ended[NODE].status if NODE in ended else None,
            ended_itself=ended_itself,
            out=_printed(lines, NODE, names),
            helpers_out="".join(_printed(lines, app, names) for app in helpers),
            files=files,
            wall_s=wall_s,
        )


def _graph(mission: Mission) -> RosRuntime:
    """Return the mission's ROS, which is there once its nodes are."""
    assert mission.ros is not None
    return mission.ros


def _line(app: str, file: str) -> str:
    return _ENTRY.format(app=app, file=file, priority=_PRIORITIES.get(app, 100))


def _printed(lines: list[str], app: str, names: dict[str, str]) -> str:
    """Return a node's output. Its lines carry its application's name, and its own name from init_node on."""
    marks = [f"[{name}] " for name in {app, names.get(app, app)}]
    found = [line.partition("] ")[2] for line in lines if line.startswith(tuple(marks))]
    return "".join(f"{line}\n" for line in found)


def _replaced(text: str, names: dict[str, str]) -> str:
    for name, value in names.items():
        text = text.replace(name, value)
    return text


def _put(tree: dict[str, Any], keys: list[str], value: Any) -> None:
    for key in keys[:-1]:
        tree = tree.setdefault(key, {})
    tree[keys[-1]] = value
