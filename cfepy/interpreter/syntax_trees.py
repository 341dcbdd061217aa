"""Syntax trees of Python source, built without a garbage collection in between.

CPython before 3.11.8 and 3.12.2 counts the depth of a tree for the whole interpreter. A collection during `ast.parse`
can run a finalizer that builds another tree, such as one that logs a traceback. `ast.parse` then raises SystemError.

`NameScopes` determines which variable a name in a tree refers to, and which variables several tasks can share. It
follows Python's own rules (The Python Language Reference, 4.2). A name that a block binds is local to it, unless it is
declared global or nonlocal. Other names are looked up in the enclosing functions, then in the module. Comprehensions
are blocks of their own. Names of a class block are not visible in the blocks inside it.
"""

from __future__ import annotations

import ast
import re
from collections import Counter
from collections.abc import Iterable
from types import CodeType
from typing import Literal, overload

from cfepy.interpreter.garbage import no_collection
from cfepy.reading.input_limits import PYTHON_DEPTH, PYTHON_WORDS

MODULE, FUNCTION, CLASS, COMPREHENSION = "module", "function", "class", "comprehension"
_WORD = re.compile(rb"\w+|[^\w\s]")
_TOO_DEEP = "is nested too deeply"
_AGAIN = 2  # a name bound in a loop is bound more than once


class TooDeepError(SyntaxError):
    """Exception for a source whose expressions or blocks are nested too deeply."""


@overload
def parsed(source: str | bytes, file: str = ...) -> ast.Module: ...
@overload
def parsed(source: str | bytes, file: str = ..., *, mode: Literal["eval"]) -> ast.Expression: ...
def parsed(source: str | bytes, file: str = "<unknown>", *, mode: Literal["exec", "eval"] = "exec") -> ast.AST:
    """Return the tree of a module or, with the mode "eval", of one expression.

    Args:
        source: its text.
        file: its name, for errors.
        mode: the mode of `ast.parse`.

    Raises:
        SyntaxError: if the source is not Python; `TooDeepError` if it is nested too deeply for Python's own parser.
        ValueError: if it has a NUL byte.
    """
    try:
        with no_collection:
            return ast.parse(source, file, mode)
    except (RecursionError, MemoryError):  # the parser raises MemoryError for thousands of brackets
        raise TooDeepError(f"{_TOO_DEEP} for Python; split it", (file, 1, 1, None)) from None
    except SyntaxError as error:
        raise error.with_traceback(None) from None  # without the frame of `ast`


def compiled(source: str | bytes | ast.Module, file: str) -> CodeType:
    """Compile a module of a mission with its asserts, however Python was started.

    A run must not depend on `python -O` or PYTHONOPTIMIZE.

    Args:
        source: its text or its tree.
        file: its name, for tracebacks.

    Raises:
        SyntaxError: if the source is not Python.
        ValueError: if it has a NUL byte.
    """
    code: CodeType = compile(source, file, "exec", dont_inherit=True, optimize=0)
    return code


@overload
def parsed_input(source: str | bytes, file: str = ..., *, depth: int = ...) -> ast.Module: ...
@overload
def parsed_input(
    source: str | bytes, file: str = ..., *, mode: Literal["eval"], depth: int = ...
) -> ast.Expression: ...
def parsed_input(
    source: str | bytes,
    file: str = "<unknown>",
    *,
    mode: Literal["exec", "eval"] = "exec",
    depth: int = PYTHON_DEPTH,
) -> ast.AST:
    """Parse a source for inspection, not for execution, within the limits that all inputs have.

    A tree takes a thousand times the memory of its text. Code that walks a tree recurses as deeply as it is nested.

    Args:
        source: its text.
        file: its name, for errors.
        mode: the mode of `ast.parse`.
        depth: maximum nesting of expressions and blocks; less than the default if the caller walks the tree
            recursively.

    Returns:
        The tree.

    Raises:
        SyntaxError: if the source is not Python or exceeds a limit.
        ValueError: if it has a NUL byte.
    """
    if len(source) > PYTHON_WORDS:
        words = (
            _WORD.finditer(source) if isinstance(source, bytes) else _WORD.finditer(source.encode("utf-8", "replace"))
        )
        if sum(1 for _ in words) > PYTHON_WORDS:
            text = f"has more than the limit of {PYTHON_WORDS:,} words and signs in a source; split it"
            raise SyntaxError(text, (file, 1, 1, None))
    tree = parsed(source, file, mode=mode) if mode == "eval" else parsed(source, file)
    _check_depth(tree, file, depth)
    return tree


