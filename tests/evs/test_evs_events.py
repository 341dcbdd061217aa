"""Sending events: permission, routing, and the causes that hold an event back."""

from __future__ import annotations

import pytest

from cfepy import evs
from cfepy.config.platform import PlatformConfig
from cfepy.evs import CRITICAL, DEBUG, ERROR, INFORMATION
from cfepy.evs import packets as pk
from cfepy.msg import TLM_HEADER_SIZE
from cfepy.status import (
    CFE_ES_BAD_ARGUMENT,
    CFE_EVS_APP_ILLEGAL_APP_ID,
    CFE_EVS_APP_NOT_REGISTERED,
    CFE_EVS_APP_SQUELCHED,
    CFE_EVS_EVT_NOT_REGISTERED,
    CFE_EVS_INVALID_PARAMETER,
    CFE_EVS_UNKNOWN_FILTER,
    CFE_SUCCESS,
    CfeError,
)
from tests.evs.conftest import APP_ID, EVS_ID, MUTE_ID, Sent, World

READY = "cFE EVS Initialized: CFE_EVS v7.0.1+dev0 (Draco) v7.0.1 Official Release, EDS disabled"


def test_evs_reports_that_it_is_ready(fresh: World) -> None:
    fresh.evs.early_init(fresh.kept)
    fresh.kernel.spawn("CFE_EVS", fresh.evs.task_main, 61, fresh.apps[EVS_ID])
    fresh.kernel.run(1000)
    assert fresh.log == ["CFE_EVS_EarlyInit: Event Log cleared following power-on reset"]
    assert fresh.console.lines == [f"EVS Port1 T1001000 66/1/CFE_EVS 1: {READY}"]
    assert fresh.sent() == [Sent("CFE_EVS", 1, INFORMATION, READY)]
    assert fresh.perf == [2, -2]


def test_long_event_has_the_bytes_of_nasas_event(world: World) -> None:
    world.call(lambda: world.evs.send_event(3, INFORMATION, "TO telemetry output enabled for IP 127.0.0.1"))
    real = (
        "0808c00000a5000f4628800000000000"
        "484b000000000000000000000000000000000000030002004200000001000000"
        "544f2074656c656d65747279206f757470757420656e61626c656420666f72204950203132372e302e302e31"
    )
    assert world.packets[0].hex() == real.ljust(172 * 2, "0")


def test_short_format_sends_the_identity_only_but_logs_and_shows_all(world: World) -> None:
    world.evs.format_mode = pk.FORMAT_SHORT
    world.send(7)
    (packet,) = world.packets
    assert packet[:6].hex() == "0809c0000029"
    assert len(packet) == 48
    assert pk.SHORT_EVENT.unpack(packet, TLM_HEADER_SIZE)["PacketID"]["EventID"] == 7
    assert world.console.lines[-1].endswith("66/1/HK 7: hello")
    assert len(world.evs.log.entries()[-1]) == 172


@pytest.mark.parametrize(
    ("send", "event_type"),
    [("send_dbg", DEBUG), ("send_info", INFORMATION), ("send_err", ERROR), ("send_crit", CRITICAL)],
)
def test_each_event_type_has_its_own_call(world: World, send: str, event_type: int) -> None:
    world.evs.apps[APP_ID].types = 0x0F
    world.call(lambda: getattr(world.evs, send)(9, "text"))
    assert world.sent() == [Sent("HK", 9, event_type, "text")]


def test_debug_events_are_off_by_default(world: World) -> None:
    world.send(1, DEBUG)
    world.send(1, 5)
    assert world.sent() == []


@pytest.mark.parametrize(("length", "ending"), [(121, "xx"), (122, "x$"), (500, "x$")])
def test_too_long_text_ends_in_a_dollar_sign(world: World, length: int, ending: str) -> None:
    world.send(1, text="x" * length)
    (event,) = world.sent()
    assert len(event.text) == 121
    assert event.text.endswith(ending)
    assert world.evs.truncated == (length > 121)


def test_a_text_is_a_c_string(world: World) -> None:
    world.send(1, text="seen\0unseen")
    assert world.sent()[0].text == "seen"
    assert world.console.lines[-1].endswith(": seen")


