"""Syntax trees of Python source, made without a collection of garbage on the way.

CPython before 3.11.8 and 3.12.2 counts the depth of a tree for the whole interpreter. A collection in the middle of
one may run a finalizer that makes another, such as one that logs a traceback, and then `ast.parse` raises SystemError.
"""

from __future__ import annotations

import ast
from typing import Literal, overload

from cfepy.garbage import no_collection


@overload
def parsed(source: str | bytes, file: str = ...) -> ast.Module: ...
@overload
def parsed(source: str | bytes, file: str = ..., *, mode: Literal["eval"]) -> ast.Expression: ...
def parsed(source: str | bytes, file: str = "<unknown>", *, mode: Literal["exec", "eval"] = "exec") -> ast.AST:
    """The tree of a module or, with the mode "eval", of one expression.

    Args:
        source: its text.
        file: its name, for errors.
        mode: as of `ast.parse`.

    Raises:
        SyntaxError: it is not Python.
        ValueError: it has a NUL byte.
    """
    with no_collection:
        return ast.parse(source, file, mode)
