"""`TappedLink`: the publishing side of a topic in a run that is recorded.

A message that nobody gets is not serialised, so the bus never sees it; here it is shown to whoever looks on. Nothing
else changes: no virtual time, no sequence number, no record in the trace. Imports rospy_shim only.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from rospy_shim.link import Link

if TYPE_CHECKING:
    from rospy_shim.node import Node


class TappedLink(Link):
    """A link that shows what nobody gets to `on_unsent` of the bus."""

    def __init__(self, node: Node, name: str, data_class: Any) -> None:
        super().__init__(node, name, data_class)
        self._on_unsent: Any = node.cfe.sb.on_unsent

    def send(self, message: Any) -> None:
        """See `Link.send`."""
        route = self._routes.get(self.msg_id)
        if self.topic is not None and self._on_unsent is not None and (route is None or not route.active):
            try:
                self._on_unsent(self, self._pack(message))
            except Exception:  # whatever a generated class raises
                pass  # as `Link.send`, which does not look at a message that nobody gets
        super().send(message)


def link_class(node: Node) -> type[Link]:
    """The class of a node's links."""
    return Link if node.cfe.sb.on_unsent is None else TappedLink
