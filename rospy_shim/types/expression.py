"""Expressions in files: `$(eval ...)` in launch files and `rad(...)` in parameters.

They are written in Python's syntax, but Python does not execute them. An interpreter of their syntax tree supports
constants, operators, comparisons, conditions, subscripts, comprehensions, and calls of given functions and of methods
of texts, lists and mappings. These give no access to the computer. Each value is limited in size and the whole in its
number of steps (`cfepy.reading.input_limits`), so any expression ends soon.
"""

from __future__ import annotations

import ast
import math
import operator
import re
from collections.abc import Callable, Iterable, Iterator, Mapping
from typing import Any

from cfepy.interpreter.syntax_trees import TooDeepError, parsed
from cfepy.reading.input_limits import (
    EXPRESSION_BITS,
    EXPRESSION_CHARACTERS,
    EXPRESSION_DEPTH,
    EXPRESSION_SIZE,
    EXPRESSION_STEPS,
    EXPRESSION_WORK,
)
from cfepy.reading.suggestions import expected

_SHOWN = 60  # characters of an expression in an error
_TOO_MUCH = "compute less, or pass the value as an argument"
_LARGEST_COUNT = 5_000  # largest argument of n! and similar functions
_WIDTH = re.compile(r"\d{5,}")  # more than 9,999 characters
_PERCENT_WIDTH = re.compile(r"%[-+ #0]*(?:\(|\*|\d{5,}|\d*\.(?:\*|\d{5,}))")  # or as many as another value gives
_HASHED = 20  # weight of an item of a set or key of a mapping: many may have one hash
# fmt: off
_METHODS: dict[type, frozenset[str]] = {
    str: frozenset({
        "capitalize", "casefold", "center", "count", "endswith", "find", "format", "index", "isalnum", "isalpha",
        "isdecimal", "isdigit", "isidentifier", "islower", "isnumeric", "isspace", "istitle", "isupper", "join",
        "ljust", "lower", "lstrip", "partition", "removeprefix", "removesuffix", "replace", "rfind", "rindex", "rjust",
        "rpartition", "rsplit", "rstrip", "split", "splitlines", "startswith", "strip", "swapcase", "title", "upper",
        "zfill",
    }),
    list: frozenset({"copy", "count", "index"}),
    tuple: frozenset({"count", "index"}),
    dict: frozenset({"copy", "get", "items", "keys", "values"}),
    set: frozenset({"difference", "intersection", "isdisjoint", "issubset", "issuperset", "union"}),
    int: frozenset({"bit_length"}),
    float: frozenset({"is_integer"}),
}
_OF_MATH = (
    "acos", "acosh", "asin", "asinh", "atan", "atan2", "atanh", "cbrt", "ceil", "comb", "copysign", "cos", "cosh",
    "degrees", "dist", "e", "erf", "erfc", "exp", "exp2", "expm1", "fabs", "factorial", "floor", "fmod", "frexp",
    "fsum", "gamma", "gcd", "hypot", "inf", "isclose", "isfinite", "isinf", "isnan", "isqrt", "lcm", "ldexp", "lgamma",
    "log", "log10", "log1p", "log2", "modf", "nan", "nextafter", "perm", "pi", "pow", "prod", "radians", "remainder",
    "sin", "sinh", "sqrt", "tan", "tanh", "tau", "trunc", "ulp",
)
# fmt: on
MATH: dict[str, Any] = {name: getattr(math, name) for name in _OF_MATH if hasattr(math, name)}
"""The part of Python's `math` that roslaunch offers."""
_UNARY: dict[type[ast.AST], Callable[[Any], Any]] = {
    ast.Not: operator.not_,
    ast.USub: operator.neg,
    ast.UAdd: operator.pos,
    ast.Invert: operator.invert,
}
_BINARY: dict[type[ast.AST], Callable[[Any, Any], Any]] = {
    ast.Add: operator.add,
    ast.Sub: operator.sub,
    ast.Mult: operator.mul,
    ast.Div: operator.truediv,
    ast.FloorDiv: operator.floordiv,
    ast.Mod: operator.mod,
    ast.Pow: operator.pow,
    ast.LShift: operator.lshift,
    ast.RShift: operator.rshift,
    ast.BitAnd: operator.and_,
    ast.BitOr: operator.or_,
    ast.BitXor: operator.xor,
}
_COMPARE: dict[type[ast.AST], Callable[[Any, Any], bool]] = {
    ast.Eq: operator.eq,
    ast.NotEq: operator.ne,
    ast.Lt: operator.lt,
    ast.LtE: operator.le,
    ast.Gt: operator.gt,
    ast.GtE: operator.ge,
    ast.Is: operator.is_,
    ast.IsNot: operator.is_not,
    ast.In: lambda left, right: left in right,
    ast.NotIn: lambda left, right: left not in right,
}
_SIMPLE = (bool, float, complex, type(None))


