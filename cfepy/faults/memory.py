"""Faults on memory: files, table images, the CDS and other retained memory get other bytes. Imports its neighbours."""

from __future__ import annotations

from abc import ABC, abstractmethod
from random import Random
from typing import Any

from cfepy.faults.messages import damaged
from cfepy.faults.plan import Fault
from cfepy.faults.report import FaultReport
from cfepy.status import CfeError

DEFAULT_SIGNATURE = {"bytes": {0: 0}}


class MemoryFault(ABC):
    """A fault on some bytes.

    Args:
        fault: what the plan says.
        random: where random bits are.
        report: takes what happens.
    """

    def __init__(self, fault: Fault, random: Random, report: FaultReport) -> None:
        self._fault = fault
        self._random = random
        self._report = report

    def strike(self, processor: Any) -> None:
        """Do it now."""
        try:
            memory, what = self._find(processor)
        except (CfeError, LookupError) as error:
            self._report.missed(self._fault, error.args[0] if isinstance(error, LookupError) else str(error))
            return
        if not len(memory):
            self._report.missed(self._fault, f"{what} is empty")
            return
        memory[:] = damaged(bytes(memory), 0, self._options(), self._random)
        self._report.happened(self._fault, f"changes {what}")

    def _options(self) -> Any:
        return self._fault.options

    @abstractmethod
    def _find(self, processor: Any) -> tuple[Any, str]:
        """The bytes, which can be written in place, and what they are.

        Raises:
            CfeError, LookupError: there are none; the latter with a text.
        """


class FileFault(MemoryFault):
    """A file of the virtual file system."""

    def _find(self, processor: Any) -> tuple[Any, str]:
        path = self._fault.target[0]
        node = processor.machine.files.find(path)
        if node is None:
            raise LookupError(f"there is no file {path} at {processor.machine.kernel.now / 1e9:g} s")
        return node.data, f"file {path}"


class TableFault(MemoryFault):
    """The active image of a table."""

    def _find(self, processor: Any) -> tuple[Any, str]:
        name = self._fault.target[0]
        table = processor.cfe.tbl.registry.find(name)
        if table is None or table.active is None:
            raise LookupError(f"there is no table {name} at {processor.machine.kernel.now / 1e9:g} s")
        return table.active.view(), f"table {name}"


class RetainedFault(MemoryFault):
    """Memory that outlives a reset: the CDS or a block of it, the EEPROM, the reset and the user reserved area."""

    def _options(self) -> Any:
        """By default the CDS as a whole loses its signature, so that the next boot finds none."""
        options = self._fault.options
        whole_cds = self._fault.target[0] == "cds" and "block" not in options
        return DEFAULT_SIGNATURE if whole_cds and not {"bits", "bytes"} & set(options) else options

    def _find(self, processor: Any) -> tuple[Any, str]:
        area, block_name = self._fault.target[0], self._fault.options.get("block")
        memory = memoryview(getattr(processor.machine.retained, area))
        if block_name is None:
            return memory, f"the {area.upper()}" if area != "user_reserved" else "the user reserved area"
        store = processor.cfe.es.cds
        if store is None:
            raise LookupError("there is no CDS yet")
        block = store.named(block_name)
        start = block.offset + block.size - block.user_size
        return memory[start : start + block.user_size], f"CDS block {block_name}"


CLASSES: dict[str, type[MemoryFault]] = {
    "corrupt_file": FileFault,
    "corrupt_table": TableFault,
    "corrupt_memory": RetainedFault,
}
