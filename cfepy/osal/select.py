"""OSAL's select (osapi-select.h): waiting until one of several descriptors can be read or written.

A file can always be both. May import cfepy.ids, status and its neighbours in cfepy.osal.
"""

from __future__ import annotations

from cfepy.ids import OS_STREAM_BASE, get_base
from cfepy.osal.clock import OsTime
from cfepy.osal.files import OsStream
from cfepy.osal.limits import OS_PEND
from cfepy.osal.sockets import SocketApi
from cfepy.osal.streams import OsSocket, ns_of
from cfepy.status import OS_ERR_INVALID_ID, OS_INVALID_POINTER, OsalError

OS_STREAM_STATE_BOUND = 0x01
OS_STREAM_STATE_CONNECTED = 0x02
OS_STREAM_STATE_READABLE = 0x04
OS_STREAM_STATE_WRITABLE = 0x08
OS_STREAM_STATE_LISTENING = 0x10


class FdSet:
    """A set of descriptors (OS_FdSet); filled with `select_fd_add`, and changed by `select_multiple`.

    Attributes:
        slots: places in the table of descriptors, ascending.
    """

    __slots__ = ("slots",)

    def __init__(self) -> None:
        self.slots: list[int] = []


class SelectApi(SocketApi):
    """The OS_Select* functions."""

    def select_single(self, objid: int, state_flags: int, msecs: int = OS_PEND) -> int | None:
        """Wait until a descriptor can be read or written (OS_SelectSingle).

        Args:
            objid: a socket or a file.
            state_flags: what to wait for: OS_STREAM_STATE_READABLE, OS_STREAM_STATE_WRITABLE or both; 0 never waits.
            msecs: OS_PEND (-1) waits without limit, OS_CHECK (0) not at all.

        Returns:
            Which of the flags are true; None when none came true in that time.

        Raises:
            OsalError: OS_ERR_INVALID_ID.
        """
        return self._select_single(objid, state_flags, ns_of(msecs))

    def select_single_abs(self, objid: int, state_flags: int, abs_timeout: OsTime) -> int | None:
        """As `select_single`, until a local time (OS_SelectSingleAbs)."""
        return self._select_single(objid, state_flags, self._ns_until(abs_timeout))

    def select_multiple(self, read_set: FdSet | None, write_set: FdSet | None, msecs: int = OS_PEND) -> bool:
        """Wait until a descriptor of the one set can be read or one of the other written (OS_SelectMultiple).

        Args:
            read_set: what to read from; afterwards only those that can be read are in it. None for nothing.
            write_set: the same for writing.
            msecs: OS_PEND (-1) waits without limit, OS_CHECK (0) not at all.

        Returns:
            False when none was ready in that time; the sets are as they were then.

        Raises:
            OsalError: OS_ERR_INVALID_ID when there is no open descriptor in the sets.
        """
        return self._select_multiple(read_set, write_set, ns_of(msecs))

    def select_multiple_abs(self, read_set: FdSet | None, write_set: FdSet | None, abs_timeout: OsTime) -> bool:
        """As `select_multiple`, until a local time (OS_SelectMultipleAbs)."""
        return self._select_multiple(read_set, write_set, self._ns_until(abs_timeout))

    def select_fd_zero(self, fd_set: FdSet) -> None:
        """Empty a set (OS_SelectFdZero), or OS_INVALID_POINTER."""
        _given(fd_set).slots.clear()

    def select_fd_add(self, fd_set: FdSet, objid: int) -> None:
        """Add a descriptor (OS_SelectFdAdd), or OS_INVALID_POINTER, OS_ERR_INVALID_ID."""
        slots, slot = _given(fd_set).slots, self._slot(objid)
        if slot not in slots:
            slots.append(slot)
            slots.sort()

    def select_fd_clear(self, fd_set: FdSet, objid: int) -> None:
        """Take a descriptor out, if it is there (OS_SelectFdClear), or OS_INVALID_POINTER, OS_ERR_INVALID_ID."""
        slots, slot = _given(fd_set).slots, self._slot(objid)
        if slot in slots:
            slots.remove(slot)

    def select_fd_is_set(self, fd_set: FdSet, objid: int) -> bool:
        """Whether a descriptor is in a set (OS_SelectFdIsSet)."""
        return get_base(objid) == OS_STREAM_BASE and self._streams.index(objid) in fd_set.slots

    def _select_single(self, objid: int, wanted: int, timeout_ns: int) -> int | None:
        record = self._stream(objid)
        if not wanted:
            return 0
        endpoints = [record.endpoint] if isinstance(record, OsSocket) else []
        if not self._await(endpoints, lambda: record.deleted or _state(record) & wanted != 0, timeout_ns):
            return None
        if record.deleted:
            raise self._streams.gone(record)
        return _state(record) & wanted

    def _select_multiple(self, read_set: FdSet | None, write_set: FdSet | None, timeout_ns: int) -> bool:
        readers, writers = self._open_of(read_set), self._open_of(write_set)
        if not readers and not writers:
            raise OsalError(OS_ERR_INVALID_ID, "there is no descriptor to wait for")

        def ready() -> bool:
            return any(_can(record, OS_STREAM_STATE_READABLE) for record in readers) or any(
                _can(record, OS_STREAM_STATE_WRITABLE) for record in writers
            )

        endpoints = [record.endpoint for record in (*readers, *writers) if isinstance(record, OsSocket)]
        if not self._await(endpoints, ready, timeout_ns):
            return False
        self._keep(read_set, readers, OS_STREAM_STATE_READABLE)
        self._keep(write_set, writers, OS_STREAM_STATE_WRITABLE)
        return True

    def _open_of(self, fd_set: FdSet | None) -> list[OsStream]:
        found = [self._streams.at(slot) for slot in fd_set.slots] if fd_set is not None else []
        return [record for record in found if record is not None]

    def _keep(self, fd_set: FdSet | None, records: list[OsStream], flag: int) -> None:
        if fd_set is not None:
            fd_set.slots = [self._streams.index(record.id) for record in records if _can(record, flag)]

    def _slot(self, objid: int) -> int:
        if get_base(objid) != OS_STREAM_BASE:
            raise OsalError(OS_ERR_INVALID_ID, f"{objid:#x} is no descriptor")
        return self._streams.index(objid)


def _state(record: OsStream) -> int:
    """OS_STREAM_STATE_READABLE and OS_STREAM_STATE_WRITABLE as they are now."""
    if not isinstance(record, OsSocket):
        return OS_STREAM_STATE_READABLE | OS_STREAM_STATE_WRITABLE
    endpoint = record.endpoint
    return OS_STREAM_STATE_READABLE * endpoint.readable | OS_STREAM_STATE_WRITABLE * endpoint.writable


def _can(record: OsStream, flag: int) -> bool:
    return not record.deleted and _state(record) & flag != 0


def _given(fd_set: FdSet | None) -> FdSet:
    if fd_set is None:
        raise OsalError(OS_INVALID_POINTER, "a set of descriptors is missing")
    return fd_set
