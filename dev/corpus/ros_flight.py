"""Fly one scenario on a real ROS 1 of this computer: the same node, the same observer, and its own master.

It needs Debian's python3-rospy and python3-rosmaster. Other modules that the nodes need are searched in the folders of
CFEPY_ROS_PYTHONPATH, and libraries in the folders of LD_LIBRARY_PATH.
"""

from __future__ import annotations

import json
import os
import pty
import signal
import subprocess
import threading
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any
from xmlrpc.client import ServerProxy

from dev.corpus.flight import LONGEST_S, SHUTDOWN_S, STAND_INS
from dev.corpus.scenarios import Program, Scenario
from dev.corpus.sources import Sources
from dev.corpus.verdict import Outcome
from dev.host_ports import free_port

PYTHON, MASTER = "/usr/bin/python3", "/usr/bin/rosmaster"
PATH = "CFEPY_ROS_PYTHONPATH"
HERE = Path(__file__).parent
OF_HOST = "the rosdep view is empty"  # printed by a computer without rosdep's files


class RosFlight:
    """One scenario's run on ROS.

    Args:
        scenario: the scenario to fly.
        sources: locates the nodes.
        folder: an empty folder.
    """

    def __init__(self, scenario: Scenario, sources: Sources, folder: Path) -> None:
        self._scenario = scenario
        self._sources = sources
        self._folder = folder
        self._port = free_port()
        self._processes: list[subprocess.Popen[bytes]] = []

    def run(self) -> Outcome:
        """Run it to its end."""
        begun = time.perf_counter()
        try:
            self._start("master", [MASTER, "--core", "-p", str(self._port)])
            self._set_params()
            observer = self._start_observer()
            for number, helper in enumerate(self._scenario.helpers):
                self._start_program(f"helper{number}", helper, "/")
            node = self._start_program("node", self._scenario.node, self._scenario.namespace)
            _until((self._folder / "done").exists, LONGEST_S)
            if self._scenario.ends_itself:
                _until(lambda: node.poll() is not None, LONGEST_S)
            ended_itself = node.poll() is not None
            if not ended_itself:
                node.send_signal(signal.SIGINT)
                _until(lambda: node.poll() is not None, SHUTDOWN_S)
            status = node.poll()
            (self._folder / "end").touch()
            _until(lambda: observer.poll() is not None, SHUTDOWN_S)
        finally:
            self._end_all()
        return self._outcome(status, ended_itself, time.perf_counter() - begun)

    def _set_params(self) -> None:
        master = ServerProxy(f"http://localhost:{self._port}")
        assert _until(lambda: _answers(master), LONGEST_S), "the master does not answer"
        for name, value in self._scenario.params.items():
            master.setParam("/corpus", "/" + name.strip("/"), value)

    def _start_observer(self) -> subprocess.Popen[bytes]:
        scenario = self._scenario
        told = {"observe": scenario.observe, "stimulus": scenario.stimulus, "seconds": scenario.seconds}
        (self._folder / "scenario.json").write_text(json.dumps(told), encoding="utf-8")
        return self._start("observer", [PYTHON, str(HERE / "observer.py"), str(self._folder)])

    def _start_program(self, name: str, program: Program, namespace: str) -> subprocess.Popen[bytes]:
        package, script = self._sources.script(program)
        words = [word.replace("@TMP", str(self._folder)) for word in program.argv]
        command = [PYTHON, "-u", str(package / script), *words, *([f"__ns:={namespace}"] if namespace != "/" else [])]
        keys = self._scenario.keys if name == "node" else None
        return self._start(name, command, (package / script).parent, keys)

    def _start(
        self, name: str, command: list[str], cwd: Path | None = None, keys: tuple[str | float, ...] | None = None
    ) -> subprocess.Popen[bytes]:
        leader, follower = (None, subprocess.DEVNULL) if keys is None else pty.openpty()
        with open(self._folder / f"{name}.out", "wb") as out:
            process = subprocess.Popen(
                command,
                cwd=cwd or self._folder,
                env=self._environment(),
                stdin=follower,
                stdout=out,
                stderr=subprocess.STDOUT,
                start_new_session=True,
            )
        self._processes.append(process)
        if leader is not None and keys is not None:
            threading.Thread(target=_type, args=(leader, keys), daemon=True).start()
        return process

    def _environment(self) -> dict[str, str]:
        roots = [self._sources.folder(repo) for repo in self._scenario.repos]
        own = [str(folder) for root in roots for folder in root.rglob("src") if list(folder.glob("*/__init__.py"))]
        paths = [os.environ.get(PATH, ""), *own, str(STAND_INS)]
        return {
            "HOME": str(self._folder),
            "LD_LIBRARY_PATH": os.environ.get("LD_LIBRARY_PATH", ""),
            "PATH": "/usr/bin:/bin",
            "PYTHONPATH": os.pathsep.join(path for path in paths if path),
            "ROS_MASTER_URI": f"http://localhost:{self._port}",
            "ROS_PACKAGE_PATH": os.pathsep.join(map(str, roots)),
            "TERM": "xterm",
        }

    def _end_all(self) -> None:
        for process in reversed(self._processes):
            if process.poll() is None:
                process.kill()
            process.wait()

    def _outcome(self, status: int | None, ended_itself: bool, wall_s: float) -> Outcome:
        result = self._folder / "result.json"
        failure = {"stimulus failed": (self._folder / "observer.out").read_text(errors="replace", encoding="utf-8")}
        nothing: dict[str, Any] = {"N": {}, "T": {}, "R": failure, "rate": {}}
        seen = json.loads(result.read_text(encoding="utf-8")) if result.is_file() else nothing
        return Outcome(
            counts=seen["N"],
            messages=seen["T"],
            remarks=seen["R"],
            rates=seen["rate"],
            status=status,
            ended_itself=ended_itself,
            out=_without(OF_HOST, (self._folder / "node.out").read_text(errors="replace", encoding="utf-8")),
            wall_s=wall_s,
        )


def _without(start: str, text: str) -> str:
    return "".join(line for line in text.splitlines(keepends=True) if not line.startswith(start))


def _answers(master: ServerProxy) -> bool:
    try:
        return bool(master.getPid("/corpus"))
    except OSError:
        return False


def _until(over: Callable[[], bool], seconds: float) -> bool:
    end = time.monotonic() + seconds
    while not over() and time.monotonic() < end:
        time.sleep(0.05)
    return over()


def _type(leader: int, keys: tuple[str | float, ...]) -> None:
    for key in keys:
        time.sleep(0.1)
        if isinstance(key, str):
            os.write(leader, key.encode())
        else:
            time.sleep(key)
