"""Table Services on small stand-ins for the other services."""

from __future__ import annotations

import itertools
from types import SimpleNamespace
from typing import Any, cast

import pytest

from cfepy.config.platform import PlatformConfig
from cfepy.es.pools import MemPool
from cfepy.fs.background import FileWriteEvent, FileWriteMetaData
from cfepy.fs.header import HEADER_SIZE, init_header
from cfepy.msg import Command, command
from cfepy.status import (
    CFE_ES_CDS_ALREADY_EXISTS,
    CFE_ES_CDS_BLOCK_CRC_ERR,
    CFE_ES_CDS_OWNER_ACTIVE_ERR,
    CFE_ES_CDS_WRONG_TYPE_ERR,
    CFE_ES_ERR_NAME_NOT_FOUND,
    CFE_ES_NOT_IMPLEMENTED,
    CFE_SUCCESS,
    OS_ERR_FILE,
    OS_FS_ERR_PATH_INVALID,
    OS_FS_ERR_PATH_TOO_LONG,
    CfeError,
    OsalError,
)
from cfepy.tbl import TableImage, TableServices, build, packets

TBL_APP_ID = 0x110005
APPS = {TBL_APP_ID: "CFE_TBL", 0x110006: "APP", 0x110007: "OTHER"}
NOW = (1001000, 0x80000000)
POOL_ID = 0x140002


class Store:
    """A Critical Data Store that survives the bench. Names in `broken` are unreadable, apps in `running` own theirs.

    A block that was never written is also unreadable.
    """

    def __init__(self) -> None:
        self.blocks: dict[str, bytes] = {}
        self.names: list[str] = []
        self.broken: set[str] = set()
        self.running: set[str] = set()
        self.types: dict[str, bool] = {}
        self.is_there = True

    def register_cds_ex(self, block_size: int, full_name: str, critical_table: bool) -> tuple[int, int]:
        assert critical_table
        if not self.is_there:
            raise CfeError(CFE_ES_NOT_IMPLEMENTED, "no CDS")
        if full_name not in self.names:
            self.names.append(full_name)
        handle = 0x150001 + self.names.index(full_name)
        if len(self.blocks.get(full_name, b"")) == block_size:
            return handle, CFE_ES_CDS_ALREADY_EXISTS
        self.blocks[full_name] = bytes(block_size)
        self.broken.add(full_name)
        return handle, CFE_SUCCESS

    def copy_to_cds(self, handle: int, data: bytes) -> None:
        name = self.names[handle - 0x150001]
        assert len(data) == len(self.blocks[name])
        self.blocks[name] = bytes(data)
        self.broken.discard(name)

    def restore_from_cds(self, handle: int) -> bytes:
        name = self.names[handle - 0x150001]
        if name in self.broken:
            raise CfeError(CFE_ES_CDS_BLOCK_CRC_ERR, name)
        return self.blocks[name]

    def delete_cds(self, full_name: str, called_by_tbl_services: bool = False) -> None:
        if not self.is_there:
            raise CfeError(CFE_ES_NOT_IMPLEMENTED, "no CDS")
        if self.types.get(full_name, True) != called_by_tbl_services:
            raise CfeError(CFE_ES_CDS_WRONG_TYPE_ERR, full_name)
        if full_name not in self.blocks:
            raise CfeError(CFE_ES_ERR_NAME_NOT_FOUND, full_name)
        if full_name.partition(".")[0] in self.running:
            raise CfeError(CFE_ES_CDS_OWNER_ACTIVE_ERR, full_name)
        del self.blocks[full_name]


