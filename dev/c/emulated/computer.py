"""The emulated computer: a virtual environment with an aarch64 interpreter, started by qemu-aarch64."""

from __future__ import annotations

import os
import shutil
import subprocess
from pathlib import Path

VARIABLE = "CFEPY_AARCH64_ROOT"
QEMU = "qemu-aarch64"
COMPILERS = {"CC": "aarch64-linux-gnu-gcc", "CXX": "aarch64-linux-gnu-g++"}
PACKAGES = "packages"
"""The folder of the root with the packages that cfepy needs."""
WRAPPER = """#!/bin/sh
exec {qemu} -L {root} -0 "$0" {python} "$@"
"""
"""Other processes of Python are started through this, too, since it is what `sys.executable` says."""


def lacking() -> str | None:
    """Return which parts of the emulation are missing, in words, or None if it is complete."""
    for program in (QEMU, *COMPILERS.values()):
        if shutil.which(program) is None:
            return f"{program} is not installed"
    root = os.environ.get(VARIABLE)
    return None if root and Path(root, PACKAGES).is_dir() else f"{VARIABLE} does not name a root of aarch64"


class Computer:
    """An emulated computer.

    Args:
        root: its root folder, as `dev.c.emulated.root` makes it.
        folder: folder for its virtual environment and its build results.
    """

    def __init__(self, root: Path, folder: Path) -> None:
        self._folder = folder
        found = sorted((root / "usr" / "bin").glob("python3.*[0-9]"))
        if not found:
            raise FileNotFoundError(f"{root}/usr/bin has no python3")
        interpreter = found[-1]
        self.python = folder / "bin" / "python"
        site = folder / "lib" / interpreter.name / "site-packages"
        site.mkdir(parents=True)
        self.python.parent.mkdir()
        self.python.write_text(WRAPPER.format(qemu=shutil.which(QEMU), root=root, python=interpreter), encoding="utf-8")
        self.python.chmod(0o755)
        (folder / "pyvenv.cfg").write_text(f"home = {interpreter.parent}\n", encoding="utf-8")
        (site / "packages.pth").write_text(f"{root / PACKAGES}\n", encoding="utf-8")
        self._compilers = {name: f"{command} -idirafter {root}/usr/include" for name, command in COMPILERS.items()}

    def run(self, *arguments: str, cwd: Path) -> subprocess.CompletedProcess[str]:
        """Run its Python. The output is in `stdout`."""
        environment = {
            **os.environ,
            **self._compilers,
            "CFEPY_CACHE": str(self._folder / "engine"),
            "PYTHONPYCACHEPREFIX": str(self._folder / "bytecode"),
            "PYTHONPATH": str(cwd),
        }
        command = [str(self.python), *arguments]
        return subprocess.run(
            command, cwd=cwd, env=environment, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False
        )
