"""What a node publishes, subscribes to and offers, as rospy's managers show it (rospy.impl.registration).

Tools and bridges such as rosapi read these. Imports nothing of cfepy.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from rospy_shim.link import Link
    from rospy_shim.node import Node
    from rospy_shim.service import Service
    from rospy_shim.subscription import Subscription

PUB, SUB = "pub", "sub"


class TopicManager:
    """The topics of one node (rospy.topics._TopicManager).

    Args:
        node: the node.
    """

    __module__ = "rospy.topics"

    def __init__(self, node: Node) -> None:
        self._node = node
        self.closed = False

    @property
    def pubs(self) -> dict[str, Link]:
        """The publishing sides by topic."""
        return self._node.links

    @property
    def subs(self) -> dict[str, Subscription]:
        """The subscribing sides by topic."""
        return self._node.subscriptions

    @property
    def topics(self) -> set[str]:
        """Names of all topics of the node."""
        return {*self.pubs, *self.subs}

    def get_topics(self) -> set[str]:
        """Names of all topics of the node."""
        return self.topics

    def get_publications(self) -> list[list[str]]:
        """[topic, type] of what the node publishes."""
        return [[name, side.type] for name, side in self.pubs.items()]

    def get_subscriptions(self) -> list[list[str]]:
        """[topic, type] of what the node subscribes to."""
        return [[name, side.type] for name, side in self.subs.items()]

    def has_publication(self, resolved_name: str) -> bool:
        """Whether the node publishes a topic."""
        return resolved_name in self.pubs

    def has_subscription(self, resolved_name: str) -> bool:
        """Whether the node subscribes to a topic."""
        return resolved_name in self.subs

    def get_publisher_impl(self, resolved_name: str) -> Link | None:
        """The publishing side of a topic."""
        return self.pubs.get(resolved_name)

    def get_subscriber_impl(self, resolved_name: str) -> Subscription | None:
        """The subscribing side of a topic."""
        return self.subs.get(resolved_name)

    def get_impl(self, reg_type: str, resolved_name: str) -> Link | Subscription | None:
        """A side of a topic.

        Args:
            reg_type: "pub" or "sub".
            resolved_name: of the topic.

        Raises:
            TypeError: another `reg_type`.
        """
        return self.pubs.get(resolved_name) if _is_pub(reg_type) else self.subs.get(resolved_name)

    def acquire_impl(self, reg_type: str, resolved_name: str, data_class: Any) -> Link | Subscription:
        """A side of a topic, made when there is none, that one more handle uses.

        Raises:
            TypeError: another `reg_type`.
        """
        node, pub = self._node, _is_pub(reg_type)
        side = node.link(resolved_name, data_class) if pub else node.subscription(resolved_name, data_class)
        side.ref_count += 1
        return side

    def release_impl(self, reg_type: str, resolved_name: str) -> None:
        """A handle is done with a side, which is closed when it was the last one.

        Raises:
            TypeError: another `reg_type`.
        """
        side = self.get_impl(reg_type, resolved_name)
        if side is not None:
            side.ref_count -= 1
            if side.ref_count <= 0:
                side.close()

    def get_pub_sub_info(self) -> list[Any]:
        """All connections, as getBusInfo of the slave API gives them."""
        return [row for side in (*self.pubs.values(), *self.subs.values()) for row in side.get_stats_info()]

    def get_pub_sub_stats(self) -> tuple[list[Any], list[Any]]:
        """What went through the publishing and the subscribing sides, as getBusStats gives it."""
        return [side.get_stats() for side in self.pubs.values()], [side.get_stats() for side in self.subs.values()]

    def check_all(self) -> None:
        """Nothing to do: who has left the bus is gone from the connections."""

    def close_all(self) -> None:
        """Close all sides."""
        self.closed = True
        for link in list(self.pubs.values()):
            link.close()
        for subscription in list(self.subs.values()):
            subscription.close()


def _is_pub(reg_type: str) -> bool:
    if reg_type not in (PUB, SUB):
        raise TypeError(f"invalid reg_type: {reg_type}")
    return reg_type == PUB


def offered(node: Node) -> dict[str, Service]:
    """The services that a node offers, by name."""
    return {service.resolved_name: service for service in node.services}