def test_a_timed_event_shows_its_time_in_log_and_on_the_console(world: World) -> None:
    world.call(lambda: world.evs.send_timed_event((77, 0xABCD0000), 1, INFORMATION, "then"))
    assert world.evs.log.entries()[-1][6:12].hex() == "0000004dabcd"
    assert world.console.lines[-1] == "EVS Port1 T77 66/1/HK 1: then"


def test_the_time_of_a_timed_event_has_32_bits(world: World) -> None:
    for bad in ((-1, 0), (0, 1 << 32)):
        with pytest.raises(CfeError) as caught:
            world.call(lambda bad=bad: world.evs.send_timed_event(bad, 1, INFORMATION, "x"))  # type: ignore[misc]
        assert caught.value.status == CFE_EVS_INVALID_PARAMETER


def test_event_in_the_name_of_another_app_uses_the_types_of_its_sender(world: World) -> None:
    world.evs.apps[APP_ID].types = 0x0F
    world.call(lambda: world.evs.send_event_with_app_id(4, DEBUG, APP_ID, "for HK"), EVS_ID)
    world.call(lambda: world.evs.send_event_with_app_id(5, DEBUG, EVS_ID, "for EVS"), APP_ID)
    assert world.sent() == [Sent("CFE_EVS", 5, DEBUG, "for EVS")]
    world.call(lambda: world.evs.send_event_with_app_id(6, DEBUG, APP_ID, "for HK"), MUTE_ID)
    assert world.sent()[1:] == []  # a sender that is not registered has no types


def test_a_long_line_on_the_console_is_cut_as_nasas(world: World) -> None:
    world.evs.apps[APP_ID].name = "N" * 19
    world.send(65535, text="x" * 130)
    line = f"T1001000 66/1/{'N' * 19} 65535: {'x' * 120}$"
    assert len(line) == 162
    assert world.console.lines[-1] == f"EVS Port1 {line[:160]}"
    assert world.sent()[-1].text.endswith("$")


def test_ports_are_lines_on_the_console(world: World) -> None:
    world.evs.ports_mask = 0b1010
    world.send(1)
    assert world.console.lines == ["EVS Port2 T1001000 66/1/HK 1: hello", "EVS Port4 T1001000 66/1/HK 1: hello"]


# -- permission ----------------------------------------------------------------------------------------------------


def test_unregistered_app_is_refused_and_reported_once(world: World) -> None:
    for _ in range(2):
        with pytest.raises(CfeError, match="MUTE is not registered") as caught:
            world.call(lambda: world.evs.send_event(1, ERROR, "x"), MUTE_ID)
        assert caught.value.status == CFE_EVS_APP_NOT_REGISTERED
    text = "App MUTE not registered with Event Services. Unable to send event."
    assert world.sent() == []  # the sender of event 41 has no types
    assert world.log[-1] == f"EVS_NotRegistered: {text}"
    assert world.housekeeping()["UnregisteredAppCounter"] == 1


def test_unregistered_app_is_reported_again_after_each_register(world: World) -> None:
    """A register that fails wipes the record, as one that does not."""

    def fail() -> None:
        with pytest.raises(CfeError):
            world.evs.register(filter_scheme=99)

    for _ in range(2):
        world.call(fail, MUTE_ID)
        for _ in range(2):
            with pytest.raises(CfeError, match="MUTE is not registered"):
                world.call(lambda: world.evs.send_event(1, ERROR, "x"), MUTE_ID)
    assert [line.partition(":")[0] for line in world.log].count("EVS_NotRegistered") == 2


def test_host_code_belongs_to_no_app(world: World) -> None:
    for call in (world.evs.register, world.evs.reset_all_filters, lambda: world.evs.send_event(1, 2, "x")):
        with pytest.raises(CfeError) as caught:
            call()
        assert caught.value.status == CFE_EVS_APP_ILLEGAL_APP_ID


def test_invalid_app_id_of_an_event_is_refused(world: World) -> None:
    send = world.evs.send_event_with_app_id
    with pytest.raises(CfeError) as caught:
        world.call(lambda: send(1, 2, 0x160001, "x"))
    assert caught.value.status == CFE_EVS_APP_ILLEGAL_APP_ID
    with pytest.raises(CfeError) as caught:
        world.call(lambda: send(1, 2, MUTE_ID, "x"))
    assert caught.value.status == CFE_EVS_APP_NOT_REGISTERED


