"""A value that is computed once."""

from __future__ import annotations

import threading

import pytest

from cfepy.interpreter.cached import CachedProperty


class Sensor:
    """Says how often it was read."""

    reads = 0

    def read(self) -> int:
        """Read it."""
        self.reads += 1
        return self.reads

    value = CachedProperty(read)


def test_value_is_computed_once_for_each_object() -> None:
    first, second = Sensor(), Sensor()
    assert (first.value, first.value, second.value, first.reads) == (1, 1, 1, 1)
    assert Sensor.value.__doc__ == Sensor.read.__doc__
    with pytest.raises(TypeError, match="without calling __set_name__"):
        CachedProperty(len).__get__(first)


def test_value_is_computed_without_a_lock() -> None:
    """One object's value may need another's, which another thread computes."""

    class Link:
        def __init__(self, following: Link | None = None) -> None:
            self.following = following

        @CachedProperty
        def length(self) -> int:
            return 1 if self.following is None else 1 + in_thread(self.following)

    def in_thread(link: Link) -> int:
        found: list[int] = []
        thread = threading.Thread(target=lambda: found.append(link.length), daemon=True)
        thread.start()
        thread.join(30)
        return sum(found)

    assert Link(Link()).length == 2
