"""`cfepy run --watch`: runs the mission again whenever one of its files changes, and shows each result briefly.

Each run is a process of its own, so that nothing of an earlier one remains, and a run can be ended when a file changes
meanwhile. It writes its numbers and a journal without files into a temporary folder. The journal names the files that
the mission opened.
"""

from __future__ import annotations

import argparse
import json
import os
import subprocess
import sys
import tempfile
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from cfepy.cli.main import BAD_USAGE, INTERRUPTED
from cfepy.cli.text_table import show_paragraph
from cfepy.io import WatchedFiles
from cfepy.mission import LAUNCH_FILES, find_script, is_node
from cfepy.status import UsageError

OPTION = "--watch"
LOOK_S = 0.3  # wall time between two looks at the files during a run
_OUTPUTS = ("json", "bag", "record", "trace", "save_files", "profile")
_NOT_TOGETHER = {
    "realtime": "--realtime, because such a run does not end",
    "check_determinism": "--check-determinism",
}


@dataclass(frozen=True, slots=True)
class WatchedRun:
    """A run that has ended.

    Attributes:
        status: its exit status.
        results: its numbers; None if it did not start.
        errors: its lines on standard error.
        files: the files that the mission opened.
    """

    status: int
    results: dict[str, Any] | None
    errors: tuple[str, ...]
    files: tuple[str, ...]

    def text(self, number: int, trace_before: str) -> str:
        """Return the lines about it.

        Args:
            number: its number, from 1.
            trace_before: the digest of the run before; empty for none.
        """
        if self.results is None:
            return "\n".join([f"run {number}: exit status {self.status}", *(f"  {line}" for line in self.errors)])
        problems = self.results["problems"]
        count = f"{len(problems)} problem{'s' if len(problems) != 1 else ''}" if problems else "no problems"
        took = f"{self.results['virtual_s']:g} virtual s in {self.results['wall_s']:.2f} s"
        trace = self.results["trace"] or "none"
        same = ", the same as before" if trace == trace_before else ""
        return "\n".join([f"run {number}: {count}, {took}, trace {trace}{same}", *(f"  {each}" for each in problems)])


def run(arguments: argparse.Namespace) -> int:
    """Run the mission that the command line names again and again, until Ctrl-C.

    Returns:
        The exit status.

    Raises:
        UsageError: an option conflicts with `--watch`.
    """
    for name, option in _NOT_TOGETHER.items():
        if getattr(arguments, name) is not None:
            raise UsageError(f"cannot be combined with {option}", field=OPTION)
    if arguments.json == "-":
        raise UsageError("cannot be combined with --json -, give a file", field=OPTION)
    is_alone = is_node(arguments.mission)
    script = Path(arguments.mission) if is_alone else find_script(arguments.mission)
    own_folder = None if is_alone or script.suffix in LAUNCH_FILES else script.parent
    words = [word for word in arguments.given if word != OPTION]
    outputs = [path for name in _OUTPUTS if isinstance(path := getattr(arguments, name, None), str) and path != "-"]
    with tempfile.TemporaryDirectory(prefix="cfepy-watch-") as folder:
        process = RunProcess(words, Path(folder), arguments.json, arguments.record)
        watching = WatchedFiles(own_folder, [str(script)], outputs)
        try:
            _go_on(process, watching)
        except KeyboardInterrupt:
            return INTERRUPTED
        finally:
            process.end()
    return BAD_USAGE


def _go_on(process: RunProcess, watching: WatchedFiles) -> None:
    """Run again and again."""
    number, trace = 0, ""
    while True:
        number += 1
        done = process.run(lambda: bool(watching.changed()))
        if done is not None:
            _show(done.text(number, trace))
            trace = "" if done.results is None else done.results["trace"]
            watching.add(done.files)
            _show(f"watching {len(watching.stamps)} files; Ctrl-C ends")
        changed = watching.wait()
        _show(f"changed: {', '.join(_short(path) for path in changed)}")


def _show(text: str) -> None:
    for line in text.splitlines():
        show_paragraph(line, sys.stdout)
    sys.stdout.flush()


def _short(path: str) -> str:
    short = os.path.relpath(path)
    return path if short.startswith("..") else short


class RunProcess:
    """The process of a run.

    Args:
        words: the command line without `--watch`.
        folder: for its files.
        json_file: the user's file for its numbers, or None.
        record: the user's journal, or None.
    """

    def __init__(self, words: Sequence[str], folder: Path, json_file: str | None, record: str | None) -> None:
        self._folder = folder
        self._json = Path(json_file) if json_file is not None else folder / "run.json"
        self._journal = Path(record) if record is not None else folder / "run.cfepy"
        command, *rest = words
        more = [] if "--quiet" in rest else ["--quiet"]
        more += [] if json_file is not None else ["--json", str(self._json)]
        if record is None and os.name == "posix":  # a journal names files as POSIX does
            more += ["--record", str(self._journal), "--record-no-files"]
        self._words = [sys.executable, "-m", "cfepy", command, *more, *rest]
        self._process: subprocess.Popen[bytes] | None = None

    def run(self, is_stale: Callable[[], bool]) -> WatchedRun | None:
        """Run the mission; return None if it was ended because its files changed meanwhile.

        Args:
            is_stale: returns whether files have changed.
        """
        self._json.unlink(missing_ok=True)
        self._journal.unlink(missing_ok=True)
        errors = self._folder / "errors.txt"
        with open(errors, "wb") as said:
            self._process = subprocess.Popen(self._words, stdout=subprocess.DEVNULL, stderr=said)
            while True:
                try:
                    status = self._process.wait(LOOK_S)
                    break
                except subprocess.TimeoutExpired:
                    if is_stale():
                        self.end()
                        return None
        lines = errors.read_text(encoding="utf-8", errors="replace").splitlines()
        return WatchedRun(status, self._results(), tuple(lines), tuple(self._opened()))

    def end(self) -> None:
        """End the process, if it runs."""
        process = self._process
        if process is not None and process.poll() is None:
            process.terminate()
            process.wait()

    def _results(self) -> dict[str, Any] | None:
        try:
            found: dict[str, Any] = json.loads(self._json.read_text(encoding="utf-8"))
        except (OSError, ValueError):
            return None
        return found

    def _opened(self) -> list[str]:
        """Return the files in the journal; none if the run did not start."""
        from cfepy.journal import read_journal

        try:
            return [*read_journal(self._journal).files]
        except (OSError, UsageError):
            return []
