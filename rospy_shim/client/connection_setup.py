"""Connecting a publisher and a subscriber: at once, or after the time that a connection takes.

On ROS the master notifies the subscriber of the publisher, and the subscriber connects to it, in a thread
(rospy.impl.tcpros_pubsub). Until then neither counts the other, and published messages do not reach the subscriber.
Then the publisher's side counts the connection, notifies its listeners, and hands over its latched message, in this
order. The duration is set in the mission file (`connection_delay`), or left open to the schedule (`connect=`). Only
nodes connect: messages of cFE applications on a topic pass over the bus at any time.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from rospy_shim.client.link import Link
    from rospy_shim.client.subscription import Subscription


def delay_of(link: Link, subscription: Subscription) -> int:
    """Return the virtual ns until these two are connected. It is 0 with a node outside, because the network decides
    it.
    """
    if link.is_outside or subscription.is_outside:
        return 0
    node = link.node
    publisher, subscriber = node.names.name, subscription.node.names.name
    return node.kernel.connection_delay(publisher, subscriber, link.name, node.graph.connection_delay_ns)


def begin(link: Link, subscription: Subscription, delay_ns: int, *, late: bool) -> None:
    """Connect two sides that are both on the graph.

    Args:
        link: the publishing side.
        subscription: the subscribing side.
        delay_ns: virtual ns until they are connected; 0 connects them at once.
        late: the publisher existed before, and may have a latched message.
    """
    if subscription.connects_itself and not late:
        link.expect_peer(subscription)  # until its connection exists
        return
    if not delay_ns:
        link.peer_joined(subscription, late=late)
        return
    link.expect_peer(subscription)
    link.node.start_task("connect", lambda: _finish(link, subscription, delay_ns))


def _finish(link: Link, subscription: Subscription, delay_ns: int) -> None:
    """Connect them, unless one has left or the whole node is about to. A long message on its way is not cut."""
    link.node.kernel.delay(delay_ns)
    link.acquire()
    try:
        if subscription not in link.expected or link.closed:
            return
        link.peer_connected(subscription)
    finally:
        link.release()
    link.welcome(subscription, late=True)
