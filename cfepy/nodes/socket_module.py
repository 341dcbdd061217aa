"""`socket` of a node: sockets on the mission's network while that is joined to this computer's, names otherwise.

In virtual time nobody outside could answer, so a socket is refused there; `--realtime` joins the networks. The pair of
`socketpair` needs no network and is always there.
"""

from __future__ import annotations

import socket
from types import ModuleType
from typing import TYPE_CHECKING, Any

from cfepy.nodes.refused import NETWORK, refusal
from cfepy.nodes.socket_names import LOCAL, name_functions
from cfepy.nodes.socket_type import NodeSocket
from cfepy.nodes.synth import rebind
from cfepy.osal.endpoints import Place, Stream
from cfepy.osal.network import Network

if TYPE_CHECKING:
    from cfepy.nodes.universe import Universe

_REFUSED = ("fromfd", "fromshare", "send_fds", "recv_fds", "sethostname")
_REBOUND = ("create_connection", "create_server", "has_dualstack_ipv6")


def socket_module(universe: Universe) -> ModuleType:
    """The modules `socket` and `_socket` of a universe."""
    known = universe.importer.modules.get("socket")
    if known is not None:
        return known
    table = universe.sockets
    own = type("socket", (NodeSocket,), {"universe": universe, "__module__": "socket"})

    def set_default(timeout: float | None) -> None:
        table.default_timeout = timeout

    def socketpair(family: Any = None, type: int = socket.SOCK_STREAM, proto: int = 0) -> tuple[Any, Any]:
        near, far = _pair()
        return tuple(own.joined(end, Network(), socket.AF_INET) for end in (near, far))  # type: ignore[attr-defined]

    return rebind(
        socket,
        only=_REBOUND,
        **name_functions(universe.host_name),
        **{name: refusal(universe, f"socket.{name}", NETWORK) for name in _REFUSED if hasattr(socket, name)},
        SocketType=own,
        getdefaulttimeout=lambda: table.default_timeout,
        if_nameindex=lambda: [(1, "lo")],
        setdefaulttimeout=set_default,
        socket=own,
        socketpair=socketpair,
    )


def _pair() -> tuple[Stream, Stream]:
    """Two streams that are connected with each other."""
    place = Place(LOCAL, 0)
    near, far = Stream(place, place), Stream(place, place)
    near.other, far.other = far, near
    return near, far
