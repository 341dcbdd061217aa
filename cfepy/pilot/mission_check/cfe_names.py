"""Checks of an application's use of its handle `cfe`: unknown names, and calls whose arguments cannot fit.

Sources are read, not run. A name counts as the handle only if it cannot be anything else: a parameter annotated `Cfe`,
the first parameter of the entry point, and names that all assignments and all calls of a file bind to these. So the
reports are certain, and a handle that cannot be followed is not checked.
"""

from __future__ import annotations

import ast
import importlib.util
import inspect
import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import suppress
from functools import cache
from itertools import islice
from pathlib import Path
from types import ModuleType
from typing import Any, NamedTuple, get_type_hints

from cfepy import msg
from cfepy.app import Cfe
from cfepy.interpreter.syntax_trees import parsed
from cfepy.mission import app_sources as sources
from cfepy.pilot.mission_check.problem import MissionProblem
from cfepy.reading.suggestions import did_you_mean

HANDLE = "cfe"
_ALL_NAMES = "docs/reference/generated/api_map.md lists all names"
_MOST = 500  # maximum number of reported problems of a file
_LONGEST_CHAIN = 20
GUARDS = ("AttributeError", "TypeError")
_NEW_WORD = re.compile(r"(?<=[a-z0-9])(?=[A-Z])")
_ASKING = ("hasattr", "getattr", "setattr")
_NOT_PLAIN = ("property", "staticmethod", "classmethod", "cached_property", "functools.cached_property")
_Function = ast.FunctionDef | ast.AsyncFunctionDef | ast.Lambda
_Place = _Function | ast.ClassDef | ast.Module
_Binding = ast.expr | ast.arg | None
"""The binding of a name: a value, a parameter, or None if it is not followed."""


class _Kind(NamedTuple):
    """The kind of an expression: the handle (""), a service of it, or an instance of a class in the file."""

    service: str = ""
    owner: ast.ClassDef | None = None


def wrong_names(source: Path, entry_point: str) -> Iterator[MissionProblem]:
    """Yield wrong uses of `cfe` in an application, as far as its sources can be read.

    Args:
        source: file of its module, or the `__init__.py` of its package.
        entry_point: the function that gets the handle.
    """
    trees = {file: sources.tree_of(file) for file in sources.files_of(source)}
    for file, tree in trees.items():
        shared = {name for other, each in trees.items() if other != file for name in _imported(each)}
        yield from _wrong_imports(file, tree)
        with suppress(RecursionError):  # deeply nested generated code is not checked
            yield from islice(_Reader(file, tree, entry_point, shared).problems(), _MOST)


def _imported(tree: ast.Module) -> set[str]:
    """Return the names that a file imports from others; "*" for a star import."""
    froms = (node for node in ast.walk(tree) if isinstance(node, ast.ImportFrom))
    return {alias.name for node in froms for alias in node.names}


def _wrong_imports(file: Path, tree: ast.Module) -> Iterator[MissionProblem]:
    """Yield names that a file imports unconditionally from cfepy but that do not exist."""
    for node in tree.body:
        module = node.module if isinstance(node, ast.ImportFrom) and node.level == 0 else None
        if not isinstance(node, ast.ImportFrom) or module is None or module.partition(".")[0] != "cfepy":
            continue
        source = sources.source_of(module) if _is_module(module) else None
        if source is None:
            yield MissionProblem(file, node.lineno, f"unknown module {module}; {_ALL_NAMES}")
            continue
        for alias in node.names:
            if not (alias.name == "*" or sources.defines(source, alias.name) or _is_module(f"{module}.{alias.name}")):
                known = [*sources.functions_and_classes_of(source), *sorted(_imported(sources.tree_of(source)))]
                hint = did_you_mean(alias.name, known, _ALL_NAMES)
                yield MissionProblem(file, node.lineno, f"{module} has no name {alias.name!r}; {hint}")


def _is_module(name: str) -> bool:
    try:
        return importlib.util.find_spec(name) is not None
    except ImportError:
        return False


# -- bindings ----------------------------------------------------------------------------------------------------------


