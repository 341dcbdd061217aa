"""Writing what was generated: the same bytes each time, and never over a file that its user has changed since.

A list of what was written, with the hash of each file, lies beside them.
"""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping
from pathlib import Path

from cfepy.status import UsageError

MANIFEST = ".cfepy-convert.json"
SHOWN = 6


def write_files(folder: Path, files: Mapping[str, bytes], force: bool = False) -> list[str]:
    """Write files to a folder, and take away those of the last time that are no longer made.

    Args:
        folder: made if need be.
        files: contents by path in the folder.
        force: write over files that were changed by hand, too.

    Returns:
        Paths of the files that are other than before, sorted.

    Raises:
        UsageError: the user has changed a file, or it is not one of ours; nothing has been written.
        OSError: the folder cannot be written.
    """
    known = _known(folder)
    changed = [
        name for name in sorted({*files, *known}) if _is_changed(folder / name, known.get(name), files.get(name))
    ]
    if changed and not force:
        more = f" and {len(changed) - SHOWN} more" if len(changed) > SHOWN else ""
        text = f"{', '.join(changed[:SHOWN])}{more} changed by hand since; move it away, or say --force"
        raise UsageError(text, file=folder)
    for name in known:
        if name not in files:
            (folder / name).unlink(missing_ok=True)
    written = [name for name in sorted(files) if _write(folder / name, files[name])]
    hashes = {name: _hash(files[name]) for name in sorted(files)}
    _write(folder / MANIFEST, (json.dumps(hashes, indent=1) + "\n").encode())
    return written


def _known(folder: Path) -> dict[str, str]:
    """What was written the last time: hashes by path."""
    try:
        found = json.loads((folder / MANIFEST).read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return {}
    inside = isinstance(found, dict) and all(".." not in Path(name).parts and name[:1] != "/" for name in found)
    return {str(name): str(value) for name, value in found.items()} if inside else {}


def _is_changed(file: Path, known: str | None, content: bytes | None) -> bool:
    """Whether a file has something else than what was written to it, and than what would be."""
    if not file.is_file():
        return False
    present = file.read_bytes()
    return present != content and _hash(present) != known


def _write(file: Path, content: bytes) -> bool:
    if file.is_file() and file.read_bytes() == content:
        return False
    file.parent.mkdir(parents=True, exist_ok=True)
    file.write_bytes(content)
    return True


def _hash(content: bytes) -> str:
    return hashlib.sha256(content).hexdigest()
