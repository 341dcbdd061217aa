"""`--save-files DIR`: the files that a mission wrote into its virtual disks, on the host after the run.

/ram/cfe_evs.log becomes DIR/ram/cfe_evs.log. A run itself never writes to the host, so that it cannot change the next.
"""

from __future__ import annotations

from pathlib import Path

from cfepy.osal import FileSystem
from cfepy.status import UsageError

OPTION = "--save-files"


def saving_to(folder: str | None) -> Path | None:
    """The folder to save to, made if it is not there; that it can be made is better known before a run than after it.

    Raises:
        UsageError: it cannot be made.
    """
    if folder is None:
        return None
    path = Path(folder)
    try:
        path.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise UsageError(f"cannot be made: {error.strerror}", file=path, field=OPTION) from None
    return path


def save_files(files: FileSystem, folder: Path) -> None:
    """Write what the mission wrote, and say where it is.

    Args:
        files: the mission's.
        folder: files of the same name in it are written over.

    Raises:
        UsageError: one cannot be written.
    """
    written = files.written()
    for name, data in written.items():
        path = folder / name.lstrip("/")
        try:
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_bytes(data)
        except OSError as error:
            raise UsageError(f"could not be written: {error.strerror}", file=path, field=OPTION) from None
    count = len(written)
    print(f"saved to {folder}: {count} {'file' if count == 1 else 'files'}")
