"""gdb on compiled applications: it is started on this process, with the symbols of the loaded objects.

Compiled code is at the same addresses in each run, but no loader of the host knows about it. A script for gdb gives the
address of each file, and stops at the main function of the application. While gdb has the process, its wall time does
not count.
"""

from __future__ import annotations

import contextlib
import ctypes
import os
import shutil
import subprocess
import tempfile
from pathlib import Path

from cfepy.interpreter.host_system import signal_number
from cfepy.mission import Mission
from cfepy.status import UsageError

WATCH_SIGNAL = signal_number("SIGRTMIN") + 6
"""Signal by which the engine watches code that computes without a call."""
PR_SET_PTRACER = 0x59616D61
ANYBODY = -1
LOOK_S = 0.05
SETTLE_S = 0.3
"""Wall time to wait after gdb has a thread. In this time it stops all threads until its user continues."""


def gdb_script(mission: Mission, folder: Path, function: str) -> str:
    """Return commands that give gdb the loaded objects, and the place of the first stop.

    Args:
        mission: the flying mission.
        folder: receives copies of the objects, because the mission's objects may be only in its journal.
        function: function of the first stop; empty for none.
    """
    runtime = mission.processor.compiled
    lines = [
        "set pagination off",
        "set width 0",
        "set confirm off",
        f"handle SIG{WATCH_SIGNAL} nostop noprint pass",
    ]
    for number, image in enumerate(runtime.images() if runtime is not None else ()):
        file = folder / f"{number}-{image.source.name}"
        file.write_bytes(image.source.data)
        lines.append(f"add-symbol-file {file} -o 0x{image.base:x}")
    if function:
        lines += [f"tbreak {function}", "continue"]
    else:
        lines.append(r"echo \nThe run waits: set breakpoints, then continue\n")
    return "\n".join(lines) + "\n"


class GdbSession:
    """gdb, started once for a run.

    Args:
        app: the application, at whose main function gdb stops.
    """

    def __init__(self, app: str) -> None:
        self._app = app
        self._process: subprocess.Popen[bytes] | None = None
        self._folder = contextlib.ExitStack()

    def begin(self, mission: Mission, is_running: bool) -> None:
        """Start gdb on this process, and wait until its user lets the process go on.

        Args:
            mission: the flying mission.
            is_running: whether the application is past the beginning of its main function.

        Raises:
            UsageError: there is no gdb, or it may not trace this process.
        """
        if self._process is not None:
            return
        gdb = shutil.which("gdb")
        if gdb is None:
            raise UsageError("requires gdb, which is not installed", field="--gdb")
        mission.stall_watch.limit_s = 0
        folder = Path(self._folder.enter_context(tempfile.TemporaryDirectory(prefix="cfepy-gdb-")))
        script = folder / "commands"
        entry = next((each.symbol for each in mission.spec.entries if each.name == self._app), "")
        script.write_text(gdb_script(mission, folder, "" if is_running else entry), encoding="utf-8")
        ctypes.CDLL(None).prctl(PR_SET_PTRACER, ANYBODY)  # a child may trace its parent
        self._process = subprocess.Popen(
            [gdb, "-q", "-nx", "-iex", "set auto-load no", "-p", str(os.getpid()), "-x", str(script)]
        )
        while not _is_traced():
            if self._waited(LOOK_S) is not None:
                raise UsageError(
                    "gdb ended without tracing this process; check that tracing is "
                    "permitted (kernel.yama.ptrace_scope)",
                    field="--gdb",
                )
        self._waited(SETTLE_S)

    def _waited(self, seconds: float) -> int | None:
        """Wait for the end of gdb. Returns its exit status, or None if it still runs."""
        assert self._process is not None
        try:
            return self._process.wait(seconds)
        except subprocess.TimeoutExpired:
            return None

    def close(self) -> None:
        """Remove the files of the session. gdb sees that the process ends, and its user leaves it."""
        self._folder.close()


def _is_traced() -> bool:
    """Return True if a debugger traces this thread."""
    status = Path("/proc/thread-self/status").read_text(encoding="utf-8")
    return next(int(line.split()[1]) for line in status.splitlines() if line.startswith("TracerPid:")) != 0
