"""A node on cfepy, as the product builds and flies it, beside the same driver."""

from __future__ import annotations

import json
import os
import re
from collections.abc import Mapping
from dataclasses import replace
from io import BytesIO
from pathlib import Path
from typing import Any
from unittest.mock import patch

import cfepy.extra.convert.flight_build
from cfepy.es.packets import START_APP
from cfepy.extra.convert import build_for_flight
from cfepy.extra.convert.build import provided_packages
from cfepy.extra.convert.cpp_package import Program
from cfepy.mission import Mission
from cfepy.mission.launch import COMPILED_STACK_BYTES, PRIORITY, read_launch
from cfepy.mission.processor import Machine
from cfepy.writing.console import Console
from dev.convert.stimulus.outcome import Outcome, outcome_of
from dev.convert.stimulus.script import Scene, Seen
from rospy_shim.graph.compiled import CompiledNodes
from rospy_shim.types.msgs import Library

NODE, DRIVER = "NODE", "DRIVER"
HERE = Path(__file__).parent
LOOK_S = 4.0
_OTHERS = re.compile(r"EVS Port|CFE_PSP|OS_\w+: |\d{4}-\d{3}-|\[driver\]|$")
"""Lines of the console that are not the node's."""
LONGEST_S = 40.0
STEP_S = 0.5
ANY = "std_srvs/Empty"
"""Stands for the type of a service that a node only waits for."""
MANIFEST = """<package format="2"><name>stimulus</name><version>1.0.0</version><description>stimulus</description>
<maintainer email="a@b.c">a</maintainer><license>Apache-2.0</license></package>
"""
BOOT_S = 1.0
"""From the start of the processor to that of the node: the driver is there before."""


class Fault(Exception):
    """The node has died on cfepy. The text gives the cause."""


class NodeFlight:
    """A node on cfepy.

    Args:
        program: its sources.
        library: library of message types.
        environ: environment variables that locate the packages.
        folder: folder for the launch file.
    """

    def __init__(self, program: Program, library: Library, environ: Mapping[str, str], folder: Path) -> None:
        self._program = program
        self._library = library
        self._folder = folder
        package = folder / "stimulus"
        package.mkdir(exist_ok=True)
        (package / "package.xml").write_text(MANIFEST, encoding="utf-8")
        (package / "driver.py").write_bytes((HERE / "driver.py").read_bytes())
        (package / "driver.py").chmod(0o755)
        paths = f"{environ['ROS_PACKAGE_PATH']}{os.pathsep}{folder}"
        self._environ = {"ROS_PACKAGE_PATH": paths}

    def look(self, scene: Scene) -> Seen:
        """Return the node's entries in the graph, once everything that it calls is available."""
        calls: dict[str, str] = {}
        while True:
            known = dict(calls)
            nothing = {"listen": [], "publish": {}, "call": {}, "steps": [], "gap": 1.0, "seconds": LOOK_S}
            nothing["serve"] = {name: [kind, [self._empty(kind)]] for name, kind in calls.items()}
            with self._mission(nothing, scene, calls) as mission:
                mission.run_for(LOOK_S)
                refuse_fault(mission.console.lines)
                node = mission.ros.graph.compiled.get("/node")
                services = {name: entry.service for name, entry in mission.ros.graph.services.items()}
                serves = {name: each.service_class._type for name, each in services.items() if each.__node__ is node}
                published = {name: kind for name, kind in node.published.items() if name != "/rosout"} if node else {}
                seen = Seen(published, dict(node.subscribed) if node else {}, serves, calls)
            for name in serves:
                calls.pop(name, None)  # its own
            if calls == known:
                return seen

    def run(self, script: Mapping[str, Any], scene: Scene, like: Outcome) -> Outcome:
        """Fly it beside the driver.

        Args:
            script: script of the driver.
            scene: the environment that the node needs.
            like: the run of roscpp whose times this run uses as well.
        """
        begun = property(lambda machine: like.begun_ns - round(BOOT_S * 1e9))
        with (
            patch.object(Machine, "epoch_ns", begun),
            self._mission({**script, "base": like.base}, scene, {}) as mission,
        ):
            for _ in range(round(LONGEST_S / STEP_S)):
                mission.run_for(STEP_S)
                if DRIVER in mission.ros.ended:
                    break
            lines = list(mission.console.lines)
        refuse_fault(lines)
        rows = [line.removeprefix("[driver] ") for line in lines if line.startswith("[driver] ")]
        return outcome_of(rows, printed_by_node(lines), self._library, ended(lines))

    def _mission(self, script: Mapping[str, Any], scene: Scene, calls: dict[str, str]) -> Any:
        (self._folder / "script.json").write_text(json.dumps(script), encoding="utf-8")
        params = {name.replace("~", "node/"): value for name, value in scene.params.items()}
        listed = "".join(f'<rosparam param="{name}">{json.dumps(value)}</rosparam>' for name, value in params.items())
        package, kind, args = self._program.package.name, self._program.type, scene.args
        if self._program.nodelet:
            package, kind, args = "nodelet", "nodelet", f"standalone {kind}"
        elif package in provided_packages():
            package = "stimulus"  # cfepy's own program of that name would be taken
            cmake = f"project(stimulus)\nadd_executable({kind} {kind}.cpp)\n"
            (self._folder / "stimulus/CMakeLists.txt").write_text(cmake, encoding="utf-8")
        launch = self._folder / "stimulus.launch"
        launch.write_text(
            f'<launch>{listed}<node pkg="stimulus" type="driver.py" name="driver" output="screen"'
            f' args="{self._folder / "script.json"}"/>'
            f'<node pkg="{package}" type="{kind}" name="node" output="screen" args="{args}"/></launch>\n',
            encoding="utf-8",
        )
        enroll = CompiledNodes._call

        def call(graph: CompiledNodes, node: Any, name: str, declared: Any) -> Any:
            calls[name] = calls.get(name, ANY) if declared._type == "*" else declared._type
            return enroll(graph, node, name, declared)

        whatever = patch.object(cfepy.extra.convert.flight_build, "program_of", return_value=self._program)
        with patch.dict(os.environ, self._environ), whatever:  # CMakeLists.txt does not name all that the survey lists
            spec = read_launch(launch, {}, build_for_flight)
        assert not spec.notes, spec.notes
        lines = (spec.startup or b"").splitlines(keepends=True)
        spec = replace(spec, startup=b"".join(line for line in lines if NODE.encode() not in line))
        mission = Mission(spec, console=Console(quiet=True))
        return _Watched(mission, patch.object(CompiledNodes, "_call", call), spec.built[NODE].entry)

    def _empty(self, kind: str) -> str:
        buffer = BytesIO()
        self._library.message_class(f"{kind}Response")().serialize(buffer)
        return buffer.getvalue().hex()


