"""rospy.impl.paramserver: a node's cache of the parameters that it asked for with `get_param_cached`.

`get_param` reads this cache first, so that a namespace has only its cached parts, and a deleted parameter is an empty
dictionary until its first read. Values are not copied.
"""

from __future__ import annotations

import threading
from collections.abc import Callable
from typing import Any

from rospy.impl._node import adopt_cache
from rospy.names import GLOBALNS, SEP

__all__ = ["GLOBALNS", "SEP", "ParamServerCache", "get_param_server_cache"]


class ParamServerCache:
    """A tree of the cached parameters, None until the first one."""

    def __init__(self) -> None:
        self.lock = threading.Lock()
        self.d: dict[str, Any] | None = None
        self.notifier: Callable[[str, Any], object] | None = None

    def set_notifier(self, notifier: Callable[[str, Any], object]) -> None:
        """Set the function that is called with each updated parameter."""
        self.notifier = notifier

    def update(self, key: str, value: Any) -> None:
        """Change a value.

        Raises:
            KeyError: the parameter is not in the cache.
            IndexError: it is the root.
            TypeError: a value that is not a namespace is above it.
        """
        with self.lock:
            if self.d is None:
                raise KeyError(key)
            parts = _parts(key)
            last = parts[-1]
            place: Any = self.d
            for part in parts[:-1]:
                if part not in place:
                    raise KeyError(key)
                place = place[part]
            if last not in place:
                raise KeyError(key)
            place[last] = value
            if self.notifier is not None:
                self.notifier(key, value)

    def set(self, key: str, value: Any) -> None:
        """Add or change a value; values above it become namespaces.

        Raises:
            TypeError: the root can only be a dictionary.
        """
        with self.lock:
            if key == GLOBALNS:
                if type(value) is not dict:
                    raise TypeError("cannot set root of parameter tree to non-dictionary")
                self.d = value
                return
            parts = _parts(key)
            last = parts[-1]
            if self.d is None:
                self.d = {}
            place = self.d
            for part in parts[:-1]:
                if type(place.get(part)) is not dict:
                    place[part] = {}
                place = place[part]
            place[last] = value

    def get(self, key: str) -> Any:
        """Return the value itself, or a namespace with its cached parts.

        Raises:
            KeyError: the parameter is not in the cache, or it is empty.
        """
        with self.lock:
            found: Any = self.d
            if found is None:
                raise KeyError(key)
            for part in _parts(key):
                if type(found) is not dict:
                    raise KeyError(found)
                found = found[part]
            if isinstance(found, dict) and not found:
                raise KeyError(key)
            return found

    def delete(self, key: str) -> None:
        """Remove a value.

        Raises:
            KeyError: the parameter is not in the cache, or it is the root.
        """
        with self.lock:
            if key == GLOBALNS:
                raise KeyError("cannot delete root of parameter tree")
            if self.d is None:
                raise KeyError(key)
            parts = _parts(key)
            last = parts[-1]
            place: Any = self.d
            for part in parts[:-1]:
                if type(place) is not dict or part not in place:
                    raise KeyError(key)
                place = place[part]
            if last not in place:
                raise KeyError(key)
            del place[last]


def _parts(key: str) -> list[str]:
    return [part for part in key.split(SEP) if part]


_cache = ParamServerCache()
adopt_cache(_cache)


def get_param_server_cache() -> ParamServerCache:
    """Return the node's cache."""
    return _cache
