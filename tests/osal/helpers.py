"""Common parts of OSAL tests: an Osal on a kernel, and tasks that run to their end."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from cfepy.config.platform import PlatformConfig
from cfepy.osal import Osal
from cfepy.rtos import Kernel
from cfepy.trace import Trace
from cfepy.writing.console import Console

MS = 1_000_000


class Ledger:
    """Counts memory, as a board's budget does."""

    def __init__(self, free: int) -> None:
        self.free: int | None = free
        self._claims: list[int] = [0]

    def claim(self, owner: str, kind: str, size: int) -> int:
        """Take some."""
        assert self.free is not None
        self.free -= size
        self._claims.append(size)
        return len(self._claims) - 1

    def release(self, token: int) -> None:
        """Give it back."""
        assert self.free is not None
        self.free += self._claims[token]
        self._claims[token] = 0


class Bench:
    """One kernel with an Osal on it."""

    def __init__(self, **setup: Any) -> None:
        self.kernel = Kernel(setup.pop("context", "thread"), Trace())
        self.console = Console(quiet=True)
        self.os = Osal(self.kernel, setup.pop("config", PlatformConfig()), self.console, **setup)
        self.log: list[Any] = []

    def task(self, body: Callable[[], object], priority: int = 100, name: str = "", owner: Any = None) -> int:
        """Start an OSAL task. Its default name is the function's."""
        return self.os.task_create(name or body.__name__, body, 4096, priority, owner=owner)

    def run(self, body: Callable[[], object], until_ms: int = 60_000) -> Any:
        """Run `body` in a task called MAIN until the run is over. Returns the result of `body`."""
        results: list[Any] = []
        self.task(lambda: results.append(body()), name="MAIN")
        self.kernel.run(until_ns=until_ms * MS)
        assert results, "the task did not come to its end"
        return results[0]
