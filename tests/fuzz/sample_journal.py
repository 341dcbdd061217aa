"""The journal of a short run with files, folders and paths that a node asked for, made once."""

from __future__ import annotations

from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory

from cfepy.journal.journal import FrameWriter, read_frames
from tests.journal.missions import paths
from tests.journal.replays import plan_for, record


@cache
def sample() -> bytes:
    """Its bytes."""
    with TemporaryDirectory() as folder:
        path = Path(folder, "run.cfepy")
        record(plan_for(paths(Path(folder)), 1, schedule="random:3"), path)
        return path.read_bytes()


def with_frames(path: Path, change: object) -> None:
    """Write a journal whose frames were changed: `change` gets kind and body, and may change the body."""
    path.write_bytes(sample())
    frames = list(read_frames(path))
    writer = FrameWriter(path)
    for kind, body in frames:
        if callable(change):
            change(kind, body)
        writer.write(kind, body)
    writer.close()