class _Bindings(ast.NodeVisitor):
    """The bindings of names and of attributes of `self` in a file, and the calls of its functions.

    Attributes:
        place_of: the scope of each node of the tree.
        names: bindings of names, by scope.
        attributes: bindings of attributes of `self` by methods, by class.
        calls: calls of plain names.
        escaped: names that are used for anything but a call.
        shared: names that `global` and `nonlocal` make too hard to follow.
        asked: attributes that the file itself sets or tests.
    """

    def __init__(self, tree: ast.Module) -> None:
        self.place_of: dict[ast.AST, _Place] = {}
        self.names: dict[tuple[_Place, str], list[_Binding]] = {}
        self.attributes: dict[tuple[ast.ClassDef, str], list[ast.expr | None]] = {}
        self.calls: dict[str, list[ast.Call]] = {}
        self.escaped: set[str] = set()
        self.shared: set[str] = set()
        self.asked: set[str] = set()
        self._followed: set[ast.AST] = set()
        self._place: _Place = tree
        self.visit(tree)

    def visit(self, node: ast.AST) -> None:
        """Record the scope of a node, then visit it."""
        self.place_of[node] = self._place
        super().visit(node)

    def _inside(self, place: _Place, parts: Iterable[ast.AST]) -> None:
        outside, self._place = self._place, place
        for part in parts:
            self.visit(part)
        self._place = outside

    def visit_FunctionDef(self, node: ast.FunctionDef | ast.AsyncFunctionDef) -> None:
        """Bind the name of a function outside, and its parameters inside."""
        self._bind(node.name, None)
        self._parameters(node, [*node.decorator_list, *([] if node.returns is None else [node.returns])])
        self._inside(node, node.body)

    visit_AsyncFunctionDef = visit_FunctionDef

    def visit_Lambda(self, node: ast.Lambda) -> None:
        """Bind the parameters of a lambda."""
        self._parameters(node, [])
        self._inside(node, [node.body])

    def _parameters(self, node: _Function, outside: list[ast.expr]) -> None:
        arguments = node.args
        for each in (*outside, *arguments.defaults, *filter(None, arguments.kw_defaults)):
            self.visit(each)
        plain = [*arguments.posonlyargs, *arguments.args, *arguments.kwonlyargs]
        self._inside(node, [*plain, *filter(None, (arguments.vararg, arguments.kwarg))])

    def visit_ClassDef(self, node: ast.ClassDef) -> None:
        """Open the scope of a class body."""
        self._bind(node.name, None)
        for each in (*node.bases, *node.keywords, *node.decorator_list):
            self.visit(each)
        self._inside(node, node.body)

    def visit_arg(self, node: ast.arg) -> None:
        """Bind a parameter."""
        self._bind(node.arg, node)
        self.generic_visit(node)

    def visit_Assign(self, node: ast.Assign) -> None:
        """Bind names and attributes to a value; parts of a tuple are not followed."""
        for target in node.targets:
            self._assign(target, node.value)
        self.generic_visit(node)

    def visit_AnnAssign(self, node: ast.AnnAssign) -> None:
        """Bind an annotated name; without a value it is not a binding."""
        if node.value is None:
            self._followed.add(node.target)
        else:
            self._assign(node.target, node.value)
        self.generic_visit(node)

    def visit_NamedExpr(self, node: ast.NamedExpr) -> None:
        """Bind the name of an assignment expression."""
        self._assign(node.target, node.value)
        self.generic_visit(node)

    def visit_Name(self, node: ast.Name) -> None:
        """Handle a name that is used, or bound by a loop, a `with` or an unpacking."""
        if isinstance(node.ctx, ast.Load):
            if node not in self._followed:
                self.escaped.add(node.id)
        elif node not in self._followed:
            self._bind(node.id, None)

    def visit_Attribute(self, node: ast.Attribute) -> None:
        """Handle an attribute that is bound by a loop, a `with` or an unpacking."""
        if not isinstance(node.ctx, ast.Load) and node not in self._followed:
            self._store(node, None)
        self.generic_visit(node)

    def visit_Call(self, node: ast.Call) -> None:
        """Record a call of a plain name."""
        if isinstance(node.func, ast.Name):
            self._followed.add(node.func)
            self.calls.setdefault(node.func.id, []).append(node)
            if node.func.id in _ASKING:
                self.asked |= {str(arg.value) for arg in node.args if isinstance(arg, ast.Constant)}
        self.generic_visit(node)

    def visit_Global(self, node: ast.Global | ast.Nonlocal) -> None:
        """Record names that are bound from more than one scope."""
        self.shared |= set(node.names)

    visit_Nonlocal = visit_Global

    def visit_alias(self, node: ast.alias) -> None:
        """Bind the name of an import."""
        self._bind(node.asname or node.name.partition(".")[0], None)

    def visit_ExceptHandler(self, node: ast.ExceptHandler | ast.MatchAs | ast.MatchStar) -> None:
        """Bind the names of errors and patterns."""
        if node.name is not None:
            self._bind(node.name, None)
        self.generic_visit(node)

    visit_MatchAs = visit_MatchStar = visit_ExceptHandler

    def _bind(self, name: str, value: _Binding) -> None:
        self.names.setdefault((self._place, name), []).append(value)

    def _assign(self, target: ast.expr, value: ast.expr) -> None:
        if isinstance(target, ast.Name):
            self._followed.add(target)
            self._bind(target.id, value)
        elif isinstance(target, ast.Attribute):
            self._followed.add(target)
            self._store(target, value)

    def _store(self, target: ast.Attribute, value: ast.expr | None) -> None:
        owner = self.owner(self._place)
        if owner is not None and isinstance(target.value, ast.Name) and target.value.id == _first(self._place):
            self.attributes.setdefault((owner, target.attr), []).append(value)
        else:
            self.asked.add(target.attr)  # a written attribute of the handle exists afterwards

    def owner(self, function: _Place) -> ast.ClassDef | None:
        """Return the class of a method; None for other functions, including static and class methods."""
        place = self.place_of.get(function)
        if not isinstance(place, ast.ClassDef) or not isinstance(function, ast.FunctionDef | ast.AsyncFunctionDef):
            return None
        of_class = any(ast.unparse(each) in ("staticmethod", "classmethod") for each in function.decorator_list)
        return None if of_class else place


