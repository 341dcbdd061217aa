"""Hooks before the puts into pipes: each of several is called, in any order of addition."""

from __future__ import annotations

import pytest

from cfepy.sb import Destination, PutHook
from tests.sb.harness import Bench, packet

MID = 0x0881


class Least(PutHook):
    """Limits the number of waiting messages."""

    def __init__(self, most: int, inner: PutHook | None) -> None:
        super().__init__(inner)
        self._most = most
        self.puts = 0

    def limit(self, destination: Destination) -> int:
        return min(super().limit(destination), self._most)

    def put(self, destination: Destination) -> None:
        super().put(destination)
        self.puts += 1


@pytest.mark.parametrize("limits", [(1, 3), (3, 1)])
def test_each_hook_is_called(limits: tuple[int, int]) -> None:
    bench = Bench()
    bus = bench.bus
    inner = Least(limits[0], bus.put_hook)
    bus.put_hook = outer = Least(limits[1], inner)

    def send() -> None:
        bus.subscribe(MID, bus.create_pipe(4, "P"))
        for _ in range(3):
            bus.transmit_msg(packet(MID))

    bench.do("APP", send)
    assert (inner.puts, outer.puts) == (1, 1)
    assert bus.counters.msg_limit_error == 2
