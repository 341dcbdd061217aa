"""rospy.impl.paramserver: a cache for the values of parameters."""

from __future__ import annotations

import threading
from collections.abc import Callable
from typing import Any

from rospy.names import GLOBALNS, SEP

__all__ = ["GLOBALNS", "SEP", "ParamServerCache", "get_param_server_cache"]


class ParamServerCache:
    """Values by the parameter's resolved name."""

    def __init__(self) -> None:
        self.lock = threading.Lock()
        self.d: dict[str, Any] = {}
        self.notifier: Callable[[str, Any], object] | None = None

    def set_notifier(self, notifier: Callable[[str, Any], object]) -> None:
        """Set the function that is called with each updated parameter."""
        self.notifier = notifier

    def update(self, key: str, value: Any) -> None:
        """Change a value.

        Raises:
            KeyError: the parameter is not in the cache.
        """
        with self.lock:
            if key not in self.d:
                raise KeyError(key)
            self.d[key] = value
        if self.notifier is not None:
            self.notifier(key, value)

    def set(self, key: str, value: Any) -> None:
        """Add or change a value."""
        with self.lock:
            self.d[key] = value

    def get(self, key: str) -> Any:
        """Return a value.

        Raises:
            KeyError: the parameter is not in the cache.
        """
        with self.lock:
            return self.d[key]

    def delete(self, key: str) -> None:
        """Remove a value and the values below it."""
        with self.lock:
            for each in [each for each in self.d if each == key or each.startswith(key.rstrip(SEP) + SEP)]:
                del self.d[each]


_cache = ParamServerCache()


def get_param_server_cache() -> ParamServerCache:
    """Return the node's cache."""
    return _cache