def _first(function: _Place) -> str | None:
    """Return the name of the first parameter of a function."""
    names = _positional(function) if isinstance(function, _Function) else []
    return names[0] if names else None


def _positional(function: _Function) -> list[str]:
    return [each.arg for each in (*function.args.posonlyargs, *function.args.args)]


# -- kinds -------------------------------------------------------------------------------------------------------------


class _Reader:
    """Checks one file.

    Args:
        file: its path.
        tree: its syntax tree.
        entry_point: the function that gets the handle.
        shared: names that other files of the package import.
    """

    def __init__(self, file: Path, tree: ast.Module, entry_point: str, shared: set[str]) -> None:
        self._file = file
        self._tree = tree
        self._entry_point = entry_point
        self._shared = shared
        self._bindings = _Bindings(tree)
        self._kinds: dict[tuple[_Place, str], _Kind | None] = {}
        froms = [each for each in ast.walk(tree) if isinstance(each, ast.ImportFrom) and each.module == "cfepy.app"]
        self._has_cfe = any(alias.name == "Cfe" and not alias.asname for each in froms for alias in each.names)

    def problems(self) -> Iterator[MissionProblem]:
        """Yield the wrong uses of the handle."""
        nodes = list(ast.walk(self._tree))
        guarded = {part for node in nodes if _expects_it(node) for part in ast.walk(node)}
        for node in nodes:
            if isinstance(node, ast.Attribute) and node not in guarded and node.attr not in self._bindings.asked:
                base = self._kind(node.value)
                if base is not None and base.owner is None and not _has(base.service, node.attr):
                    yield MissionProblem(self._file, node.lineno, _absence(base.service, node.attr))
            elif isinstance(node, ast.Call) and isinstance(node.func, ast.Attribute) and node not in guarded:
                base = self._kind(node.func.value)
                fault = _misfit(base.service, node) if base is not None and base.service else None
                if fault is not None:
                    yield MissionProblem(self._file, node.lineno, fault)

    def _kind(self, node: ast.expr | None) -> _Kind | None:
        """Return the kind of an expression if it is certain; long chains of attributes are not followed."""
        if isinstance(node, ast.NamedExpr):
            return self._kind(node.value)
        if _chain(node) > _LONGEST_CHAIN:
            return None
        if isinstance(node, ast.Name):
            return self._kind_of_name(node.id, self._bindings.place_of[node])
        base = self._kind(node.value) if isinstance(node, ast.Attribute) else None
        if base is None or not isinstance(node, ast.Attribute):
            return None
        if base.owner is not None:
            return self._kind_of_attribute(base.owner, node.attr)
        return _Kind(node.attr) if not base.service and node.attr in _services() else None

    def _kind_of_name(self, name: str, place: _Place) -> _Kind | None:
        inside = place
        while (inside, name) not in self._bindings.names or (isinstance(inside, ast.ClassDef) and inside is not place):
            if isinstance(inside, ast.Module):
                return None
            inside = self._bindings.place_of[inside]
        if name in self._bindings.shared:
            return None
        return self._agreed((inside, name), self._bindings.names[inside, name])

    def _kind_of_attribute(self, owner: ast.ClassDef, name: str) -> _Kind | None:
        """Return the kind of `self.name`: of the assignments in all methods, also of related classes, or of a dataclass
        field.
        """
        if (owner, name) in self._bindings.names:  # a method or a value of the class
            return None
        if (owner, name) in self._bindings.attributes:
            stored = self._bindings.attributes.items()
            kin = [values for (other, each), values in stored if each == name and (other is owner or other.bases)]
            return self._agreed((owner, f"self.{name}"), [value for values in kin for value in values])
        fields = [each for each in owner.body if isinstance(each, ast.AnnAssign)]
        annotations = [each.annotation for each in fields if ast.unparse(each.target) == name]
        return _Kind() if annotations and all(map(self._is_cfe, annotations)) else None

    def _agreed(self, key: tuple[_Place, str], bound: Sequence[_Binding]) -> _Kind | None:
        """Return the kind that all values of a name share, except the constant None; None if they differ."""
        if key not in self._kinds:
            self._kinds[key] = None  # during the search
            values = [each for each in bound if not (isinstance(each, ast.Constant) and each.value is None)]
            self._kinds[key] = _the_same(
                self._kind_of_parameter(each) if isinstance(each, ast.arg) else self._kind(each) for each in values
            )
        return self._kinds[key]

    def _kind_of_parameter(self, node: ast.arg) -> _Kind | None:
        function = self._bindings.place_of[node]
        if not isinstance(function, ast.FunctionDef) or node.arg not in _positional(function):
            return None
        owner, at = self._bindings.owner(function), _positional(function).index(node.arg)
        if owner is not None and at == 0:
            return _Kind(owner=owner)
        if node.annotation is not None:
            return _Kind() if self._is_cfe(node.annotation) else None
        if function in self._tree.body and not function.decorator_list:
            is_entry = function.name == self._entry_point and at == 0
            return _Kind() if is_entry else self._passed(function.name, node.arg, at)
        if owner in self._tree.body and owner is not None and function.name == "__init__":
            return self._passed(owner.name, node.arg, at - 1)
        return None

    def _passed(self, callee: str, name: str, at: int) -> _Kind | None:
        """Return the kind of a parameter in all calls of a function; None if the function is also used in
        another way.
        """
        known = self._bindings
        if callee in known.escaped or self._shared & {callee, "*"} or len(known.names[self._tree, callee]) > 1:
            return None
        return _the_same(self._kind(_given(call, name, at)) for call in known.calls.get(callee, ()))

    def _is_cfe(self, annotation: ast.expr) -> bool:
        """Return whether an annotation is the class of the handle, imported from cfepy."""
        text = annotation.value if isinstance(annotation, ast.Constant) else ast.unparse(annotation)
        return self._has_cfe and text == "Cfe"


