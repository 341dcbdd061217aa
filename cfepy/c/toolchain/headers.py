"""The headers that compiled applications include: cFE's, OSAL's and the PSP's public interface, under NASA's names.

What they declare is in `cfepy/c/headers`, a file for each part. The compiler is given a folder in the user's cache
that has them under `cfepy/`, and for each name of NASA's a file that leads there (`headers/names.txt`).
"""

from __future__ import annotations

import hashlib
import os
import tempfile
from pathlib import Path

from cfepy.c.engine import cache_folder

DECLARATIONS = Path(__file__).parents[1] / "headers"
NAMES = DECLARATIONS / "names.txt"
INNER = "cfepy"
"""The folder of the declarations, seen from the names."""


def headers_folder() -> Path:
    """The folder for the compiler's -I, made before if need be.

    Raises:
        OSError: it cannot be written.
    """
    files = _files()
    digest = hashlib.sha256(repr(sorted(files.items())).encode()).hexdigest()[:16]
    folder = cache_folder() / f"headers-{digest}"
    if not folder.is_dir():
        folder.parent.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryDirectory(dir=folder.parent) as made:
            _write(files, Path(made) / "all")
            try:
                os.rename(Path(made) / "all", folder)
            except OSError:
                if not folder.is_dir():  # otherwise another process was quicker
                    raise
    return folder


def names() -> dict[str, list[str]]:
    """Which of our headers a name of NASA's stands for; all without `.h`."""
    found: dict[str, list[str]] = {}
    ours: list[str] = []
    for line in NAMES.read_text(encoding="utf-8").splitlines():
        if line.endswith(":"):
            ours = line[:-1].split()
        elif not line.startswith("#"):
            found.update((name, ours) for name in line.split())
    return found


def _files() -> dict[str, str]:
    """What the folder holds: path to text."""
    files = {f"{INNER}/{each.name}": each.read_text(encoding="utf-8") for each in DECLARATIONS.glob("*.h")}
    for name, ours in names().items():
        files[f"{name}.h"] = "".join(f'#include "{INNER}/{each}.h"\n' for each in ours)
    return files


def _write(files: dict[str, str], folder: Path) -> None:
    (folder / INNER).mkdir(parents=True)
    for name, text in files.items():
        (folder / name).write_text(text, encoding="utf-8")
