"""Quality of service as the seam needs it, and the rule by which a publisher and a subscription match.

A subscription requests, a publisher offers. DDS connects them only if the offer is at least as good as the request.
Publishers and subscribers of ROS 1 have no such rule: they are reliable, and a latching publisher keeps its message.
"""

from __future__ import annotations

from typing import NamedTuple


class Quality(NamedTuple):
    """Quality of service of one side of a topic.

    Attributes:
        depth: number of messages that are kept.
        is_reliable: False for best effort.
        is_kept: True if a publisher keeps messages for later subscriptions (transient local).
        keeps_all: True if no message may be dropped because of the depth.
    """

    depth: int = 10
    is_reliable: bool = True
    is_kept: bool = False
    keeps_all: bool = False


def mismatch(offered: Quality, requested: Quality) -> str | None:
    """Return the name of the policy that keeps two sides apart, as rmw names it; None if they match."""
    if requested.is_kept and not offered.is_kept:
        return "DURABILITY"
    if requested.is_reliable and not offered.is_reliable:
        return "RELIABILITY"
    return None
