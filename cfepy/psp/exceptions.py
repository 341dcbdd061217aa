"""Exceptions that the board stores until they are read (CFE_PSP_Exception_*, cfe_psp_exceptionstorage.c).

A Python exception that ends a task is what a signal of the processor is to NASA's Linux PSP. The code that catches it
hands it to `store_exception`; ES reads it out in its background task. The storage is retained memory: it outlives a
processor reset, though CFE_PSP_AttachExceptions then discards unread entries.
"""

from __future__ import annotations

from typing import NamedTuple

from cfepy.status import CFE_PSP_NO_EXCEPTION_DATA, OsalError
from cfepy.writing.console import Console

MAX_EXCEPTION_ENTRIES = 4  # CFE_PSP_MAX_EXCEPTION_ENTRIES of the Linux PSP
EXCEPTION_ID_BASE = 0x111_0000
_INDEX_MASK = 0xFFFF


class StoredException(NamedTuple):
    """One entry: its id, the task, what happened in words, and what else is known, as bytes."""

    context_id: int
    task_id: int
    reason: str
    context: bytes


class ExceptionSummary(NamedTuple):
    """What `exception_get_summary` tells."""

    context_id: int
    task_id: int
    reason: str


class ExceptionStorage:
    """A ring of entries, each readable once as a summary, and as a context until its place is taken."""

    def __init__(self) -> None:
        self.written = 0
        self.read = 0
        self.entries: dict[int, StoredException] = {}  # by place in the ring

    @property
    def unread(self) -> int:
        """Entries whose summary has not been read."""
        return self.written - self.read

    def add(self, task_id: int, reason: str, context: bytes) -> int:
        """Store an exception; its id, 0 when the ring is full of unread ones."""
        if self.unread >= MAX_EXCEPTION_ENTRIES:
            return 0
        context_id = EXCEPTION_ID_BASE + (self.written & _INDEX_MASK)
        self.entries[self.written % MAX_EXCEPTION_ENTRIES] = StoredException(context_id, task_id, reason, context)
        self.written += 1
        self._expire(self.written % MAX_EXCEPTION_ENTRIES)
        return context_id

    def _expire(self, place: int) -> None:
        """The context of the entry that is overwritten next is not given out any more, its summary is."""
        if place in self.entries:
            self.entries[place] = self.entries[place]._replace(context_id=0)

    def find(self, context_id: int) -> StoredException | None:
        """The entry of an id, if it has not expired."""
        found = self.entries.get(context_id % MAX_EXCEPTION_ENTRIES)
        return found if context_id and found is not None and found.context_id == context_id else None

    def clear(self) -> None:
        """A power-on reset."""
        self.written = self.read = 0
        self.entries.clear()


class ExceptionApi:
    """The CFE_PSP functions on exceptions; a `Psp` has the console and the storage that they use."""

    console: Console
    exceptions: ExceptionStorage

    def attach_exceptions(self) -> None:
        """Watch for exceptions from now on, and forget unread ones (CFE_PSP_AttachExceptions)."""
        self.console.write("CFE_PSP: CFE_PSP_AttachExceptions called")
        self.exceptions.read = self.exceptions.written

    def set_default_exception_environment(self) -> None:
        """Nothing: every task is watched alike (CFE_PSP_SetDefaultExceptionEnvironment)."""

    def store_exception(self, task_id: int, reason: str, context: bytes = b"") -> int:
        """Keep an exception that ended a task; what a signal handler does in NASA's PSP.

        The caller then tells ES, as the PSP's idle task does with CFE_ES_ProcessAsyncEvent.

        Args:
            task_id: OSAL's id of the task, kept even when the task is gone by the time it is read.
            reason: what happened, in words.
            context: what else is known, for the exception and reset log.

        Returns:
            The entry's id; 0 when there are as many unread ones as the storage holds, and this one is lost.
        """
        return self.exceptions.add(task_id, reason, context)

    def exception_get_count(self) -> int:
        """The number of exceptions that are still unread (CFE_PSP_Exception_GetCount)."""
        return self.exceptions.unread

    def exception_get_summary(self) -> ExceptionSummary:
        """The oldest unread exception, which is read from then on (CFE_PSP_Exception_GetSummary).

        Raises:
            OsalError: CFE_PSP_NO_EXCEPTION_DATA when there is none.
        """
        storage = self.exceptions
        entry = storage.entries.get(storage.read % MAX_EXCEPTION_ENTRIES) if storage.unread else None
        if entry is None:
            raise OsalError(CFE_PSP_NO_EXCEPTION_DATA, "no unread exception")
        storage.read += 1
        return ExceptionSummary(entry.context_id, entry.task_id, entry.reason)

    def exception_copy_context(self, context_log_id: int, context_size: int) -> bytes:
        """What else is known of an exception (CFE_PSP_Exception_CopyContext).

        Args:
            context_log_id: an entry's id.
            context_size: bytes at most; what is longer is cut off, with a line on the console.

        Raises:
            OsalError: CFE_PSP_NO_EXCEPTION_DATA for no id, or when it has expired.
        """
        entry = self.exceptions.find(context_log_id)
        if entry is None:
            raise OsalError(CFE_PSP_NO_EXCEPTION_DATA, f"unknown exception context {context_log_id:#x}")
        if len(entry.context) > context_size:
            self.console.write(
                f"CFE_PSP: Insufficient buffer for exception context, total={len(entry.context)} bytes, "
                f"saved={context_size}"
            )
        return entry.context[:context_size]
