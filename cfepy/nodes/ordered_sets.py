"""Sets that iterate in insertion order, and the transformation that makes a program's set displays use them.

The order of a plain set depends on the hash seed of the process and on addresses, so a program that iterates one may
behave differently from run to run. With ordered sets switched on for a node, `set(...)`, `{a, b}` and `{x for ...}` in
its code create the class below. `frozenset`, and sets made by C code (`d.keys() & e`), stay plain.
"""

from __future__ import annotations

import ast
import builtins
from collections.abc import Iterable, Iterator
from typing import Any

SET_NAME = "__ordered_set__"


class _AnySet(type):
    def __instancecheck__(cls, instance: object) -> bool:
        return isinstance(instance, builtins.set)


class OrderedSet(set[Any], metaclass=_AnySet):
    """A set in insertion order. The plain set in its base class is kept in step, for readers written in C."""

    __slots__ = ("_order",)

    def __init__(self, items: Iterable[Any] = ()) -> None:
        self._order: dict[Any, None] = dict.fromkeys(items)
        super().__init__(self._order)

    def __iter__(self) -> Iterator[Any]:
        return iter(self._order)

    def __repr__(self) -> str:
        return "{" + ", ".join(map(repr, self._order)) + "}" if self._order else "set()"

    def __reduce__(self) -> tuple[Any, ...]:
        return OrderedSet, (list(self._order),)

    def add(self, item: Any) -> None:
        self._order[item] = None
        super().add(item)

    def discard(self, item: Any) -> None:
        self._order.pop(item, None)
        super().discard(item)

    def remove(self, item: Any) -> None:
        super().remove(item)
        del self._order[item]

    def pop(self) -> Any:
        """Remove and return the oldest item."""
        if not self._order:
            raise KeyError("pop from an empty set")
        item = next(iter(self._order))
        self.remove(item)
        return item

    def clear(self) -> None:
        self._order.clear()
        super().clear()

    def copy(self) -> OrderedSet:
        return OrderedSet(self._order)

    __copy__ = copy

    def update(self, *others: Iterable[Any]) -> None:
        for other in others:
            for item in list(other):
                self.add(item)

    def union(self, *others: Iterable[Any]) -> OrderedSet:
        result = self.copy()
        result.update(*others)
        return result

    def intersection(self, *others: Iterable[Any]) -> OrderedSet:
        known = [builtins.set(other) for other in others]
        return OrderedSet(item for item in self._order if all(item in other for other in known))

    def difference(self, *others: Iterable[Any]) -> OrderedSet:
        known = [builtins.set(other) for other in others]
        return OrderedSet(item for item in self._order if not any(item in other for other in known))

    def symmetric_difference(self, other: Iterable[Any]) -> OrderedSet:
        other = OrderedSet(other)
        return self.difference(other).union(other.difference(self))

    def intersection_update(self, *others: Iterable[Any]) -> None:
        self._become(self.intersection(*others))

    def difference_update(self, *others: Iterable[Any]) -> None:
        self._become(self.difference(*others))

    def symmetric_difference_update(self, other: Iterable[Any]) -> None:
        self._become(self.symmetric_difference(other))

    def _become(self, items: OrderedSet) -> None:
        self.clear()
        self.update(items)

    def __or__(self, other: Any) -> Any:
        return self.union(other) if _is_set(other) else NotImplemented

    def __and__(self, other: Any) -> Any:
        return self.intersection(other) if _is_set(other) else NotImplemented

    def __sub__(self, other: Any) -> Any:
        return self.difference(other) if _is_set(other) else NotImplemented

    def __xor__(self, other: Any) -> Any:
        return self.symmetric_difference(other) if _is_set(other) else NotImplemented

    def __ror__(self, other: Any) -> Any:
        return OrderedSet(other).union(self) if _is_set(other) else NotImplemented

    def __rand__(self, other: Any) -> Any:
        return OrderedSet(other).intersection(self) if _is_set(other) else NotImplemented

    def __rsub__(self, other: Any) -> Any:
        return OrderedSet(other).difference(self) if _is_set(other) else NotImplemented

    def __rxor__(self, other: Any) -> Any:
        return OrderedSet(other).symmetric_difference(self) if _is_set(other) else NotImplemented

    def __ior__(self, other: Any) -> Any:
        return self._in_place(self.union, other)

    def __iand__(self, other: Any) -> Any:
        return self._in_place(self.intersection, other)

    def __isub__(self, other: Any) -> Any:
        return self._in_place(self.difference, other)

    def __ixor__(self, other: Any) -> Any:
        return self._in_place(self.symmetric_difference, other)

    def _in_place(self, operation: Any, other: Any) -> Any:
        if not _is_set(other):
            return NotImplemented
        self._become(operation(other))
        return self


def _is_set(value: object) -> bool:
    return isinstance(value, (builtins.set, frozenset)) or (hasattr(value, "isdisjoint") and hasattr(value, "__and__"))


class _SetLiterals(ast.NodeTransformer):
    """Turns `{a, b}` and `{x for ...}` into calls; the right side of `in` stays, because its order is not visible."""

    def visit_Compare(self, node: ast.Compare) -> ast.AST:
        node.left = self.visit(node.left)
        node.comparators = [
            right if isinstance(right, ast.Set) and isinstance(how, (ast.In, ast.NotIn)) else self.visit(right)
            for how, right in zip(node.ops, node.comparators, strict=True)
        ]
        return node

    def visit_Set(self, node: ast.Set) -> ast.AST:
        self.generic_visit(node)
        return _call(node, ast.List(node.elts, ast.Load()))

    def visit_SetComp(self, node: ast.SetComp) -> ast.AST:
        self.generic_visit(node)
        return _call(node, ast.GeneratorExp(node.elt, node.generators))


def _call(node: ast.expr, argument: ast.expr) -> ast.AST:
    call = ast.Call(ast.Name(SET_NAME, ast.Load()), [argument], [])
    return ast.fix_missing_locations(ast.copy_location(call, node))


def with_ordered_sets(tree: ast.Module) -> ast.Module:
    """Return a module whose set displays make ordered sets."""
    made: ast.Module = _SetLiterals().visit(tree)
    return made
