"""A property that is computed at its first use and then kept, without a lock of the host.

`functools.cached_property` of Python 3.11 holds one real lock for all objects of a class while it computes the value. A
task that waits inside would stop the whole simulated computer, and a process forked meanwhile would never get the lock.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Generic, Self, TypeVar, overload

T = TypeVar("T")


class CachedProperty(Generic[T]):
    """`functools.cached_property` as of Python 3.12, without a lock."""

    def __init__(self, function: Callable[[Any], T]) -> None:
        self.func = function
        self.attrname: str | None = None
        self.__doc__ = function.__doc__
        self.__module__ = function.__module__

    def __set_name__(self, owner: type, name: str) -> None:
        if self.attrname not in (None, name):
            raise TypeError(
                f"Cannot assign the same cached_property to two different names ({self.attrname!r} and {name!r})."
            )
        self.attrname = name

    @overload
    def __get__(self, instance: None, owner: type | None = None) -> Self: ...

    @overload
    def __get__(self, instance: object, owner: type | None = None) -> T: ...

    def __get__(self, instance: object, owner: type | None = None) -> Self | T:
        if instance is None:
            return self
        if self.attrname is None:
            raise TypeError("Cannot use cached_property instance without calling __set_name__ on it.")
        cache = instance.__dict__
        if self.attrname not in cache:
            cache[self.attrname] = self.func(instance)
        value: T = cache[self.attrname]
        return value
