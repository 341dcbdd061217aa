"""The clock on virtual time: its reading, the tone that keeps it, and flywheel mode."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from cfepy.config.platform import PlatformConfig
from cfepy.msg import CMD_HEADER_SIZE, get_msg_id
from cfepy.ports import Ports
from cfepy.rtos import Kernel
from cfepy.status import (
    CFE_TIME_BAD_ARGUMENT,
    CFE_TIME_CALLBACK_NOT_REGISTERED,
    CFE_TIME_TOO_MANY_SYNCH_CALLBACKS,
    CfeError,
)
from cfepy.time import CLOCK_FLYWHEEL, CLOCK_INVALID, CLOCK_VALID, SysTime, TimeServices
from cfepy.time import packets as pk
from tests.time.conftest import APP_ID, OTHER_ID, SECOND_NS, TIME_ID, World

READY = "cFE TIME Initialized: CFE_TIME v7.0.1+dev0 (Draco) v7.0.1 Official Release, EDS disabled"
FLY_OFF, FLY_ON = (21, "Stop FLYWHEEL"), (20, "Start FLYWHEEL")


def test_time_counts_from_the_epoch_before_the_start() -> None:
    kernel = Kernel()
    time = TimeServices(kernel, Ports(), PlatformConfig())
    assert time.text() == "1980-001-00:00:00.00000"
    kernel.run(676_549_690_000)
    assert time.text() == "1980-001-00:11:16.54969"


def test_clock_starts_at_a_met_of_1000_s(world: World) -> None:
    time = world.time
    assert time.get_met() == (1000, 0)
    assert time.get_stcf() == (1_000_000, 0)
    assert time.get_tai() == time.get_time() == time.now() == (1_001_000, 0)
    assert time.get_utc() == (1_001_000 - 37, 0)
    assert time.get_leap_seconds() == 37
    assert time.text() == "1980-012-14:03:20.00000"


@pytest.mark.parametrize("start_ns", [0, 1, 351_000_000, 999_999_999])
@pytest.mark.parametrize("tick_ns", [0, 10_000_000])
def test_met_follows_virtual_time_exactly(make: Callable[..., World], start_ns: int, tick_ns: int) -> None:
    """Tones set the clock every second and never move it, at whatever instant it started."""
    world = make(start_ns=start_ns, tick_ns=tick_ns)
    world.start()
    jumps = world.jumps
    for part in (0.3, 0.7, 5, 0.123456789, 100):
        world.run(part)
        met = world.time.get_met()
        elapsed = world.kernel.now - world.start_ns
        assert met.seconds == 1000 + elapsed // SECOND_NS
        assert abs(met.subseconds * SECOND_NS / 2**32 - elapsed % SECOND_NS) < 1
        assert world.time.get_met_seconds() == met.seconds
        assert world.time.get_met_subsecs() == met.subseconds
    assert world.jumps == jumps


def test_stamp_is_computed_once_an_instant(world: World) -> None:
    time, clock = world.time, world.time.clock
    world.run(0.5)
    assert time.stamp() == 1_001_000 << 16 | 0x8000
    assert (clock.stamp_now, clock.stamp_at) == (time.stamp(), world.kernel.now)
    clock.update(stcf=clock.reference.stcf + (1 << 32))
    assert clock.stamp_at == -1
    assert time.stamp() == 1_001_001 << 16 | 0x8000


def test_spacecraft_time_of_a_met(world: World) -> None:
    assert world.time.met2sc_time((5, 7)) == SysTime(1_000_005, 7)


def test_arithmetic_is_available_to_apps(world: World) -> None:
    time = world.time
    assert time.compare(time.add((1, 0), (1, 0)), time.subtract((3, 0), (1, 0))) == 0
    assert time.sub2micro_secs(time.micro2sub_secs(7)) == 7
    assert time.print_((0, 0)) == "1980-001-00:00:00.00000"


# -- tone ----------------------------------------------------------------------------------------------------------


def test_first_tone_ends_flywheel_mode(world: World) -> None:
    world.start()
    world.run(0.9)
    assert world.events == [(1, READY)]
    assert world.time.get_clock_info() == 0x7BC0
    world.run(0.1)
    assert world.events == [(1, READY), FLY_OFF]
    assert world.time.text() == "1980-012-14:03:21.00000"
    world.run(100)
    assert world.events == [(1, READY), FLY_OFF]
    assert world.time.get_clock_info() == 0x33E0


def test_second_has_its_marks_in_the_performance_log(world: World) -> None:
    """Marks are NASA's, negative at the end of a piece of code: 10 and 11 tasks, 8 local signal, 7 tone, 6 CFE_TIME."""
    world.start()
    world.run(1.5)
    world.perf.clear()
    world.run(1)
    assert world.perf == [10, -10, 6, 8, -8, 7, 11, -11, -7, -6, 6, -6, 6, -6, 6, -6]


