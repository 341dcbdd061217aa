"""Transformation that makes mission code report its accesses and lets other tasks run between its steps.

Python code is compiled from a syntax tree with added calls of hooks (`cfepy.nodes.accesses`). A hook is called just
before an access, with the object as argument, and returns it: `self.n` becomes `__reads_attribute__(self, "n").n`.
Every operation thus stays in place, is done once, and fails in the program's own line; results do not change. Bodies of
modules and classes are left unchanged, because no other task can use them yet, except that of a node's script, which is
its main program.
"""

from __future__ import annotations

import ast
import builtins
from collections.abc import Iterable, Sequence
from typing import NamedTuple, TypeVar

from cfepy.interpreter.syntax_trees import FUNCTION, MODULE, NameScopes
from cfepy.schedules import name_of

READING_METHODS = frozenset(
    {
        *("copy", "count", "difference", "get", "index", "intersection", "isdisjoint", "issubset", "issuperset"),
        *("items", "keys", "most_common", "symmetric_difference", "union", "values"),
    }
)
"""Methods of Python's containers that read them."""
CHANGING_METHODS = frozenset(
    {
        *("add", "append", "appendleft", "clear", "difference_update", "discard", "extend", "extendleft", "insert"),
        *("intersection_update", "move_to_end", "pop", "popitem", "popleft", "remove", "reverse", "rotate"),
        *("setdefault", "sort", "subtract", "symmetric_difference_update", "update"),
    }
)
"""Methods of Python's containers that change them."""
_READERS = frozenset(
    {
        *("all", "any", "dict", "enumerate", "filter", "frozenset", "iter", "len", "list", "map", "max", "min"),
        *("reversed", "set", "sorted", "sum", "tuple", "zip"),
    }
)
_CHANGERS = frozenset(
    {"heapify", "heappop", "heappush", "heappushpop", "heapreplace", "insort", "insort_left", "insort_right", "shuffle"}
)
_QUIET = frozenset(
    {
        *("__del__", "__repr__", "__str__", "__format__", "__bytes__", "__hash__", "__eq__", "__ne__", "__lt__"),
        *("__le__", "__gt__", "__ge__", "__bool__", "__len__", "__getattr__", "__getattribute__", "__setattr__"),
        *("__delattr__", "__dir__", "__reduce__", "__reduce_ex__", "__getstate__", "__setstate__", "__index__"),
    }
)
"""Methods that are left unchanged because any code, including cfepy, may call them implicitly."""
_NEVER_AWAY = frozenset(
    name for name in dir(builtins) if name not in ("__import__", "eval", "exec", "input", "open", "print")
)
"""Built-in functions, which never enter cfepy; functions they call back have their own hooks."""
_CONTAINERS = (ast.Name, ast.Attribute, ast.Subscript)
_TEXT = 60  # maximum length of a container's name

E = TypeVar("E", bound=ast.expr)


class Kinds(NamedTuple):
    """Which hooks the code of a file gets.

    Attributes:
        accesses: at attributes, items, and variables of modules and functions that several tasks may share.
        lines: at the start of each statement.
        calls: at the end of each call.
        is_main: the module's own statements get hooks too.
        names: the only names at which `accesses` applies (`cfepy.schedules.name_of`); empty for all.
    """

    accesses: bool = False
    lines: bool = False
    calls: bool = False
    is_main: bool = False
    names: frozenset[str] = frozenset()


def with_hooks(tree: ast.Module, kinds: Kinds) -> ast.Module:
    """Return a module that calls hooks.

    Args:
        tree: the module.
        kinds: which hooks it calls; its builtins must contain them.
    """
    made: ast.Module = _Hooking(tree, kinds).visit(tree)
    return made


