"""Executes all commands of a page in order, in an empty folder and in a separate network.

`python -m tests.docs.reader PAGE` (within `tests.own_network`, in the folder) ends with 1 and reports the difference if
a command does not do what its scene and its page describe.
"""

from __future__ import annotations

import os
import re
import resource
import signal
import subprocess
import sys
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path

from cfepy.extra.c.build_cache import cache_folder
from cfepy.reading.resources import import_path
from tests.docs.pages import ROOT
from tests.docs.scene import Scene, scene_of

PATIENCE_S = 120.0
"""For one command, which takes some seconds; longer is for ever."""
KEPT = ("export ", "cd ", ". ", "source ")
"""Commands that change the shell of those after them."""
TRACEBACK = re.compile(r"^Traceback \(most recent call last\)", re.MULTILINE)
"""Of cfepy itself; those of a mission's code that it tells are indented."""
SPEED = re.compile(r"virtual s in \S+ s: \S+ x real time, board (\w+), \w+ tasks")
"""In the last line of a run; tasks are greenlets where they are installed."""
NO_EXTRA = "does not provide the extra"
PROGRAMS = {
    **{"cfepy": "-m cfepy", "pytest": "-m pytest -p no:cacheprovider -p no:randomly", "dask": "-m dask"},
    **{"pip": "-m pip", "python": "", "python3": ""},
}


@dataclass
class Given:
    """A command that was given: a process in a group of its own, which is ended when it takes too long."""

    process: subprocess.Popen[str]
    patience_s: float
    output: str = ""
    took_too_long: bool = False
    _drain: threading.Thread | None = None

    def interrupt(self) -> None:
        """Ctrl-C."""
        os.killpg(self.process.pid, signal.SIGINT)

    def read(self, until: str = "") -> None:
        """Read its output to the end, or up to a line that matches a pattern."""
        with self._limited():
            self._read(until)

    def go_on(self) -> None:
        """Read its output in the background from now on, so that it never blocks."""
        self._drain = threading.Thread(target=self._read)
        self._drain.start()

    def status(self) -> int:
        """Wait for its end and read the remaining output. Returns its exit status, as in a shell."""
        with self._limited():
            if self._drain:
                self._drain.join()
            self._read()
            status = self.process.wait()
        return status if status >= 0 else 128 - status

    def _read(self, until: str = "") -> None:
        assert self.process.stdout is not None
        for line in self.process.stdout:
            self.output += line
            if until and re.search(until, line):
                return

    @contextmanager
    def _limited(self) -> Iterator[None]:
        timer = threading.Timer(self.patience_s, self._stop)
        timer.start()
        try:
            yield
        finally:
            timer.cancel()

    def _stop(self) -> None:
        self.took_too_long = True
        os.killpg(self.process.pid, signal.SIGKILL)


