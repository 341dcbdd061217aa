"""Ground commands of Time Services, its housekeeping and its diagnostics."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

import pytest

from cfepy.msg import Command, Layout, get_msg_id
from cfepy.time import SysTime, add, subtract
from cfepy.time import packets as pk
from tests.declared import assert_as_recorded, assert_complete
from tests.layouts import assert_same
from tests.time.conftest import World

DATA = Path(__file__).parent.parent / "data"


def u32(*values: int) -> bytes:
    return b"".join(value.to_bytes(4, "little") for value in values)


def i16(value: int) -> bytes:
    return value.to_bytes(2, "little", signed=True)


@pytest.fixture
def running(world: World) -> World:
    """TIME, half a second after its third tone."""
    world.start()
    world.run(3.5)
    world.events.clear()
    return world


def test_declarations_are_complete_and_as_recorded() -> None:
    assert_complete(pk)
    assert_as_recorded(pk, 2)


@pytest.mark.parametrize(
    ("layout", "c_name"),
    [
        (pk.SYS_TIME, "CFE_TIME_SysTime_t"),
        (pk.HOUSEKEEPING, "CFE_TIME_HousekeepingTlm_Payload_t"),
        (pk.DIAGNOSTIC, "CFE_TIME_DiagnosticTlm_Payload_t"),
        (pk.TONE_DATA, "CFE_TIME_ToneDataCmd_Payload_t"),
        (pk.RESET_VARS, "CFE_TIME_ResetVars_t"),
    ],
)
def test_layouts_match_nasas_structures(layout: Layout, c_name: str) -> None:
    assert_same(layout, c_name)


NOOP = "No-op Cmd Rcvd: CFE_TIME v7.0.1+dev0 (Draco) v7.0.1 Official Release, EDS disabled"
OK_COMMANDS = [
    (0, b"", 4, NOOP),
    (2, b"", 6, "Request diagnostics command"),
    (4, i16(-1), 7, "Set Clock State = INVALID"),
    (4, i16(0), 7, "Set Clock State = VALID"),
    (4, i16(1), 7, "Set Clock State = FLYWHEEL"),
    (7, u32(5, 500000), 12, "Set Time -- secs = 5, usecs = 500000, ssecs = 0x80000000"),
    (8, u32(5, 1), 13, "Set MET -- secs = 5, usecs = 1, ssecs = 0x10C7"),
    (9, u32(5, 0), 14, "Set STCF -- secs = 5, usecs = 0, ssecs = 0x0"),
    (10, i16(-3), 17, "Set Leap Seconds = -3"),
    (11, u32(1, 2), 15, "STCF Adjust -- secs = 1, usecs = 2, ssecs = 0x218E, dir[1=Pos, 2=Neg] = 1"),
    (12, u32(1, 2), 15, "STCF Adjust -- secs = 1, usecs = 2, ssecs = 0x218E, dir[1=Pos, 2=Neg] = 2"),
    (13, u32(1, 255), 16, "STCF 1Hz Adjust -- secs = 1, ssecs = 0xFF, dir[1=Pos, 2=Neg] = 1"),
    (13, u32(0xFFFFFFFF, 1), 16, "STCF 1Hz Adjust -- secs = -1, ssecs = 0x1, dir[1=Pos, 2=Neg] = 1"),
    (14, u32(1, 255), 16, "STCF 1Hz Adjust -- secs = 1, ssecs = 0xFF, dir[1=Pos, 2=Neg] = 2"),
]


@pytest.mark.parametrize(("code", "payload", "event_id", "text"), OK_COMMANDS)
def test_valid_command_is_executed_counted_and_confirmed(
    running: World, code: int, payload: bytes, event_id: int, text: str
) -> None:
    running.command(code, payload)
    assert running.events == [(event_id, text)]
    assert running.command_counters() == (1, 0)


CLIENT = "Set Delay commands invalid without CFE_PLATFORM_TIME_CFG_CLIENT set to TRUE"
BAD_COMMANDS = [
    (3, i16(1), 40, "Set Source commands invalid without CFE_PLATFORM_TIME_CFG_SOURCE set to TRUE"),
    (3, i16(3), 31, "Invalid Time Source = 0x3"),
    (4, i16(-2), 30, "Invalid Clock State = 0xFFFFFFFE"),
    (5, u32(0, 1), 42, CLIENT),
    (6, u32(0, 1), 42, CLIENT),
    (5, u32(0, 1000000), 33, "Invalid Tone Delay -- secs = 0, usecs = 1000000"),
    (7, u32(1, 1000000), 34, "Invalid Time -- secs = 1, usecs = 1000000"),
    (8, u32(1, 1000000), 35, "Invalid MET -- secs = 1, usecs = 1000000"),
    (9, u32(1, 1000000), 36, "Invalid STCF -- secs = 1, usecs = 1000000"),
    (11, u32(1, 1000000), 37, "Invalid STCF Adjust -- secs = 1, usecs = 1000000, dir[1=Pos, 2=Neg] = 1"),
    (15, i16(2), 41, "Set Signal commands invalid without CFE_PLATFORM_TIME_CFG_SIGNAL set to TRUE"),
    (15, i16(0), 32, "Invalid Tone Source = 0x0"),
    (16, b"", 27, "Invalid command code -- ID = 0x1805, CC = 16"),
    (0, b"xx", 49, "Invalid msg length: ID = 0x1805,  CC = 0, Len = 10, Expected = 8"),
]


@pytest.mark.parametrize(("code", "payload", "event_id", "text"), BAD_COMMANDS)
def test_invalid_command_is_refused_counted_and_reported(
    running: World, code: int, payload: bytes, event_id: int, text: str
) -> None:
    before = running.time.get_time()
    running.command(code, payload)
    assert running.events == [(event_id, text)]
    assert running.command_counters() == (0, 1)
    assert running.time.get_time() == before


def test_unknown_message_is_reported_but_not_counted(running: World) -> None:
    running.command(0, msg_id=0x1899)
    assert running.events == [(26, "Invalid message ID -- ID = 0x1899")]
    assert running.command_counters()[1] == 0


def test_a_request_for_housekeeping_may_have_any_length(running: World) -> None:
    """NASA's TIME does not look, as ES, EVS and SB do not."""
    running.command(0, b"xyz", msg_id=pk.SEND_HK_MID)
    assert running.events == []
    assert running.command_counters() == (0, 0)


