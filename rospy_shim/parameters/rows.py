"""The rows of the parameter tables that hold each parameter; a change writes only the rows that differ.

The rows here are the intended contents of the tables; `rospy_shim.parameters.app` writes the `changed` ones into them.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

from rospy_shim.parameters.table import FREE, VALUE_BYTES, Record, Row, count_rows, rows_for
from rospy_shim.parameters.values import leaf_names, least_size, leaves_of, text_of, written
from rospy_shim.types.exceptions import ROSException

_FREE, _USED = 0, 1
_MOST_SHOWN = 200  # characters of a name in an error


class ParametersFull(ROSException):
    """The parameter tables have no room for a parameter."""


class ParameterRows:
    """The rows of all tables together.

    Args:
        rows: the contents of the tables; rows that belong to no good parameter are emptied.
        good: the parameters in them, by name.

    Attributes:
        rows: the intended contents.
        changed: numbers of the rows that the tables do not hold yet, in the order of their change.
    """

    def __init__(self, rows: Iterable[Row], good: Mapping[str, Record]) -> None:
        self.rows = list(rows)
        self.changed: dict[int, None] = {}
        self._used = bytearray(len(self.rows))
        self._records = dict(good)
        for record in good.values():
            self._used[record.first : record.first + record.length] = bytes([_USED]) * record.length
        for index, row in enumerate(self.rows):
            if not self._used[index] and row != FREE:
                self._put(index, FREE)

    @property
    def parameters(self) -> int:
        """The number of parameters; an empty namespace counts as one."""
        return len(self._records)

    @property
    def free(self) -> int:
        """The number of free rows."""
        return self._used.count(_FREE)

    def replace(self, name: str, value: Any, former: Any) -> None:
        """Replace the value of a parameter or namespace.

        Args:
            name: its name in the tables, "" for the root.
            value: the new value.
            former: the old value; an empty dictionary if there was none.

        Raises:
            ParametersFull: there is no room; nothing has changed.
        """
        room = len(self.rows) * VALUE_BYTES
        if least_size(value, room) > room:  # before the texts are made
            raise ParametersFull(
                f"the parameter tables are full: {_shown(name)} needs more than all {len(self.rows)} rows"
            )
        new = dict(leaves_of(name, value))
        self._change(name, new, [*leaf_names(name, former), *self._above(name)])

    def remove(self, name: str, former: Any, empty: str | None) -> None:
        """Remove a parameter or namespace.

        Args:
            name: its name in the tables.
            former: its value.
            empty: the namespace above it if that is empty now and not the root, otherwise None.
        """
        new = {} if empty is None else {empty: text_of({})}
        self._change(name, new, list(leaf_names(name, former)))

    def _above(self, name: str) -> list[str]:
        """Return values, or empty namespaces, that a name needs as a namespace."""
        found = []
        while name:
            name = name.rpartition("/")[0]
            if name in self._records:
                found.append(name)
        return found

    def _change(self, name: str, new: dict[str, str], old: list[str]) -> None:
        going = [record for each in dict.fromkeys(old) if (record := self._records.get(each)) is not None]
        kept = {record.name: record for record in going if new.get(record.name) == record.text}
        released = sum(record.length for record in going if record.name not in kept)
        needed = sum(count_rows(each, text) for each, text in new.items() if each not in kept)
        free = self.free + released
        if needed > free:
            room = f"{needed} rows of {len(self.rows)}, {free} are free"
            raise ParametersFull(f"the parameter tables are full: {_shown(name)} needs {room}")
        coming = {each: rows_for(each, text) for each, text in new.items() if each not in kept}
        for record in going:
            if record.name not in kept and not self._in_place(record, new, coming):
                self._release(record)
        for each, rows in coming.items():
            self._place(each, new[each], rows)

    def _in_place(self, record: Record, new: dict[str, str], coming: dict[str, list[Row]]) -> bool:
        """Write the rows of a parameter over its former ones. Returns False if their number differs."""
        rows = coming.get(record.name)
        if rows is None or len(rows) != record.length:
            return False
        self._records[record.name] = record._replace(text=new[record.name])
        for index, row in enumerate(rows, record.first):
            self._put(index, row)
        del coming[record.name]
        return True

    def _release(self, record: Record) -> None:
        del self._records[record.name]
        for index in range(record.first, record.first + record.length):
            self._used[index] = _FREE
            self._put(index, FREE)

    def _place(self, name: str, text: str, rows: list[Row]) -> None:
        first = self._used.find(bytes(len(rows)))
        if first < 0:
            first = self._move_together()
        self._records[name] = Record(name, text, first, len(rows))
        for index, row in enumerate(rows, first):
            self._used[index] = _USED
            self._put(index, row)

    def _move_together(self) -> int:
        """Move all parameters to the front, so that the free rows are adjacent. Returns the first free row."""
        kept = [row for row, used in zip(self.rows, self._used, strict=True) if used]
        moved: dict[int, int] = {}
        for index, used in enumerate(self._used):
            if used:
                moved[index] = len(moved)
        self._records = {name: record._replace(first=moved[record.first]) for name, record in self._records.items()}
        free = len(self.rows) - len(kept)
        self._used[:] = bytes([_USED]) * len(kept) + bytes(free)
        for index, row in enumerate([*kept, *[FREE] * free]):
            self._put(index, row)
        return len(kept)

    def _put(self, index: int, row: Row) -> None:
        if self.rows[index] != row:
            self.rows[index] = row
            self.changed[index] = None


def _shown(name: str) -> str:
    return name[:_MOST_SHOWN] or "/"


def name_of(parts: Iterable[str]) -> str:
    """Return the name in the tables from its parts."""
    return "".join(f"/{written(part)}" for part in parts)
