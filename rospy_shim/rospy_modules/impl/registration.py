"""rospy.impl.registration: listeners for topics and services that come and go, and the node's managers of them."""

from __future__ import annotations

import threading
import traceback
from typing import Any

from rospy.core import rospyerr
from rospy.impl._node import topic_manager

__all__ = [
    "Registration",
    "RegistrationListener",
    "RegistrationListeners",
    "get_registration_listeners",
    "get_service_manager",
    "get_topic_manager",
    "set_service_manager",
    "set_topic_manager",
]


class Registration:
    """Kinds of registrations."""

    PUB = "pub"
    SUB = "sub"
    SRV = "srv"


class RegistrationListener:
    """Base class of listeners to the node's registrations."""

    def reg_added(self, resolved_name: str, data_type_or_uri: str, reg_type: str) -> None:
        """Handle a new publisher or subscriber (with the topic's type) or a new service (with its URI)."""

    def reg_removed(self, resolved_name: str, data_type_or_uri: str, reg_type: str) -> None:
        """Handle one that was removed."""


class RegistrationListeners:
    """Calls all listeners; an exception in one does not affect the others."""

    def __init__(self) -> None:
        self.listeners: list[Any] = []
        self.lock = threading.Lock()

    def add_listener(self, l: Any) -> None:  # noqa: E741  # rospy's name
        """Add a listener."""
        with self.lock:
            self.listeners.append(l)

    def clear(self) -> None:
        """Remove all listeners."""
        with self.lock:
            self.listeners.clear()

    def notify_added(self, resolved_name: str, data_type: str, reg_type: str) -> None:
        """Notify the listeners of a registration."""
        self._notify("reg_added", resolved_name, data_type, reg_type)

    def notify_removed(self, resolved_name: str, data_type_or_uri: str, reg_type: str) -> None:
        """Notify the listeners of a registration that was removed."""
        self._notify("reg_removed", resolved_name, data_type_or_uri, reg_type)

    def _notify(self, method: str, *what: str) -> None:
        for listener in self.listeners[:]:
            try:
                getattr(listener, method)(*what)
            except Exception:
                rospyerr("error in a registration listener: %s", traceback.format_exc())


_listeners = RegistrationListeners()
_managers: dict[str, Any] = {"topics": topic_manager}


def get_registration_listeners() -> RegistrationListeners:
    """Return the node's listeners."""
    return _listeners


def get_topic_manager() -> Any:
    """Return the manager of the node's topics."""
    return _managers["topics"]


def set_topic_manager(tm: Any) -> None:
    """Set the manager that `get_topic_manager` returns."""
    _managers["topics"] = tm


def get_service_manager() -> Any:
    """Return the manager of the node's services."""
    if "services" not in _managers:
        import rospy.service  # noqa: F401  # which sets it
    return _managers["services"]


def set_service_manager(sm: Any) -> None:
    """Set the manager that `get_service_manager` returns."""
    _managers["services"] = sm
