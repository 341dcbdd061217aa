"""Files of a run: a layer for the output of its programs over the host's files, which are only read.

Everything that determines a program's view of a path belongs here: the layers and copying on write (`overlay`), paths
and places (`paths`), metadata (`stamps`), and Python's functions that take paths or descriptors: `open` (`opened`),
those of `os` (`file_calls`) and those of modules that open files in C (`shared`). `file_points` lets other tasks run
before file calls while schedules are explored. The files of OSAL are in `cfepy.osal`.
"""

from __future__ import annotations

from cfepy.nodes.files.file_calls import DISK_BYTES, Entries, FileCalls, same_sizes
from cfepy.nodes.files.file_points import READS_FILE, WRITES_FILE, FilePoints, file_points
from cfepy.nodes.files.opened import OpenFiles
from cfepy.nodes.files.overlay import PREFIX, Overlay
from cfepy.nodes.files.paths import below_root
from cfepy.nodes.files.stamps import ASKED, GROUP, LISTED, MADE, NEEDED, USER

__all__ = [
    "ASKED",
    "DISK_BYTES",
    "GROUP",
    "LISTED",
    "MADE",
    "NEEDED",
    "PREFIX",
    "READS_FILE",
    "USER",
    "WRITES_FILE",
    "Entries",
    "FileCalls",
    "FilePoints",
    "OpenFiles",
    "Overlay",
    "below_root",
    "file_points",
    "same_sizes",
]
