"""Random ground commands, byte for byte: the same answers as NASA's cFE.

The answers are on record. If NASA's executable is installed (CFEPY_REAL_CFE names it), it is asked as well.
`python -m dev.twin` flies more commands.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import pytest

from cfepy.es import packets as es
from cfepy.evs import packets as evs
from cfepy.sb import packets as sb
from dev.twin import masks, recorded
from dev.twin.__main__ import fly
from dev.twin.commands import PLAIN, Step
from dev.twin.flight import Simulated, differences, real, simulated
from dev.twin.real import VARIABLE, installed

RELEASES = ("7.0.0", "7.0.1")
FLIGHTS = [
    (release, number) for release in RELEASES for number in range(len(recorded.load(recorded.of_release(release))))
]
ORDINARY = 10  # steps
needs_real = pytest.mark.skipif(installed() is None, reason=f"{VARIABLE} does not name a folder with NASA's core-cpu1")


class Letter(NamedTuple):
    """A packet to a service, and the events that it causes there: application, event id, text."""

    service: str
    packet: bytes
    events: list[tuple[str, int, bytes]]


LETTERS = {
    "length field 0": Letter("TO_LAB", bytes.fromhex("1880c000000001a6"), [("TO_LAB", 13, b"Reset counters command")]),
    "log mode of 8 bits": Letter(
        "ES",
        es.OVER_WRITE_SYS_LOG.packet(Mode=0x80000000),
        [("CFE_ES", 70, b"Set OverWriteSysLog Command Received with Mode setting = -2147483648")],
    ),
    "log mode 256": Letter(
        "ES",
        es.OVER_WRITE_SYS_LOG.packet(Mode=256),
        [("CFE_ES", 70, b"Set OverWriteSysLog Command Received with Mode setting = 256")],
    ),
    "log mode, refused": Letter(
        "ES",
        es.OVER_WRITE_SYS_LOG.packet(Mode=0xFFFFFFFF),
        [("CFE_ES", 71, b"Set OverWriteSysLog Command: Invalid Mode setting = -1")],
    ),
    "trigger mode": Letter(
        "ES",
        es.START_PERF_DATA.packet(TriggerMode=0xFFFFFFFF),
        [("CFE_ES", 59, b"Cannot start collecting performance data, trigger mode (-1) out of range (0 to 2)")],
    ),
    "name of 20 characters": Letter(
        "ES",
        es.STOP_APP.packet(Application="X" * 20),
        [("CFE_ES", 36, b"Stop Application " + b"X" * 19 + b", GetAppIDByName failed. RC = 0xC4000002.")],
    ),
    "name of 20 characters to EVS": Letter(
        "EVS",
        evs.RESET_ALL_FILTERS.packet(AppName="X" * 20),
        [("CFE_EVS", 9, b"Unable to retrieve application ID for " + b"X" * 19 + b": CC = 14")],
    ),
    "file name that is too long": Letter(
        "SB",
        sb.WRITE_PIPE_INFO.packet(Filename="z" * 64),
        [("CFE_SB", 40, b"Error creating file /ram/" + b"z" * 58 + b", stat=0xc6000003")],
    ),
    "bytes that are not UTF-8": Letter(
        "ES",
        es.QUERY_ONE.packet(Application=b"\xff\x80A"),
        [("CFE_ES", 50, b"Failed to send \xff\x80A application data: GetAppIDByName Failed, RC = 0xC4000002")],
    ),
}
ALL_TYPES = Step("EVS", (evs.ENABLE_EVENT_TYPE.packet(BitMask=15),), PLAIN)


@pytest.fixture(scope="module")
def flown() -> Iterator[Simulated]:
    with simulated("7.0.0") as computer:
        computer.fly(ALL_TYPES)
        yield computer


def events(packets: tuple[bytes, ...]) -> list[tuple[str, int, bytes]]:
    return [
        (packet[16:36].partition(b"\0")[0].decode(), packet[36], packet[48:170].partition(b"\0")[0])
        for packet in packets
        if masks.is_event(packet) and masks.of_packet(packet) is not None
    ]


@pytest.mark.parametrize("name", LETTERS)
def test_events_to_the_letter(flown: Simulated, name: str) -> None:
    letter = LETTERS[name]
    assert events(flown.fly(Step(letter.service, (letter.packet,), PLAIN)).packets) == letter.events


@needs_real
def test_recorded_events_equal_nasas() -> None:
    built = installed()
    assert built is not None
    with real(built) as computer:
        computer.fly(ALL_TYPES)
        for name, letter in LETTERS.items():
            found = events(computer.fly(Step(letter.service, (letter.packet,), PLAIN)).packets)
            assert (name, found) == (name, letter.events)


def fly_again(release: str, flight: recorded.Flight) -> list[str]:
    with simulated(release) as computer:
        found = []
        for number, (step, observed) in enumerate(flight):
            found += [f"step {number}: {line}" for line in differences(computer.fly(step), observed)]
        return found


@pytest.mark.slow
@pytest.mark.parametrize("release", RELEASES)
def test_first_recorded_commands_give_the_recorded_answers(release: str) -> None:
    flight = recorded.load(recorded.of_release(release))[0][:ORDINARY]
    assert len(flight) == ORDINARY
    assert fly_again(release, flight) == []


@pytest.mark.slow
@pytest.mark.parametrize(("release", "number"), FLIGHTS)
def test_all_recorded_commands_give_the_recorded_answers(release: str, number: int) -> None:
    assert fly_again(release, recorded.load(recorded.of_release(release))[number]) == []


def test_difference_is_found() -> None:
    """A comparison that cannot fail would prove nothing: another text, a packet less, another file."""
    flight = recorded.load(recorded.of_release("7.0.0"))[0]
    step, observed = next(pair for pair in flight if any(map(masks.is_event, pair[1].packets)))
    assert differences(observed, observed) == []
    at = next(at for at, packet in enumerate(observed.packets) if masks.is_event(packet))
    other = observed.packets[at][:38] + b"\7" + observed.packets[at][39:]
    assert differences(
        observed._replace(packets=(*observed.packets[:at], other, *observed.packets[at + 1 :])), observed
    )
    assert differences(observed._replace(packets=observed.packets[1:]), observed)
    assert differences(observed._replace(files={"/ram/x": b"1"}), observed) == ["file /ram/x: not there"]
    assert step.packets


def test_housekeeping_of_both_ci_labs_is_compared_field_by_field() -> None:
    head = bytes.fromhex("0884c0010021 000000000000 00000000")
    flags, counts = bytes([3, 1, 0, 1]), bytes([89, 0, 0, 0, 2, 0, 0, 0])
    ours = head + flags + bytes(8) + counts + bytes(4)
    theirs = head[:4] + b"\0\x15" + head[6:] + flags + counts
    assert masks.of_packet(theirs) == masks.of_packet(ours)
    assert masks.of_packet(theirs[:-4] + b"\1" + theirs[-3:]) != masks.of_packet(ours)


@needs_real
@pytest.mark.slow
def test_commands_give_the_answers_of_nasas_cfe() -> None:
    built = installed()
    assert built is not None
    assert [flown for flown in fly(built, 1, 40) if flown.lines] == []
