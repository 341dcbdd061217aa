"""Table Services on small stand-ins for the other services."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any, cast

import pytest

from cfepy.config import PlatformConfig
from cfepy.msg import command
from cfepy.status import OS_FS_ERR_PATH_INVALID, OsalError
from cfepy.tbl import TableImage, TableServices, build, packets

TBL_APP_ID = 0x110005
APPS = {TBL_APP_ID: "CFE_TBL", 0x110006: "APP", 0x110007: "OTHER"}
NOW = (1001000, 0x80000000)


class Bench:
    """One TableServices with everything around it that a test wants to look at."""

    def __init__(self, **limits: int) -> None:
        self.events: list[tuple[int, int, str]] = []
        self.log: list[str] = []
        self.sent: list[bytes] = []
        self.claims: list[tuple[str, str, int]] = []
        self.files: dict[str, bytes] = {}
        self.kernel = cast(Any, SimpleNamespace(current=SimpleNamespace(owner=None)))
        ports = SimpleNamespace(
            es=SimpleNamespace(get_app_name=APPS.__getitem__),
            syslog=SimpleNamespace(write_to_sys_log=self.log.append),
            evs=SimpleNamespace(
                send_event=lambda event_id, kind, text: self.events.append((event_id, kind, text)),
                send_event_with_app_id=lambda event_id, kind, app, text: self.events.append((event_id, kind, text)),
            ),
            sb=SimpleNamespace(transmit_msg=self.sent.append),
            time=SimpleNamespace(now=lambda: NOW),
            memory=SimpleNamespace(claim=lambda owner, kind, size: self.claims.append((owner, kind, size))),
        )
        config = PlatformConfig().with_limits(dict(limits))
        self.tbl = TableServices(self.kernel, cast(Any, ports), config, self)
        self.tbl.registry.services_app_id = TBL_APP_ID
        self.as_app("APP")

    def read_file(self, path: str) -> bytes:
        if path not in self.files:
            raise OsalError(OS_FS_ERR_PATH_INVALID, path)
        return self.files[path]

    def write_file(self, path: str, data: bytes) -> None:
        if not path.startswith("/"):
            raise OsalError(OS_FS_ERR_PATH_INVALID, path)
        self.files[path] = data

    def exists(self, path: str) -> bool:
        return path in self.files

    def as_app(self, name: str | None) -> None:
        """The next calls come from this app."""
        app_id = next((app_id for app_id in APPS if APPS[app_id] == name), 0)
        self.kernel.current.owner = SimpleNamespace(app_id=app_id, name=name, is_core=False) if name else None

    def ground(self, fcn_code: int, payload: bytes = b"") -> None:
        """A command from the ground, handled in the CFE_TBL task."""
        before = self.kernel.current.owner
        self.as_app("CFE_TBL")
        self.tbl.task.handle(bytes(command(packets.CMD_MID, fcn_code, payload)))
        self.kernel.current.owner = before

    def named(self, fcn_code: int, name: str) -> None:
        """A ground command that carries a table's name."""
        self.ground(fcn_code, packets.NAME_COMMAND.pack(TableName=name))

    def send_hk(self) -> dict[str, Any]:
        """Ask for housekeeping; returns its fields."""
        self.sent.clear()
        self.tbl.task.handle(bytes(command(packets.SEND_HK_MID, 0)))
        return packets.HOUSEKEEPING.unpack(self.sent[0][16:])

    def put(self, path: str, name: str, data: bytes, offset: int = 0) -> None:
        """A table file."""
        self.files[path] = build(TableImage(name, data, "test", offset))

    def take_events(self) -> list[tuple[int, int, str]]:
        """The events since the last time."""
        events = list(self.events)
        self.events.clear()
        return events


@pytest.fixture
def bench() -> Bench:
    return Bench()