class Bench:
    """One TableServices with all of its environment, for inspection by tests.

    Args:
        store: earlier content of the CDS; None for an empty one.
        limits: fields of `PlatformConfig`, including the release.
    """

    def __init__(self, store: Store | None = None, **limits: Any) -> None:
        self.store = store = store or Store()
        self.events: list[tuple[int, int, str]] = []
        self.log: list[str] = []
        self.sent: list[bytes] = []
        self.pools: list[tuple[int, str]] = []
        self.jobs: list[FileWriteMetaData] = []
        self.files: dict[str, bytes] = {}
        self.left_open: list[str] = []
        self.too_long = ""
        self.kernel = cast(Any, SimpleNamespace(current=SimpleNamespace(owner=None), now=0))
        ports = SimpleNamespace(
            es=SimpleNamespace(
                get_app_name=APPS.__getitem__,
                pool_create=self._make_table_pool,
                get_pool_buf=lambda pool_id, size: self.table_pool.get(size),
                put_pool_buf=lambda pool_id, block: self.table_pool.put(block),
                register_cds_ex=store.register_cds_ex,
                copy_to_cds=store.copy_to_cds,
                restore_from_cds=store.restore_from_cds,
                delete_cds=store.delete_cds,
            ),
            fs=SimpleNamespace(background_file_dump_request=self.jobs.append),
            syslog=SimpleNamespace(write_to_sys_log=self.log.append),
            evs=SimpleNamespace(
                send_event=lambda event_id, kind, text: self.events.append((event_id, kind, text)),
                send_event_with_app_id=lambda event_id, kind, app, text: self.events.append((event_id, kind, text)),
            ),
            sb=SimpleNamespace(transmit_msg=self.sent.append),
            time=SimpleNamespace(now=lambda: NOW),
        )
        config = PlatformConfig().with_limits(limits)
        self.tbl = TableServices(self.kernel, cast(Any, ports), config, self)
        self.tbl.early_init()
        self.tbl.registry.services_app_id = TBL_APP_ID
        self.as_app("APP")

    def _make_table_pool(self, size: int, owner: str = "") -> int:
        self.pools.append((size, owner))
        self.table_pool = MemPool(owner, size)
        return POOL_ID

    def read_file(self, path: str) -> bytes:
        if path == self.too_long:
            raise OsalError(OS_FS_ERR_PATH_TOO_LONG, path)
        if path not in self.files:
            raise OsalError(OS_FS_ERR_PATH_INVALID, path)
        return self.files[path]

    def write_file(self, path: str, data: bytes) -> None:
        if not path.startswith("/"):
            raise OsalError(OS_FS_ERR_PATH_INVALID, path)
        self.files[path] = data

    def leave_open(self, path: str) -> None:
        self.left_open.append(path)

    def exists(self, path: str) -> bool:
        return path in self.files

    def as_app(self, name: str | None) -> None:
        """The next calls come from this app."""
        app_id = next((app_id for app_id in APPS if APPS[app_id] == name), 0)
        self.kernel.current.owner = SimpleNamespace(app_id=app_id, name=name, is_core=False) if name else None

    def ground(self, wish: Command, **values: Any) -> None:
        """A command from the ground, handled in the CFE_TBL task."""
        self.receive(wish.packet(values))

    def receive(self, packet: bytes) -> None:
        """A packet for the CFE_TBL task."""
        before = self.kernel.current.owner
        self.as_app("CFE_TBL")
        self.tbl.task.handle(packet)
        self.kernel.current.owner = before

    def named(self, wish: Command, name: str) -> None:
        """A ground command that carries a table's name."""
        self.ground(wish, TableName=name)

    def background(self) -> None:
        """Process waiting files as ES's background task does."""
        for job in self.jobs:
            size, records, last = HEADER_SIZE, b"", False
            for number in itertools.count():
                data, last = job.get_data(number)
                size, records = size + len(data), records + data
                if last:
                    break
            if not job.file_name.startswith("/ram/none/"):
                self.files[job.file_name] = init_header(job.description, job.file_subtype).pack() + records
                job.on_event(FileWriteEvent.COMPLETE, CFE_SUCCESS, number + 1, 0, size)
            else:
                job.on_event(FileWriteEvent.CREATE_ERROR, OS_ERR_FILE, 0, 0, 0)
            job.is_pending = False
        self.jobs.clear()

    def send_hk(self) -> dict[str, Any]:
        """Request housekeeping. Returns its fields."""
        self.sent.clear()
        self.tbl.task.handle(bytes(command(packets.SEND_HK_MID, 0)))
        return packets.HOUSEKEEPING.unpack(self.sent[0][16:])

    def put(self, path: str, name: str, data: bytes, offset: int = 0) -> None:
        """A table file."""
        self.files[path] = build(TableImage(name, data, "test", offset))

    def take_events(self) -> list[tuple[int, int, str]]:
        """Return the events since the last time."""
        events = list(self.events)
        self.events.clear()
        return events


@pytest.fixture
def bench() -> Bench:
    return Bench()
