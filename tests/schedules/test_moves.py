"""Moves name their places by features that survive edits of a program, as text that needs no shell quoting."""

from __future__ import annotations

import shlex
from collections.abc import Callable

import pytest

from cfepy.rtos import AskingPolicy, Decision, Kernel, NotingPolicy, Policy, Question, Task
from cfepy.schedules import Move, MoveNumbers, Schedule, make_kernel
from cfepy.status import UsageError
from cfepy.trace import Trace

Program = Callable[[Kernel], list[str]]
OWNER = type("Owner", (), {"name": "ODOMETER"})()


@pytest.mark.parametrize(
    ("text", "move"),
    [
        ("A=B", Move("A", "B")),
        ("A@650=B", Move("A", "B", 650)),
        ("A@650/3=B", Move("A", "B", 650, "", 3)),
        ("A@0/3=hold", Move("A", "hold", 0, "", 3)),
        ("A.left-2@7/add.publish=A.right", Move("A.left-2", "A.right", 7, "add.publish")),
        ("A@7/-.take/12=B", Move("A", "B", 7, "-.take", 12)),
        ("A@7/next=B", Move("A", "B", 7, "next")),
        ("connection+of+/base+to+/arm=100ms", Move("connection of /base to /arm", "100ms")),
        ("a%2Bb%40%23%3D%3A%2C%7E%25=%C3%A9", Move("a+b@#=:,~%", "\N{LATIN SMALL LETTER E WITH ACUTE}")),
    ],
)
def test_move_is_written_and_parsed(text: str, move: Move) -> None:
    assert move.text() == text
    assert Move.parse(text) == move
    schedule = Schedule().by_moves([move, Move("Z", "Y")])
    assert Schedule.parse(f"{schedule}:any:hold=1ms") == Schedule.parse("at:any:hold=1ms").by_moves(schedule.moves)
    assert shlex.quote(str(schedule)) == str(schedule)


@pytest.mark.parametrize(
    ("text", "wrong"),
    [
        ("moves:A", "invalid move 'A'"),
        ("moves:A@x=B", "invalid move 'A@x=B'"),
        ("moves:A@1/nowhere=B", "invalid move 'A@1/nowhere=B'"),
        ("moves:A@1/0=B", "invalid move 'A@1/0=B'"),
        ("moves:A=B,", "invalid move ''"),
        ("moves:A=B:C=D", "invalid schedule 'moves:A=B:C=D'; expected moves:TASK@MS/FUNCTION.CALL=TASK"),
    ],
)
def test_invalid_move_is_refused(text: str, wrong: str) -> None:
    with pytest.raises(UsageError, match=wrong):
        Schedule.parse(text)


def two_calls(kernel: Kernel) -> list[str]:
    """Return three tasks that make calls."""
    said: list[str] = []

    def look() -> None:
        kernel.charge(1)

    def publish() -> None:
        kernel.charge(1)

    def callback(name: str) -> Callable[[], None]:
        def run() -> None:
            look()
            said.append(f"{name} looked")
            publish()
            said.append(f"{name} published")

        return run

    for number, name in enumerate(("left", "right", "left"), 1):
        kernel.spawn(f"ODOMETE.{name}.{number}", callback(f"{name}{number}"), owner=OWNER)
    return said


def flown(program: Program, policy: Policy) -> list[str]:
    with make_kernel(trace=Trace(), policy=policy) as kernel:
        said = program(kernel)
        kernel.run()
        return said


def edited(kernel: Kernel) -> list[str]:
    """Return the same in a larger mission: another task comes first, so all tasks have other numbers."""
    kernel.spawn("LOGGER.x.1", lambda: kernel.charge(1))
    return two_calls(kernel)


@pytest.mark.parametrize("program", [two_calls, edited])
def test_moves_keep_their_meaning_after_an_edit(program: Program) -> None:
    schedule = Schedule.parse("moves:ODOMETER.left@0/publish.line=ODOMETER.left-2")
    policy = schedule.policy()
    assert policy is not None
    said = flown(program, policy)
    assert said[:2] == ["left1 looked", "left3 looked"]
    assert policy.missed == policy.notes == ()


def test_number_of_a_move_counts_occasions_of_the_other_task() -> None:
    said = flown(two_calls, Schedule.parse("moves:ODOMETER.left@0/3=ODOMETER.right").policy() or Policy())
    assert said[:2] == ["left1 looked", "right2 looked"]


def test_impossible_moves_are_reported() -> None:
    schedule = Schedule.parse("moves:ODOMETER.left@0/publish.line=ODOMETER.right,ODOMETER.left@5=ODOMETER.right,X=Y")
    policy = NotingPolicy(schedule.policy())
    flown(two_calls, policy)
    assert policy.missed == ("ODOMETER.left@5=ODOMETER.right", "X=Y")
    (note,) = policy.notes
    assert note.startswith("1 of 3 moves of the schedule were possible; not possible: ODOMETER.left@5=")


@pytest.mark.parametrize("options", ["", ":fair=30"])
def test_deviations_at_decisions_that_do_not_come_are_reported(options: str) -> None:
    policy = NotingPolicy(Schedule.parse(f"at:0=1,4000=1,5000=2{options}").policy())
    flown(two_calls, policy)
    assert policy.missed == ("4000=1", "5000=2")
    assert policy.notes == ("1 of 3 deviations of the schedule were possible; not possible: 4000=1, 5000=2",)


class Naming(AskingPolicy):
    """Keeps the moves that another policy makes."""

    def __init__(self, inner: Policy) -> None:
        super().__init__(inner)
        self.moves: list[Move] = []
        self._numbers = MoveNumbers()

    def choose(self, decision: Decision) -> int:
        choice = super().choose(decision)
        moves = self._numbers.moves(decision)
        if choice:
            self.moves.append(moves[choice - 1])
        return choice


@pytest.mark.parametrize("seed", range(20))
def test_moves_of_a_run_reproduce_it(seed: int) -> None:
    naming = Naming(Schedule("random", seed).policy() or Policy())
    said = flown(two_calls, naming)
    policy = Schedule().by_moves(naming.moves).policy()
    assert policy is not None
    assert flown(two_calls, policy) == said
    assert not policy.missed


def test_move_of_a_question_has_its_name_and_answer() -> None:
    question = Question("connection of /base to /arm on /enable", "slow connection", ("0s", "100ms"), "{}")
    policy = Schedule.parse("moves:connection+of+/base+to+/arm+on+/enable@0/2=100ms").policy()
    assert policy is not None
    asked = [policy.choose(Decision(number, 0, (), False, False, None, question)) for number in range(3)]
    assert asked == [0, 1, 0]


def test_task_named_like_a_keyword_gets_an_alias() -> None:
    with make_kernel(policy=Policy()) as kernel:
        made: list[Task] = [kernel.spawn(name, kernel.exit_task) for name in ("hold", "X-2", "X.2", "X", "X")]
        assert [task.alias for task in made] == ["hold-2", "X.2", "X.2-2", "X", "X-2"]
