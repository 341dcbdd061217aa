"""An outlet of the Software Bus gets every packet at once, without delaying or losing other messages."""

from __future__ import annotations

import pytest

from cfepy.sb import Outlet
from cfepy.status import CfeError
from tests.sb.harness import Bench, packet

MID = 0x0881


def test_packets_are_passed_on_at_once_and_counted_as_delivered() -> None:
    bench, taken = Bench("thread"), []
    outlet = Outlet(bench.bus, MID, "out", taken.append)
    for number in range(1000):  # more than any pipe holds
        bench.bus.transmit_msg(packet(MID, bytes([number % 256])))
    assert [each[16] for each in taken] == [number % 256 for number in range(1000)]
    assert bench.bus.routes[MID].totals() == (1000, 0, 0, 0)
    assert bench.bus.pool_use()[1] == 0
    assert bench.events.ids() == []
    outlet.close()
    bench.bus.transmit_msg(packet(MID))
    assert len(taken) == 1000
    bench.kernel.shutdown()


def test_outlet_is_not_in_the_table_of_pipes() -> None:
    bench = Bench("thread")
    one, two = (Outlet(bench.bus, MID, name, lambda packet: None) for name in ("one", "two"))
    assert len(bench.bus.pipes) == 0
    assert len({one.pipe_id, two.pipe_id}) == 2
    bench.kernel.shutdown()


def test_bus_without_room_for_the_msg_id_is_an_error() -> None:
    bench = Bench("thread")
    for msg_id in range(0x0800, 0x0800 + bench.bus.config.sb_max_msg_ids):
        Outlet(bench.bus, msg_id, "out", lambda packet: None)
    with pytest.raises(CfeError, match="no free entry for MsgId"):
        Outlet(bench.bus, 0x1FF0, "out", lambda packet: None)
    bench.kernel.shutdown()
