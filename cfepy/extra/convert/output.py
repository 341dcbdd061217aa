"""Writes generated files: the same bytes each time, and never over a file that its user has changed since.

A list of the written files, with the hash of each file, lies beside them.
"""

from __future__ import annotations

import hashlib
import json
import sys
from collections.abc import Mapping
from pathlib import Path

from cfepy.reading.contained_files import is_contained, place_contained, write_contained
from cfepy.reading.input_files import read_limited
from cfepy.status import UsageError

MANIFEST = ".cfepy-convert.json"
MANIFEST_BYTES = 8 << 20
SHOWN = 6


def write_files(folder: Path, files: Mapping[str, bytes], force: bool = False) -> list[str]:
    """Write files to a folder, and remove files of the last time that are no longer made.

    Args:
        folder: made if necessary.
        files: contents by path in the folder.
        force: also overwrite files that were changed by hand.

    Returns:
        Paths of the files that have changed, sorted.

    Raises:
        UsageError: the user has changed a file, or cfepy did not make it, or a name leads out of the folder; nothing
            has been written.
        OSError: the folder cannot be written.
    """
    known = _known(folder)
    place_contained(folder, f"/{MANIFEST}")
    places = {name: place_contained(folder, f"/{name}") for name in sorted({*files, *known})}
    changed = [name for name in places if _is_changed(places[name], known.get(name), files.get(name))]
    if changed and not force:
        more = f" and {len(changed) - SHOWN} more" if len(changed) > SHOWN else ""
        text = f"{', '.join(changed[:SHOWN])}{more} changed by hand since; move it away, or use --force"
        raise UsageError(text, file=folder)
    for name in known:
        if name not in files:
            places[name].unlink(missing_ok=True)
    folder.mkdir(parents=True, exist_ok=True)
    written = [name for name in sorted(files) if _write(folder, name, files[name])]
    hashes = {name: _hash(files[name]) for name in sorted(files)}
    _write(folder, MANIFEST, (json.dumps(hashes, indent=1) + "\n").encode())
    return written


def _known(folder: Path) -> dict[str, str]:
    """Return the files written the last time: hashes by path."""
    try:
        found = json.loads(read_limited(folder / MANIFEST, MANIFEST_BYTES))
    except (OSError, ValueError, RecursionError):
        return {}
    inside = isinstance(found, dict) and all(is_contained(f"/{name}") for name in found)
    return {str(name): str(value) for name, value in found.items()} if inside else {}


def _is_changed(file: Path, known: str | None, content: bytes | None) -> bool:
    """Return True if a file differs both from the last written content and from the new one."""
    if not file.is_file():
        return False
    present = read_limited(file, sys.maxsize)
    return present != content and _hash(present) != known


def _write(folder: Path, name: str, content: bytes) -> bool:
    place = place_contained(folder, f"/{name}")
    if place.is_file() and read_limited(place, sys.maxsize) == content:
        return False
    write_contained(folder, f"/{name}", content)
    return True


def _hash(content: bytes) -> str:
    return hashlib.sha256(content).hexdigest()
