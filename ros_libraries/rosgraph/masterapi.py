"""rosgraph.masterapi: the master's methods as functions that return the value or raise
(wiki.ros.org/ROS/Master_API)."""

from __future__ import annotations

from typing import Any
from xmlrpc.client import ServerProxy

from rosgraph.names import make_caller_id
from rosgraph.network import parse_http_host_and_port
from rosgraph.rosenv import get_master_uri


class MasterException(Exception):
    """The master did not execute the request."""


class MasterFailure(MasterException):
    """The master failed."""


class MasterError(MasterException):
    """The master found an error in the request."""


ROSMasterException = MasterException
Error = MasterError
Failure = MasterFailure


def is_online(master_uri: str | None = None) -> bool:
    """Return whether a master answers.

    Args:
        master_uri: the master's URI; by default from the environment.
    """
    return Master("rosgraph", master_uri=master_uri).is_online()


class Master:
    """The master.

    Args:
        caller_id: name of the caller.
        master_uri: the master's URI; by default from the environment.

    Every method except `is_online` raises `MasterError` or `MasterFailure`, with the master's text, if it does not
    answer success, and the error of `xmlrpc.client` if there is no answer.
    """

    def __init__(self, caller_id: str, master_uri: str | None = None) -> None:
        self._reinit(get_master_uri() if master_uri is None else master_uri)
        self.caller_id = make_caller_id(caller_id).removesuffix("/")

    def _reinit(self, master_uri: str) -> None:
        """Ask another master from now on."""
        if master_uri is None:
            raise ValueError("ROS master URI is not set")
        try:
            parse_http_host_and_port(master_uri)
        except ValueError:
            raise ValueError(f"invalid master URI: {master_uri}") from None
        self.master_uri = master_uri
        self.handle: Any = ServerProxy(master_uri)

    def is_online(self) -> bool:
        """Return whether the master answers."""
        try:
            self.getPid()
        except Exception:
            return False
        return True

    def _succeed(self, args: Any) -> Any:
        """Return the value of an answer."""
        code, text, value = args
        if code == 1:
            return value
        raise (MasterError if code == -1 else MasterFailure)(text)

    def _ask(self, method: str, *args: Any) -> Any:
        return self._succeed(getattr(self.handle, method)(self.caller_id, *args))

    def getPid(self) -> int:
        """Return the master's process number."""
        return int(self._ask("getPid"))

    def getUri(self) -> str:
        """Return the master's URI as it knows it."""
        return str(self._ask("getUri"))

    # -- parameters --------------------------------------------------------------------------------------------------

    def deleteParam(self, key: str) -> Any:
        """Remove a parameter."""
        return self._ask("deleteParam", key)

    def setParam(self, key: str, value: Any) -> Any:
        """Set a parameter. A dictionary replaces a namespace."""
        return self._ask("setParam", key, value)

    def getParam(self, key: str) -> Any:
        """Return the value of a parameter."""
        return self._ask("getParam", key)

    def searchParam(self, key: str) -> Any:
        """Return the full name of the nearest parameter of that name."""
        return self._ask("searchParam", key)

    def hasParam(self, key: str) -> Any:
        """Return whether there is a parameter."""
        return self._ask("hasParam", key)

    def getParamNames(self) -> Any:
        """Return the names of all parameters."""
        return self._ask("getParamNames")

    def subscribeParam(self, caller_api: str, key: str) -> Any:
        """Return the value of a parameter. The master reports changes to the URI `caller_api`."""
        return self._ask("subscribeParam", caller_api, key)

    def unsubscribeParam(self, caller_api: str, key: str) -> Any:
        """End the notifications about a parameter."""
        return self._ask("unsubscribeParam", caller_api, key)

    # -- registrations -----------------------------------------------------------------------------------------------

    def registerService(self, service: str, service_api: str, caller_api: str) -> Any:
        """Register a service."""
        return self._ask("registerService", service, service_api, caller_api)

    def unregisterService(self, service: str, service_api: str) -> Any:
        """Unregister a service. Returns how many were unregistered."""
        return self._ask("unregisterService", service, service_api)

    def registerSubscriber(self, topic: str, topic_type: str, caller_api: str) -> Any:
        """Register a subscriber. Returns the URIs of the publishers."""
        return self._ask("registerSubscriber", topic, topic_type, caller_api)

    def unregisterSubscriber(self, topic: str, caller_api: str) -> Any:
        """Unregister a subscriber. Returns how many were unregistered."""
        return self._ask("unregisterSubscriber", topic, caller_api)

    def registerPublisher(self, topic: str, topic_type: str, caller_api: str) -> Any:
        """Register a publisher. Returns the URIs of the subscribers."""
        return self._ask("registerPublisher", topic, topic_type, caller_api)

    def unregisterPublisher(self, topic: str, caller_api: str) -> Any:
        """Unregister a publisher. Returns how many were unregistered."""
        return self._ask("unregisterPublisher", topic, caller_api)

    # -- the graph ---------------------------------------------------------------------------------------------------

    def lookupNode(self, node_name: str) -> Any:
        """Return the URI of a node."""
        return self._ask("lookupNode", node_name)

    def lookupService(self, service: str) -> Any:
        """Return the URI of a service."""
        return self._ask("lookupService", service)

    def getPublishedTopics(self, subgraph: str) -> Any:
        """Return [topic, type] of all published topics below a namespace."""
        return self._ask("getPublishedTopics", subgraph)

    def getTopicTypes(self) -> Any:
        """[topic, type] of all topics."""
        return self._ask("getTopicTypes")

    def getSystemState(self) -> Any:
        """Return publishers, subscribers, providers of services: three lists of [name, [node, ...]]."""
        return self._ask("getSystemState")
