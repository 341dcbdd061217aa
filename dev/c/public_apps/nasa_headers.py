"""A C or C++ compiler that takes NASA's headers where `cfepy build` gives cfepy's.

`environment` gives `cfepy build` scripts as CC and CXX, which call `run`. An application is built twice from the same
sources, definitions and options: once with cfepy's headers, and once with the headers of the NASA build.
"""

from __future__ import annotations

import os
import re
import shlex
import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path

ROOT, MODULE = Path(__file__).parents[3], "dev.c.public_apps.nasa_headers"
FLAGS = "build/native/default_cpu1/apps/sample_app/CMakeFiles/sample_app.dir/flags.make"
"""The flags of NASA's sample application: its headers."""
SAMPLE = re.compile(r"/sample_(?:app|lib)/")
OURS = re.compile(r"-I.*/headers-[0-9a-f]{16}$")
"""The option for the folder of cfepy's headers."""
_VARIABLE, _LIBRARIES = "CFEPY_NASA_FLAGS", "CFEPY_NASA_LIBRARIES"
_MATHEMATICS = "m"
"""The library that cfepy has for every application. NASA's executable for Linux has none."""


def flags_file(built: Path) -> Path:
    """Return the file with the flags of NASA's sample application, above the folder of the executable.

    Raises:
        FileNotFoundError: there is no build around the executable.
    """
    for each in built.absolute().parents:
        if (each / FLAGS).is_file():
            return each / FLAGS
    raise FileNotFoundError(f"{built}: no {FLAGS} in a folder above it; keep the build of NASA's cFE")


def environment(built: Path, scratch: Path, libraries: Sequence[str] = ()) -> dict[str, str]:
    """Return the variables for `cfepy build`.

    Args:
        built: the folder of NASA's executable, inside of the folder of its build.
        scratch: a folder for the scripts that stand for the compilers.
        libraries: libraries of this computer that the applications need, such as "socketcan".
    """
    found = {_VARIABLE: str(flags_file(built)), _LIBRARIES: " ".join(libraries)}
    for name, compiler in (("CC", "cc"), ("CXX", "c++")):
        script = scratch / f"nasas_{compiler}"
        code = f"import sys; sys.path.insert(0, {str(ROOT)!r}); from {MODULE} import run; run()"
        script.write_text(f'#!/bin/sh\nexec {sys.executable} -c "{code}" {compiler} "$@"\n', encoding="utf-8")
        script.chmod(0o755)
        found[name] = str(script)
    return found


def headers(text: str) -> list[str]:
    """Return the options for NASA's headers from the text of flags.make."""
    found = dict(re.findall(r"^(C_\w+) = (.*)$", text, re.MULTILINE))
    folders = [each for each in shlex.split(found["C_INCLUDES"]) if not SAMPLE.search(f"{each}/")]
    core = next(each for each in folders if each.endswith("/core_api/fsw/inc"))
    modules = Path(core.removeprefix("-I")).parents[2]
    return [*folders, *(f"-I{each}" for each in sorted(modules.glob("*/fsw/inc")) if f"-I{each}" not in folders)]


def compiled(source: Path, made: Path, built: Path, *more: str) -> bytes:
    """Return the shared object of a source, compiled with NASA's headers.

    Args:
        source: the source.
        made: the shared object to write.
        built: the folder of NASA's executable, inside of the folder of its build.
        more: further flags.
    """
    nasas = headers(flags_file(built).read_text(encoding="utf-8"))
    flags = ["-std=gnu99", "-w", "-fPIC", "-shared", "-D_LINUX_OS_", "-D_POSIX_OS_"]
    subprocess.run(["cc", *flags, *nasas, *more, "-o", str(made), str(source)], check=True)
    return made.read_bytes()


def with_nasas(command: Sequence[str], nasas: Sequence[str], libraries: Sequence[str]) -> list[str]:
    """Return the command of a compiler with NASA's headers in place of cfepy's, before the mission's headers.

    Args:
        command: the command.
        nasas: the options for NASA's headers.
        libraries: libraries to link.
    """
    found = [each for each in command if not OURS.match(each)]
    if "-shared" in found:
        return [*found, "-Wl,--as-needed", *(f"-l{each}" for each in libraries)]
    if len(found) < len(command):
        first = next((at for at, each in enumerate(found) if each.startswith("-I")), len(found))
        found[first:first] = nasas
    return found


def run() -> None:
    """Become the compiler that the first argument names."""
    nasas = headers(Path(os.environ[_VARIABLE]).read_text(encoding="utf-8"))
    command = with_nasas(sys.argv[1:], nasas, [_MATHEMATICS, *os.environ[_LIBRARIES].split()])
    os.execvp(command[0], command)
