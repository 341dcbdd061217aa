"""The size of a node's arena in the profiles pool and strict, with its reasons: subscriptions, the library, own code.

Blocks of the arena are powers of two, with a few bytes in front of each (roscfe/src/heap.cpp). A subscription has one
block for all its messages, each with room for the shared pointers to it, and one for the events that wait.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

from cfepy.extra.convert.message_headers import Profile
from cfepy.extra.convert.node_check.findings import SubscriptionMemory

OF_LIBRARY = 4096
"""Bytes for names, publishers, timers, and the list of subscriptions of the processor."""
OF_NODE = {Profile.POOL: 32768, Profile.STRICT: 4096}
"""Bytes for memory that the node's own code takes, which is unknown before it runs."""
OF_TRANSFORMS = 184320
"""Bytes for a buffer of transforms and its listener: the samples have a block of 131,072 bytes."""
OF_SUBSCRIPTION = 1024
"""Bytes for the names and the objects of one subscription."""
OF_POINTER, OF_EVENT, OF_CALLBACK = 112, 64, 32
"""Bytes for a message's shared pointers, for an event that waits, and for its callback."""
LEAD = 32
"""Bytes in front of a block, and the count in front of an array."""
GRAIN = 1024


@dataclass(frozen=True, slots=True)
class ArenaSize:
    """The memory that a node needs before it spins.

    Attributes:
        total: bytes of the arena.
        messages: bytes of it for messages of subscriptions.
        node: bytes of it for the node's own code.
        transforms: bytes of it for a buffer of transforms.
    """

    total: int
    messages: int
    node: int
    transforms: int = 0

    def __str__(self) -> str:
        """Return the size with its reasons."""
        rest = self.total - self.messages - self.node - self.transforms
        frames = f"{self.transforms:,} for a buffer of transforms, " if self.transforms else ""
        reasons = f"{self.messages:,} for subscriptions, {frames}{rest:,} for the library, "
        reasons += f"{self.node:,} for the node's own code"
        return f"arena of {self.total:,} bytes: {reasons}"


def arena_size(memory: Iterable[SubscriptionMemory], profile: Profile, has_transforms: bool = False) -> ArenaSize:
    """Return the size of the arena of a node.

    Args:
        memory: of all subscriptions of the node.
        profile: pool or strict. Nodes of the profile host have none.
        has_transforms: whether the node has a buffer of transforms.
    """
    messages, node = sum(_subscription(each.slots, each.size) for each in memory), OF_NODE.get(profile, 0)
    transforms = OF_TRANSFORMS if has_transforms else 0
    total = messages + transforms + OF_LIBRARY + node
    return ArenaSize(-(-total // GRAIN) * GRAIN, messages, node, transforms)


def _subscription(slots: int, size: int) -> int:
    message = -(-size // 16) * 16 + OF_POINTER
    return sum(_block(slots * each) for each in (message, OF_EVENT, OF_CALLBACK)) + OF_SUBSCRIPTION


def _block(size: int) -> int:
    return 1 << (size + LEAD - 1).bit_length()