def _chain(node: ast.expr | None) -> int:
    """Return the number of chained attributes in an expression, up to one more than the maximum."""
    count = 0
    while isinstance(node, ast.Attribute) and count <= _LONGEST_CHAIN:
        node, count = node.value, count + 1
    return count


def _the_same(kinds: Iterable[_Kind | None]) -> _Kind | None:
    """Return the kind that all have; None if they differ or there is none."""
    first, *others = [*kinds] or [None]
    return first if all(each == first for each in others) else None


def _given(call: ast.Call, name: str, at: int) -> ast.expr | None:
    """Return the argument of a call for a parameter; None if it cannot be determined."""
    by_name = [each.value for each in call.keywords if each.arg == name]
    if by_name or any(isinstance(each, ast.Starred) for each in call.args[: at + 1]):
        return by_name[0] if by_name else None
    return call.args[at] if at < len(call.args) else None


def _expects_it(node: ast.AST) -> bool:
    """Return whether code handles a missing name: a `try` with a handler for it."""
    handlers = node.handlers if isinstance(node, ast.Try) else []
    return any(guard in ast.unparse(each.type) for each in handlers if each.type is not None for guard in GUARDS)


# -- existing names ----------------------------------------------------------------------------------------------------


@cache
def _services() -> Mapping[str, Any]:
    """Return the classes of the services, and the module `msg`, by their names in the handle."""
    return {**get_type_hints(Cfe), "msg": msg}


@cache
def _names(service: str) -> frozenset[str]:
    """Return the names that the class of a service has; the empty name means the handle."""
    kind = _services()[service] if service else Cfe
    classes = () if isinstance(kind, ModuleType) else inspect.getmro(kind)
    return frozenset(dir(kind)).union(*(vars(each).get("__annotations__", ()) for each in classes))


@cache
def _tree(module: str) -> ast.Module:
    """Return the syntax tree of a module of cfepy, compiled or not."""
    spec = importlib.util.find_spec(module)
    assert spec is not None
    assert spec.origin is not None
    file = Path(spec.origin)
    return parsed(file.with_name(f"{file.name.partition('.')[0]}.py").read_bytes())