class _Hooking(ast.NodeTransformer):
    def __init__(self, tree: ast.Module, kinds: Kinds) -> None:
        self._kinds = kinds
        self._scopes = NameScopes(tree).of
        self._scope = self._scopes[tree]
        self._is_on = kinds.is_main
        self._classes: list[str] = []
        self._site = 0

    def _watches(self, *texts: str) -> bool:
        """Return whether accesses to an object get hooks: one that has one of these texts in the source."""
        if not (self._is_on and self._kinds.accesses):
            return False
        names = self._kinds.names
        return not names or any(name_of(text) in names for text in texts)

    # -- making calls of hooks -----------------------------------------------------------------------------------------

    def _call(self, hook: str, at: ast.AST, *arguments: ast.expr | str | int | None) -> ast.Call:
        """Return a call of a hook, with the place of a node of the source."""
        given = [each if isinstance(each, ast.expr) else ast.Constant(each) for each in arguments]
        call = ast.copy_location(ast.Call(ast.Name(hook, ast.Load()), given, []), at)
        for each in (call.func, *(each for each in given if isinstance(each, ast.Constant))):
            if not hasattr(each, "lineno"):
                ast.copy_location(each, at)
        return call

    def _statement(self, hook: str, at: ast.AST, *arguments: ast.expr | str | int | None) -> ast.stmt:
        return ast.copy_location(ast.Expr(self._call(hook, at, *arguments)), at)

    def _next_site(self) -> int:
        self._site += 1
        return self._site

    # -- blocks --------------------------------------------------------------------------------------------------------

    def visit_Module(self, node: ast.Module) -> ast.AST:
        node.body = self._body(node.body)
        return node

    def _function(self, node: ast.FunctionDef | ast.AsyncFunctionDef) -> ast.AST:
        node.decorator_list = self._each(node.decorator_list)
        self._defaults(node.args)
        scope, is_on = self._scope, self._is_on
        self._scope, self._is_on = self._scopes[node], node.name not in _QUIET
        node.body = self._body(node.body)
        self._scope, self._is_on = scope, is_on
        return node

    def visit_FunctionDef(self, node: ast.FunctionDef) -> ast.AST:
        return self._function(node)

    def visit_AsyncFunctionDef(self, node: ast.AsyncFunctionDef) -> ast.AST:
        return self._function(node)

    def visit_Lambda(self, node: ast.Lambda) -> ast.AST:
        self._defaults(node.args)
        scope, is_on = self._scope, self._is_on
        self._scope, self._is_on = self._scopes[node], True
        node.body = self.visit(node.body)
        self._scope, self._is_on = scope, is_on
        return node

    def visit_ClassDef(self, node: ast.ClassDef) -> ast.AST:
        node.decorator_list = self._each(node.decorator_list)
        node.bases = self._each(node.bases)
        node.keywords = [self.visit(each) for each in node.keywords]
        scope, is_on = self._scope, self._is_on
        self._scope, self._is_on = self._scopes[node], False
        self._classes.append(node.name)
        node.body = [self.visit(each) for each in node.body]
        self._classes.pop()
        self._scope, self._is_on = scope, is_on
        return node

    def _defaults(self, arguments: ast.arguments) -> None:
        arguments.defaults = self._each(arguments.defaults)
        arguments.kw_defaults = [None if each is None else self.visit(each) for each in arguments.kw_defaults]

    def _comprehension(self, node: ast.ListComp | ast.SetComp | ast.GeneratorExp | ast.DictComp) -> ast.AST:
        node.generators[0].iter = self._iterated(node.generators[0].iter)
        scope, self._scope = self._scope, self._scopes[node]
        for number, each in enumerate(node.generators):
            if number:
                each.iter = self._iterated(each.iter)
            each.target = self.visit(each.target)
            each.ifs = self._each(each.ifs)
        if isinstance(node, ast.DictComp):
            node.key, node.value = self.visit(node.key), self.visit(node.value)
        else:
            node.elt = self.visit(node.elt)
        self._scope = scope
        return node

    def visit_ListComp(self, node: ast.ListComp) -> ast.AST:
        return self._comprehension(node)

    def visit_SetComp(self, node: ast.SetComp) -> ast.AST:
        return self._comprehension(node)

    def visit_GeneratorExp(self, node: ast.GeneratorExp) -> ast.AST:
        return self._comprehension(node)

    def visit_DictComp(self, node: ast.DictComp) -> ast.AST:
        return self._comprehension(node)

    def _each(self, nodes: Sequence[E]) -> list[E]:
        return [self.visit(each) for each in nodes]

    # -- statements ----------------------------------------------------------------------------------------------------

    def _body(self, nodes: Sequence[ast.stmt]) -> list[ast.stmt]:
        """Return the statements of a block, with hooks before and after them."""
        found: list[ast.stmt] = []
        for number, node in enumerate(nodes):
            is_docstring = not number and isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant)
            if is_docstring or isinstance(node, ast.Global | ast.Nonlocal) or _is_future(node):
                found.append(node)
                continue
            if self._is_on and self._kinds.lines:
                found.append(self._statement("__line__", node))
            found += self._before(node)
            behind = self._behind(node)
            made = self.visit(node)
            found.append(made)
            found += behind
        return found

    def generic_visit(self, node: ast.AST) -> ast.AST:
        """Visit the fields of a node, except types, patterns and parameter names; bodies get hooks."""
        for name, value in ast.iter_fields(node):
            if name in ("annotation", "returns", "type_params", "pattern"):
                continue
            if name in ("body", "orelse", "finalbody") and isinstance(value, list):
                setattr(node, name, self._body(value))
            elif isinstance(value, list):
                setattr(node, name, [self.visit(each) if isinstance(each, ast.AST) else each for each in value])
            elif isinstance(value, ast.AST):
                setattr(node, name, self.visit(value))
        return node

    def _before(self, node: ast.stmt) -> list[ast.stmt]:
        """Return the reports before a statement: variables that it deletes, or reads in order to change them."""
        if isinstance(node, ast.AugAssign):
            return self._told("__read_variable__", [node.target], node)
        if isinstance(node, ast.Delete):
            return self._told("__write_variable__", node.targets, node)
        return []

    def _behind(self, node: ast.stmt) -> list[ast.stmt]:
        """Return the reports after a statement: variables that it sets as one of several targets."""
        if isinstance(node, ast.Assign):
            several = [each for each in node.targets if not isinstance(each, ast.Name)]
            return self._told("__wrote_variable__", several, node)
        return []

    def _told(self, hook: str, targets: Iterable[ast.expr], at: ast.AST) -> list[ast.stmt]:
        return [
            self._statement(hook, at, each.id, *self._cell(each.id, at))
            for target in targets
            for each in _bare_names(target)
            if self._is_shared(each.id)
        ]

    def visit_Assign(self, node: ast.Assign) -> ast.AST:
        names = [each.id for each in node.targets if isinstance(each, ast.Name) and self._is_shared(each.id)]
        node.value = self.visit(node.value)
        for name in names:
            node.value = self._call("__writes_variable__", node.value, node.value, name, *self._cell(name, node.value))
        node.targets = self._each(node.targets)
        return node

    def visit_AnnAssign(self, node: ast.AnnAssign) -> ast.AST:
        if node.value is None:
            return node
        node.value = self.visit(node.value)
        if isinstance(node.target, ast.Name) and self._is_shared(node.target.id):
            name = node.target.id
            node.value = self._call("__writes_variable__", node.value, node.value, name, *self._cell(name, node.value))
        node.target = self.visit(node.target)
        return node

    def visit_AugAssign(self, node: ast.AugAssign) -> ast.AST:
        target = node.target
        node.value = self.visit(node.value)
        if isinstance(target, ast.Name):
            if self._is_shared(target.id):
                cell = self._cell(target.id, node.value)
                node.value = self._call("__writes_variable__", node.value, node.value, target.id, *cell)
        elif not self._watches(self._text_of_changed(target)):
            node.target = self.visit(target)
        else:
            site = self._next_site()
            if isinstance(target, ast.Attribute):
                self._hook_attribute(target, "__updates_attribute__", site)
            else:
                self._hook_item(target, "update", site)
            node.value = self._call("__updated__", node.value, node.value, site)
        return node

    def visit_For(self, node: ast.For) -> ast.AST:
        site = self._next_site()
        is_watched = isinstance(node.iter, _CONTAINERS) and self._watches(_text(node.iter))
        node.iter = self._iterated(node.iter, site)
        told = self._told("__wrote_variable__", [node.target], node)
        node.target = self.visit(node.target)
        node.body = self._body(node.body)
        again = [self._statement("__looks_again__", node.iter, site)] if is_watched else []
        node.body = [*told, *again, *node.body]
        node.orelse = self._body(node.orelse)
        return node

    def visit_With(self, node: ast.With) -> ast.AST:
        targets = [each.optional_vars for each in node.items if each.optional_vars is not None]
        told = self._told("__wrote_variable__", targets, node)
        for each in node.items:
            each.context_expr = self.visit(each.context_expr)
            if each.optional_vars is not None:
                each.optional_vars = self.visit(each.optional_vars)
        node.body = [*told, *self._body(node.body)]
        return node

    def visit_If(self, node: ast.If) -> ast.AST:
        node.test = self._tested(node.test)
        node.body, node.orelse = self._body(node.body), self._body(node.orelse)
        return node

    def visit_While(self, node: ast.While) -> ast.AST:
        node.test = self._tested(node.test)
        node.body, node.orelse = self._body(node.body), self._body(node.orelse)
        return node

    def visit_match_case(self, node: ast.match_case) -> ast.AST:
        node.guard = None if node.guard is None else self._tested(node.guard)
        node.body = self._body(node.body)
        return node

    def visit_ImportFrom(self, node: ast.ImportFrom) -> ast.AST:
        return node

    # -- variables -----------------------------------------------------------------------------------------------------

    def _is_shared(self, name: str) -> bool:
        if not (self._watches(name) and self._scope.is_shared(name)):
            return False
        return self._scope.function.kind in (FUNCTION, MODULE)

    def _cell(self, name: str, at: ast.AST) -> list[ast.expr]:
        """Return a function that uses a variable of a function, by which its cell is found; nothing for a global
        variable.
        """
        if self._scope.owner(name).kind == MODULE:
            return []
        nothing = ast.arguments(posonlyargs=[], args=[], kwonlyargs=[], kw_defaults=[], defaults=[])
        name_of_it = ast.copy_location(ast.Name(name, ast.Load()), at)
        return [ast.copy_location(ast.Lambda(nothing, name_of_it), at)]

    def visit_Name(self, node: ast.Name) -> ast.AST:
        if not isinstance(node.ctx, ast.Load) or not self._is_shared(node.id):
            return node
        told = self._call("__read_variable__", node, node.id, *self._cell(node.id, node))
        return ast.copy_location(ast.BoolOp(ast.Or(), [told, node]), node)

    def visit_NamedExpr(self, node: ast.NamedExpr) -> ast.AST:
        node.value = self.visit(node.value)
        name = node.target.id
        if self._is_shared(name):
            node.value = self._call("__writes_variable__", node.value, node.value, name, *self._cell(name, node.value))
        return node

    # -- attributes and items ------------------------------------------------------------------------------------------

    def visit_Attribute(self, node: ast.Attribute) -> ast.AST:
        hook = "__reads_attribute__" if isinstance(node.ctx, ast.Load) else "__writes_attribute__"
        return self._hook_attribute(node, hook)

    def _hook_attribute(self, node: ast.Attribute, hook: str, site: int | None = None) -> ast.AST:
        base = node.value
        node.value = self.visit(base)
        name = node.attr
        is_special = name.startswith("__") and name.endswith("__")
        if is_special or not self._watches(self._mangled(name)) or _is_super(base):
            return node
        more = [] if site is None else [site]
        node.value = self._call(hook, base, node.value, self._mangled(name), *more)
        return node

    def _text_of_changed(self, target: ast.Attribute | ast.Subscript) -> str:
        """Return the text of the object that an augmented assignment changes: the attribute, or the container."""
        return self._mangled(target.attr) if isinstance(target, ast.Attribute) else _text(target.value)

    def _mangled(self, name: str) -> str:
        """Return a private name as mangled by its class."""
        if not name.startswith("__") or not self._classes:
            return name
        plain = self._classes[-1].lstrip("_")
        return f"_{plain}{name}" if plain else name

    def visit_Subscript(self, node: ast.Subscript) -> ast.AST:
        if isinstance(node.ctx, ast.Load):
            return self._hook_item(node, "read")
        return self._hook_item(node, "write" if isinstance(node.ctx, ast.Store) else "change")

    def _hook_item(self, node: ast.Subscript, how: str, site: int = 0) -> ast.AST:
        """Return an item access with its hook: a key without side effects is passed with the container, others after
        it.
        """
        container, key = node.value, node.slice
        text = _text(container)
        node.value = self.visit(container)
        node.slice = self._visit_key(key)
        if not self._watches(text):
            return node
        site = site or self._next_site()
        if _has_slice(key) or how == "change":
            if how == "update":
                node.value = self._call("__updates_all__", container, node.value, text, site)
            else:
                hook = "__looks_into__" if how == "read" else "__changes__"
                node.value = self._call(hook, container, node.value, text)
        elif _is_plain(node.slice):
            hook = {"read": "__reads_item__", "write": "__writes_item__", "update": "__updates_item__"}[how]
            more = [site] if how == "update" else []
            node.value = self._call(hook, container, node.value, _again(node.slice), text, *more)
        else:
            hook = {"read": "__reads_key__", "write": "__writes_key__", "update": "__updates_key__"}[how]
            node.value = self._call("__holds__", container, node.value, text, site)
            node.slice = self._call(hook, key, node.slice, site)
        return node

    def _visit_key(self, key: ast.expr) -> ast.expr:
        """Return the visited key of an item; a slice is not an expression."""
        if isinstance(key, ast.Slice):
            self.generic_visit(key)
            return key
        visited: ast.expr = self.visit(key)
        return visited

    # -- containers as a whole -----------------------------------------------------------------------------------------

    def _looked_into(self, node: ast.expr, site: int | None = None) -> ast.expr:
        """Return an expression with a report that its value is read, if it may be a shared container."""
        text = _text(node)
        visited: ast.expr = self.visit(node)
        if not (isinstance(node, _CONTAINERS) and self._watches(text)):
            return visited
        more = [] if site is None else [site]
        return self._call("__looks_into__", node, visited, text, *more)

    def _iterated(self, node: ast.expr, site: int | None = None) -> ast.expr:
        return self._looked_into(node, site)

    def _tested(self, node: ast.expr) -> ast.expr:
        """Return a condition with a report, because the truth of a container depends on its length."""
        if isinstance(node, ast.BoolOp):
            node.values = [self._tested(each) for each in node.values]
            return node
        if isinstance(node, ast.UnaryOp) and isinstance(node.op, ast.Not):
            node.operand = self._tested(node.operand)
            return node
        return self._looked_into(node)

    def visit_IfExp(self, node: ast.IfExp) -> ast.AST:
        node.test = self._tested(node.test)
        node.body, node.orelse = self.visit(node.body), self.visit(node.orelse)
        return node

    def visit_Starred(self, node: ast.Starred) -> ast.AST:
        node.value = self._looked_into(node.value) if isinstance(node.ctx, ast.Load) else self.visit(node.value)
        return node

    def visit_Compare(self, node: ast.Compare) -> ast.AST:
        node.left = self.visit(node.left)
        node.comparators = [
            self._looked_into(each) if isinstance(how, ast.In | ast.NotIn) else self.visit(each)
            for how, each in zip(node.ops, node.comparators, strict=True)
        ]
        return node

    # -- calls ---------------------------------------------------------------------------------------------------------

    def visit_Call(self, node: ast.Call) -> ast.AST:
        if _is_super(node):
            return node
        may_leave = not (isinstance(node.func, ast.Name) and self._is_builtin(node.func.id))
        if self._is_on and self._kinds.accesses:
            self._hook_call(node)
        else:
            self.generic_visit(node)
        if self._is_on and self._kinds.calls and may_leave:
            return self._call("__called__", node, node)
        return node

    def _is_builtin(self, name: str) -> bool:
        owner = self._scope.owner(name)
        return name in _NEVER_AWAY and owner.kind == MODULE and name not in owner.bound

    def _hook_call(self, node: ast.Call) -> None:
        function = node.func
        name = function.id if isinstance(function, ast.Name) else getattr(function, "attr", "")
        if isinstance(function, ast.Attribute) and name in READING_METHODS | CHANGING_METHODS:
            self._hook_method(node, function)
            return
        text = _text(node.args[0]) if name in _CHANGERS and node.args else ""
        node.func = self.visit(function)
        reads = name in _READERS and isinstance(function, ast.Name)
        node.args = [self._looked_into(each) if reads else self.visit(each) for each in node.args]
        node.keywords = [self.visit(each) for each in node.keywords]
        if text and self._watches(text):
            node.args[0] = self._call("__changes__", node.args[0], node.args[0], text)

    def _hook_method(self, node: ast.Call, function: ast.Attribute) -> None:
        """Add a hook to a method call that may be a container's; it reports once the arguments are evaluated."""
        receiver = function.value
        text = _text(receiver)
        function.value = self.visit(receiver)
        node.args = [self.visit(each) for each in node.args]
        node.keywords = [self.visit(each) for each in node.keywords]
        if _is_super(receiver) or not self._watches(text, function.attr):
            return
        last = node.keywords[-1] if node.keywords else node.args[-1] if node.args else None
        if last is None or isinstance(last, ast.Starred) or all(map(_is_plain, node.args)):
            function.value = self._call("__calls_method__", receiver, function.value, function.attr, text)
            return
        site = self._next_site()
        function.value = self._call("__holds_method__", receiver, function.value, function.attr, text, site)
        if isinstance(last, ast.keyword):
            last.value = self._call("__calls_held__", last.value, last.value, site)
        else:
            node.args[-1] = self._call("__calls_held__", last, last, site)