class ExpressionError(Exception):
    """An expression has a part that expressions in files cannot have, or is too large; its text names it."""


def value_of(text: str, names: Mapping[str, Any]) -> Any:
    """Evaluate an expression.

    Args:
        text: the expression.
        names: values of names, and functions that it may call. They take precedence over Python's own functions for
            numbers, texts and lists.

    Returns:
        Its value.

    Raises:
        SyntaxError: it is not an expression.
        ExpressionError: it has a part that is not permitted, or is too large.
        Exception: any error of Python's, such as ZeroDivisionError.
    """
    if len(text) > EXPRESSION_CHARACTERS:
        raise ExpressionError(f"must have at most {EXPRESSION_CHARACTERS:,} characters, not {len(text):,}; {_TOO_MUCH}")
    try:
        return _Interpreter(names).value(parsed(text, mode="eval").body)
    except (RecursionError, MemoryError, TooDeepError):
        raise _too_deep() from None


def plain_text(value: Any) -> str:
    """Return `str(value)`.

    Raises:
        ExpressionError: its text may differ from run to run.
    """
    _check_printable(value)
    return str(value)


def _check_printable(value: Any) -> None:
    if isinstance(value, set) and len(value) > 1:
        raise ExpressionError("converts a set, which has no order, to text; write sorted(...)")
    if not isinstance(value, (*_SIMPLE, int, str, list, tuple, dict, set, range, slice)):
        what = "an iterator" if isinstance(value, Iterator) else type(value).__name__
        raise ExpressionError(f"converts {what} to text; write a call, or list(...) around it")
    if isinstance(value, (list, tuple, set, dict)):
        for each in (part for pair in value.items() for part in pair) if isinstance(value, dict) else value:
            _check_printable(each)


def _too_deep() -> ExpressionError:
    return ExpressionError(f"has more than {EXPRESSION_DEPTH} operators or brackets inside each other; {_TOO_MUCH}")


