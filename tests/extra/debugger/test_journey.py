"""Going back in a run reproduces each moment exactly."""

from __future__ import annotations

import bdb
import io
import random
import re
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from cfepy.extra.debugger.app_debugger import own_frame
from cfepy.extra.debugger.breakpoints import VariableCondition, finders
from cfepy.extra.debugger.debugger import Debugger
from cfepy.extra.debugger.journey import Journey, LineMoment, RunMoment
from cfepy.pilot import Course
from cfepy.pilot.pilot import Flown, fly
from cfepy.pilot.plan import RunPlan
from cfepy.status import UsageError

COUNTER = """
import threading
import rospy
from std_msgs.msg import Int32

state = 0
lock = threading.Lock()

def on_number(message):
    global state
    with lock:
        state = message.data * 2

rospy.init_node("counter")
publisher = rospy.Publisher("/numbers", Int32, queue_size=10)
rospy.Subscriber("/numbers", Int32, on_number)
for number in range(4):
    rospy.sleep(0.1)
    publisher.publish(number)
rospy.sleep(0.1)
"""
BOTH = pytest.mark.parametrize("tasks", ["thread", "greenlet"])
STEPS = 500


@pytest.fixture
def plan(tmp_path: Path) -> RunPlan:
    """A run of a node that counts, in two threads."""
    script = tmp_path / "counter.py"
    script.write_text(COUNTER, encoding="utf-8")
    return RunPlan((str(script),), command="node", seconds=1.2, tasks="greenlet")


class User(io.StringIO):
    """Types the text that a function returns.

    Attributes:
        debugger: debugger of the current flight.
    """

    def __init__(self, say: Callable[[Debugger], str]) -> None:
        super().__init__()
        self.debugger: Debugger
        self._say = say

    def readline(self, size: int = -1, /) -> str:
        return self._say(self.debugger) + "\n"


def journey_of(plan: RunPlan, commands: str | User, journey: Journey, **options: Any) -> tuple[str, Flown, int]:
    """Fly with a debugger, again each time its user goes back.

    Returns its output, the last flight, and the number of flights.
    """
    typed = io.StringIO(commands) if isinstance(commands, str) else commands
    stream, flights, end = io.StringIO(), 0, End()
    while True:
        spec = plan.spec()
        debugger = Debugger(spec, commands=typed, stream=stream, journey=journey, on_quit=end.come, **options)
        if isinstance(typed, User):
            typed.debugger = debugger
        flown = fly(plan, attachments=[debugger], spec=spec, make_course=end.course)
        flights += 1
        if not journey.flies_again:
            return stream.getvalue(), flown, flights
        journey.flies_again = False


class End:
    """Ends a flight, as a replay does."""

    def __init__(self) -> None:
        self._course: Course

    def course(self, *given: Any) -> Course:
        """Return the flown course."""
        self._course = Course(*given)
        return self._course

    def come(self) -> None:
        """It ends here."""
        self._course.until_ns = -1
        self._course.mission.kernel.stop()


def times(said: str) -> list[str]:
    return [line for line in said.splitlines() if line[:1].isdigit()]


def state_of(debugger: Debugger) -> str:
    """Return all observable state of a stopped debugger."""
    mission, frame = debugger._mission, own_frame()
    variables = {} if frame is None else {name: repr(frame.f_globals.get(name)) for name in ("state", "number")}
    pipes = [(pipe.name, len(pipe.items)) for pipe in mission.cfe.sb.pipes]
    return f"{mission.trace.digest()} {mission.kernel.now} {mission.kernel.waiting()} {pipes} {variables}"


class Walk:
    """A user who goes back and forth at random, and checks that everything is reproduced."""

    def __init__(self, steps: int, seed: int) -> None:
        self.known: dict[RunMoment, str] = {}
        self.seen_again = 0
        self.wrong: list[RunMoment] = []
        self._random = random.Random(seed)
        self._left = steps

    def say(self, debugger: Debugger) -> str:
        """Return the next input."""
        moment, state = debugger._moment, state_of(debugger)
        if moment in self.known:
            self.seen_again += 1
            if self.known[moment] != state:
                self.wrong.append(moment)
        self.known[moment] = state
        self._left -= 1
        return "q" if not self._left else self._random.choice(["s", "b"])


def walked(plan: RunPlan, steps: int, seed: int) -> Walk:
    walk = Walk(steps, seed)
    user = User(walk.say)
    journey_of(plan, user, Journey(asks_at_end=True), step=True, from_ns=600_000_000)
    assert not walk.wrong
    return walk


def test_moments_are_reproduced(plan: RunPlan) -> None:
    assert walked(plan, 8, 1).seen_again > 1


@pytest.mark.slow
def test_hundreds_of_steps_forward_and_back_end_in_equal_states(plan: RunPlan) -> None:
    walk = walked(plan, STEPS, 2)
    assert walk.seen_again > STEPS / 2
    assert walk.seen_again + len(walk.known) == STEPS


