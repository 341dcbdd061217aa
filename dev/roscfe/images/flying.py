"""Fly nodes on a bare Cortex-M7 that QEMU emulates: one image with a stand-in for cFE and OSAL."""

from __future__ import annotations

import shutil
import subprocess
from pathlib import Path

EMULATOR = "qemu-system-arm"
BOARD = ("-M", "mps2-an500", "-nographic", "-monitor", "none", "-serial", "none")
PATIENCE = 300  # s


def lacking_emulator() -> str | None:
    """Return the emulator's command if it is not installed."""
    return EMULATOR if shutil.which(EMULATOR) is None else None


def flown(image: Path) -> list[str]:
    """Return the console's lines of an image that ends by itself."""
    host = ("-semihosting-config", "enable=on,target=native")
    command = [EMULATOR, *BOARD, *host, "-kernel", str(image)]
    done = subprocess.run(command, capture_output=True, text=True, check=False, timeout=PATIENCE)
    if done.returncode:
        raise RuntimeError(f"the image ended with {done.returncode}: {(done.stdout + done.stderr)[-2000:]}")
    return (done.stdout + done.stderr).splitlines()
