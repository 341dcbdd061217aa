"""The open files of a program, which are written out and closed when it ends, and its sockets by descriptor.

Left to the garbage collector, the parts of a file would be closed in any order, and the rest of its buffer lost.
Sockets need a network to be opened on; without one they are refused.
"""

from __future__ import annotations

import os
from collections.abc import Callable
from contextlib import suppress
from itertools import count
from typing import IO, TYPE_CHECKING, Any
from weakref import WeakValueDictionary

from cfepy.nodes.refused import NETWORK, refusal

if TYPE_CHECKING:
    from cfepy.nodes.stdlib.socket_module import NodeSocket
    from cfepy.nodes.universe import Universe
    from cfepy.osal import Network

_PATHS = (str, bytes, os.PathLike)
FIRST_DESCRIPTOR = 1000  # above those that the host gives to the files of a node


class OpenFiles:
    """The open files of one program.

    Args:
        resolve: makes a path of the program one of the computer.
    """

    def __init__(self, resolve: Callable[[Any], str]) -> None:
        self._resolve = resolve
        self._files: WeakValueDictionary[int, IO[Any]] = WeakValueDictionary()
        self._numbers = count()

    def opener(self) -> Callable[..., IO[Any]]:
        """The program's `open`, with paths relative to its working directory."""

        def open_file(file: Any, *args: Any, **options: Any) -> IO[Any]:
            opened: IO[Any] = open(self._resolve(file) if isinstance(file, _PATHS) else file, *args, **options)  # noqa: SIM115
            self._files[next(self._numbers)] = opened
            return opened

        return open_file

    def close_all(self) -> None:
        """The program has ended; a full disk is not its problem any more."""
        for opened in list(self._files.values()):
            with suppress(OSError, ValueError):
                opened.close()


class SocketTable:
    """The open sockets of a node, by descriptor.

    Args:
        universe: the node's.
        network: the mission's; None where there is none.

    Attributes:
        default_timeout: `socket.getdefaulttimeout`, in s.
    """

    def __init__(self, universe: Universe, network: Network | None) -> None:
        self.default_timeout: float | None = None
        self._universe = universe
        self._network = network
        self._open: dict[int, NodeSocket] = {}
        self._next = FIRST_DESCRIPTOR

    def network(self, what: str) -> Network:
        """The network to plug a socket into.

        Args:
            what: the function that was called.

        Raises:
            RefusedError: the network is not joined to another one.
        """
        if self._network is None or self._network.dial is None:
            refusal(self._universe, what, NETWORK)()
        return self._network

    def find(self, fd: int) -> NodeSocket | None:
        """The socket with a descriptor."""
        return self._open.get(fd)

    def add(self, opened: NodeSocket) -> int:
        """Give a socket its descriptor."""
        fd, self._next = self._next, self._next + 1
        self._open[fd] = opened
        return fd

    def remove(self, fd: int) -> None:
        """Forget a socket that is closed."""
        self._open.pop(fd, None)

    def close_all(self) -> None:
        """The program has ended."""
        for opened in list(self._open.values()):
            opened._real_close()
