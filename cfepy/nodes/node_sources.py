"""Code objects of files: compiled once per process and shared by all universes, since code objects are immutable.

The key contains the size and time stamp of a node's file, so an edited file is compiled again; for a file of an
application it is the text. Modules of the standard library and installed packages come from Python's byte code cache.
"""

from __future__ import annotations

import functools
import importlib.machinery
import os
import sys
import warnings
from types import CodeType
from typing import TYPE_CHECKING, NamedTuple

from cfepy.interpreter.syntax_trees import TooDeepError, compiled, parsed
from cfepy.nodes.busy_waits import add_hooks, busy_loops
from cfepy.reading.input_files import read_limited
from cfepy.reading.input_limits import PYTHON_BYTES

if TYPE_CHECKING:
    from cfepy.nodes.instrument import Kinds

SOURCES = 512  # number of application texts that are kept
# raised as Python audit event for a file that was compiled before, like the event for an opened one
AGAIN = "cfepy.source"
_LOOP = b"while"

_compiled: dict[tuple[object, ...], CodeType] = {}


class Doubt(NamedTuple):
    """A compiler warning: text, category and line."""

    text: str
    category: type[Warning]
    line: int


_doubts: dict[CodeType, tuple[Doubt, ...]] = {}


def code_of_file(path: str, ordered: bool, name: str, kinds: Kinds | None = None) -> CodeType:
    """Return the code of a source file of a node.

    Args:
        path: the file.
        ordered: whether set displays in it make ordered sets.
        name: file name that the code sees.
        kinds: which hooks it calls; None for none.

    Raises:
        OSError: if it cannot be read.
        SyntaxError: if it cannot be compiled.
    """
    stat = os.stat(path)
    key = (path, stat.st_mtime_ns, stat.st_size, ordered, kinds)
    code = _compiled.get(key)
    if code is not None:
        sys.audit(AGAIN, path)
        return code
    source = read_limited(path, PYTHON_BYTES)
    with warnings.catch_warnings(record=True) as seen:  # they are shown in the node's output
        warnings.simplefilter("default")
        _compiled[key] = code = _compile(source, name, ordered, kinds)
    if seen:
        _doubts[code] = tuple(Doubt(str(each.message), each.category, each.lineno) for each in seen)
    return code


def doubts_of(code: CodeType) -> tuple[Doubt, ...]:
    """Return the compiler's warnings for the code of a file."""
    return _doubts.get(code, ())


def own_files() -> list[str]:
    """Return the source files of nodes that were read so far, in that order."""
    return list(dict.fromkeys(str(key[0]) for key in _compiled if len(key) > 1))


@functools.lru_cache(maxsize=SOURCES)
def code_of_source(source: bytes, name: str, kinds: Kinds | None = None) -> CodeType:
    """Return the code of a text, cached by text.

    Args:
        source: text of a module.
        name: file name that the code sees.
        kinds: which hooks it calls; None for none.

    Raises:
        SyntaxError: if it cannot be compiled.
    """
    return _compile(source, name, False, kinds)


def _compile(source: bytes, path: str, ordered: bool, kinds: Kinds | None) -> CodeType:
    """Compile a module; its tree is built only if code may be added to it."""
    is_plain = kinds is None and not ordered
    if is_plain and _LOOP not in source:
        return compiled(source, path)
    try:
        tree = parsed(source, path)
        loops = busy_loops(tree)
        if ordered:
            from cfepy.nodes.ordered_sets import with_ordered_sets

            tree = with_ordered_sets(tree)
        if kinds is not None:
            from cfepy.nodes.instrument import with_hooks

            tree = with_hooks(tree, kinds)
        add_hooks(loops, path)
        return compiled(tree, path)
    except (RecursionError, TooDeepError):
        if not is_plain:
            raise
        return compiled(source, path)  # Python nests more deeply in a text than in a tree


def code_of_library(spec: importlib.machinery.ModuleSpec) -> CodeType:
    """Return the code of a module of the standard library or of an installed package.

    Raises:
        ImportError: if the module has no Python code.
    """
    key = (spec.origin,)
    code = _compiled.get(key)
    if code is None:
        loader = spec.loader
        if not isinstance(loader, importlib.machinery.SourceFileLoader):
            raise ImportError(f"{spec.name} is not a Python source file, so it cannot be loaded into a node")
        in_cache = not sys.flags.optimize  # otherwise the cached code has no asserts
        code = loader.get_code(spec.name) if in_cache else compiled(loader.get_data(loader.path), loader.path)
        if code is None:
            raise ImportError(f"{spec.name} has no code")
        _compiled[key] = code
    return code
