"""Hashes that do not show where an object lies: the standard library goes through sets of its threads and futures."""

from __future__ import annotations

from types import ModuleType
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from cfepy.nodes.universe import Universe


def hash_by_serial(universe: Universe, cls: Any) -> None:
    """Let the objects of a class of the node's hash by a number that counts up as they are first asked for it."""

    def serial_hash(self: Any) -> int:
        number = self.__dict__.get("_serial_hash")
        if number is None:
            universe.serial = number = universe.serial + 1
            self.__dict__["_serial_hash"] = number
        return int(number)

    cls.__hash__ = serial_hash


def fix_futures(universe: Universe, module: ModuleType) -> None:
    """After `concurrent.futures._base` was loaded: `as_completed` and `wait` make sets of futures."""
    hash_by_serial(universe, module.Future)
