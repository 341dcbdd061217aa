"""rospy.impl.paramserver: values of parameters that a program keeps itself."""

from __future__ import annotations

import threading
from collections.abc import Callable
from typing import Any

from rospy.names import GLOBALNS, SEP

__all__ = ["GLOBALNS", "SEP", "ParamServerCache", "get_param_server_cache"]


class ParamServerCache:
    """Values by resolved name of the parameter."""

    def __init__(self) -> None:
        self.lock = threading.Lock()
        self.d: dict[str, Any] = {}
        self.notifier: Callable[[str, Any], object] | None = None

    def set_notifier(self, notifier: Callable[[str, Any], object]) -> None:
        """Have a function called with each parameter that is updated."""
        self.notifier = notifier

    def update(self, key: str, value: Any) -> None:
        """Change a value.

        Raises:
            KeyError: the parameter is not kept here.
        """
        with self.lock:
            if key not in self.d:
                raise KeyError(key)
            self.d[key] = value
        if self.notifier is not None:
            self.notifier(key, value)

    def set(self, key: str, value: Any) -> None:
        """Keep a value."""
        with self.lock:
            self.d[key] = value

    def get(self, key: str) -> Any:
        """A value.

        Raises:
            KeyError: the parameter is not kept here.
        """
        with self.lock:
            return self.d[key]

    def delete(self, key: str) -> None:
        """Forget a value, and those below it."""
        with self.lock:
            for each in [each for each in self.d if each == key or each.startswith(key.rstrip(SEP) + SEP)]:
                del self.d[each]


_cache = ParamServerCache()


def get_param_server_cache() -> ParamServerCache:
    """The node's."""
    return _cache
