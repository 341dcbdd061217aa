"""`rospy.msproxy.MasterProxy` and `rospy.get_master`: the master with the node's name and remappings filled in."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from typing import TYPE_CHECKING, Any, ClassVar

from rospy_shim.types.exceptions import ROSException

if TYPE_CHECKING:
    from rospy_shim.client.node import Node

# Methods whose first argument is a name to which the node's remappings apply.
# fmt: off
_NAMED = frozenset({
    "deleteParam", "getParam", "getPublishedTopics", "hasParam", "lookupNode", "lookupService", "registerPublisher",
    "registerService", "registerSubscriber", "requestTopic", "searchParam", "setParam", "subscribeParam",
    "unregisterPublisher", "unregisterService", "unregisterSubscriber", "unsubscribeParam",
})
# fmt: on


class MasterProxy:
    """The master as a node sees it: every method of the Master API without the caller's name.

    It is a dictionary of parameters as well. Each node has a subclass that knows the node.
    """

    __module__ = "rospy.msproxy"
    _node: ClassVar[Node]

    def __init__(self, uri: str) -> None:
        """Make a proxy.

        Args:
            uri: URI of the master.
        """
        self.target: Any = self._node.universe.importer.load("xmlrpc.client").ServerProxy(uri)

    def __getattr__(self, name: str) -> Callable[..., Any]:
        def ask(*args: Any, **kwds: Any) -> Any:
            given = list(args)
            if name in _NAMED:
                given[0] = self._node.names.resolve_name(given[0])
            return getattr(self.target, name)(self._node.names.get_caller_id(), *given, **kwds)

        return ask

    def __getitem__(self, key: str) -> Any:
        """Return the value of a parameter.

        Raises:
            KeyError: it is not set.
        """
        resolved = self._node.names.resolve_name(key)
        try:
            return self._node.params.cached(resolved)
        except KeyError:
            pass
        code, _, value = self.target.getParam(self._node.names.get_caller_id(), resolved)
        if code != 1:
            raise KeyError(key)
        return value

    def get_param_cached(self, key: str) -> Any:
        """Return the value of a parameter from the node's cache; the master keeps it up to date from the first call on.

        Raises:
            KeyError: it is not set, or an empty namespace.
            TypeError: before `init_node`; the node has no URI for the master's updates.
        """
        node = self._node
        resolved = node.names.resolve_name(key)
        cache = node.universe.importer.load("rospy.impl.masterslave").get_param_server_cache()
        try:
            return cache.get(resolved)
        except KeyError:
            code, _, value = self.target.subscribeParam(
                node.names.get_caller_id(), node.client.get_node_uri(), resolved
            )
            if code != 1:
                raise KeyError(key)  # noqa: B904  # as in rospy, the traceback shows both errors
            cache.set(resolved, value)
            if isinstance(value, dict) and not value:
                raise KeyError(key)  # noqa: B904
            return value

    def __setitem__(self, key: str, value: Any) -> None:
        """Set a parameter; a cached value becomes `value` itself."""
        resolved = self._node.names.resolve_name(key)
        self.target.setParam(self._node.names.get_caller_id(), resolved, value)
        self._node.params.recache(resolved, value)

    def __delitem__(self, key: str) -> None:
        """Remove a parameter.

        Raises:
            KeyError: it is not set.
            ROSException: the master failed.
        """
        code, text, _ = self.deleteParam(key)
        if code == -1:
            raise KeyError(key)
        if code != 1:
            raise ROSException(f"cannot delete parameter: {text}")

    def __contains__(self, key: str) -> bool:
        """Return True if a parameter is set.

        Raises:
            ROSException: the master failed.
        """
        code, text, found = self.hasParam(key)
        if code != 1:
            raise ROSException(f"cannot check parameter on server: {text}")
        return bool(found)

    def __iter__(self) -> Iterator[str]:
        """Iterate over the names of all parameters.

        Raises:
            ROSException: the master failed.
        """
        code, text, names = self.getParamNames()
        if code != 1:
            raise ROSException(f"cannot retrieve parameter names: {text}")
        return iter(names)

    def search_param(self, key: str) -> str | None:
        """Return the full name of the nearest parameter of that name, or None.

        Raises:
            ROSException: the master failed.
        """
        key = self._node.names.get_mappings().get(key, key)
        code, text, found = self.target.searchParam(self._node.names.get_caller_id(), key)
        if code == 0:
            raise ROSException(f"cannot search for parameter: {text}")
        return found if code == 1 else None


def make_master_proxy(node: Node) -> type[MasterProxy]:
    """Make the class `rospy.msproxy.MasterProxy` of a node."""
    return type("MasterProxy", (MasterProxy,), {"__module__": MasterProxy.__module__, "_node": node})


def make_get_master(node: Node, proxy: type[MasterProxy]) -> Callable[..., MasterProxy]:
    """Make the function `rospy.get_master` of a node; all calls return the same proxy, of the node's class `proxy`."""
    made: list[MasterProxy] = []

    def get_master(env: Mapping[str, str] = node.universe.environ) -> MasterProxy:
        """Return the master that the environment names.

        Args:
            env: environment with ROS_MASTER_URI; the node's environment by default.
        """
        if not made:
            uri = env.get("ROS_MASTER_URI", "http://localhost:11311")
            made.append(proxy(uri))
        return made[0]

    return get_master
