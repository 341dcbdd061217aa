"""Ends of applications, resets and ground tones on NASA's cFE, on record: cfepy answers each step alike."""

from __future__ import annotations

import itertools

import pytest

from dev.twin import recorded
from dev.twin.flight import differences
from dev.twin.lives import LivesCommander
from dev.twin.lives_flight import settled, simulated

RELEASES = ("7.0.0", pytest.param("7.0.1", marks=pytest.mark.slow))
ORDINARY = 8
"""Steps that every run of the tests flies; the slow ones fly all."""


def fly_again(release: str, number: int, count: int | None = None) -> list[str]:
    flight = recorded.load(recorded.of_release(release, "lives"))[number][:count]
    assert count is None or len(flight) == count
    with simulated(release) as computer:
        return [
            f"step {at}, {step}: {line}"
            for at, (step, observed) in enumerate(flight)
            for line in differences(settled(computer.fly(step)), settled(observed))
        ]


@pytest.mark.slow
@pytest.mark.parametrize("release", RELEASES)
def test_first_recorded_steps_give_the_recorded_answers(release: str) -> None:
    assert fly_again(release, 0, ORDINARY) == []


@pytest.mark.slow
@pytest.mark.parametrize("release", RELEASES)
def test_all_recorded_steps_give_the_recorded_answers(release: str) -> None:
    flights = len(recorded.load(recorded.of_release(release, "lives")))
    assert [line for number in range(flights) for line in fly_again(release, number)] == []


@pytest.mark.parametrize("release", RELEASES)
def test_record_has_all_kinds_of_steps(release: str) -> None:
    """Both kinds of resets, ends of every lab application, tones, blocks of the CDS."""
    flights = recorded.load(recorded.of_release(release, "lives"))
    sent = b"".join(packet for flight in flights for step, _ in flight for packet in step.packets)
    assert {step.pace for flight in flights for step, _ in flight} == {"plain", "background", "control", "reset"}
    for reset in (b"\x18\x06\xc0\x00\x00\x03\x02", b"\x18\x10", b"\x18\x11", b"\x18\x60", b"\x18\x62", b"STATE"):
        assert reset in sent
    for app in (b"CI_LAB", b"TO_LAB", b"SCH_LAB", b"SAMPLE_APP"):
        assert app in sent


def test_steps_depend_only_on_the_seed() -> None:
    first, second = (list(itertools.islice(LivesCommander(7).steps(), 60)) for _ in range(2))
    assert first == second
    assert first != list(itertools.islice(LivesCommander(8).steps(), 60))