@cache
def _body(owner: type) -> list[ast.stmt]:
    """Return the body of a class in its source."""
    tree = _tree(owner.__module__)
    return next(node.body for node in tree.body if isinstance(node, ast.ClassDef) and node.name == owner.__name__)


@cache
def _set_by_methods(service: str) -> frozenset[str]:
    """Return the attributes that methods of a service assign to `self`."""
    classes = inspect.getmro(_services()[service])[:-1]
    nodes = (node for each in classes for statement in _body(each) for node in ast.walk(statement))
    return frozenset(node.attr for node in nodes if isinstance(node, ast.Attribute) and isinstance(node.ctx, ast.Store))


def _has(service: str, name: str) -> bool:
    kind = _services()[service] if service else Cfe
    if isinstance(kind, ModuleType):
        return hasattr(kind, name)
    if name in _names(service):
        return True
    return bool(service) and (hasattr(kind, "__getattr__") or name in _set_by_methods(service))


def _absence(service: str, name: str) -> str:
    path = f"{HANDLE}.{service}" if service else HANDLE
    known = sorted(each for each in _names(service) if each[0] != "_")
    hint = did_you_mean(_pythonic(name), known, _ALL_NAMES, form=f"{path}.{{}}")
    return f"{path} has no {name!r}; {hint}"


def _pythonic(name: str) -> str:
    """Return the name of CFE_SB_TransmitMsg or TransmitMsg in cfepy."""
    return _NEW_WORD.sub("_", name.rpartition("_")[2] if name.startswith(("CFE_", "OS_")) else name).lower()


def _misfit(service: str, call: ast.Call) -> str | None:
    """Return why a call must fail with any argument values; None if it may succeed."""
    assert isinstance(call.func, ast.Attribute)
    if any(isinstance(each, ast.Starred) for each in call.args) or None in _keywords(call):
        return None
    name = call.func.attr
    signature = _signature(service, name)
    if signature is None:
        return None
    try:
        signature.bind(*call.args, **{str(each): None for each in _keywords(call)})
    except TypeError as error:
        names = ", ".join(map(str, signature.parameters.values()))
        return f"{HANDLE}.{service}.{name}: {error}; write {name}({names})"
    return None


@cache
def _signature(service: str, name: str) -> inspect.Signature | None:
    """Return the signature of a service's function without annotations; None if it is not a plain function or method.

    It is read from the source, because compiled functions have none.
    """
    kind = _services()[service]
    found = inspect.getattr_static(kind, name, None)
    if isinstance(kind, ModuleType):
        body = _tree(found.__module__).body if inspect.isfunction(found) else []
    else:
        body = next((_body(each) for each in inspect.getmro(kind)[:-1] if name in vars(each)), [])
    own_name = getattr(found, "__name__", name)
    function = next((node for node in body if isinstance(node, ast.FunctionDef) and node.name == own_name), None)
    if function is None or any(ast.unparse(each) in _NOT_PLAIN for each in function.decorator_list):
        return None
    parameters = _written_parameters(function.args)
    return inspect.Signature(parameters if isinstance(kind, ModuleType) else parameters[1:])


class _Written(str):
    """A default value as written in the source."""

    __repr__ = str.__str__


def _written_parameters(arguments: ast.arguments) -> list[inspect.Parameter]:
    kinds = inspect.Parameter
    positional: list[tuple[ast.arg, inspect._ParameterKind]] = [
        *((each, kinds.POSITIONAL_ONLY) for each in arguments.posonlyargs),
        *((each, kinds.POSITIONAL_OR_KEYWORD) for each in arguments.args),
    ]
    defaults = [*[None] * (len(positional) - len(arguments.defaults)), *arguments.defaults]
    made = [_parameter(each, kind, default) for (each, kind), default in zip(positional, defaults, strict=True)]
    if arguments.vararg is not None:
        made.append(_parameter(arguments.vararg, kinds.VAR_POSITIONAL, None))
    for each, default in zip(arguments.kwonlyargs, arguments.kw_defaults, strict=True):
        made.append(_parameter(each, kinds.KEYWORD_ONLY, default))
    if arguments.kwarg is not None:
        made.append(_parameter(arguments.kwarg, kinds.VAR_KEYWORD, None))
    return made


def _parameter(argument: ast.arg, kind: inspect._ParameterKind, default: ast.expr | None) -> inspect.Parameter:
    written = inspect.Parameter.empty if default is None else _Written(ast.unparse(default))
    return inspect.Parameter(argument.arg, kind, default=written)


def _keywords(call: ast.Call) -> list[str | None]:
    """Return the names of keyword arguments, with None for `**`."""
    return [each.arg for each in call.keywords]
