"""CFE_TBL_*: Table Services for C.

In NASA's default build, which keeps deprecated elements, a handle of C is an int16, the lower half of a handle id. In a
build with OMIT_DEPRECATED it is the id itself (`CRuntime.omit_deprecated`). A table's address is the address of its
buffer, without a copy. Only with the guard, a validation function gets a copy if a table fills a part of a load buffer.
"""

from __future__ import annotations

import struct
from collections.abc import Callable
from typing import TYPE_CHECKING

from cfepy.extra.c.crashes import CFault
from cfepy.ids import TBL_HANDLE_BASE, UNDEFINED, make
from cfepy.reading.texts import to_bytes
from cfepy.status import (
    CFE_SUCCESS,
    CFE_TBL_BAD_ARGUMENT,
    CFE_TBL_INFO_UPDATED,
    CfeError,
)
from cfepy.tbl import Validator

if TYPE_CHECKING:
    from cfepy.extra.c.calls import Declarations
    from cfepy.extra.c.runtime import CRuntime

BAD = CFE_TBL_BAD_ARGUMENT
FROM_FILE, FROM_ADDRESS = 0, 1
"""CFE_TBL_SrcEnum_t."""
INFO = struct.Struct("<QIIIIII?????64s3x")
"""CFE_TBL_Info_t on a 64-bit computer."""
_POINTER = 8
_FIRST = make(TBL_HANDLE_BASE, 0)


class Handles:
    """Conversion between C's handles and ids.

    Args:
        omit_deprecated: whether the code was built with OMIT_DEPRECATED.

    Attributes:
        letter: of a handle as a parameter.
        output: of a handle that is written.
        array: an element of an array of handles.
        bad: CFE_TBL_BAD_TABLE_HANDLE.
    """

    def __init__(self, omit_deprecated: bool) -> None:
        self.letter, self.output = ("I", "4") if omit_deprecated else ("h", "2")
        self.array = struct.Struct("<I" if omit_deprecated else "<h")
        self.bad = UNDEFINED if omit_deprecated else -1
        self._first = 0 if omit_deprecated else _FIRST

    def to_id(self, handle: int) -> int:
        """Return the id of a handle (CFE_TBL_HANDLE_IMPORT)."""
        return handle + self._first & 0xFFFFFFFF

    def of(self, handle_id: int) -> int:
        """Return the handle of an id (CFE_TBL_HANDLE_EXPORT)."""
        return int(handle_id) - self._first


def declare(api: Declarations, c: CRuntime) -> None:
    handles = Handles(c.omit_deprecated)
    _declare_registration(api, c, handles)
    _declare_content(api, c, handles)
    _declare_addresses(api, c, handles)
    _declare_rest(api, c, handles)


def _declare_registration(api: Declarations, c: CRuntime, handles: Handles) -> None:
    tbl, memory = c.handle.tbl, c.memory
    put = memory.put_u32 if handles.output == "4" else memory.put_u16

    def validator_at(name: str, function: int) -> Validator | None:
        if not function:
            return None
        if c.tables is None:
            return lambda image: c.status(function, memory.address_of(image))
        judge = c.tables.judge
        return lambda image: judge(image, name, lambda address: c.status(function, address))

    def register(out: int, name: str, size: int, options: int, validate: int) -> int:
        try:
            made = tbl.register(name, size, options, validator_at(name, validate))
        except CfeError:
            put(out, handles.bad)
            raise
        put(out, handles.of(made))
        return made.status

    def share(out: int, name: str) -> None:
        try:
            put(out, handles.of(tbl.share(name)))
        except CfeError:
            put(out, handles.bad)
            raise

    def handle_to_id(handle: int) -> int:
        return UNDEFINED if handle == handles.bad else handles.to_id(handle)

    api.add("CFE_TBL_Register", "PSQHp", register, BAD)
    api.add("CFE_TBL_Share", "PS", share, BAD)
    api.add("CFE_TBL_HandleToID", handles.letter, handle_to_id)
    api.add("CFE_TBL_HandleFromID", "I", lambda handle_id: handles.of(handle_id) if handle_id else handles.bad)


