"""`sys`, `builtins`, `io` and `importlib` of a node: own arguments, module table, search path, streams, import."""

from __future__ import annotations

import builtins
import importlib
import importlib.util
import io
import sys
from importlib.machinery import ModuleSpec
from types import ModuleType
from typing import TYPE_CHECKING, Any

from cfepy.interpreter.node_interrupt import NodeInterrupt
from cfepy.nodes.made_modules import proxy
from cfepy.nodes.node_tracebacks import traceback_text
from cfepy.nodes.ordered_sets import SET_NAME, OrderedSet

if TYPE_CHECKING:
    from cfepy.nodes.universe import Universe


def sys_module(universe: Universe) -> ModuleType:
    """Return the module `sys` of a universe. Interpreter settings are accepted without effect."""

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
    """Return the module `io` of a universe."""
    open_file = universe.builtins.open
    return proxy(io, open=open_file, open_code=lambda path: open_file(path, "rb"), FileIO=universe.files.raw_type)


class Builtins(ModuleType):
    """The module `builtins` of a universe."""

    def __init__(self) -> None:
        super().__init__("builtins")
        vars(self)["__copies__"] = []

    def copy_for_library(self) -> dict[str, Any]:
        """Return a copy for a module of a library, which gets more names. It follows later changes by the node."""
        known = vars(self)
        copied = dict(known)
        known["__copies__"].append(copied)
        return copied

    def __setattr__(self, name: str, value: Any) -> None:
        known = vars(self)
        before = known.get(name)
        for each in known["__copies__"]:
            if each.get(name) is before:
                each[name] = value
        super().__setattr__(name, value)


def builtins_module(universe: Universe, ordered_sets: bool) -> Builtins:
    """Return the module `builtins` of a universe; its dictionary is the `__builtins__` of the node's code."""
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

    module = Builtins()
    vars(module).update(vars(builtins))
    vars(module).update(
        KeyboardInterrupt=NodeInterrupt,
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


def importlib_module(universe: Universe) -> ModuleType:
    """Return the module `importlib` of a universe."""
    importer = universe.importer
    module = proxy(
        importlib,
        __import__=importer.import_name,
        import_module=importer.import_module,
        invalidate_caches=importlib.invalidate_caches,
        reload=importer.reload,
    )
    importer.modules["importlib"] = module
    vars(module)["util"] = importer.load("importlib.util")
    return module


def importlib_util_module(universe: Universe) -> ModuleType:
    """`importlib.util`: modules made from a spec get the node's builtins before they are executed."""

    def module_from_spec(spec: ModuleSpec) -> ModuleType:
        module = importlib.util.module_from_spec(spec)
        vars(module)["__builtins__"] = vars(universe.builtins)
        return module

    return proxy(importlib.util, find_spec=universe.importer.find_spec, module_from_spec=module_from_spec)