class _Watched:
    """A mission under observation. A command starts the node."""

    def __init__(self, mission: Mission, watch: Any, entry: str) -> None:
        self._mission = mission
        self._watch = watch
        self._entry = entry

    def __enter__(self) -> Mission:
        self._watch.__enter__()
        mission = self._mission.__enter__()
        mission.run_for(BOOT_S)
        start = START_APP.packet(
            Application=NODE,
            AppEntryPoint=self._entry,
            AppFileName=f"/cf/{NODE}.so",
            StackSize=COMPILED_STACK_BYTES,
            Priority=PRIORITY,
        )
        mission.cfe.sb.transmit_msg(start)
        return mission

    def __exit__(self, *error: Any) -> None:
        self._mission.__exit__(*error)
        self._watch.__exit__(*error)


def refuse_fault(lines: list[str]) -> None:
    """Raise `Fault` when the node has died, or could not be loaded."""
    loading = f"OS_ModuleLoad: /cf/{NODE}.so: "
    for number, line in enumerate(lines):
        if line.startswith(loading):
            raise Fault(line.removeprefix(loading))
        if line.startswith(f"{NODE}: ") and "died of an exception" in line:
            raise Fault(next((each for each in lines[number:] if "Fault: " in each or "Error: " in each), line))


def printed_by_node(lines: list[str]) -> list[str]:
    """Return the node's output: lines of its log, and lines that it wrote directly to the console."""
    kept = [line for line in lines if not _OTHERS.match(line)]
    return [line.removeprefix("[/node] ") for line in kept]


def ended(lines: list[str]) -> bool | None:
    """Return whether the node ended with an error (True) or without (False), or None if it kept running."""
    for line in lines:
        if f"Application {NODE} called CFE_ES_ExitApp" in line:
            return any(f"CFE_ES 14: Exit Application {NODE}" in other for other in lines)
    return None