def _declare_content(api: Declarations, c: CRuntime, handles: Handles) -> None:
    tbl, memory = c.handle.tbl, c.memory
    accesses = c.cfe.tbl.registry.accesses

    def load(handle: int, kind: int, source: int) -> int:
        handle_id = handles.to_id(handle)
        if kind == FROM_FILE:
            return tbl.load(handle_id, memory.text(source))
        if kind != FROM_ADDRESS:
            return tbl.load(handle_id, memoryview(b""), source_type=kind)
        access = accesses.find(handle_id)
        size = 0 if access is None else access.table.size
        memory.peek(source, size)  # missing bytes are a fault of the caller

        def read() -> bytes:
            try:
                image: bytes = memory.peek(source, size)
                return image
            except CFault:  # the application has ended, and its memory with the table is gone
                return bytes(size)

        return tbl.load(handle_id, memory.view(source, size), address=source, read=read)

    def on_handle(name: str, call: Callable[[int], object]) -> None:
        api.add(name, handles.letter, lambda handle: call(handles.to_id(handle)))

    def unregister(handle_id: int) -> None:
        _check(c, [handle_id], "CFE_TBL_Unregister")
        tbl.unregister(handle_id)

    api.add("CFE_TBL_Load", f"{handles.letter}iP", load, BAD)
    on_handle("CFE_TBL_Unregister", unregister)
    on_handle("CFE_TBL_Update", tbl.update)
    on_handle("CFE_TBL_Validate", tbl.validate)
    on_handle("CFE_TBL_Manage", tbl.manage)
    on_handle("CFE_TBL_DumpToBuffer", tbl.dump_to_buffer)
    on_handle("CFE_TBL_Modified", tbl.modified)
    on_handle("CFE_TBL_GetStatus", tbl.get_status)


def _check(c: CRuntime, handle_ids: list[int], function: str) -> None:
    """With the guard, check tables whose addresses are given back.

    Raises:
        CFault: the application wrote past a table.
    """
    if c.tables is not None:
        accesses = (c.cfe.tbl.registry.accesses.find(each) for each in handle_ids)
        tables = [access.table for access in accesses if access is not None]
        c.tables.check((buffer.data for table in tables for buffer in table.buffers), f"{function}()")


def _declare_addresses(api: Declarations, c: CRuntime, handles: Handles) -> None:
    tbl, memory = c.handle.tbl, c.memory

    def get_address(out: int, handle: int) -> int:
        memory.put_u64(out, 0)
        image, is_updated = tbl.get_address(handles.to_id(handle))
        memory.put_u64(out, memory.address_of(image))
        return CFE_TBL_INFO_UPDATED if is_updated else CFE_SUCCESS

    def each(at: int, count: int) -> list[int]:
        return [handle for (handle,) in handles.array.iter_unpack(memory.peek(at, count * handles.array.size))]

    def get_addresses(outputs: int, count: int, array: int) -> int:
        outs = [memory.u64(outputs + _POINTER * number) for number in range(count)]
        for out in outs:
            memory.put_u64(out, 0)
        images, status = tbl.get_addresses_in_c([handles.to_id(handle) for handle in each(array, count)])
        for out, image in zip(outs, images, strict=False):
            memory.put_u64(out, 0 if image is None else memory.address_of(image))
        return status

    def release_address(handle: int) -> int:
        _check(c, [handles.to_id(handle)], "CFE_TBL_ReleaseAddress")
        return tbl.release_address(handles.to_id(handle))

    def release_addresses(count: int, array: int) -> int:
        handle_ids = [handles.to_id(handle) for handle in each(array, count)]
        _check(c, handle_ids, "CFE_TBL_ReleaseAddresses")
        return tbl.release_addresses(handle_ids)

    api.add("CFE_TBL_GetAddress", f"P{handles.letter}", get_address, BAD)
    api.add("CFE_TBL_ReleaseAddress", handles.letter, release_address)
    api.add("CFE_TBL_GetAddresses", "PHP", get_addresses, BAD)
    api.add("CFE_TBL_ReleaseAddresses", "HP", release_addresses, BAD)


def _declare_rest(api: Declarations, c: CRuntime, handles: Handles) -> None:
    tbl, memory = c.handle.tbl, c.memory

    def get_info(at: int, name: str) -> None:
        info = tbl.get_info(name)
        loaded = to_bytes(info.last_file_loaded)
        if len(loaded) >= 64:  # a long path; keep the mark of a modified table
            loaded = loaded[:60] + loaded[-3:]
        raw = INFO.pack(
            info.size,
            info.num_users,
            *info.file_time,
            info.crc,
            *info.time_of_last_update,
            info.table_loaded_once,
            info.dump_only,
            info.double_buffered,
            info.user_def_addr,
            info.critical,
            loaded,
        )
        memory.poke(at, raw)

    def notify(handle: int, msg_id: int, code: int, parameter: int) -> None:
        tbl.notify_by_message(handles.to_id(handle), msg_id, code, parameter)

    api.add("CFE_TBL_GetInfo", "PS", get_info, BAD)
    api.add("CFE_TBL_NotifyByMessage", f"{handles.letter}IHI", notify)
