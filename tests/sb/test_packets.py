"""The packets of the Software Bus have NASA's layouts, and what stands in them is true."""

from __future__ import annotations

from cfepy.sb import packets as pk
from cfepy.sb.task import SbTask
from tests.layouts import assert_same
from tests.sb.harness import Bench, packet


def test_layouts_are_nasas() -> None:
    assert_same(pk.HOUSEKEEPING, "CFE_SB_HousekeepingTlm_Payload_t")
    assert_same(pk.STATISTICS, "CFE_SB_StatsTlm_Payload_t")
    assert_same(pk.PIPE_DEPTH_STATS, "CFE_SB_PipeDepthStats_t")


def test_housekeeping_and_statistics_count_what_happened() -> None:
    bench = Bench()
    task = SbTask(bench.bus)
    pipe = bench.do("A", lambda: bench.bus.create_pipe(2, "PIPE"))
    assert isinstance(pipe, int)
    bench.do("A", lambda: bench.bus.subscribe_ex(0x881, pipe, 0, 9))
    for _ in range(3):
        bench.do("B", lambda: bench.bus.transmit_msg(packet(0x881, bytes(20))))
    bench.do("B", lambda: bench.bus.transmit_msg(packet(0x882)))
    housekeeping = pk.HOUSEKEEPING.unpack(pk.HOUSEKEEPING.pack(task.housekeeping()))
    assert housekeeping["PipeOverflowErrorCounter"] == housekeeping["NoSubscribersCounter"] == 1
    assert housekeeping["MemInUse"] == 2 * (36 + 64)
    assert housekeeping["UnmarkedMem"] == 524288 - housekeeping["MemInUse"]
    statistics = pk.STATISTICS.unpack(pk.STATISTICS.pack(task.statistics()))
    assert (statistics["PipesInUse"], statistics["SubscriptionsInUse"], statistics["SBBuffersInUse"]) == (1, 1, 2)
    assert statistics["PipeDepthStats"][0] == {
        "PipeId": pipe,
        "MaxQueueDepth": 2,
        "CurrentQueueDepth": 2,
        "PeakQueueDepth": 2,
        "Spare": 0,
    }
    bench.kernel.shutdown()


def test_eight_bit_counters_wrap() -> None:
    bench = Bench()
    bench.bus.counters.no_subscribers = 257
    assert SbTask(bench.bus).housekeeping()["NoSubscribersCounter"] == 1
    bench.kernel.shutdown()
