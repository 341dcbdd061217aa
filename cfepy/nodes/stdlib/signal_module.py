"""`signal` and `atexit` of a node, with its own handlers and exit hooks. Signals come from `os.kill` with its own
process number, `signal.raise_signal`, or the universe's owner, never from the host's terminal.
"""

from __future__ import annotations

import signal
from collections.abc import Callable
from types import ModuleType
from typing import TYPE_CHECKING, Any

from cfepy.interpreter.node_interrupt import NodeInterrupt
from cfepy.nodes.made_modules import made, proxy
from cfepy.nodes.refused_modules import SIGNALS, refusal

if TYPE_CHECKING:
    from cfepy.nodes.universe import Universe

_REFUSED = ("alarm", "setitimer", "sigwait", "sigwaitinfo", "sigtimedwait")
_NO_EFFECT = ("siginterrupt", "pthread_sigmask", "pthread_kill")
_HARMLESS = frozenset({"SIGCHLD", "SIGCONT", "SIGURG", "SIGWINCH"})


class SignalTable:
    """Signal handlers of one node.

    Args:
        universe: universe of the node.
    """

    def __init__(self, universe: Universe) -> None:
        self._universe = universe
        self._handlers: dict[int, Any] = {int(signal.SIGINT): signal.default_int_handler}

    def set(self, number: int, handler: Any) -> Any:
        """`signal.signal`: returns the former handler.

        Raises:
            ValueError: the caller is not the node's main thread, as CPython has it.
            TypeError: that is not a handler.
        """
        self._check_thread("signal")
        if not callable(handler) and handler not in (signal.SIG_DFL, signal.SIG_IGN):
            raise TypeError("signal handler must be signal.SIG_IGN, signal.SIG_DFL, or a callable object")
        former = self.get(number)
        self._handlers[int(number)] = handler
        return former

    def set_wakeup_fd(self, fd: int, **options: Any) -> int:
        """`signal.set_wakeup_fd`: has no effect, because no signal comes from the host; raises as `set` does."""
        self._check_thread("set_wakeup_fd")
        return -1

    def _check_thread(self, function: str) -> None:
        if self._universe.kernel.current is not self._universe.main_task:
            raise ValueError(f"{function} only works in main thread of the main interpreter")

    def get(self, number: int) -> Any:
        """`signal.getsignal`."""
        return self._handlers.get(int(signal.Signals(number)), signal.SIG_DFL)

    def handlers(self) -> list[Any]:
        """All that were set."""
        return list(self._handlers.values())

    def deliver(self, number: int) -> None:
        """Handle a signal in the calling task."""
        handler = self.get(number)
        if handler is signal.default_int_handler:
            raise NodeInterrupt
        if callable(handler):
            handler(int(number), None)
        elif handler == signal.SIG_DFL and signal.Signals(number).name not in _HARMLESS:
            self._universe.exit_now(128 + number)


def signal_module(universe: Universe) -> ModuleType:
    """Return the module `signal` of a universe."""
    table = universe.signals
    refused = {name: refusal(universe, f"signal.{name}", SIGNALS) for name in _REFUSED if hasattr(signal, name)}
    ignored: dict[str, Any] = {name: lambda *args: None for name in _NO_EFFECT if hasattr(signal, name)}
    return proxy(
        signal,
        **refused,
        **ignored,
        getsignal=table.get,
        pause=lambda: universe.clock.wait(None),
        raise_signal=table.deliver,
        set_wakeup_fd=table.set_wakeup_fd,
        signal=table.set,
    )


def atexit_module(universe: Universe) -> ModuleType:
    """Return the module `atexit` of a universe."""
    hooks = universe.exit_hooks

    def register(function: Callable[..., Any], *args: Any, **options: Any) -> Callable[..., Any]:
        hooks.append((function, args, options))
        return function

    def unregister(function: Callable[..., Any]) -> None:
        hooks[:] = [hook for hook in hooks if hook[0] != function]

    return made(
        "atexit",
        _clear=hooks.clear,
        _ncallbacks=lambda: len(hooks),
        _run_exitfuncs=universe.run_exit_hooks,
        register=register,
        unregister=unregister,
    )
