"""Parameters: the functions by which a node reads and writes the mission's tree (`rospy_shim.parameters.tree`).

Values are limited to those of XML-RPC (`rospy_shim.parameters.values`): tuples become lists, bytes become Binary, None
and big integers are refused with the same errors.
"""

from __future__ import annotations

from collections.abc import Mapping
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

    def get_param(self, param_name: str, default: Any = UNSPECIFIED) -> Any:
        """Return the value of a parameter, or a namespace as a dictionary.

        Args:
            param_name: global, relative or private.
            default: the result if there is no such parameter; it may be None.

        Raises:
            KeyError: there is no such parameter and no default; it holds `param_name`.
        """
        self._node.universe.charge()
        key = self._sent("getParam", self._node.names.resolve_name(param_name))[0]
        value = self._tree.find(key)
        if value is not _MISSING:
            return self._unpacked(value)
        if default is UNSPECIFIED:
            raise KeyError(param_name)
        return default

    def get_param_cached(self, param_name: str, default: Any = UNSPECIFIED) -> Any:
        """Return the same as `get_param`; the tree is as fast as a cache would be.

        Raises:
            TypeError: before `init_node`.
        """
        if not self._node.initialized:  # rospy asks the master to report changes to the node's URI, which is None
            raise TypeError("cannot marshal None unless allow_none is enabled")
        value = self.get_param(param_name, default)
        if value == {} and default is not value:
            if default is UNSPECIFIED:
                raise KeyError(param_name)
            return default  # rospy takes an empty namespace for none
        return value

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
        key = self._node.names.resolve_name(param_name)
        key, value = self._sent("setParam", key, marshalled(param_value))
        if key != SEP or type(value) is dict:
            self._tree.set(key, value)  # rospy ignores the master's refusal of a root that is not a dictionary

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

    def _unpacked(self, value: Any) -> Any:
        """Return a copy for the node, with bytes and dates in the classes of its own xmlrpc.client."""
        if type(value) is dict:
            return {key: self._unpacked(item) for key, item in value.items()}
        if type(value) is list:
            return [self._unpacked(item) for item in value]
        if type(value) is bytes:
            return self._node.universe.importer.load("xmlrpc.client").Binary(value)
        if type(value) is DateTime:
            return self._node.universe.importer.load("xmlrpc.client").DateTime(value.value)
        return value
