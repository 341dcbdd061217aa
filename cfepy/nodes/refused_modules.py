"""Modules that a node on the simulated computer cannot use: processes, and sockets in virtual time.

The modules can be loaded, because many programs load them without need; the error at first use gives an alternative. A
flight computer with an RTOS has no processes either.
"""

from __future__ import annotations

import os
import sys
from collections.abc import Callable
from types import FrameType, ModuleType
from typing import TYPE_CHECKING, NoReturn

from cfepy.nodes.made_modules import made, proxy
from cfepy.nodes.node_tracebacks import is_hidden

if TYPE_CHECKING:
    from cfepy.nodes.universe import Universe

_LIBRARIES = os.path.dirname(os.__file__)

NETWORK = (
    "run the mission with --realtime, which joins it to this computer's network, or let nodes talk through topics and "
    "services"
)
PROCESS = "start a thread (threading.Thread), or list the program as a node of its own in the mission"
SIGNALS = "use threading.Timer"
ENCRYPTION = "it takes entropy and a clock from outside; talk without encryption, or through topics and services"
_MULTIPROCESSING_ERRORS = ("AuthenticationError", "BufferTooShort", "ProcessError", "TimeoutError")


class RefusedError(OSError):
    """Error for something that the simulated computer does not have; the text gives an alternative.

    Args:
        what: the function or class.
        advice: the alternative.
        node: the caller.
    """

    def __init__(self, what: str, advice: str, node: str = "") -> None:
        asked = f" (node {node}, {_caller()})" if node else ""
        super().__init__(f"{what} is not available on the simulated computer; {advice}{asked}")


def _caller() -> str:
    """Return file and line of the node's code that is being executed, ignoring libraries."""
    frame: FrameType | None = sys._getframe(1)
    innermost = ""
    while frame is not None:
        file = frame.f_code.co_filename
        if not is_hidden(file):
            innermost = innermost or f"{file}:{frame.f_lineno}"
            if not file.startswith(_LIBRARIES):
                return f"{file}:{frame.f_lineno}"
        frame = frame.f_back
    return innermost


def refusal(universe: Universe, what: str, advice: str) -> Callable[..., NoReturn]:
    """Return a callable that refuses whatever it is called with."""

    def refuse(*args: object, **options: object) -> NoReturn:
        raise RefusedError(what, advice, universe.name)

    return refuse


def refused_class(universe: Universe, module: str, name: str, advice: str) -> type:
    """Return a class that can be named, derived from and tested against, but has no instances."""
    return type(name, (), {"__init__": refusal(universe, f"{module}.{name}", advice), "__module__": module})


def refused_import(name: str, advice: str) -> Callable[[Universe], ModuleType]:
    """Return the factory of a module that cannot be loaded at all; libraries that try it handle the ImportError."""

    def factory(universe: Universe) -> ModuleType:
        raise ModuleNotFoundError(f"{name} is not available on the simulated computer; {advice}", name=name)

    return factory


def subprocess_module(universe: Universe) -> ModuleType:
    """`subprocess`: its constants and errors; it cannot start anything."""
    import subprocess

    functions = ("run", "call", "check_call", "check_output", "getoutput", "getstatusoutput")
    return proxy(
        subprocess,
        Popen=refused_class(universe, "subprocess", "Popen", PROCESS),
        **{name: refusal(universe, f"subprocess.{name}", PROCESS) for name in functions},
    )


def multiprocessing_module(universe: Universe) -> ModuleType:
    """`multiprocessing`: every name can be loaded, but a processor has one core and no processes."""
    import multiprocessing

    def lookup(name: str) -> object:
        if name.startswith("__"):
            raise AttributeError(name)
        if name[0].isupper():  # programs derive from Process and test against Queue
            return vars(module).setdefault(name, refused_class(universe, "multiprocessing", name, PROCESS))
        return refusal(universe, f"multiprocessing.{name}", PROCESS)

    errors = {name: getattr(multiprocessing, name) for name in _MULTIPROCESSING_ERRORS}
    module = made("multiprocessing", __path__=[], __getattr__=lookup, cpu_count=lambda: 1, **errors)
    return module


def multiprocessing_submodule(universe: Universe) -> ModuleType:
    """`multiprocessing.managers`, `.shared_memory` and so on."""
    return made("multiprocessing", __getattr__=universe.importer.load("multiprocessing").__getattr__)


def pool_module(universe: Universe) -> ModuleType:
    """`multiprocessing.pool`, with threads."""
    return universe.importer.load_file(
        "multiprocessing.pool", os.path.join(os.path.dirname(__file__), "stdlib", "thread_pool.py")
    )


def dummy_module(name: str) -> Callable[[Universe], ModuleType]:
    """Return the factory of `multiprocessing.dummy`, threads under the names of processes, or of its part
    `connection`.
    """

    def factory(universe: Universe) -> ModuleType:
        folder = os.path.join(_LIBRARIES, "multiprocessing", "dummy")
        part = name.partition("dummy.")[2]
        file = os.path.join(folder, f"{part or '__init__'}.py")
        return universe.importer.load_file(name, file, None if part else folder)

    return factory