@pytest.mark.parametrize("command", [pk.TONE_CMD, pk.ONEHZ_CMD, pk.DATA_CMD, pk.SEND_CMD], ids=lambda each: each.name)
def test_messages_of_the_tone_may_be_too_long(running: World, command: Command) -> None:
    running.command(0, command.packet()[8:] + b"x", msg_id=command.msg_id)
    assert running.events == []
    assert running.command_counters() == (0, 0)


def test_short_tone_message_is_refused(running: World) -> None:
    running.command(0, msg_id=pk.DATA_CMD_MID)
    assert running.events == [(49, "Invalid msg length: ID = 0x1860,  CC = 0, Len = 8, Expected = 28")]


def test_set_time_changes_only_the_stcf(running: World) -> None:
    running.command(pk.SET_TIME_CC, u32(2_000_000, 250_000))
    assert running.time.get_time() == (2_000_000, 0x40000000)
    assert running.time.get_met() == (1003, 0x80000000)
    running.run(10)
    assert running.time.get_time() == (2_000_010, 0x40000000)


def test_met_continues_from_its_new_value_with_each_tone(running: World) -> None:
    running.command(pk.SET_MET_CC, u32(7000, 0))
    assert running.time.get_met() == (7000, 0)
    running.run(0.5)
    assert running.time.get_met() == (7001, 0)
    running.run(2)
    assert running.time.get_met() == (7003, 0)


def test_stcf_is_set_and_adjusted(running: World) -> None:
    running.command(pk.SET_STCF_CC, u32(10, 0))
    running.command(pk.ADD_ADJUST_CC, u32(5, 500_000))
    running.command(pk.SUB_ADJUST_CC, u32(1, 0))
    assert running.time.get_stcf() == (14, 0x80000000)
    assert running.time.get_clock_info() & 0x300 == 0x100


def test_stcf_drifts_every_second_after_an_adjustment_command(running: World) -> None:
    running.command(pk.SUB_ONE_HZ_ADJUSTMENT_CC, u32(0, 0x10000000))
    running.run(4)
    assert running.time.get_stcf() == (999_999, 0xC0000000)
    assert running.housekeeping()["AdjustmentFactor"] == {"Seconds": 0, "Subseconds": 0x10000000}
    assert running.time.get_clock_info() & 0x300 == 0x200


def test_forced_flywheel_ignores_tones_until_the_state_is_set(running: World) -> None:
    running.command(pk.SET_STATE_CC, i16(1))
    running.run(20)
    assert running.events == [(7, "Set Clock State = FLYWHEEL")]
    assert running.time.get_clock_info() & 0x4C00 == 0x4C00
    running.command(pk.SET_STATE_CC, i16(0))
    running.run(1)
    assert running.events[1:] == [(7, "Set Clock State = VALID"), (21, "Stop FLYWHEEL")]
    assert running.time.get_clock_state() == 0
    assert running.time.get_met() == (1024, 0x80000000)


def test_housekeeping(running: World) -> None:
    running.command(0)
    assert running.housekeeping() == {
        "CommandCounter": 1,
        "CommandErrorCounter": 0,
        "ClockStateFlags": 0x33E0,
        "ClockStateAPI": -1,
        "LeapSeconds": 37,
        "MET": {"Seconds": 1003, "Subseconds": 0x80000000},
        "STCF": {"Seconds": 1_000_000, "Subseconds": 0},
        "AdjustmentFactor": {"Seconds": 0, "Subseconds": 0},
    }


