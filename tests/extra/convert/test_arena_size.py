"""The size of a node's arena: room for the messages of its subscriptions, for the library, and for the node."""

from __future__ import annotations

from pathlib import Path

from cfepy.extra.convert.message_headers import Profile
from cfepy.extra.convert.node_check import SourcePlace, SubscriptionMemory, arena_size
from cfepy.extra.convert.node_check.arena_size import GRAIN, OF_LIBRARY, OF_NODE, OF_TRANSFORMS

PLACE = SourcePlace(Path("node.cpp"), 1)


def memory(slots: int, size: int) -> SubscriptionMemory:
    return SubscriptionMemory("/a", "a/A", slots, size, PLACE)


def test_node_without_subscriptions_has_room_for_the_library_and_its_own_code() -> None:
    for profile, own in OF_NODE.items():
        size = arena_size([], profile)
        assert (size.total, size.messages, size.node) == (OF_LIBRARY + own, 0, own)


def test_arena_holds_each_block_of_a_subscription() -> None:
    size = arena_size([memory(68, 1000)], Profile.STRICT)
    assert size.messages >= 68 * (1000 + 96) + 68 * 64
    assert size.total % GRAIN == 0
    assert size.total - size.messages - size.node >= OF_LIBRARY
    assert arena_size([memory(68, 1000)] * 2, Profile.STRICT).messages == 2 * size.messages


def test_size_says_its_reasons() -> None:
    text = "arena of 8,192 bytes: 0 for subscriptions, 4,096 for the library, 4,096 for the node's own code"
    assert str(arena_size([], Profile.STRICT)) == text


def test_size_has_room_for_a_buffer_of_transforms() -> None:
    with_transforms, without = (arena_size([], Profile.POOL, each) for each in (True, False))
    assert with_transforms.total - without.total == OF_TRANSFORMS
    assert "184,320 for a buffer of transforms" in str(with_transforms)