def test_every_second_has_signal_request_and_data(world: World) -> None:
    world.start()
    world.run(1.5)
    assert [get_msg_id(packet) for packet in world.packets] == [0x1811, 0x1810, 0x1862, 0x1860]
    assert [packet.hex() for packet in world.packets[:3]] == [
        "1811c000000100" + "37",
        "1810c00000010036",
        "1862c00000010044",
    ]
    world.run(1)
    assert world.tone_data() == {
        "AtToneMET": {"Seconds": 1002, "Subseconds": 0},
        "AtToneSTCF": {"Seconds": 1_000_000, "Subseconds": 0},
        "AtToneLeapSeconds": 37,
        "AtToneState": CLOCK_INVALID,
    }


def test_clock_enters_flywheel_after_two_seconds_without_data_and_recovers(world: World) -> None:
    world.start()
    world.run(3.5)
    world.events.clear()
    world.lost.add(pk.DATA_CMD_MID)
    world.run(1)
    assert world.events == []
    world.run(3)
    assert world.events == [FLY_ON]
    assert world.time.get_clock_info() & 0x4800 == 0x4800
    world.lost.clear()
    world.run(3)
    assert world.events == [FLY_ON, FLY_OFF]
    assert world.time.get_met() == (1010, 0x80000000)


def test_clock_in_flywheel_renews_its_reference(world: World) -> None:
    world.start()
    world.lost.add(pk.DATA_CMD_MID)
    world.run(30.5)
    assert world.time.clock.since_tone() >> 32 < 9
    assert world.time.get_met() == (1030, 0x80000000)


def test_late_data_does_not_match_its_tone(world: World) -> None:
    world.start()
    world.run(5.5)
    matches = world.time.tone.counters.tone_match
    data = next(packet for packet in world.packets if get_msg_id(packet) == pk.DATA_CMD_MID)
    world.call(lambda: world.time.commands.process(data), TIME_ID)
    assert world.time.tone.counters.tone_match == matches
    assert world.time.tone.counters.tone_match_error == 1


def test_tone_at_the_wrong_time_is_not_accepted(world: World) -> None:
    world.start()
    world.run(5.5)
    world.time.external_tone()
    assert world.time.get_clock_info() & 0x20 == 0
    assert world.time.tone.counters.tone_interrupt_error == 1
    world.run(3)
    assert world.time.get_clock_info() & 0x20


def test_1_hz_message_from_the_ground_makes_a_tone_of_the_current_time(world: World) -> None:
    """NASA's takes the time when the message comes: neither this tone nor the next is a second after the one before.

    The clock misses a pair, flies for a moment, and is right again with the next one.
    """
    world.start()
    world.run(5.5)
    counters = world.time.tone.counters
    good = counters.tone_interrupt
    world.call(lambda: world.time.commands.process(pk.ONEHZ_CMD.packet()), TIME_ID)
    assert world.time.get_clock_info() & 0x20 == 0
    world.run(1)
    assert (counters.tone_interrupt, counters.tone_interrupt_error) == (good, 2)
    world.run(3)
    assert (counters.tone_interrupt, counters.tone_interrupt_error) == (good + 3, 2)
    assert not world.time.clock.reference.flying
    assert world.time.get_met() == (1009, 0x80000000)
    assert world.time.tone.virtual_met == 1009