def test_unknown_app_has_no_name_in_the_event(world: World) -> None:
    gone = 0x1100FF
    with pytest.raises(CfeError, match="AppId 0x1100ff is not registered"):
        world.call(lambda: world.evs.send_event_with_app_id(1, 2, gone, "x"))
    assert world.log[-1].startswith("EVS_NotRegistered: App  not registered")


@pytest.mark.parametrize("event_type", [DEBUG, INFORMATION, ERROR, CRITICAL])
def test_app_id_0_is_refused(world: World, event_type: int) -> None:
    with pytest.raises(CfeError) as caught:
        world.call(lambda: world.evs.send_event_with_app_id(0, event_type, 0, "OK"))
    assert caught.value.status == CFE_EVS_APP_ILLEGAL_APP_ID


def test_values_go_into_the_text_as_printf_puts_them(world: World) -> None:
    world.call(lambda: world.evs.send(1, INFORMATION, "%d %u 0x%08lX %s%%", -5, 7, 0xBEEF, "x"))
    world.call(lambda: world.evs.send_err(2, "100%"))
    assert [event.text for event in world.sent()] == ["-5 7 0x0000BEEF x%", "100%"]
    for text, value in (("%d", "x"), ("none", 1), ("%d %d", 1)):
        with pytest.raises(CfeError) as caught:
            world.call(lambda text=text, value=value: world.evs.send_info(1, text, value))  # type: ignore[misc]
        assert caught.value.status == CFE_EVS_INVALID_PARAMETER


@pytest.mark.parametrize(("event_id", "text"), [(-1, "x"), (65536, "x"), ("1", "x"), (1, None)])
def test_id_and_text_are_checked(world: World, event_id: int, text: str) -> None:
    with pytest.raises(CfeError) as caught:
        world.send(event_id, text=text)
    assert caught.value.status == CFE_EVS_INVALID_PARAMETER


def test_a_cleaned_up_app_is_not_registered_any_more(world: World) -> None:
    world.evs.cleanup_app(APP_ID)
    with pytest.raises(CfeError, match="CFE_EVS_APP_NOT_REGISTERED"):
        world.send(1)


# -- filters -------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("mask", "passed"),
    [
        (evs.NO_FILTER, range(20)),
        (evs.EVERY_OTHER_ONE, range(0, 20, 2)),
        (evs.EVERY_OTHER_TWO, [0, 1, 4, 5, 8, 9, 12, 13, 16, 17]),
        (evs.EVERY_FOURTH_ONE, range(0, 20, 4)),
        (evs.FIRST_ONE_STOP, range(1)),
        (evs.FIRST_TWO_STOP, range(2)),
        (evs.FIRST_4_STOP, range(4)),
        (evs.FIRST_8_STOP, range(8)),
        (evs.FIRST_16_STOP, range(16)),
        (evs.FIRST_32_STOP, range(20)),
        (evs.FIRST_64_STOP, range(20)),
    ],
)
def test_filter_passes_events_by_count_and_mask(world: World, mask: int, passed: list[int]) -> None:
    """cEVS3104.2: an event is filtered out when its count and the mask have a bit in common."""
    world.call(lambda: world.evs.register([(5, mask)]))
    for number in range(20):
        world.send(5, text=str(number))
    assert [int(event.text) for event in world.sent()] == list(passed)


def test_reset_filter_counts_from_zero(world: World) -> None:
    world.call(lambda: world.evs.register([(5, 0xFFFF), (6, 0xFFFF)]))
    for reset in (lambda: None, lambda: world.evs.reset_filter(5), world.evs.reset_all_filters):
        world.call(reset)
        for event_id in (5, 6):
            world.send(event_id)
    assert [event.event_id for event in world.sent()] == [5, 6, 5, 5, 6]


def test_reset_of_an_unknown_filter_is_refused(world: World) -> None:
    with pytest.raises(CfeError) as caught:
        world.call(lambda: world.evs.reset_filter(5))
    assert caught.value.status == CFE_EVS_EVT_NOT_REGISTERED
    with pytest.raises(CfeError) as caught:
        world.call(lambda: world.evs.reset_filter(5), MUTE_ID)
    assert caught.value.status == CFE_EVS_APP_NOT_REGISTERED


