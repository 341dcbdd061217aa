"""The part of the PSP that the Critical Data Store uses, with memory that survives it."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any, cast

from cfepy.es.cds import CriticalDataStore
from cfepy.psp.psp import RST_TYPE_POWERON, RST_TYPE_PROCESSOR

SIZE = 4096
ENTRIES = 8


class Board:
    """The part of the PSP that the CDS uses. `boot` is a processor reset."""

    def __init__(self, size: int = SIZE, entries: int = ENTRIES) -> None:
        self.memory = bytearray(size)
        self.entries = entries
        self.log: list[str] = []
        self.cds = self.boot(RST_TYPE_POWERON)

    def boot(self, reset_type: int = RST_TYPE_PROCESSOR) -> CriticalDataStore:
        psp = SimpleNamespace(
            get_cds_size=lambda: len(self.memory),
            read_from_cds=lambda offset, size: bytes(self.memory[offset : offset + size]),
            write_to_cds=self._write,
            get_restart_type=lambda: SimpleNamespace(reset_type=reset_type),
        )
        self.cds = CriticalDataStore(cast(Any, psp), self.entries, self.log.append)
        self.cds.early_init()
        return self.cds

    def _write(self, data: bytes, offset: int) -> None:
        self.memory[offset : offset + len(data)] = data