class _Interpreter:
    """Evaluates one expression; see `value_of`."""

    def __init__(self, names: Mapping[str, Any]) -> None:
        own = {
            "abs": abs, "all": self._all, "any": self._any, "bin": bin, "bool": bool, "chr": chr, "dict": self._dict,
            "divmod": divmod, "enumerate": self._enumerate, "filter": self._filter, "float": float, "hex": hex,
            "int": int, "len": len, "list": self._list, "map": self._map, "max": self._max, "min": self._min,
            "oct": oct, "ord": ord, "range": range, "repr": self._repr,
            "reversed": self._reversed, "round": self._round, "set": self._set, "sorted": self._sorted,
            "str": self._text, "sum": self._sum, "tuple": self._tuple, "zip": self._zip,
        }  # fmt: skip
        guards = {math.factorial: self._counted, math.comb: self._counted, math.perm: self._counted}
        self._guards: dict[Any, Callable[..., None]] = {
            **guards,
            math.prod: self._product,
            math.lcm: lambda *numbers: self._product(numbers),
        }
        self._names: dict[str, Any] = {**own, **names}
        self._functions = {id(each) for each in self._names.values() if callable(each)}
        self._known: dict[int, tuple[Any, int]] = {}  # sizes of immutable values; kept, so that ids stay unique
        self._steps = self._work = self._depth = 0
        # fmt: off
        self._kinds: dict[type[ast.AST], Callable[[Any], Any]] = {
            ast.Constant: self._constant, ast.Name: self._name, ast.UnaryOp: self._unary, ast.BinOp: self._binary,
            ast.BoolOp: self._logic, ast.Compare: self._comparison, ast.IfExp: self._condition, ast.Call: self._called,
            ast.List: self._items_of, ast.Tuple: lambda node: tuple(self._items_of(node)),
            ast.Set: lambda node: set(self._items_of(node)), ast.Dict: self._mapping, ast.Subscript: self._subscript,
            ast.Slice: self._slice, ast.ListComp: lambda node: list(self._made(node)),
            ast.SetComp: lambda node: set(self._made(node)), ast.GeneratorExp: self._generated,
            ast.DictComp: lambda node: dict(self._made(node)), ast.JoinedStr: self._joined,
            ast.FormattedValue: self._formatted,
        }
        # fmt: on

    def value(self, node: ast.AST) -> Any:
        """Return the value of a part of the expression."""
        self._steps += 1
        if self._steps > EXPRESSION_STEPS:
            raise ExpressionError(f"takes more than {EXPRESSION_STEPS:,} steps; {_TOO_MUCH}")
        evaluate = self._kinds.get(type(node))
        if evaluate is None:
            what = type(node).__name__
            raise ExpressionError(f"has {_said(node)}, which is not allowed in expressions in files ({what})")
        if self._depth >= EXPRESSION_DEPTH:
            raise _too_deep()
        self._depth += 1
        try:
            return self._held(evaluate(node))
        finally:
            self._depth -= 1

    # -- limits ------------------------------------------------------------------------------------------------------

    def _held(self, value: Any) -> Any:
        """Return a value if it is not too large."""
        if isinstance(value, _SIMPLE):
            return value
        self._allow(self._size(value))
        return value

    def _allow(self, size: float) -> None:
        """Count characters and items that are about to be made.

        Raises:
            ExpressionError: there are too many.
        """
        if size > EXPRESSION_SIZE:
            raise ExpressionError(f"makes a value of more than {EXPRESSION_SIZE:,} characters or items; {_TOO_MUCH}")
        self._work += int(size)
        if self._work > EXPRESSION_WORK:
            raise ExpressionError(f"makes values of more than {EXPRESSION_WORK:,} characters or items; {_TOO_MUCH}")

    def _allow_bits(self, bits: float) -> None:
        """Check the bits of a whole number that is about to be made. Errors as for `_allow`."""
        if bits > EXPRESSION_BITS:
            raise ExpressionError(f"makes a whole number of more than {EXPRESSION_BITS:,} bits; {_TOO_MUCH}")

    def _size(self, value: Any) -> int:
        """Return the number of characters and items; repeated inner ones count repeatedly."""
        if isinstance(value, str):
            return len(value)
        if isinstance(value, int) and not isinstance(value, bool):
            self._allow_bits(value.bit_length())
            return 1
        if not isinstance(value, (list, tuple, dict, set)):
            return 1
        known = self._known.get(id(value))
        if known is None:
            inner: Iterable[Any] = value
            if isinstance(value, dict):
                inner = (each for pair in value.items() for each in pair)
            size = 1 + sum(self._size(each) + 1 for each in inner)
            known = self._known[id(value)] = (value, size)
        return known[1]

    def _taken(self, values: Any) -> list[Any]:
        """Return the items of an iterable."""
        if isinstance(values, range):
            self._allow(len(values))
        found = list(values)
        self._steps += len(found)
        self._allow(self._size(found))
        return found

    def _once(self, values: list[Any]) -> Iterator[Any]:
        """Return items as an iterator, as Python's own functions do."""
        self._allow(self._size(values))
        return iter(values)

    # -- names, constants and displays -------------------------------------------------------------------------------

    def _constant(self, node: ast.Constant) -> Any:
        if isinstance(node.value, bytes) or node.value is ...:
            raise ExpressionError(f"has {_said(node)}, which is not allowed in expressions in files")
        return node.value

    def _name(self, node: ast.Name) -> Any:
        if node.id not in self._names:
            raise NameError(f"name {node.id!r} is not defined")
        return self._names[node.id]

    def _items_of(self, node: ast.List | ast.Tuple | ast.Set) -> list[Any]:
        return [each for part in node.elts for each in self._spread(part)]

    def _spread(self, node: ast.expr) -> list[Any]:
        return self._taken(self.value(node.value)) if isinstance(node, ast.Starred) else [self.value(node)]

    def _mapping(self, node: ast.Dict) -> dict[Any, Any]:
        found: dict[Any, Any] = {}
        for key, value in zip(node.keys, node.values, strict=True):
            if key is None:
                found.update(self.value(value))
            else:
                found[self.value(key)] = self.value(value)
        return found

    # -- operators ---------------------------------------------------------------------------------------------------

    def _unary(self, node: ast.UnaryOp) -> Any:
        return _UNARY[type(node.op)](self.value(node.operand))

    def _binary(self, node: ast.BinOp) -> Any:
        left, right = self.value(node.left), self.value(node.right)
        make = _BINARY.get(type(node.op))
        if make is None:
            raise ExpressionError(f"has {_said(node)}, whose operator is not allowed in expressions in files")
        self._foresee(type(node.op), left, right)
        return make(left, right)

    def _foresee(self, kind: type[ast.AST], left: Any, right: Any) -> None:
        """Check the size of an operator's result in advance, where it may be much more than the operands."""
        if isinstance(left, int) and isinstance(right, int):
            if kind is ast.Pow and right > 0:
                self._allow_bits(left.bit_length() * right if abs(left) > 1 else 1)
            elif kind is ast.LShift and left and right > 0:
                self._allow_bits(left.bit_length() + right)
            elif kind is ast.Mult:
                self._allow_bits(left.bit_length() + right.bit_length() - 1)
        elif kind is ast.Mult:
            for many, times in ((left, right), (right, left)):
                if isinstance(times, int):
                    self._allow(self._size(many) * max(0, times))
        elif kind is ast.Mod and isinstance(left, str):
            if len(left) > EXPRESSION_CHARACTERS or _PERCENT_WIDTH.search(left):
                raise ExpressionError(
                    "formats with a name or a width that is too large; write %s, or widths below 10,000"
                )
            for each in right if isinstance(right, tuple) else (right,):
                self._repr(each)

    def _logic(self, node: ast.BoolOp) -> Any:
        is_and, value = isinstance(node.op, ast.And), None
        for each in node.values:
            value = self.value(each)
            if bool(value) != is_and:
                return value
        return value

    def _comparison(self, node: ast.Compare) -> bool:
        left = self.value(node.left)
        for kind, each in zip(node.ops, node.comparators, strict=True):
            right = self.value(each)
            self._allow(self._size(left) + self._size(right))
            if not _COMPARE[type(kind)](left, self._taken(right) if isinstance(right, Iterator) else right):
                return False
            left = right
        return True

    def _condition(self, node: ast.IfExp) -> Any:
        return self.value(node.body if self.value(node.test) else node.orelse)

    def _subscript(self, node: ast.Subscript) -> Any:
        value, index = self.value(node.value), self.value(node.slice)
        if isinstance(value, type) or id(value) in self._functions:
            raise TypeError(f"{ast.unparse(node.value)} is not subscriptable")
        return value[index]

    def _slice(self, node: ast.Slice) -> slice:
        lower, upper, step = (
            None if each is None else self.value(each) for each in (node.lower, node.upper, node.step)
        )
        return slice(lower, upper, step)

    # -- comprehensions ----------------------------------------------------------------------------------------------

    def _generated(self, node: ast.GeneratorExp) -> Iterator[Any]:
        return self._once(list(self._made(node)))

    def _made(self, node: ast.ListComp | ast.SetComp | ast.DictComp | ast.GeneratorExp) -> Iterator[Any]:
        """Yield the items of a comprehension, pairs for a mapping; its variables hide names while it is evaluated."""
        outer = dict(self._names)
        size, each_one = 0, 1 if isinstance(node, (ast.ListComp, ast.GeneratorExp)) else _HASHED
        try:
            for _ in self._rounds(node.generators):
                if isinstance(node, ast.DictComp):
                    item: Any = (self.value(node.key), self.value(node.value))
                else:
                    item = self.value(node.elt)
                size += self._size(item) + each_one
                self._allow(0 if size <= EXPRESSION_SIZE else size)
                yield item
        finally:
            self._names = outer

    def _rounds(self, loops: list[ast.comprehension]) -> Iterator[None]:
        if not loops:
            yield
            return
        first, *inner = loops
        for item in self._taken(self.value(first.iter)):
            self._bind(first.target, item)
            if all(self.value(test) for test in first.ifs):
                yield from self._rounds(inner)

    def _bind(self, target: ast.expr, value: Any) -> None:
        if isinstance(target, ast.Name):
            self._names[target.id] = value
            return
        if not isinstance(target, (ast.Tuple, ast.List)):
            raise ExpressionError(f"has {_said(target)} as a variable; only names are allowed")
        values = self._taken(value)
        if len(values) != len(target.elts):
            raise ValueError(f"{len(values)} values for {len(target.elts)} variables")
        for part, each in zip(target.elts, values, strict=True):
            self._bind(part, each)

    # -- texts -------------------------------------------------------------------------------------------------------

    def _joined(self, node: ast.JoinedStr) -> str:
        found = [self.value(each) for each in node.values]
        return self._method("", "join", [found], {})  # type: ignore[no-any-return]

    def _formatted(self, node: ast.FormattedValue) -> str:
        value = self.value(node.value)
        if node.conversion != -1:
            value = ascii(value) if node.conversion == ord("a") else self._shown(value, chr(node.conversion))
        return self._format(value, "" if node.format_spec is None else self.value(node.format_spec))

    def _shown(self, value: Any, conversion: str) -> str:
        return self._repr(value) if conversion == "r" else self._text(value)

    def _format(self, value: Any, form: str) -> str:
        if _WIDTH.search(form):
            raise ExpressionError(f"formats with {_short(form)!r}; write widths below 10,000")
        return format(value, form) if form else self._text(value)

    def _fill(self, text: str, values: list[Any], named: dict[str, Any]) -> str:
        """Fill a text as `str.format` does; its fields may name values, but no attributes or items of them."""
        from string import Formatter

        for _, field, form, _ in Formatter().parse(text):
            if field is not None and re.fullmatch(r"\w*", field) is None:
                raise ExpressionError(f"formats {_short(field)!r}; name a value without attributes or items")
            if form and ("{" in form or _WIDTH.search(form)):
                raise ExpressionError(f"formats with {_short(form)!r}; write widths below 10,000")
        for each in (*values, *named.values()):
            self._text(each)
        self._allow(text.count("{") * max(map(self._size, (*values, *named.values())), default=0))
        return text.format(*values, **named)

    # -- calls -------------------------------------------------------------------------------------------------------

    def _called(self, node: ast.Call) -> Any:
        if any(each.arg is None for each in node.keywords):
            raise ExpressionError(f"has {_said(node)}; ** is not allowed there")
        if isinstance(node.func, ast.Attribute):
            value, name = self.value(node.func.value), node.func.attr
            return self._method(value, name, *self._given(node))
        function = self.value(node.func)
        if id(function) not in self._functions:
            raise TypeError(f"{ast.unparse(node.func)} cannot be called")
        values, named = self._given(node)
        return self._apply(function, values, named)

    def _given(self, node: ast.Call) -> tuple[list[Any], dict[str, Any]]:
        values = [each for part in node.args for each in self._spread(part)]
        return values, {each.arg: self.value(each.value) for each in node.keywords if each.arg is not None}

    def _apply(self, function: Callable[..., Any], values: list[Any], named: dict[str, Any] | None = None) -> Any:
        if id(function) not in self._functions:
            raise TypeError("this cannot be called")
        self._steps += 1
        guard = self._guards.get(function)
        if guard is not None:
            guard(*values, **(named or {}))
        return self._held(function(*values, **(named or {})))

    def _method(self, value: Any, name: str, values: list[Any], named: dict[str, Any]) -> Any:
        """Call a method of a text, a list or a mapping."""
        kind: type = type(value)
        if name not in _METHODS.get(kind, ()):
            hint = expected(name, sorted(_METHODS.get(kind, ())), subject="allowed are", last="and")
            raise ExpressionError(f"calls {name} of a {kind.__name__}, which is not allowed; {hint}")
        if name == "format":
            return self._fill(value, values, named)
        if name in ("center", "ljust", "rjust", "zfill") and values and isinstance(values[0], int):
            self._allow(values[0])
        elif name == "replace" and len(values) > 1 and isinstance(values[1], str):
            self._allow((len(value) + 1) * (len(values[1]) + 1))
        elif name == "join" and values:
            values = [self._taken(values[0]), *values[1:]]
            self._allow(self._size(values[0]) + len(value) * len(values[0]))
        found = getattr(value, name)(*values, **named)
        return list(found) if kind is dict and name in ("items", "keys", "values") else found

    # -- Python's functions, within the limits -------------------------------------------------------------------------

    def _text(self, value: Any = "") -> str:
        self._allow(2 * self._size(value))
        return plain_text(value)

    def _repr(self, value: Any) -> str:
        self._text(value)
        return repr(value)

    def _list(self, values: Any = ()) -> list[Any]:
        return self._taken(values)

    def _tuple(self, values: Any = ()) -> tuple[Any, ...]:
        return tuple(self._taken(values))

    def _set(self, values: Any = ()) -> set[Any]:
        return set(self._hashed(values))

    def _dict(self, values: Any = (), **named: Any) -> dict[Any, Any]:
        return dict(values if isinstance(values, dict) else self._hashed(values), **named)

    def _hashed(self, values: Any) -> list[Any]:
        """Return the items of an iterable that become keys."""
        found = self._taken(values)
        self._allow(_HASHED * len(found))
        return found

    def _all(self, values: Any) -> bool:
        return all(self._taken(values))

    def _any(self, values: Any) -> bool:
        return any(self._taken(values))

    def _enumerate(self, values: Any, start: int = 0) -> Iterator[Any]:
        return self._once(list(enumerate(self._taken(values), start)))

    def _reversed(self, values: Any) -> Iterator[Any]:
        return self._once(self._taken(values)[::-1])

    def _zip(self, *lists: Any) -> Iterator[Any]:
        return self._once(list(zip(*map(self._taken, lists), strict=False)))

    def _map(self, function: Any, first: Any, *lists: Any) -> Iterator[Any]:
        rows = zip(*map(self._taken, (first, *lists)), strict=False)
        return self._once([self._apply(function, list(row)) for row in rows])

    def _filter(self, function: Any, values: Any) -> Iterator[Any]:
        taken = self._taken(values)
        return self._once([each for each in taken if (each if function is None else self._apply(function, [each]))])

    def _max(self, *values: Any, **named: Any) -> Any:
        return max(*self._compared(values), **self._with_key(named))

    def _min(self, *values: Any, **named: Any) -> Any:
        return min(*self._compared(values), **self._with_key(named))

    def _compared(self, values: tuple[Any, ...]) -> tuple[Any, ...]:
        return (self._taken(values[0]),) if len(values) == 1 else values

    def _sorted(self, values: Any, **named: Any) -> list[Any]:
        return sorted(self._taken(values), **self._with_key(named))

    def _with_key(self, named: dict[str, Any]) -> dict[str, Any]:
        key = named.get("key")
        return named if key is None else {**named, "key": lambda each: self._apply(key, [each])}

    def _sum(self, values: Any, start: Any = 0) -> Any:
        for each in self._taken(values):
            if isinstance(start, str):
                raise TypeError("sum() cannot add texts; write ''.join(...)")
            start = self._held(start + each)
        return start

    def _round(self, number: Any, digits: int | None = None) -> Any:
        self._allow_bits(abs(digits) if isinstance(digits, int) else 0)
        return round(number, digits)

    def _counted(self, *numbers: Any) -> None:
        """Check n!, and choices out of n, in advance."""
        if any(isinstance(each, int) and each > _LARGEST_COUNT for each in numbers):
            raise ExpressionError(f"counts combinations of more than {_LARGEST_COUNT:,}; {_TOO_MUCH}")

    def _product(self, values: Any, *, start: Any = 1) -> None:
        """Check a product in advance; an iterator can be read only once, so it is refused."""
        if not isinstance(values, (list, tuple, set)):
            raise ExpressionError("multiplies a value that is not a list; write list(...) around it")
        self._allow_bits(sum(each.bit_length() for each in (start, *values) if isinstance(each, int)))


def _said(node: ast.AST) -> str:
    """Return a part of an expression for an error."""
    return repr(_short(ast.unparse(node)))


def _short(text: str) -> str:
    """Return a text on one line, and not too long."""
    line = " ".join(text.split())
    return line if len(line) <= _SHOWN else f"{line[:_SHOWN]}..."