def test_board_may_send_the_local_signal(world: World) -> None:
    world.start()
    world.run(0.5)
    world.call(lambda: world.time.local1hz_isr())
    world.run(0.1)
    assert world.time.tone.counters.local_task == 1
    assert get_msg_id(world.packets[0]) == pk.ONEHZ_CMD_MID


def test_processor_reset_keeps_the_time(make: Callable[..., World]) -> None:
    world = make()
    world.start()
    world.run(3.25)
    world.command(pk.SET_LEAP_SECONDS_CC, b"\x07\x00")
    world.housekeeping()
    saved = pk.RESET_VARS.unpack(world.kept["TIME"])
    assert saved == {
        "Signature": 0xA5A55A5A,
        "LeapSeconds": 7,
        "ClockSignal": 1,
        "CurrentMET": {"Seconds": 1003, "Subseconds": 0x40000000},
        "CurrentSTCF": {"Seconds": 1_000_000, "Subseconds": 0},
        "CurrentDelay": {"Seconds": 0, "Subseconds": 0},
    }
    after = make(start_ns=0, kept=world.kept)
    after.start()
    assert after.time.get_met() == SysTime(1003, 0x40000000)
    assert after.diagnostic()["DataStoreStatus"] == 4
    after.run(10)
    assert after.time.get_met() == (1013, 0x40000000)
    assert after.time.get_leap_seconds() == 7


@pytest.mark.parametrize("damage", [{"Signature": 1}, {"ClockSignal": 3}])
def test_reset_variables_that_are_damaged_are_not_used(make: Callable[..., World], damage: dict[str, int]) -> None:
    world = make()
    world.command(pk.SET_LEAP_SECONDS_CC, b"\x07\x00")
    world.housekeeping()
    kept = {"TIME": pk.RESET_VARS.pack(pk.RESET_VARS.unpack(world.kept["TIME"]) | damage)}
    after = make(kept=kept)
    assert (after.time.get_met(), after.time.get_leap_seconds()) == ((1000, 0), 37)
    assert after.diagnostic()["DataStoreStatus"] == 3


# -- callbacks -----------------------------------------------------------------------------------------------------


def test_callback_is_called_at_every_accepted_tone(world: World) -> None:
    calls: list[str] = []
    first, second = lambda: calls.append("first"), lambda: calls.append("second")
    world.call(lambda: world.time.register_synch_callback(second), OTHER_ID)
    world.call(lambda: world.time.register_synch_callback(first), APP_ID)
    world.start()
    world.run(1.5)
    assert calls == ["first", "second"]
    world.call(lambda: world.time.unregister_synch_callback(first), APP_ID)
    world.time.cleanup_app(OTHER_ID)
    world.run(3)
    assert calls == ["first", "second"]


def test_callback_may_remove_another_one(world: World) -> None:
    calls: list[str] = []
    world.call(lambda: world.time.register_synch_callback(lambda: world.time.cleanup_app(OTHER_ID)), APP_ID)
    world.call(lambda: world.time.register_synch_callback(lambda: calls.append("other")), OTHER_ID)
    world.start()
    world.run(1.5)
    assert calls == []


def test_app_has_at_most_one_callback(world: World) -> None:
    time = world.time

    def status(call: Callable[[], object]) -> int:
        with pytest.raises(CfeError) as caught:
            world.call(call)
        return caught.value.status

    world.call(lambda: time.register_synch_callback(print))
    assert status(lambda: time.register_synch_callback(print)) == CFE_TIME_TOO_MANY_SYNCH_CALLBACKS
    assert status(lambda: time.unregister_synch_callback(len)) == CFE_TIME_CALLBACK_NOT_REGISTERED  # type: ignore[arg-type]
    assert status(lambda: time.register_synch_callback(None)) == CFE_TIME_BAD_ARGUMENT  # type: ignore[arg-type]


def test_clock_states(world: World) -> None:
    world.start()
    world.run(2)
    assert world.time.get_clock_state() == CLOCK_INVALID
    for state in (CLOCK_VALID, CLOCK_FLYWHEEL, CLOCK_INVALID):
        world.command(pk.SET_STATE_CC, state.to_bytes(2, "little", signed=True))
        assert world.time.get_clock_state() == state
    assert CMD_HEADER_SIZE + pk.STATE_COMMAND.size == 10
