"""Which modules of the kernel and the bus mypyc compiles to C from these sources, and whether they are in use.

A wheel built with CFEPY_ENGINE has the compiled modules (`hatch_build.py`), each next to its source, which Python then
ignores. They behave the same and are never required.
"""

from __future__ import annotations

import hashlib
from importlib.machinery import EXTENSION_SUFFIXES
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from mypy_extensions import mypyc_attr as mypyc_attr
else:

    def mypyc_attr(**_: Any) -> Any:
        """Pass attributes of a class to mypyc; it does nothing in plain Python."""
        return lambda decorated: decorated


MODULES = (
    "cfepy/rtos/task.py",
    "cfepy/rtos/scheduler.py",
    "cfepy/rtos/kernel.py",
    "cfepy/rtos/queue.py",
    "cfepy/sb/buffers.py",
    "cfepy/sb/bus.py",
    "cfepy/sb/core.py",
    "cfepy/sb/pipe.py",
    "cfepy/sb/pipes.py",
    "cfepy/sb/routing.py",
    "cfepy/time/clock.py",
)
ROOT = Path(__file__).resolve().parents[2]


def library_name(root: Path) -> str:
    """Return the name of the library that all compiled modules share, without mypyc's suffix. It depends on the
    sources.

    Args:
        root: the folder that contains `cfepy`.
    """
    digest = hashlib.sha256()
    for module in MODULES:
        digest.update((root / module).read_bytes())
    return f"cfepy_{digest.hexdigest()[:16]}"


def state() -> str:
    """Return how the kernel and the bus run here, as text for `cfepy --version`."""
    compiled = [(ROOT / module).with_suffix(suffix) for module in MODULES for suffix in EXTENSION_SUFFIXES]
    if not any(path.exists() for path in compiled):
        return "kernel and bus interpreted"
    if not list(ROOT.glob(f"{library_name(ROOT)}__mypyc.*")):
        return (
            "the compiled kernel and bus do not match the sources here; build them again, or delete the compiled files"
        )
    return "kernel and bus compiled"
