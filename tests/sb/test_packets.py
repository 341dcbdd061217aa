"""The packets of the Software Bus have NASA's layouts, and their contents are true."""

from __future__ import annotations

from cfepy.sb import packets as pk
from cfepy.sb.task import SbTask
from tests.layouts import assert_same
from tests.sb.harness import Bench, packet


def test_layouts_match_nasas_structures() -> None:
    assert_same(pk.HOUSEKEEPING, "CFE_SB_HousekeepingTlm_Payload_t")
    assert_same(pk.STATISTICS, "CFE_SB_StatsTlm_Payload_t")
    assert_same(pk.PIPE_DEPTH_STATS, "CFE_SB_PipeDepthStats_t")
    assert_same(pk.SUBSCRIPTION_ENTRY, "CFE_SB_SubEntries_t")
    assert_same(pk.ROUTING_FILE_ENTRY, "CFE_SB_RoutingFileEntry_t")
    assert_same(pk.PIPE_FILE_ENTRY, "CFE_SB_PipeInfoEntry_t")
    assert_same(pk.MAP_FILE_ENTRY, "CFE_SB_MsgMapFileEntry_t")
    assert (pk.ONESUB_TLM.length, pk.ALLSUBS_TLM.length) == (32, 268)


def test_housekeeping_and_statistics_match_the_traffic() -> None:
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
    assert housekeeping["MemInUse"] == 32 + 2 * (36 + 64)
    assert housekeeping["UnmarkedMem"] == 524288 - (32 + 3 * (36 + 64)), "the third one was there while it was sent"
    statistics = pk.STATISTICS.unpack(pk.STATISTICS.pack(task.statistics()))
    assert (statistics["PipesInUse"], statistics["SubscriptionsInUse"], statistics["SBBuffersInUse"]) == (1, 1, 2)
    assert statistics["PeakSBBuffersInUse"] == 3
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
