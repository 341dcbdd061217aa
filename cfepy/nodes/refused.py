"""What a node on the simulated computer cannot have: real sockets and processes, refused by name.

The modules can be imported, because many programs import them without need; the first use says what to do instead.
A flight computer under an RTOS has no processes either.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from types import ModuleType
from typing import TYPE_CHECKING, Any, NoReturn

from cfepy.nodes.synth import made, proxy

if TYPE_CHECKING:
    from cfepy.nodes.universe import Universe

NETWORK = "let nodes talk through topics and services; a cFE application can pass on bytes from outside"
PROCESS = "start a thread (threading.Thread), or list the program as a node of its own in the mission"
SIGNALS = "use threading.Timer"


class RefusedError(OSError):
    """A node asked for something that the simulated computer does not have; the text says what to do instead."""

    def __init__(self, what: str, advice: str) -> None:
        super().__init__(f"{what} is not available on the simulated computer; {advice}")


def refusal(what: str, advice: str) -> Callable[..., NoReturn]:
    """A callable that refuses whatever it is called with."""

    def refuse(*args: object, **options: object) -> NoReturn:
        raise RefusedError(what, advice)

    return refuse


def refused_class(module: str, name: str, advice: str) -> type:
    """A class that can be named, derived from and tested against, but has no instances."""
    return type(name, (), {"__init__": refusal(f"{module}.{name}", advice), "__module__": module})


def refused_import(name: str, advice: str) -> Callable[[Universe], ModuleType]:
    """The factory of a module that cannot even be imported; libraries that try it cope with ImportError."""

    def factory(universe: Universe) -> ModuleType:
        raise ModuleNotFoundError(f"{name} is not available on the simulated computer; {advice}", name=name)

    return factory


def socket_module(universe: Universe) -> ModuleType:
    """`socket`: its constants and errors, the host's own name; no connections."""
    import socket

    functions = ("create_connection", "create_server", "socketpair", "fromfd", "getaddrinfo", "gethostbyaddr")
    module = proxy(
        socket,
        socket=refused_class("socket", "socket", NETWORK),
        SocketType=refused_class("socket", "socket", NETWORK),
        gethostname=lambda: universe.host_name,
        getfqdn=lambda name="": name or universe.host_name,
        gethostbyname=lambda name: "127.0.0.1",
    )
    vars(module).update({name: refusal(f"socket.{name}", NETWORK) for name in functions})
    return module


def select_module(universe: Universe) -> ModuleType:
    """`select`: waiting for nothing, or for a key press that never comes, is sleeping; anything else is a socket."""
    import select

    def wait(
        readers: Sequence[Any], writers: Sequence[Any], others: Sequence[Any], timeout: float | None = None
    ) -> tuple[list[Any], list[Any], list[Any]]:
        if writers or any(reader is not universe.stdin and reader != 0 for reader in readers):
            raise RefusedError("select.select() on files or sockets", NETWORK)
        universe.clock.wait(timeout)
        return [], [], []

    names = ("poll", "epoll", "kqueue", "devpoll")
    return proxy(select, select=wait, **{name: refusal(f"select.{name}", NETWORK) for name in names})


def subprocess_module(universe: Universe) -> ModuleType:
    """`subprocess`: its constants and errors; nothing can be started."""
    import subprocess

    functions = ("run", "call", "check_call", "check_output", "getoutput", "getstatusoutput")
    return proxy(
        subprocess,
        Popen=refused_class("subprocess", "Popen", PROCESS),
        **{name: refusal(f"subprocess.{name}", PROCESS) for name in functions},
    )


def multiprocessing_module(universe: Universe) -> ModuleType:
    """`multiprocessing`: every name can be imported; a processor has one core and no processes."""

    def lookup(name: str) -> object:
        if name.startswith("__"):
            raise AttributeError(name)
        return refusal(f"multiprocessing.{name}", PROCESS)

    return made("multiprocessing", __path__=[], __getattr__=lookup, cpu_count=lambda: 1)


def multiprocessing_submodule(universe: Universe) -> ModuleType:
    """`multiprocessing.pool`, `.shared_memory` and so on."""
    return made("multiprocessing", __getattr__=multiprocessing_module(universe).__getattr__)
