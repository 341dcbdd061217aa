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
        deadline_ns: longest time between two messages in ns; 0 for no limit.
        lifespan_ns: time in ns after which a message of a publisher expires; 0 for never.
        is_manual: True if a publisher must say that it is alive (MANUAL_BY_TOPIC).
        lease_ns: longest time between two such assertions in ns; 0 for no limit.
    """

    depth: int = 10
    is_reliable: bool = True
    is_kept: bool = False
    keeps_all: bool = False
    deadline_ns: int = 0
    lifespan_ns: int = 0
    is_manual: bool = False
    lease_ns: int = 0


def mismatch(offered: Quality, requested: Quality) -> str | None:
    """Return the name of the policy that keeps two sides apart, as rmw names it; None if they match."""
    if requested.is_kept and not offered.is_kept:
        return "DURABILITY"
    if requested.is_reliable and not offered.is_reliable:
        return "RELIABILITY"
    if _is_longer(offered.deadline_ns, requested.deadline_ns):
        return "DEADLINE"
    if (requested.is_manual and not offered.is_manual) or _is_longer(offered.lease_ns, requested.lease_ns):
        return "LIVELINESS"
    return None


def _is_longer(offered_ns: int, requested_ns: int) -> bool:
    """Return True if an offered time is longer than the requested one; 0 stands for no limit."""
    return bool(requested_ns) and (not offered_ns or offered_ns > requested_ns)
