"""Lines of a script that arrive one at a time, while the mission continues."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

from cfepy.ground import dictionary_of
from cfepy.mission import Mission, PacketWatch, read_mission
from cfepy.rtos import ENDLESS
from cfepy.script import TYPED, Collected, Scene, StandingScript, Step, StepVerdict
from cfepy.status import UsageError
from cfepy.units import NS_PER_S


class Told:
    """A mission with a standing script, and its reported verdicts."""

    def __init__(self) -> None:
        spec = read_mission("lab")
        packets = Collected()
        self.mission = Mission(spec, attachments=[PacketWatch(packets.append)])
        self.mission.console.sink = lambda line: None
        self.scene = Scene(self.mission, dictionary_of(spec), packets)
        self.script = StandingScript(self.scene, spec)
        self.verdicts: list[StepVerdict] = []

    def add(self, text: str) -> None:
        self.script.add(text, TYPED, self.tell)
        self.script.advance()

    def tell(self, step: Step, verdict: StepVerdict) -> None:
        self.verdicts.append(verdict)

    def run(self, seconds: float) -> None:
        end_ns = self.mission.kernel.now + round(seconds * NS_PER_S)
        while self.mission.kernel.now < end_ns:
            self.mission.run_until(min(end_ns, self.script.advance()))
        self.script.advance()

    def words(self) -> list[str]:
        return [f"{'ok' if each.ok else 'FAILED'} {each.at_s:.2f} {each.step}" for each in self.verdicts]


@pytest.fixture
def told() -> Iterator[Told]:
    found = Told()
    with found.mission:
        yield found


def test_line_acts_at_once_while_others_wait(told: Told) -> None:
    told.run(1)
    told.add("expect event SAMPLE_APP 3 within 3")
    told.add("expect no event * CRITICAL")
    assert told.script.is_waiting
    told.add("send CFE_ES_NOOP")
    assert told.words() == ["ok 1.00 send CFE_ES_NOOP"]
    told.run(0.5)
    told.add("expect event CFE_ES 3")  # looks back to the last command
    told.add("send SAMPLE_APP_NOOP")
    told.run(0.1)
    assert told.words()[1:] == [
        "ok 1.00 expect event CFE_ES 3",
        "ok 1.50 send SAMPLE_APP_NOOP",
        "ok 1.50 expect event SAMPLE_APP 3 within 3",
    ]
    assert not told.script.is_waiting
    (guard,) = told.script.end()
    assert guard.ok


def test_abandoned_steps_are_not_reported_but_guards_are(told: Told) -> None:
    told.run(0.7)
    told.add("expect event NOBODY")
    told.add("expect no event CFE_ES 3")
    told.add("at 30 end")
    assert told.script.give_up() == 2
    assert not told.script.is_waiting
    told.add("send CFE_ES_NOOP")
    told.run(0.1)
    assert told.words() == ["ok 0.70 send CFE_ES_NOOP", "FAILED 0.70 expect no event CFE_ES 3"]
    assert told.script.advance() == ENDLESS
    assert told.script.end() == []


def test_line_with_a_mistake_does_nothing(told: Told) -> None:
    with pytest.raises(UsageError, match="unknown command NOPE"):
        told.add("send CFE_ES_NOOP\nsend NOPE")
    assert told.verdicts == []


def test_oldest_packets_are_dropped_and_numbers_kept(told: Told) -> None:
    few = Collected(most=2)
    told.run(1)
    seen = told.scene.packets.since(0)[:5]
    for each in seen:
        few.append(each)
    assert len(few) == 5
    assert few.since(0) == few.since(3) == seen[3:]
    assert few.since(4) == seen[4:]