@BOTH
def test_step_back_shows_the_moment_of_the_step_forward(plan: RunPlan, tasks: str) -> None:
    plan = RunPlan(plan.words, command="node", seconds=1.2, tasks=tasks)
    said, _, flights = journey_of(plan, "s\ns\nb\nb\nq\n", Journey(), stops=["msg.data == 1"])
    first, second, third, again, stop = times(said)
    assert again == second
    assert third != second
    assert flights == 3
    assert stop.endswith("goes on") or stop.endswith("bytes")
    assert first.endswith("/numbers of /counter: data: 1")


@pytest.mark.slow
def test_back_to_the_last_breakpoint(plan: RunPlan) -> None:
    said, flown, flights = journey_of(plan, "c\nc\nrc\nrc\nrc\nc\nq\n", Journey(), stops=["/numbers"])
    assert [line[-1] for line in times(said)] == list("0121001")
    assert said.count("no match before this point of the run") == 1
    assert flights == 1 + 2 + 2 + 1
    assert flown.interrupted is False


def test_backward_search_finds_the_last_match_from_the_end(plan: RunPlan) -> None:
    said, flown, _ = journey_of(plan, "bt state == 4\nw\nc\n", Journey(asks_at_end=True))
    end, held, again = times(said)
    assert end == again
    assert end.endswith("the end of the run")
    assert held.startswith("0.950006")  # then the next number comes
    assert flown.trace == fly(plan).trace


@pytest.mark.slow
def test_first_flight_finds_the_last_match(plan: RunPlan) -> None:
    said, _, flights = journey_of(plan, "q\n", Journey(back_to="msg.data == 2"))
    assert times(said)[0].endswith("/numbers of /counter: data: 2")
    assert flights == 2
    said, _, flights = journey_of(plan, "q\n", Journey(asks_at_end=True, back_to="msg.data == 7"))
    assert said.startswith("no match before this point of the run")
    assert flights == 1


@pytest.mark.slow
def test_lines_of_a_task_backwards(plan: RunPlan) -> None:
    plan = RunPlan(plan.words, command="node", seconds=1.2, tasks="thread")  # as a debugger in a task needs them
    typed = "n\nn\nrstep\nrs\np number\nb 19\nc\nc\np number\nrcontinue\np number\nrc\nq\n"
    try:
        said, _, flights = journey_of(plan, typed, Journey(), app="COUNTER", stops=["msg.data == 1"])
    finally:
        bdb.Breakpoint.clearBreakpoints()  # type: ignore[no-untyped-call]  # they are the process's
    shown = [line.removeprefix("-> ") for line in said.splitlines() if line.startswith("-> ")]
    begins, sleeps, publishes = "for number in range(4):", "rospy.sleep(0.1)", "publisher.publish(number)"
    forward = [begins, sleeps, publishes]
    assert shown == [*forward, sleeps, begins, publishes, publishes, publishes, publishes]
    assert re.findall(r"\(Pdb\) (\d)", said) == ["1", "3", "2"]
    assert said.count("no match before this point of the run") == 0
    assert flights == 1 + 2 + 2 + 2


def test_step_back_is_refused_without_a_journey(plan: RunPlan) -> None:
    spec, stream = plan.spec(), io.StringIO()
    debugger = Debugger(
        spec, commands=io.StringIO("b\nrc\nbt /numbers\nwhat\nc\n"), stream=stream, stops=["msg.data == 0"]
    )
    fly(plan, attachments=[debugger], spec=spec)
    assert stream.getvalue().count("cannot go back") == 3
    assert "back to the last breakpoint" not in stream.getvalue()


@pytest.mark.parametrize("text", ["launch() == 3", "x := 3", "state ==", "no_such_packet"])
def test_invalid_or_state_changing_condition_is_refused(plan: RunPlan, text: str) -> None:
    with pytest.raises(UsageError):
        finders(text, plan.spec(), lambda what: None)


def test_condition_with_unknown_names_is_false() -> None:
    assert VariableCondition("STEPS == 500 and len('abc') == 3").holds(sys._getframe())
    assert not VariableCondition("there == 3").holds(sys._getframe())
    assert not VariableCondition("STEPS == 500").holds(None)


def test_the_moment_before() -> None:
    assert RunMoment(5).before() == RunMoment(4)
    assert RunMoment(5, hits=1).before() == RunMoment(5)
    assert RunMoment(5, finds=1, text="/a").before() == RunMoment(5)


def test_search_ends_at_its_limit() -> None:
    journey = Journey()
    journey.look_for("", LineMoment(3, 9))
    journey.finds(LineMoment(3, 4))
    journey.finds(RunMoment(7, 1))  # a breakpoint of the run, and not of the debugger's
    journey.finds(LineMoment(3, 9))
    assert not journey.arrives(LineMoment(3, 9))
    assert journey.target == LineMoment(3, 4)
    assert journey.arrives(LineMoment(3, 4))
    assert not journey.is_silent
