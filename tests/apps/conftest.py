"""An app's handle on stand-ins: real Table Services and pools, and a script instead of a bus."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from cfepy.es import APP_EXIT
from cfepy.es.pools import MemPool, PoolBlock
from cfepy.msg import command
from cfepy.status import CFE_SB_BAD_ARGUMENT, OS_ERROR, CfeError, OsalError
from tests.tbl.conftest import Bench

APPS = Path(__file__).parents[2] / "apps"
POOL_ID = 0x140003
PIPE_ID = 0x160001
Step = bytes | None | Callable[[], object]


class Ended(BaseException):
    """Raised by exit_app to end the app's task."""


class AppBench(Bench):
    """Runs one app's main function in the host, through a script of messages.

    Attributes:
        cfe: the handle for the app.
        refuse: function names ("sb.subscribe") with the statuses that they fail with.
        subscriptions: current MsgIds of subscriptions.
        exit_status: status with which the app ended.
        symbols: functions of libraries, by name.
    """

    def __init__(self, name: str) -> None:
        super().__init__()
        self.refuse: dict[str, int] = {}
        self.subscriptions: set[int] = set()
        self.exit_status: int | None = None
        self.pool: MemPool | None = None
        self.printed: list[str] = []
        self.symbols: dict[str, object] = {}
        self._script: list[Step] = []
        self.cfe: Any = SimpleNamespace(
            es=SimpleNamespace(
                run_loop=lambda status=1: status == 1 and bool(self._script),
                exit_app=self._exit,
                write_to_sys_log=self.log.append,
                pool_create=self._pool_create,
                get_pool_buf=self._get_pool_buf,
                put_pool_buf=self._put_pool_buf,
                perf_log_entry=lambda marker: None,
                perf_log_exit=lambda marker: None,
            ),
            os=SimpleNamespace(symbol_lookup=self._symbol),
            sb=SimpleNamespace(
                create_pipe=self._create_pipe,
                subscribe=self._subscribe,
                unsubscribe=lambda msg_id, pipe: self.subscriptions.discard(msg_id),
                transmit_msg=self._transmit,
                receive_buffer=self._receive,
            ),
            evs=SimpleNamespace(
                register=lambda: self._check("evs.register"),
                send_dbg=lambda event_id, text: self.events.append((event_id, 1, text)),
                send_info=lambda event_id, text: self.events.append((event_id, 2, text)),
                send_err=lambda event_id, text: self.events.append((event_id, 3, text)),
                send_crit=lambda event_id, text: self.events.append((event_id, 4, text)),
            ),
            tbl=self.tbl,
        )
        self.kernel.current.owner = SimpleNamespace(app_id=0x110006, name=name, is_core=False)
        for table in APPS.glob("*/tables/*.tbl"):
            self.files[f"/cf/{table.name}"] = table.read_bytes()

    def run(self, main: Callable[[Any], None], *script: Step) -> None:
        """Run an app until the script is over: bytes are received, None is a timeout, functions are called between."""
        self._script = list(script) or [None]
        with pytest.raises(Ended):
            main(self.cfe)

    def _check(self, function: str) -> None:
        if function in self.refuse:
            raise CfeError(self.refuse[function], "the test says so")

    def _exit(self, status: int = APP_EXIT) -> None:
        self.exit_status = status
        raise Ended

    def _symbol(self, name: str) -> object:
        if name not in self.symbols:
            raise OsalError(OS_ERROR, f"no library has {name}")
        return self.symbols[name]

    def _pool_create(self, size: int) -> int:
        self._check("es.pool_create")
        self.pool = MemPool("APP", size)
        return POOL_ID

    def _get_pool_buf(self, pool_id: int, size: int) -> PoolBlock:
        self._check("es.get_pool_buf")
        assert self.pool is not None
        return self.pool.get(size)

    def _put_pool_buf(self, pool_id: int, block: PoolBlock) -> int:
        self._check("es.put_pool_buf")
        assert self.pool is not None
        return self.pool.put(block)

    def _create_pipe(self, depth: int, name: str) -> int:
        self._check("sb.create_pipe")
        return PIPE_ID

    def _subscribe(self, msg_id: int, pipe: int) -> None:
        self._check("sb.subscribe")
        self._check_pipe(pipe)
        self.subscriptions.add(msg_id)

    def _receive(self, pipe: int, timeout_ms: int) -> bytes | None:
        self._check("sb.receive_buffer")
        while self._script and callable(self._script[0]):
            self._script.pop(0)()  # type: ignore[operator,misc]
        step = self._script.pop(0) if self._script else None
        self._check_pipe(pipe)
        assert step is None or isinstance(step, bytes)
        return step

    def _check_pipe(self, pipe: int) -> None:
        if pipe != PIPE_ID:
            raise CfeError(CFE_SB_BAD_ARGUMENT, "no such pipe")

    def _transmit(self, packet: bytes) -> None:
        self._check("sb.transmit_msg")
        self.sent.append(bytes(packet))


def cmd(msg_id: int, fcn_code: int = 0, payload: bytes = b"") -> bytes:
    """Return a command packet."""
    return bytes(command(msg_id, fcn_code, payload))