def test_housekeeping_matches_the_bytes_of_nasas_packet(running: World) -> None:
    """All bytes except time stamp and MET are from a packet of the real system."""
    running.housekeeping()
    real = bytes.fromhex(
        "0805c0030029000f462ba667000000000000e033ffff2500eb030000f0ea66a640420f00000000000000000000000000"
    )
    ours = running.packets[-1]
    assert len(ours) == len(real) == 48
    assert ours[16:28] == real[16:28]
    assert ours[32:] == real[32:]


def test_diagnostics(running: World) -> None:
    fields = running.diagnostic()
    zero = {"Seconds": 0, "Subseconds": 0}
    assert fields["TimeSinceTone"] == {"Seconds": 0, "Subseconds": 0x80000000}
    assert fields["AtToneMET"] == {"Seconds": 1003, "Subseconds": 0}
    assert fields["CurrentUTC"] == {"Seconds": 1_001_003 - 37, "Subseconds": 0x80000000}
    assert fields["AtToneLatch"] == fields["ToneSignalLatch"]
    assert fields["AtToneDelay"] == fields["OneTimeAdjust"] == fields["OneHzAdjust"] == zero
    assert [fields[name] for name in ("ClockSetState", "ClockFlyState", "ClockSource", "ClockSignal")] == [0, 0, 1, 1]
    for name in ("ToneMatch", "ToneSignal", "ToneData", "ToneInt", "ToneTask", "LocalInt", "LocalTask"):
        assert fields[f"{name}Counter"] == 3, name
    assert fields["ToneMatchErrorCounter"] == fields["ToneIntErrorCounter"] == 0
    limits = ("MinElapsed", "MaxElapsed", "ToneOverLimit", "ToneUnderLimit")
    assert [fields[name] for name in limits] == [0, 0x33333334, 0x051EB852, 0xFAE147AF]
    assert fields["MaxLocalClock"] == {"Seconds": 27, "Subseconds": 0}
    assert fields["DataStoreStatus"] == 3
    assert fields["VirtualMET"] == 1003


def test_diagnostics_match_the_bytes_of_nasas_packet(running: World) -> None:
    """All that does not hang on the host's clock: configuration, states, STCF, flags, and the sums that hold within."""
    packets = json.loads((DATA / "packets.json").read_text(encoding="utf-8"))["telemetry"]
    (real,) = (bytes.fromhex(packet["hex"]) for packet in packets if packet["mid"] == pk.DIAG_TLM_MID)
    running.diagnostic()
    ours = running.packets[-1]
    assert len(ours) == len(real) == pk.DIAG_TLM.length == 216
    theirs, fields = pk.DIAG_TLM.read(real), pk.DIAG_TLM.read(ours)
    moving = {name for name in fields if name.endswith(("Latch", "Counter")) or name.startswith("Current")}
    moving |= {"AtToneMET", "TimeSinceTone", "VirtualMET"}
    for name in fields.keys() - moving:
        assert fields[name] == theirs[name], name
    for packet in (fields, theirs):
        time = {name: SysTime(*packet[name].values()) for name in packet if isinstance(packet[name], dict)}
        assert add(time["AtToneMET"], time["TimeSinceTone"]) == time["CurrentMET"]
        assert add(time["AtToneLatch"], time["TimeSinceTone"]) == time["CurrentLatch"]
        assert add(time["CurrentMET"], time["AtToneSTCF"]) == time["CurrentTAI"]
        assert subtract(time["CurrentTAI"], (37, 0)) == time["CurrentUTC"]
        assert packet["VirtualMET"] == time["AtToneMET"].seconds


def test_version_counts_updates_of_the_reference(make: Callable[..., World]) -> None:
    """Two at the start, one at every tone, one for every command that sets something."""
    world = make()
    assert world.diagnostic()["VersionCounter"] == 2
    world.start()
    world.run(3.5)
    assert world.diagnostic()["VersionCounter"] == 5
    for code, payload in ((pk.SET_STCF_CC, u32(1, 0)), (pk.SET_STATE_CC, i16(0)), (pk.SET_LEAP_SECONDS_CC, i16(1))):
        world.command(code, payload)
    assert world.diagnostic()["VersionCounter"] == 8


def test_reset_counters(running: World) -> None:
    running.command(99)
    running.command(pk.RESET_COUNTERS_CC)
    assert running.events[-1] == (5, "Reset Counters command")
    fields = running.diagnostic()
    assert fields["ToneMatchCounter"] == fields["LocalIntCounter"] == fields["VersionCounter"] == 0
    assert running.command_counters() == (1, 0)
    running.run(1)
    assert running.diagnostic()["ToneTaskCounter"] == 1
    assert get_msg_id(running.packets[-1]) == pk.DIAG_TLM_MID
