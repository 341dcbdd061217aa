"""Compiling a test's C++ against the headers of roscfe."""

from __future__ import annotations

import subprocess
from collections.abc import Iterable, Sequence
from pathlib import Path

from dev.roscfe.building import CPP

ROSCFE = Path(__file__).parents[2] / "roscfe"
HEADERS = ROSCFE / "include"
THREADS = ROSCFE / "threads"
BOOST = ROSCFE / "boost"
STRICT = ["-fno-exceptions", "-fno-rtti", "-Wall", "-Wextra", "-Werror"]
"""How the library itself is compiled."""


def compiled(
    folder: Path,
    sources: Iterable[Path],
    *options: str,
    name: str = "program",
    headers: Sequence[Path] = (HEADERS, BOOST),
) -> Path:
    """Return a program made from sources, in C++17.

    Args:
        folder: folder of the result.
        sources: files.
        options: options of the compiler.
        name: name of the program.
        headers: folders of headers.
    """
    program = folder / name
    includes = [f"-I{path}" for path in (*headers, THREADS)]
    command = [*CPP, "-std=c++17", *includes, *options, "-o", str(program), *map(str, sources)]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    return program
