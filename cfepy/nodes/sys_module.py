"""`sys`, `builtins` and `io` of a node: its own arguments, module table, search path, streams and import."""

from __future__ import annotations

import builtins
import io
import sys
from types import ModuleType
from typing import TYPE_CHECKING, Any

from cfepy.nodes.ordered_set import SET_NAME, OrderedSet
from cfepy.nodes.report import traceback_text
from cfepy.nodes.synth import made, proxy

if TYPE_CHECKING:
    from cfepy.nodes.universe import Universe


def sys_module(universe: Universe) -> ModuleType:
    """The module `sys` of a universe. Settings of the interpreter are accepted and change nothing."""

    def excepthook(kind: type[BaseException], error: BaseException, where: object) -> None:
        universe.print_error(traceback_text(error))

    nothing: dict[str, Any] = {name: lambda *args: None for name in ("setrecursionlimit", "setswitchinterval")}
    return proxy(
        sys,
        **nothing,
        __excepthook__=excepthook,
        __stderr__=universe.stderr,
        __stdin__=universe.stdin,
        __stdout__=universe.stdout,
        argv=universe.argv,
        excepthook=excepthook,
        modules=universe.importer.modules,
        path=universe.importer.path,
        stderr=universe.stderr,
        stdin=universe.stdin,
        stdout=universe.stdout,
    )


def io_module(universe: Universe) -> ModuleType:
    """The module `io` of a universe."""
    return proxy(io, open=universe.builtins.open)


def builtins_module(universe: Universe, ordered_sets: bool) -> ModuleType:
    """The module `builtins` of a universe; its dictionary is what all code of the node has as `__builtins__`."""
    streams = universe.importer.modules

    def print_text(*values: object, file: Any = None, **options: Any) -> None:
        print(*values, file=streams["sys"].stdout if file is None else file, **options)

    def read_line(prompt: object = "") -> str:
        streams["sys"].stdout.write(str(prompt))
        line: str = streams["sys"].stdin.readline()
        if not line:
            raise EOFError("EOF when reading a line")
        return line.rstrip("\n")

    def leave(code: object = None) -> None:
        raise SystemExit(code)

    module = made("builtins")
    vars(module).update(vars(builtins))
    vars(module).update(
        __import__=universe.importer.import_name,
        exit=leave,
        input=read_line,
        open=universe.files.opener(),
        print=print_text,
        quit=leave,
    )
    if ordered_sets:
        vars(module).update({"set": OrderedSet, SET_NAME: OrderedSet})
    return module