def _bare_names(target: ast.expr) -> list[ast.Name]:
    """Return the names that a target binds."""
    if isinstance(target, ast.Name):
        return [target]
    if isinstance(target, ast.Starred):
        return _bare_names(target.value)
    if isinstance(target, ast.Tuple | ast.List):
        return [name for each in target.elts for name in _bare_names(each)]
    return []


def _has_slice(key: ast.expr) -> bool:
    """Return whether a key is valid only between brackets."""
    parts = key.elts if isinstance(key, ast.Tuple) else [key]
    return any(isinstance(each, ast.Slice | ast.Starred) for each in parts)


def _is_future(node: ast.stmt) -> bool:
    return isinstance(node, ast.ImportFrom) and node.module == "__future__"


def _is_super(node: ast.expr) -> bool:
    """Return whether a node is `super()`, which depends on the enclosing function."""
    return isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id == "super"


def _is_plain(node: ast.expr) -> bool:
    """Return whether an expression can be evaluated twice without side effects."""
    if isinstance(node, ast.UnaryOp):
        return isinstance(node.operand, ast.Constant)
    return isinstance(node, ast.Constant | ast.Name)


def _again(node: ast.expr) -> ast.expr:
    """Return the same plain expression once more."""
    if isinstance(node, ast.UnaryOp):
        return ast.copy_location(ast.UnaryOp(node.op, _again(node.operand)), node)
    if isinstance(node, ast.Name):
        return ast.copy_location(ast.Name(node.id, ast.Load()), node)
    assert isinstance(node, ast.Constant)
    return ast.copy_location(ast.Constant(node.value), node)


def _text(node: ast.expr) -> str:
    """Return the name of a container, for reports."""
    text = ast.unparse(node)
    return text if len(text) <= _TEXT else f"{text[: _TEXT - 3]}..."
