"""Event Services, requirement by requirement: the event log and resets (cEVS3013 to 3016, 3108, 3201 to 3210)."""

from __future__ import annotations

from pathlib import Path

import pytest

from cfepy.evs import packets as pk
from cfepy.fs import read_header
from tests.requirements.covers import covers
from tests.requirements.flight import POWERON_RESET, PROCESSOR_RESET, Flight
from tests.requirements.test_evs import Fly, housekeeping, say

OVERWRITE, DISCARD = 0, 1
LOG_SIZE = 20


@pytest.fixture
def flight(fly: Fly) -> Flight:
    return fly(pk.HK_TLM_MID)


def number(flight: Flight, count: int, first: int = 0) -> None:
    """Let PROBE send events with numbers for texts."""
    for text in range(first, first + count):
        say(flight, text=str(text))


def logged(flight: Flight, path: str = "") -> list[str]:
    """Return the texts of the event log from a written file."""
    flight.send(pk.WRITE_LOG_DATA_FILE, LogFilename=path)
    data = flight.mission.files.read_file(path or "/ram/cfe_evs.log")
    assert read_header(data).subtype == 16
    size = pk.LONG_EVENT_MSG.length
    return [pk.LONG_EVENT_MSG.read(data[at : at + size])["Message"] for at in range(64, len(data), size)]


def state(flight: Flight) -> tuple[int, int, int]:
    """Full flag, overflow counter and mode of the log."""
    values = housekeeping(flight)
    return values["LogFullFlag"], values["LogOverflowCounter"], values["LogMode"]


def test_cEVS3013_the_log_is_cleared(flight: Flight) -> None:
    number(flight, 30)
    flight.send(pk.CLEAR_LOG)
    assert logged(flight) == []
    assert state(flight) == (0, 0, DISCARD)


@covers("cEVS3014", "cEVS3016", "cEVS3108.3")
def test_cEVS3014_a_full_log_overwrites_or_discards(flight: Flight) -> None:
    flight.send(pk.CLEAR_LOG)
    number(flight, 25)
    assert logged(flight) == [str(text) for text in range(20)]
    flight.send(pk.SET_LOG_MODE, LogMode=OVERWRITE)
    number(flight, 3, 25)
    assert logged(flight) == [str(text) for text in [*range(3, 20), 25, 26, 27]]
    flight.send(pk.SET_LOG_MODE, LogMode=DISCARD)
    number(flight, 1, 28)
    assert logged(flight)[-1] == "27"


@covers("cEVS3015", "cEVS3015.1", "cEVS3016", "cEVS3108")
def test_cEVS3015_the_log_is_written_to_a_file(flight: Flight) -> None:
    """Events are logged in the long format in any format mode. Setting the time back changes no order."""
    flight.send(pk.CLEAR_LOG)
    flight.send(pk.SET_EVENT_FORMAT_MODE, MsgFormat=pk.FORMAT_SHORT)
    say(flight, text="first")
    flight.call(lambda: flight.cfe.evs.send_timed_event((5, 0), 1, 2, "earlier by its time"))
    assert logged(flight) == ["first", "earlier by its time"]
    assert logged(flight, "/ram/mine.log") == ["first", "earlier by its time"]


@covers("cEVS3015", "cEVS3016", "cEVS3108", "cEVS3103.4")
def test_cEVS3015_the_log_of_a_boot_matches_nasas_bytes(flight: Flight) -> None:
    """Times of this boot, and two texts that name the build and the mission, are all that differs in 20 events."""
    real = (Path(__file__).parents[1] / "data" / "cfe_evs.log").read_bytes()
    flight.send(pk.WRITE_LOG_DATA_FILE)
    ours = flight.mission.files.read_file("/ram/cfe_evs.log")
    assert len(ours) == len(real) == 64 + LOG_SIZE * 172
    assert (ours[:24], ours[32:64]) == (real[:24], real[32:64])
    other_texts = []
    for at in range(64, len(real), 172):
        mine, theirs = ours[at : at + 172], real[at : at + 172]
        assert (mine[:6], mine[12:64]) == (theirs[:6], theirs[12:64])  # up to the first words of the text
        if mine[64:] != theirs[64:]:
            other_texts.append(pk.LONG_EVENT_MSG.read(mine)["Message"].split(":")[0])
    assert other_texts == ["cFS Versions", "Version Info"]


