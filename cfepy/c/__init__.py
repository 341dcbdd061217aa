"""Compiled applications: unmodified C, built against NASA's headers, as lines of a startup script.

What belongs here: the engine, a C extension that runs such code as coroutines (`engine/`), what loads a shared object
without the host's loader (`elf.py`, `image.py`), the memory that C code sees (`arena.py`), and in `api/` what the
public functions of OSAL, the PSP and cFE mean for C: arguments, outputs, structures. What does not: the services.

It is imported only when a mission has an ELF file where a startup script names one.
"""

from __future__ import annotations

from cfepy.c.loading import CompiledLoader
from cfepy.c.runtime import CRuntime

__all__ = ["CRuntime", "CompiledLoader"]