def _inside(nodes: list[ast.AST]) -> list[ast.AST]:
    """Return the children of several nodes, in a third of the time of `ast.iter_child_nodes`."""
    found: list[ast.AST] = []
    for node in nodes:
        for name in node._fields:
            value = getattr(node, name, None)
            if isinstance(value, list):
                found += [each for each in value if isinstance(each, ast.AST)]
            elif isinstance(value, ast.AST) and not isinstance(value, ast.expr_context):
                found.append(value)
    return found


def _check_depth(tree: ast.AST, file: str, depth: int) -> None:
    level: list[ast.AST] = [tree]
    for _ in range(depth):
        level = _inside(level)
        if not level:
            return
    line = next((node.lineno for node in level if isinstance(node, ast.expr | ast.stmt)), 1)
    raise TooDeepError(f"{_TOO_DEEP}: more than {depth} levels; split it", (file, line, 1, None))


class NameScope:
    """A block of Python source.

    Args:
        kind: MODULE, FUNCTION, CLASS or COMPREHENSION.
        parent: the enclosing block; None for a module.

    Attributes:
        bound: the minimum number of times that it binds each name.
        globals, nonlocals: the names that it declares as such.
        captured: its names that functions inside use.
        rebound: its names that functions inside bind, after a nonlocal or global declaration.
    """

    def __init__(self, kind: str, parent: NameScope | None = None) -> None:
        self.kind = kind
        self.parent = parent
        self.bound: Counter[str] = Counter()
        self.globals: set[str] = set()
        self.nonlocals: set[str] = set()
        self.captured: set[str] = set()
        self.rebound: set[str] = set()

    def owner(self, name: str) -> NameScope:
        """Return the block that a name in this block belongs to; the module's if no block binds it."""
        if name in self.globals:
            return self.module
        if name in self.bound and name not in self.nonlocals:
            return self
        scope = self.parent
        while scope is not None and scope.parent is not None:
            if name in scope.globals:
                return self.module
            if scope.kind != CLASS and name in scope.bound and name not in scope.nonlocals:
                return scope
            scope = scope.parent
        return self.module

    @property
    def module(self) -> NameScope:
        """The block of the module."""
        scope = self
        while scope.parent is not None:
            scope = scope.parent
        return scope

    @property
    def function(self) -> NameScope:
        """The innermost block that is not a comprehension, starting with this one."""
        scope = self
        while scope.kind == COMPREHENSION and scope.parent is not None:
            scope = scope.parent
        return scope

    def is_shared(self, name: str) -> bool:
        """Return whether a name in this block is a changing variable that other functions can access."""
        if name.startswith("__"):  # a class mangles such a name
            return False
        owner = self.owner(name)
        changes = owner.bound[name] > 1 or name in owner.rebound
        if owner.kind == MODULE:
            return changes and name in owner.bound
        return owner.kind == FUNCTION and changes and name in owner.captured


