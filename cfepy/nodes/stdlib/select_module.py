"""`select` of a node: waiting for its sockets and keyboard. Without descriptors it sleeps.

Host files are refused, because a file is always readable. Other descriptors do not exist.
"""

from __future__ import annotations

import errno
import select
from collections.abc import Callable, Sequence
from types import ModuleType
from typing import TYPE_CHECKING, Any

from cfepy.nodes.made_modules import proxy
from cfepy.nodes.refused_modules import NETWORK, refusal
from cfepy.nodes.stdlib.descriptors import FIRST_DESCRIPTOR
from cfepy.nodes.stdlib.socket_module import NodeSocket, await_endpoints
from cfepy.nodes.stdlib.socket_names import failure
from cfepy.nodes.stdlib.streams import STDIN, descriptor
from cfepy.osal import Stream

if TYPE_CHECKING:
    from cfepy.nodes.universe import Universe

POLLIN, POLLPRI, POLLOUT, POLLHUP = 1, 2, 4, 16  # as on Linux and macOS; Windows has no `poll`
_READ = POLLIN | POLLPRI
_MS = 1e-3


class Waiter:
    """Waits for descriptors of one node.

    Args:
        universe: universe of the node.
    """

    def __init__(self, universe: Universe) -> None:
        self._universe = universe

    def events(self, fd: int, mask: int) -> int:
        """Return which events of `mask` a descriptor has now; POLLHUP is always reported.

        Raises:
            RefusedError: if the descriptor is a file.
            ValueError: if it is negative, such as `fileno()` of a closed socket.
            OSError: EBADF, if it belonged to a socket that is closed now.
        """
        if fd == STDIN:
            terminal = self._universe.terminal
            return mask & POLLIN if terminal is not None and terminal.ready else 0
        endpoint = self._socket(fd).endpoint
        found = mask & POLLIN * endpoint.readable | mask & POLLOUT * endpoint.writable
        gone = isinstance(endpoint, Stream) and endpoint.ended and (endpoint.write_shut or endpoint.other is None)
        return found | (POLLHUP if gone else 0)

    def wait(self, fds: Sequence[int], ready: Callable[[], bool], seconds: float | None) -> bool:
        """Wait until `ready` returns true; it is checked again at each event of a descriptor.

        Args:
            fds: the descriptors.
            ready: returns whether the wait is over.
            seconds: longest wait in seconds; None for no limit.

        Returns:
            False if the time elapsed first.
        """
        terminal = self._universe.terminal
        waits = terminal.waits if terminal is not None and STDIN in fds else None
        endpoints = [self._socket(fd).endpoint for fd in fds if fd != STDIN]
        return await_endpoints(self._universe, endpoints, ready, seconds, waits)

    def _socket(self, fd: int) -> NodeSocket:
        found = self._universe.sockets.find(fd)
        if found is not None:
            return found
        if fd < 0:
            raise ValueError(f"file descriptor cannot be a negative integer ({fd})")
        if fd >= FIRST_DESCRIPTOR:
            raise failure(errno.EBADF)
        return refusal(self._universe, "waiting for files", NETWORK)()


class Poll:
    """`select.poll`.

    Args:
        waiter: of the node.
    """

    def __init__(self, waiter: Waiter) -> None:
        self._waiter = waiter
        self._masks: dict[int, int] = {}

    def register(self, fd: Any, eventmask: int = _READ | POLLOUT) -> None:
        """Watch a descriptor from now on."""
        self._masks[descriptor(fd)] = eventmask

    def modify(self, fd: Any, eventmask: int) -> None:
        """Change the requested events."""
        if descriptor(fd) not in self._masks:
            raise failure(errno.ENOENT)
        self._masks[descriptor(fd)] = eventmask

    def unregister(self, fd: Any) -> None:
        """Stop watching a descriptor."""
        del self._masks[descriptor(fd)]

    def poll(self, timeout: float | None = None) -> list[tuple[int, int]]:
        """Wait at most so many ms, without limit for None or a negative number; returns descriptors and their
        events.
        """
        return self._wait(None if timeout is None or timeout < 0 else timeout * _MS)

    def _wait(self, seconds: float | None) -> list[tuple[int, int]]:
        self._waiter.wait(list(self._masks), lambda: bool(self._found()), seconds)
        return self._found()

    def _found(self) -> list[tuple[int, int]]:
        return [(fd, true) for fd, mask in self._masks.items() if (true := self._waiter.events(fd, mask))]


class Epoll(Poll):
    """`select.epoll`; its events have the numbers of `poll`."""

    def __init__(self, waiter: Waiter, sizehint: int = -1, flags: int = 0) -> None:
        super().__init__(waiter)
        self.closed = False

    def __enter__(self) -> Epoll:
        return self

    def __exit__(self, *error: object) -> None:
        self.close()

    def close(self) -> None:
        """Close it and stop watching all descriptors."""
        self.closed = True
        self._masks.clear()

    def poll(self, timeout: float | None = None, maxevents: int = -1) -> list[tuple[int, int]]:
        """Wait at most so many seconds, without limit for None or a negative number."""
        found = self._wait(None if timeout is None or timeout < 0 else timeout)
        return found if maxevents < 0 else found[:maxevents]


class _Kind:
    """Makes objects of a class with the waiter of one universe. `selectors` stores it as a class attribute, where a
    function would become a method, as would a `functools.partial` from Python 3.14 on.
    """

    def __init__(self, made: Callable[..., Any], waiter: Waiter) -> None:
        self._made, self._waiter = made, waiter

    def __call__(self, *args: Any, **options: Any) -> Any:
        return self._made(self._waiter, *args, **options)


def select_module(universe: Universe) -> ModuleType:
    """Return the module `select` of a universe."""
    waiter = Waiter(universe)

    def wait(
        rlist: Sequence[Any], wlist: Sequence[Any], xlist: Sequence[Any], timeout: float | None = None
    ) -> tuple[list[Any], list[Any], list[Any]]:
        if timeout is not None and timeout < 0:
            raise ValueError("timeout must be non-negative")
        wanted = [(each, descriptor(each), mask) for each, mask in _with_masks(rlist, wlist)]

        def found(mask: int) -> list[Any]:
            return [each for each, fd, asked in wanted if asked == mask and waiter.events(fd, asked)]

        fds = list(dict.fromkeys(fd for _, fd, _ in wanted))
        waiter.wait(fds, lambda: any(waiter.events(fd, mask) for _, fd, mask in wanted), timeout)
        return found(POLLIN), found(POLLOUT), []

    kqueues = {name: refusal(universe, f"select.{name}", NETWORK) for name in ("kqueue", "devpoll")}
    return proxy(
        select,
        select=wait,
        poll=_Kind(Poll, waiter),
        epoll=_Kind(Epoll, waiter),
        **{name: refuse for name, refuse in kqueues.items() if hasattr(select, name)},
    )


def _with_masks(rlist: Sequence[Any], wlist: Sequence[Any]) -> list[tuple[Any, int]]:
    return [*((each, POLLIN) for each in rlist), *((each, POLLOUT) for each in wlist)]
