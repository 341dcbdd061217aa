"""Sockets of a program, by descriptor. Sockets are refused if there is no network for them."""

from __future__ import annotations

from typing import TYPE_CHECKING

from cfepy.nodes.refused_modules import NETWORK, refusal

if TYPE_CHECKING:
    from cfepy.nodes.stdlib.socket_module import NodeSocket
    from cfepy.nodes.universe import Universe
    from cfepy.osal import Network

FIRST_DESCRIPTOR = 1000  # above those that the host gives to the files of a node


class SocketTable:
    """Open sockets of a node, by descriptor.

    Args:
        universe: universe of the node.
        network: network of the mission; None if there is none.

    Attributes:
        default_timeout: `socket.getdefaulttimeout`, in seconds; None for no limit.
    """

    def __init__(self, universe: Universe, network: Network | None) -> None:
        self.default_timeout: float | None = None
        self._universe = universe
        self._network = network
        self._open: dict[int, NodeSocket] = {}
        self._next = FIRST_DESCRIPTOR

    def network(self, what: str) -> Network:
        """Return the network for a socket.

        Args:
            what: name of the called function, for the error.

        Raises:
            RefusedError: if there is no network, or it is not joined to another one.
        """
        if self._network is None or self._network.dial is None:
            refusal(self._universe, what, NETWORK)()
        return self._network

    def find(self, fd: int) -> NodeSocket | None:
        """Return the socket with a descriptor."""
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
        """Close all sockets at the end of the program."""
        for opened in list(self._open.values()):
            opened._real_close()