def test_a_filter_locks_at_its_last_count(world: World) -> None:
    world.call(lambda: world.evs.register([(5, 1)]))
    slot = world.evs.apps[APP_ID].filters.find(5)
    assert slot is not None
    slot.count = 0xFFFE
    for _ in range(3):
        world.send(5)
    locked = "Max filter count reached, AppName = HK, EventID = 0x00000005: Filter locked until reset"
    assert world.sent() == [Sent("CFE_EVS", 42, INFORMATION, locked), Sent("HK", 5, INFORMATION, "hello")]
    assert slot.count == 0xFFFF


def test_filters_beyond_the_limit_are_ignored(world: World) -> None:
    world.call(lambda: world.evs.register([(event_id, 0xFFFF) for event_id in range(10)]))
    assert world.log[-1] == "CFE_EVS_Register: Filter limit truncated to 8"
    assert world.evs.apps[APP_ID].filters.find(7) is not None
    assert world.evs.apps[APP_ID].filters.find(8) is None


@pytest.mark.parametrize("bad", [5, (1,), (1, 65536), (-1, 0), ("1", 0)])
def test_a_filter_is_two_numbers(world: World, bad: object) -> None:
    with pytest.raises(CfeError) as caught:
        world.call(lambda: world.evs.register([bad]))  # type: ignore[list-item]
    assert caught.value.status == CFE_ES_BAD_ARGUMENT


def test_unknown_filter_scheme_fails_the_registration(world: World) -> None:
    with pytest.raises(CfeError) as caught:
        world.call(lambda: world.evs.register([], 1))
    assert caught.value.status == CFE_EVS_UNKNOWN_FILTER
    with pytest.raises(CfeError, match="CFE_EVS_APP_NOT_REGISTERED"):
        world.send(1)


# -- the flood brake -----------------------------------------------------------------------------------------------


def _flood(world: World, events: int) -> None:
    def send() -> None:
        for number in range(events):
            world.evs.send_event(5, INFORMATION, str(number))

    world.call(send)


def test_flood_is_stopped_after_a_burst_and_reported_once(world: World) -> None:
    _flood(world, 100)
    events = world.sent()
    assert len(events) == 33
    assert events[-1] == Sent("CFE_EVS", 44, ERROR, "Events squelched, AppName = HK")
    assert [int(event.text) for event in events[:-1]] == list(range(32))
    app_data = world.housekeeping()["AppData"]
    assert app_data[1]["AppMessageSquelchedCounter"] == 68  # type: ignore[index]


def test_sender_gets_success_when_filtered_and_an_error_when_squelched(world: World) -> None:
    """Held back by the type or by a filter is success, held back by the brake is not, as in NASA's evs_send_test.c."""
    send = world.evs.send_event
    world.call(lambda: world.evs.register([(9, 0xFFFF)]))
    results = [world.call(lambda kind=kind: send(0, kind, "OK")) for kind in (DEBUG, INFORMATION)]  # type: ignore[misc]
    results += [world.call(lambda: send(9, ERROR, "OK")) for _ in range(31)]
    assert set(results) == {CFE_SUCCESS}
    _flood(world, 32)
    assert world.call(lambda: send(0, ERROR, "too much")) == CFE_EVS_APP_SQUELCHED
    assert world.call(lambda: world.evs.send_timed_event((1000, 1000), 0, ERROR, "too")) == CFE_EVS_APP_SQUELCHED


def test_after_a_flood_events_come_back_at_fifteen_a_second(world: World) -> None:
    _flood(world, 100)
    world.packets.clear()
    world.kernel.run(world.kernel.now + 2_000_000_000)
    _flood(world, 1)  # -32 + 30 events: still below zero, and one more to pay
    assert world.sent() == []
    world.kernel.run(world.kernel.now + 1_000_000_000)
    _flood(world, 20)  # -3 + 15
    assert len([event for event in world.sent() if event.app == "HK"]) == 12


def test_the_brake_can_be_taken_off() -> None:
    world = World(PlatformConfig(evs_max_app_event_burst=0))
    world.start()
    world.call(world.evs.register)
    _flood(world, 100)
    assert len(world.sent()) == 100
    world.kernel.shutdown()


# -- for reports ---------------------------------------------------------------------------------------------------


def test_events_are_counted_by_type_and_errors_by_app(world: World) -> None:
    for event_type in (INFORMATION, ERROR, ERROR, CRITICAL):
        world.send(1, event_type)
    assert world.evs.counts == {INFORMATION: 2, ERROR: 2, CRITICAL: 1}
    assert world.evs.errors_by_app == {"HK": 3}
