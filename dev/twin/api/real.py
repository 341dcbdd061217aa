"""Play a script on NASA's own cFE, built with the application in `app/`, in its own namespaces.

The folder that CFEPY_REAL_API names has the executable core-cpu1 and its cf. To build it: copy app/ into the mission's
apps as api_app, put it into the APPLIST of sample_defs/targets.cmake, take `STARTUP` of `dev.twin.api.twin` as the
startup script, and set CFE_PLATFORM_EVS_MAX_APP_EVENT_BURST to 2000000. That prevents squelching of events, which
depends on the host's speed. Both sides write `answers.txt` with the same rules.
"""

from __future__ import annotations

import shutil
import subprocess
import tempfile
from pathlib import Path

from dev.twin import real

VARIABLE = "CFEPY_REAL_API"
LIMIT_S = 300


def installed() -> Path | None:
    """Return the folder of the executable from CFEPY_REAL_API, or None if there is none."""
    return real.installed(VARIABLE)


def play(built: Path, script: list[str]) -> list[str]:
    """Return the answers of the real cFE to a script.

    Raises:
        subprocess.TimeoutExpired: it did not end.
        FileNotFoundError: the application did not start.
    """
    with tempfile.TemporaryDirectory() as folder:
        here = Path(folder) / "run"
        shutil.copytree(built, here)
        (here / "script.txt").write_text("\n".join(script) + "\n", encoding="utf-8")
        inside = f"{real.FURNISH}exec ./{real.EXECUTABLE} > console.txt 2>&1"
        command = ["taskset", "-c", str(real.one_cpu()), *real.NAMESPACES, "bash", "-c", inside]
        subprocess.run(command, cwd=here, stdin=subprocess.DEVNULL, timeout=LIMIT_S, check=False)
        lines = (here / "answers.txt").read_text(errors="surrogateescape", encoding="utf-8").splitlines()
        return lines[lines.index("begin") + 1 :]