class NameScopes(ast.NodeVisitor):
    """The blocks of a module.

    Args:
        tree: the tree of the module.

    Attributes:
        of: the block of each function, class and comprehension, and of the module.
    """

    def __init__(self, tree: ast.Module) -> None:
        self.of: dict[ast.AST, NameScope] = {tree: NameScope(MODULE)}
        self._scope = self.of[tree]
        self._loops = 0
        self._uses: list[tuple[NameScope, str]] = []
        self._all(tree.body)
        for scope, name in self._uses:
            owner = scope.owner(name)
            if owner is not scope.function and owner is not scope:
                owner.captured.add(name)
        for scope in self.of.values():
            for name in scope.globals & set(scope.bound):
                scope.module.rebound.add(name)
                scope.module.bound[name] += 1
            for name in scope.nonlocals & set(scope.bound):
                scope.owner(name).rebound.add(name)
                scope.owner(name).captured.add(name)

    def _all(self, nodes: Iterable[ast.AST | None]) -> None:
        for node in nodes:
            if node is not None:
                self.visit(node)

    def _bind(self, name: str | None, scope: NameScope | None = None) -> None:
        if name is not None:
            (scope or self._scope).bound[name] += _AGAIN if self._loops else 1

    def _define(self, name: str) -> None:
        """Define a function, class or module, which is not a changing variable even if several have the same name."""
        self._scope.bound[name] += 0

    # -- blocks --------------------------------------------------------------------------------------------------------

    def _inside(self, node: ast.AST, kind: str, parts: Iterable[ast.AST | None], names: Iterable[str] = ()) -> None:
        outer, loops = self._scope, self._loops
        self.of[node] = self._scope = NameScope(kind, outer)
        self._loops = 0
        for name in names:
            self._bind(name)
        self._all(parts)
        self._scope, self._loops = outer, loops

    def _function(self, node: ast.FunctionDef | ast.AsyncFunctionDef) -> None:
        self._define(node.name)
        self._all([*node.decorator_list, *node.args.defaults, *node.args.kw_defaults])
        self._inside(node, FUNCTION, node.body, _names(node.args))

    def visit_FunctionDef(self, node: ast.FunctionDef) -> None:
        self._function(node)

    def visit_AsyncFunctionDef(self, node: ast.AsyncFunctionDef) -> None:
        self._function(node)

    def visit_Lambda(self, node: ast.Lambda) -> None:
        self._all([*node.args.defaults, *node.args.kw_defaults])
        self._inside(node, FUNCTION, [node.body], _names(node.args))

    def visit_ClassDef(self, node: ast.ClassDef) -> None:
        self._define(node.name)
        self._all([*node.decorator_list, *node.bases, *node.keywords])
        self._inside(node, CLASS, node.body)

    def _comprehend(self, node: ast.ListComp | ast.SetComp | ast.GeneratorExp | ast.DictComp) -> None:
        first, *others = node.generators
        self.visit(first.iter)
        values = [node.key, node.value] if isinstance(node, ast.DictComp) else [node.elt]
        self._inside(node, COMPREHENSION, [first.target, *first.ifs, *others, *values])

    visit_ListComp = visit_SetComp = visit_GeneratorExp = visit_DictComp = _comprehend

    # -- names ---------------------------------------------------------------------------------------------------------

    def visit_Name(self, node: ast.Name) -> None:
        if isinstance(node.ctx, ast.Load):
            self._uses.append((self._scope, node.id))
        else:
            self._bind(node.id)

    def visit_NamedExpr(self, node: ast.NamedExpr) -> None:
        self.visit(node.value)
        self._bind(node.target.id, self._scope.function)

    def visit_Global(self, node: ast.Global) -> None:
        self._scope.globals.update(node.names)

    def visit_Nonlocal(self, node: ast.Nonlocal) -> None:
        self._scope.nonlocals.update(node.names)

    def visit_AugAssign(self, node: ast.AugAssign) -> None:
        self.generic_visit(node)
        if isinstance(node.target, ast.Name):
            self._uses.append((self._scope, node.target.id))

    def visit_Import(self, node: ast.Import | ast.ImportFrom) -> None:
        for alias in node.names:
            self._define(alias.asname or alias.name.partition(".")[0])

    visit_ImportFrom = visit_Import

    def visit_ExceptHandler(self, node: ast.ExceptHandler) -> None:
        self._bind(node.name)
        self.generic_visit(node)

    def visit_MatchAs(self, node: ast.MatchAs) -> None:
        self._bind(node.name)
        self.generic_visit(node)

    def visit_MatchStar(self, node: ast.MatchStar) -> None:
        self._bind(node.name)

    def visit_MatchMapping(self, node: ast.MatchMapping) -> None:
        self._bind(node.rest)
        self.generic_visit(node)

    # -- loops ---------------------------------------------------------------------------------------------------------

    def _loop(self, node: ast.AST) -> None:
        self._loops += 1
        self.generic_visit(node)
        self._loops -= 1

    visit_For = visit_AsyncFor = visit_While = _loop


def _names(arguments: ast.arguments) -> list[str]:
    """Return the parameters of a function."""
    given = [*arguments.posonlyargs, *arguments.args, *arguments.kwonlyargs, arguments.vararg, arguments.kwarg]
    return [each.arg for each in given if each is not None]