@dataclass
class Reader:
    """Reads a page and executes its commands."""

    scene: Scene
    patience_s: float = PATIENCE_S
    kept: list[str] = field(default_factory=list)
    background: dict[str, Given] = field(default_factory=dict)

    def problems(self) -> Iterator[str]:
        """Execute the commands, up to one that takes too long. Yields the differences from the page."""
        for command in self.scene.commands:
            step = self.scene.step(command)
            for other in step.ends:
                yield from self._end(other)
            if step.is_left_out:
                print("left out, not all installed:", *step.needs, flush=True)
            elif command.startswith(KEPT) and "&&" not in command:
                self.kept.append(self.scene.line(command))
            else:
                yield from self._give(command)
        for command in list(self.background):
            yield from self._end(command)

    def _give(self, command: str) -> Iterator[str]:
        step = self.scene.step(command)
        given = self._start(command)
        if not step.ready:
            self._type(given.process, step.typed)
        waited_for = step.ready or step.until
        given.read(waited_for)
        if waited_for and not re.search(waited_for, given.output):
            yield f"{command}\nnever said {waited_for!r}"
        elif step.ready:
            self.background[command] = given
            given.go_on()
            return
        elif step.until:
            given.interrupt()
        yield from self._judged(command, given)

    def _start(self, command: str) -> Given:
        line = self.scene.line(command)
        print("$", line, flush=True)
        process = subprocess.Popen(
            ["bash", "-c", "\n".join([*self.kept, line])],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            start_new_session=True,
        )
        return Given(process, self.patience_s)

    @staticmethod
    def _type(process: subprocess.Popen[str], text: str) -> None:
        assert process.stdin is not None
        try:
            process.stdin.write(text)
            process.stdin.close()
        except BrokenPipeError:  # it has ended, and its status shows whether that was right
            pass

    def _end(self, command: str) -> Iterator[str]:
        given = self.background.pop(command)
        given.interrupt()
        yield from self._judged(command, given)

    def _judged(self, command: str, given: Given) -> Iterator[str]:
        step = self.scene.step(command)
        before = cpu_s()
        status = given.status()
        print(f"  {cpu_s() - before:.1f} s of CPU", flush=True)
        wrong = []
        if given.took_too_long:
            wrong.append(f"took longer than {self.patience_s:.0f} s and was ended")
        elif status != step.ends_with:
            wrong.append(f"ended with status {status}, not {step.ends_with}")
        if "cfepy" in command and TRACEBACK.search(given.output):
            wrong.append("has a traceback")
        if NO_EXTRA in given.output:
            wrong.append("asks for an extra that cfepy does not have")
        if step.says not in given.output:
            wrong.append(f"never said {step.says!r}")
        if missing := first_missing(self.scene.shown(command), given.output):
            wrong.append(f"did not print what the page shows: {missing!r}")
        if wrong:
            yield "\n".join([command, *wrong, given.output])


def cpu_s() -> float:
    """Return the processor time of all commands that have ended."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def first_missing(shown: str, output: str) -> str:
    """Return the first line of a page's output that is missing from the real output, in order, or "" if none is.

    Between its lines, and where the page has "...", the output may have more. Lines may be broken differently. Speed
    and host are left out.
    """
    rest = _flat(output)
    for line in shown.splitlines():
        for part in filter(None, map(str.strip, re.split(r"(?:^| )\.\.\.(?= |$)", _flat(line)))):
            _, found, rest = rest.partition(part)
            if not found:
                return part
    return ""


def _flat(text: str) -> str:
    return SPEED.sub(r"virtual s, board \1", " ".join(text.split()))


def with_programs(folder: Path) -> None:
    """Put cfepy, Python, pip, pytest and dask of here first on the PATH, as an environment with cfepy does."""
    folder.mkdir()
    for name, words in PROGRAMS.items():
        start = f'PYTHONPATH="{import_path()}" exec "{sys.executable}" {words} "$@"'
        (folder / name).write_text(f"#!/bin/sh\n{start}\n", encoding="utf-8")
        (folder / name).chmod(0o755)
    os.environ["PATH"] = f"{folder}:{os.environ['PATH']}"


def read(page: Path) -> list[str]:
    """Read a page in a new folder below the working one. Returns the differences from the page."""
    home = Path.cwd() / "reader"
    home.mkdir()
    with_programs(Path.cwd() / "bin")
    scene = scene_of(page)
    scene.set_up(home)
    os.chdir(home)
    os.environ["CFEPY_CACHE"] = str(cache_folder())  # compiled code is also available for the other pages
    os.environ |= {"HOME": str(home.parent), "PYTHONUNBUFFERED": "1", "ROSCONSOLE_STDOUT_LINE_BUFFERED": "1"}
    os.environ |= {"PIP_DISABLE_PIP_VERSION_CHECK": "1", "PIP_DRY_RUN": "1", "PIP_NO_INDEX": "1"}
    for name in ("PYTHONPATH", "ROS_PACKAGE_PATH"):  # ROS's own packages are not tested here
        os.environ.pop(name, None)
    return list(Reader(scene).problems())


if __name__ == "__main__":
    signal.signal(signal.SIGINT, signal.default_int_handler)  # a shell ignores it in background commands
    found = read(ROOT / sys.argv[1])
    print(*found, sep="\n\n")
    sys.exit(1 if found else 0)