@covers("cEVS3108.1", "cEVS3108.2")
def test_cEVS3108_1_full_flag_and_overflow(flight: Flight) -> None:
    flight.send(pk.CLEAR_LOG)
    number(flight, LOG_SIZE - 1)
    assert state(flight) == (0, 0, DISCARD)
    number(flight, 1)
    assert state(flight) == (1, 0, DISCARD)
    number(flight, 3)
    assert state(flight) == (1, 3, DISCARD)


@covers("cEVS3201", "cEVS3202", "cEVS3203")
def test_cEVS3201_after_a_power_on_reset(fly: Fly) -> None:
    flight = fly(pk.HK_TLM_MID, evs_log_max=40)
    flight.send(pk.SET_EVENT_FORMAT_MODE, MsgFormat=pk.FORMAT_SHORT)
    flight.send(pk.SET_LOG_MODE, LogMode=OVERWRITE)
    number(flight, 30)
    assert state(flight)[0] == 1
    flight.reset(POWERON_RESET)
    text = "CFE_EVS_EarlyInit: Event Log cleared following power-on reset"
    assert len([line for line in flight.mission.console.lines if line.endswith(text)]) == 2
    assert state(flight) == (0, 0, DISCARD)
    assert logged(flight)[0].startswith("cFE EVS Initialized")
    assert housekeeping(flight)["MessageFormatMode"] == pk.FORMAT_LONG


@covers("cEVS3201", "cEVS3203")
def test_cEVS3201_a_power_on_reset_sets_the_modes_of_the_platform(fly: Fly) -> None:
    flight = fly(pk.HK_TLM_MID, evs_default_msg_format_mode=pk.FORMAT_SHORT, evs_default_log_mode=OVERWRITE)

    def modes() -> tuple[int, int]:
        values = housekeeping(flight)
        return values["MessageFormatMode"], values["LogMode"]

    assert modes() == (pk.FORMAT_SHORT, OVERWRITE)
    flight.send(pk.SET_EVENT_FORMAT_MODE, MsgFormat=pk.FORMAT_LONG)
    flight.send(pk.SET_LOG_MODE, LogMode=DISCARD)
    assert modes() == (pk.FORMAT_LONG, DISCARD)
    flight.reset(POWERON_RESET)
    assert modes() == (pk.FORMAT_SHORT, OVERWRITE)


@covers("cEVS3207", "cEVS3208", "cEVS3210")
def test_cEVS3207_after_a_processor_reset(flight: Flight) -> None:
    flight.send(pk.CLEAR_LOG)
    number(flight, 25)
    before = logged(flight)
    assert state(flight) == (1, 5, DISCARD)
    flight.reset(PROCESSOR_RESET)
    (restored,) = [line for line in flight.mission.console.lines if "Event Log restored" in line]
    assert restored.endswith(" CFE_EVS_EarlyInit: Event Log restored, n=0, c=20, f=1, m=1, o=5")
    full, overflow, mode = state(flight)
    assert (full, mode) == (1, DISCARD)
    assert overflow == 5 + housekeeping(flight)["MessageSendCounter"]  # the events of the new start find no room
    assert logged(flight) == before == [str(text) for text in range(20)]


def test_cEVS3207_a_log_in_overwrite_mode_keeps_its_mode_after_a_processor_reset(flight: Flight) -> None:
    flight.send(pk.SET_LOG_MODE, LogMode=OVERWRITE)
    flight.reset(PROCESSOR_RESET)
    assert state(flight)[2] == OVERWRITE
