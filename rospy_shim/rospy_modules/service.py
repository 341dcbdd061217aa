"""rospy.service: the services that this node offers."""

from __future__ import annotations

import logging
import threading
from hashlib import md5
from typing import Any

from rospy.core import MASTER_NAME, ROSRPC
from rospy.impl._node import ServiceException, offered
from rospy.impl.registration import Registration, get_registration_listeners, set_service_manager
from rospy.impl.transport import BIDIRECTIONAL, INBOUND, OUTBOUND
from rospy.names import ANYTYPE, GLOBALNS, REMAP, SEP, SERVICE_ANYTYPE, TOPIC_ANYTYPE

__all__ = [
    "ANYTYPE",
    "BIDIRECTIONAL",
    "GLOBALNS",
    "INBOUND",
    "MASTER_NAME",
    "OUTBOUND",
    "REMAP",
    "ROSRPC",
    "SEP",
    "SERVICE_ANYTYPE",
    "TOPIC_ANYTYPE",
    "ServiceException",
    "ServiceManager",
    "logger",
    "md5",
]

logger = logging.getLogger("rospy.service")


class _Service:
    """A service in the table of `ServiceManager`.

    Args:
        name: its name.
        service_class: its type.
    """

    def __init__(self, name: str, service_class: Any) -> None:
        import rospy

        self.resolved_name = rospy.resolve_name(name)
        self.service_class = service_class
        self.request_class = service_class._request_class
        self.response_class = service_class._response_class
        self.uri: Any = None


class ServiceManager:
    """A table of services by name.

    Args:
        registration_listeners: are notified when a service is added or removed; None is the node's listeners.
    """

    def __init__(self, registration_listeners: Any = None) -> None:
        self.lock = threading.RLock()
        self.map: dict[str, Any] = {}
        self.registration_listeners: Any = registration_listeners or get_registration_listeners()

    def get_services(self) -> list[tuple[str, str]]:
        """Return the name and URI of each service."""
        return [(name, service.uri) for name, service in self.map.items()]

    def get_service(self, resolved_service_name: str) -> Any:
        """Return the service with a name, or None."""
        return self.map.get(resolved_service_name)

    def register(self, resolved_service_name: str, service: Any) -> None:
        """Add a service.

        Raises:
            ServiceException: there is a service with that name.
        """
        with self.lock:
            if resolved_service_name in self.map:
                raise ServiceException(f"service [{resolved_service_name}] already registered")
            self.map[resolved_service_name] = service
        self.registration_listeners.notify_added(resolved_service_name, service.uri, Registration.SRV)

    def unregister(self, resolved_service_name: str, service: Any) -> None:
        """Remove a service, if it is the one with that name."""
        with self.lock:
            if resolved_service_name not in self.map or self.map[resolved_service_name] is not service:
                return
            del self.map[resolved_service_name]
        self.registration_listeners.notify_removed(resolved_service_name, service.uri, Registration.SRV)

    def unregister_all(self) -> None:
        """Remove all services."""
        with self.lock:
            self.map.clear()


class _OfNode(ServiceManager):
    """The services that the node offers."""

    @property
    def map(self) -> dict[str, Any]:
        services: dict[str, Any] = offered()
        return services

    @map.setter
    def map(self, value: dict[str, Any]) -> None:
        """Ignore the value: the node keeps its services itself."""


set_service_manager(_OfNode())
