"""Joinable threads, which `threading` is built on from Python 3.13 on: `_thread.start_joinable_thread`, and handles."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from cfepy.nodes.universe import Universe


class ThreadHandle:
    """A thread that can be joined.

    Args:
        gate: a fresh lock of the universe; it is held until the thread is done.
        ident: of a thread that runs already.
    """

    def __init__(self, gate: Any, ident: int | None = None) -> None:
        self.ident = ident
        self._done = False
        self._gate = gate
        gate.acquire()

    def is_done(self) -> bool:
        """Whether the thread has ended."""
        return self._done

    def _set_done(self) -> None:
        if not self._done:
            self._done = True
            self._gate.release()

    def join(self, timeout: float | None = None) -> None:
        """Wait for the end, at most `timeout` seconds."""
        if not self._done and self._gate.acquire(True, -1 if timeout is None or timeout < 0 else timeout):
            self._gate.release()


def handle_names(universe: Universe, start: Callable[..., int], lock: Callable[[], Any]) -> dict[str, Any]:
    """What the module `_thread` has besides from Python 3.13 on."""
    waited_for: list[ThreadHandle] = []

    def new_handle() -> ThreadHandle:
        return ThreadHandle(lock())

    def start_joinable(
        function: Callable[[], object], handle: ThreadHandle | None = None, daemon: bool = True
    ) -> ThreadHandle:
        thread = handle if handle is not None else new_handle()

        def run() -> None:
            thread.ident = universe.kernel.current.ident
            try:
                function()
            finally:
                thread._set_done()

        thread.ident = start(run)
        if not daemon:
            waited_for.append(thread)
        return thread

    def shutdown() -> None:
        while waited_for:
            waited_for.pop(0).join()

    return {
        "_ThreadHandle": new_handle,
        "_get_main_thread_ident": lambda: universe.main_ident,
        "_make_thread_handle": lambda ident: ThreadHandle(lock(), ident),
        "_shutdown": shutdown,
        "start_joinable_thread": start_joinable,
    }
