"""Parameters: the functions by which a node reads and writes the mission's tree (`rospy_shim.parameters.tree`).

Values are limited to those of XML-RPC (`rospy_shim.parameters.values`): tuples become lists, bytes become Binary, None
and big integers are refused with the same errors.
"""

from __future__ import annotations

from collections.abc import Mapping
from contextlib import suppress
from typing import TYPE_CHECKING, Any
from xml.parsers.expat import ExpatError

from rospy_shim.parameters.tree import ParameterTree
from rospy_shim.parameters.values import DateTime, marshalled, through_xml
from rospy_shim.types.exceptions import ROSException
from rospy_shim.types.names import SEP

if TYPE_CHECKING:
    from rospy_shim.client.node import Node

_MISSING = ParameterTree.MISSING


class Unspecified:
    """The placeholder for "no default" (rospy.client._Unspecified); nodes pass it on from functions of their own."""

    __module__ = "rospy.client"


UNSPECIFIED = Unspecified()


class Params:
    """The parameter functions of one node (rospy.get_param and related functions).

    Args:
        node: the node, which resolves names.
        tree: the mission's parameters.
    """

    def __init__(self, node: Node, tree: ParameterTree) -> None:
        self._node = node
        self._tree = tree
        self.cache: Any = None  # its ParamServerCache, once the node has loaded the class
        self.rosout_keys: list[str] = []  # parameters that the node is subscribed to because it logs

    def get_param(self, param_name: str, default: Any = UNSPECIFIED) -> Any:
        """Return the value of a parameter, or a namespace as a dictionary. The node's cache comes first.

        Args:
            param_name: global, relative or private.
            default: the result if there is no such parameter; it may be None.

        Raises:
            KeyError: there is no such parameter and no default; it holds `param_name`.
            ValueError: the default is an array, which rospy compares.
        """
        self._node.universe.charge()
        resolved = self._node.names.resolve_name(param_name)
        try:
            return self.cached(resolved)
        except KeyError:
            pass
        value = self._tree.find(self._sent("getParam", resolved)[0])
        if value is not _MISSING:
            return self.unpacked(value)
        if default != UNSPECIFIED:
            return default
        raise KeyError(param_name)

    def get_param_cached(self, param_name: str, default: Any = UNSPECIFIED) -> Any:
        """Return the value of a parameter from the node's cache.

        The first call for a parameter adds it to the cache, and the master reports its changes from then on.

        Raises:
            KeyError: there is no such parameter and no default, or an empty namespace.
            TypeError: before `init_node`.
            ValueError: the default is an array, which rospy compares.
        """
        self._node.universe.charge()
        try:
            return self._node.universe.importer.load("rospy.client").get_master().get_param_cached(param_name)
        except KeyError:
            if default != UNSPECIFIED:
                return default
            raise

    def cached(self, resolved_name: str) -> Any:
        """Return the value of a parameter in the node's cache.

        Raises:
            KeyError: it is not there.
        """
        if self.cache is None:
            raise KeyError(resolved_name)
        return self.cache.get(resolved_name)

    def asked_by_rosout(self, key: str) -> Any:
        """Return the value of a global parameter that rospy itself caches with each log message; {} if it is not set.

        So `get_param("/")` has only this one after a node's first log message.
        """
        if not self.rosout_keys:
            self._node.universe.importer.load("rospy.impl.paramserver")
            self.rosout_keys.append(key)
        try:
            return self.cached(key)
        except KeyError:
            value = self._tree.find(key)
            self.cache.set(key, {} if value is _MISSING else self.unpacked(value))
            return {} if value is _MISSING else value

    def recache(self, resolved_name: str, value: Any) -> None:
        """Change a parameter in the node's cache, if it is there, to the value that the node set."""
        if self.cache is not None:
            with suppress(KeyError):
                self.cache.update(resolved_name, value)

    def has_param(self, param_name: str) -> bool:
        """Return True if a parameter or namespace exists."""
        self._node.universe.charge()
        key = self._sent("hasParam", self._node.names.resolve_name(param_name))[0]
        return self._tree.find(key) is not _MISSING

    def set_param(self, param_name: str, param_value: Any) -> None:
        """Set a parameter; a dictionary replaces a whole namespace.

        Raises:
            TypeError, OverflowError: XML-RPC cannot carry the value.
            xmlrpc.client.Fault: a text has a character that XML does not have, such as NUL.
            ParametersFull: ROS's tables have no room for it; a ROSException.
        """
        self._node.universe.charge()
        self._node.warn_of_illegal(param_name)
        resolved = self._node.names.resolve_name(param_name)
        key, value = self._sent("setParam", resolved, marshalled(param_value))
        if key != SEP or type(value) is dict:
            # rospy ignores the master's refusal of a root that is not a dictionary
            self._tree.set(key, value, self._node.names.get_name())
        self.recache(resolved, param_value)

    def give(self, values: Mapping[str, Any]) -> None:
        """Set the private parameters of the mission file for the node; see `ParameterTree.give`."""
        self._tree.give(self._node.names.get_name(), {name: marshalled(value) for name, value in values.items()})

    def delete_param(self, param_name: str) -> None:
        """Remove a parameter or namespace.

        Raises:
            KeyError: there is no such parameter or namespace.
        """
        key = self._sent("deleteParam", self._node.names.resolve_name(param_name))[0]
        try:
            self._tree.delete(key)
        except KeyError:
            raise KeyError(param_name) from None

    def search_param(self, param_name: str) -> str | None:
        """Return the full name of the nearest parameter of that name, from the node's namespace upwards, or None.

        Raises:
            ROSException: a private name.
        """
        key = self._node.names.get_mappings().get(param_name, param_name)
        key = self._sent("searchParam", marshalled(key))[0]
        if not isinstance(key, str) or not key:
            return None
        if key.startswith("~"):
            raise ROSException("cannot search for parameter: Internal failure: invalid key")
        if key.startswith(SEP):
            return key if self._tree.find(key) is not _MISSING else None
        return self._tree.search(self._node.names.get_name(), key)

    def get_param_names(self) -> list[str]:
        """Return the full names of all parameters."""
        return self._tree.names()

    def _sent(self, method: str, *arguments: Any) -> tuple[Any, ...]:
        """Return the arguments as the master gets them over XML-RPC.

        Raises:
            xmlrpc.client.Fault: of the node's own `xmlrpc.client`; XML lacks a character of a text.
        """
        self._node.kernel.tell(self, method, arguments)
        try:
            return through_xml(method, self._node.names.get_name(), *arguments)
        except ExpatError as error:
            fault = self._node.universe.importer.load("xmlrpc.client").Fault(1, f"{type(error)}:{error}")
        raise fault

    def unpacked(self, value: Any) -> Any:
        """Return a copy for the node, with bytes and dates in the classes of its own xmlrpc.client."""
        if type(value) is dict:
            return {key: self.unpacked(item) for key, item in value.items()}
        if type(value) is list:
            return [self.unpacked(item) for item in value]
        if type(value) is bytes:
            return self._node.universe.importer.load("xmlrpc.client").Binary(value)
        if type(value) is DateTime:
            return self._node.universe.importer.load("xmlrpc.client").DateTime(value.value)
        return value
