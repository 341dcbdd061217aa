"""What publishers and subscribers have in common: the handle that a node holds (rospy.topics.Topic).

Imports nothing of cfepy.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, Any, ClassVar, NamedTuple, cast

from rospy_shim.names import is_legal_name

if TYPE_CHECKING:
    from rospy_shim.node import Node


class Connection(NamedTuple):
    """A node at the other side, under the names by which libraries such as actionlib look for it."""

    endpoint_id: str
    callerid_pub: str


def connections_of(sides: Iterable[Any]) -> list[Connection]:
    """The nodes that some links or subscriptions belong to."""
    return [Connection(side.node.names.name, side.node.names.name) for side in sides]


class TopicHandle:
    """A topic as one side of a node sees it; `impl` is shared by all handles of the side, None once unregistered."""

    __module__ = "rospy.topics"
    _node: ClassVar[Node]
    impl: Any = None

    def __init__(self, name: str, data_class: Any, reg_type: str) -> None:
        """Check the arguments and resolve the name.

        Raises:
            ValueError: an empty name, a class that is no message class, or a private name before `init_node`.
        """
        if not name or not isinstance(name, str):
            raise ValueError("topic name is not a non-empty string")
        if data_class is None:
            raise ValueError("topic parameter 'data_class' is not initialized")
        if not isinstance(data_class, type):
            raise ValueError(f"data_class [{data_class}] is not a class")
        if not hasattr(data_class, "_md5sum"):
            raise ValueError(f"data_class [{type(data_class).__name__}] is not a message data class")
        node = self._node
        if not is_legal_name(name):
            node.warn_of_illegal(name)
        names = node.names
        if node.initialized:
            self.resolved_name = names.resolve_name(name)
        else:
            self.resolved_name = names.resolve_name_without_node_name(name)
        self.name = self.resolved_name
        self.data_class = message = cast(Any, data_class)
        self.type: str = message._type
        self.md5sum: str = message._md5sum
        self.reg_type = reg_type

    def get_num_connections(self) -> int:
        """How many are at the other side."""
        self._node.universe.charge()
        return self.impl.get_num_connections() if self.impl is not None else 0
