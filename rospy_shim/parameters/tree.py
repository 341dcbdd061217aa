"""The parameter server: one tree for the mission.

Reads use the tree, as fast as a dictionary. Changes are also written to cFE tables of the application ROS
(`rospy_shim.parameters.app`), which survive a processor reset.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from cfepy.reading.input_limits import PARAMETER_BYTES, PARAMETER_DEPTH
from rospy_shim.parameters.rows import ParameterRows, name_of
from rospy_shim.parameters.values import depth_of, least_size
from rospy_shim.types.exceptions import ROSException
from rospy_shim.types.names import SEP, join, namespace_of

_MISSING = object()


class ParameterTree:
    """Parameters of all nodes, by resolved name; a namespace is a dictionary.

    Args:
        initial: the tree to begin with.

    Attributes:
        changed_by: the node that set the parameter of which listeners are notified; "" for all other changes.
    """

    def __init__(self, initial: Mapping[str, Any] | None = None) -> None:
        self._root: dict[str, Any] = {}
        self._rows: ParameterRows | None = None
        self._save: Callable[[], object] = _nothing
        self._listeners: list[Callable[[str], object]] = []
        self._started: set[str] = set()
        self._survived = False
        self.changed_by = ""
        for name, value in (initial or {}).items():
            self.set(join(SEP, name), _plain(value))

    # -- the tables ----------------------------------------------------------------------------------------------------

    def keep_in(self, rows: ParameterRows, save: Callable[[], object], former: dict[str, Any]) -> None:
        """Keep the parameters in rows of tables from now on.

        Args:
            rows: rows of all tables.
            save: called when the tables are to be written.
            former: the parameters that they hold now.

        Raises:
            ParametersFull: there is no room for the present parameters.
        """
        rows.replace("", self._root, former)
        self._rows, self._save = rows, save

    def restore(self, root: dict[str, Any], rows: ParameterRows, save: Callable[[], object]) -> None:
        """Replace the present parameters by the ones in tables; arguments as for `keep_in`."""
        if self._rows is None:
            self._survived = True  # these tables have not been changed since the processor started
        self._root, self._rows, self._save = root, rows, save
        self._tell(SEP)

    def let_go(self) -> None:
        """Release the tables; the parameters stay as long as the processor runs."""
        self._rows, self._save = None, _nothing

    def give(self, node: str, values: Mapping[str, Any]) -> None:
        """Set the private parameters of the mission file for a node that starts.

        They are set once, as by roslaunch. A node that starts again, also after a processor reset, finds its own
        changes of them; only missing ones are set then.

        Args:
            node: its full name.
            values: values that XML-RPC can carry.

        Raises:
            ParametersFull: there is no room.
        """
        again = self._survived or node in self._started
        self._started.add(node)
        for name, value in values.items():
            key = join(node, name)
            if not again or self.find(key) is _MISSING:
                self._set(key, value)
                self._tell(key)
        self._save()

    def offer(self, node: str, values: Mapping[str, Any]) -> None:
        """Set the parameters in the table of a compiled node that starts: once, where there are none.

        Args:
            node: its full name.
            values: a tree of them.

        Raises:
            ParametersFull: there is no room.
        """
        if self._survived or node in self._started:
            return
        self._started.add(node)
        self._offer("", values)
        self._save()

    def _offer(self, above: str, values: Mapping[str, Any]) -> None:
        for name, value in values.items():
            key = f"{above}{SEP}{name}"
            there = self.find(key)
            if there is _MISSING:
                self._set(key, value)
                self._tell(key)
            elif type(there) is dict and type(value) is dict:
                self._offer(key, value)

    def on_change(self, listener: Callable[[str], object]) -> None:
        """Notify a listener of changes from now on.

        Args:
            listener: takes the full name of the parameter or namespace that was set or deleted.
        """
        self._listeners.append(listener)

    def _tell(self, key: str, by: str = "") -> None:
        self.changed_by = by
        for listener in self._listeners:
            listener(key)

    # -- contents ------------------------------------------------------------------------------------------------------

    def find(self, key: str) -> Any:
        """Return the value or namespace of a resolved name, or `ParameterTree.MISSING`."""
        value: Any = self._root
        for part in _parts(key):
            if type(value) is not dict or part not in value:
                return _MISSING
            value = value[part]
        return value

    MISSING = _MISSING

    def set(self, key: str, value: Any, by: str = "") -> None:
        """Set the value of a name; a dictionary replaces the whole namespace.

        Args:
            key: the name.
            value: the value.
            by: the node that sets it, if it is one.

        Raises:
            TypeError: the root can only be a dictionary.
            ParametersFull: the tables have no room for it.
            ROSException: it has too many levels, or is too large.
        """
        self._set(key, value)
        self._save()
        self._tell(key, by)

    def _set(self, key: str, value: Any) -> None:
        parts = _parts(key)
        if not parts and type(value) is not dict:
            raise TypeError("cannot set root of parameter tree to non-dictionary")
        if len(parts) + depth_of(value) > PARAMETER_DEPTH:
            raise ROSException(f"parameter {key[:200]}: more than {PARAMETER_DEPTH} nested namespaces and lists")
        if least_size(value, PARAMETER_BYTES) > PARAMETER_BYTES:
            raise ROSException(f"parameter {key[:200]}: more than the limit of {PARAMETER_BYTES:,} bytes")
        if self._rows is not None:
            former = self.find(key)
            self._rows.replace(name_of(parts), value, {} if former is _MISSING else former)
        if not parts:
            self._root = dict(value)
            return
        place = self._root
        for part in parts[:-1]:
            inner = place.get(part)
            if type(inner) is not dict:
                inner = place[part] = {}
            place = inner
        place[parts[-1]] = value

    def delete(self, key: str) -> None:
        """Remove a name.

        Raises:
            KeyError: there is no such name.
        """
        *path, last = _parts(key) or [""]
        place = self.find(SEP.join(path))
        if type(place) is not dict or last not in place:
            raise KeyError(key)
        if self._rows is not None:
            above = name_of(_parts(SEP.join(path)))
            self._rows.remove(f"{above}{name_of([last])}", place[last], above if above and len(place) == 1 else None)
        del place[last]
        self._save()
        self._tell(key)

    def search(self, namespace: str, key: str) -> str | None:
        """Return the name that has the first part of `key` in the namespace or one above it, or None."""
        first, slash, rest = key.partition(SEP)
        while True:
            candidate = join(namespace, first)
            if self.find(candidate) is not _MISSING:
                return candidate + slash + rest
            if namespace == SEP:
                return None
            namespace = namespace_of(namespace)

    def names(self) -> list[str]:
        """Return all names that have a value."""
        found: list[str] = []
        _collect("", self._root, found)
        return found


def _nothing() -> None:
    """Do nothing: the parameters are not kept over a reset."""


def _parts(key: str) -> list[str]:
    return [part for part in key.split(SEP) if part]


def _plain(value: Any) -> Any:
    """Convert mappings and sequences of a mission file to dictionaries and lists."""
    if isinstance(value, Mapping):
        return {str(key): _plain(item) for key, item in value.items()}
    if isinstance(value, (list, tuple)):
        return [_plain(item) for item in value]
    return value


def _collect(prefix: str, place: dict[str, Any], found: list[str]) -> None:
    for name, value in place.items():
        if type(value) is dict:
            _collect(f"{prefix}/{name}", value, found)
        else:
            found.append(f"{prefix}/{name}")
