"""Exceptions that the board stores until they are read (CFE_PSP_Exception_*, cfe_psp_exceptionstorage.c).

A Python exception that ends a task corresponds to a processor signal in NASA's Linux PSP. The code that catches it
calls `store_exception`, and the background task of ES reads it. The storage is retained memory and outlives a processor
reset, but CFE_PSP_AttachExceptions then discards unread entries.
"""

from __future__ import annotations

from typing import NamedTuple

from cfepy.status import CFE_PSP_NO_EXCEPTION_DATA, OsalError
from cfepy.writing.console import Console

MAX_EXCEPTION_ENTRIES = 4  # CFE_PSP_MAX_EXCEPTION_ENTRIES of the Linux PSP
EXCEPTION_ID_BASE = 0x111_0000
_INDEX_MASK = 0xFFFF


class StoredException(NamedTuple):
    """A stored exception: its id, the task, a description, and further context as bytes."""

    context_id: int
    task_id: int
    reason: str
    context: bytes


class ExceptionSummary(NamedTuple):
    """The result of `exception_get_summary`."""

    context_id: int
    task_id: int
    reason: str


class ExceptionStorage:
    """A ring of entries. Each summary can be read once, and each context until its slot is reused."""

    def __init__(self) -> None:
        self.written = 0
        self.read = 0
        self.entries: dict[int, StoredException] = {}  # by slot of the ring

    @property
    def unread(self) -> int:
        """The number of entries with an unread summary."""
        return self.written - self.read

    def add(self, task_id: int, reason: str, context: bytes) -> int:
        """Store an exception; return its id, or 0 if the ring is full of unread entries."""
        if self.unread >= MAX_EXCEPTION_ENTRIES:
            return 0
        context_id = EXCEPTION_ID_BASE + (self.written & _INDEX_MASK)
        self.entries[self.written % MAX_EXCEPTION_ENTRIES] = StoredException(context_id, task_id, reason, context)
        self.written += 1
        self._expire(self.written % MAX_EXCEPTION_ENTRIES)
        return context_id

    def _expire(self, place: int) -> None:
        """Expire the context of the entry to be overwritten next; its summary stays readable."""
        if place in self.entries:
            self.entries[place] = self.entries[place]._replace(context_id=0)

    def find(self, context_id: int) -> StoredException | None:
        """Return the entry of an id, or None if it has expired."""
        found = self.entries.get(context_id % MAX_EXCEPTION_ENTRIES)
        return found if context_id and found is not None and found.context_id == context_id else None

    def clear(self) -> None:
        """Remove all entries, for a power-on reset."""
        self.written = self.read = 0
        self.entries.clear()


class ExceptionApi:
    """The CFE_PSP functions on exceptions; `Psp` provides the console and the storage."""

    console: Console
    exceptions: ExceptionStorage

    def attach_exceptions(self) -> None:
        """Start to watch for exceptions, and discard unread ones (CFE_PSP_AttachExceptions)."""
        self.console.write("CFE_PSP: CFE_PSP_AttachExceptions called")
        self.exceptions.read = self.exceptions.written

    def set_default_exception_environment(self) -> None:
        """Do nothing, because every task is watched in the same way (CFE_PSP_SetDefaultExceptionEnvironment)."""

    def store_exception(self, task_id: int, reason: str, context: bytes = b"") -> int:
        """Store an exception that ended a task, like a signal handler in NASA's PSP.

        The caller must then notify ES, as the PSP's idle task does with CFE_ES_ProcessAsyncEvent.

        Args:
            task_id: OSAL's id of the task; it is kept even if the task is gone when it is read.
            reason: a description.
            context: further context for the exception and reset log.

        Returns:
            The entry's id, or 0 if the storage is full of unread entries and this exception is lost.
        """
        return self.exceptions.add(task_id, reason, context)

    def exception_get_count(self) -> int:
        """Return the number of unread exceptions (CFE_PSP_Exception_GetCount)."""
        return self.exceptions.unread

    def exception_get_summary(self) -> ExceptionSummary:
        """Return the oldest unread exception and mark it as read (CFE_PSP_Exception_GetSummary).

        Raises:
            OsalError: CFE_PSP_NO_EXCEPTION_DATA if there is none.
        """
        storage = self.exceptions
        entry = storage.entries.get(storage.read % MAX_EXCEPTION_ENTRIES) if storage.unread else None
        if entry is None:
            raise OsalError(CFE_PSP_NO_EXCEPTION_DATA, "no unread exception")
        storage.read += 1
        return ExceptionSummary(entry.context_id, entry.task_id, entry.reason)

    def exception_copy_context(self, context_log_id: int, context_size: int) -> bytes:
        """Return the context of an exception (CFE_PSP_Exception_CopyContext).

        Args:
            context_log_id: an entry's id.
            context_size: maximum number of bytes; a longer context is truncated, with a line on the console.

        Raises:
            OsalError: CFE_PSP_NO_EXCEPTION_DATA if the id is unknown or has expired.
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
