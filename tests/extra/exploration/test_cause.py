"""The cause of a failure is reported if the deeds show it, and nothing is reported if they do not."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence

import pytest

from cfepy.extra.exploration.cause import Evidence, cause_of
from cfepy.extra.exploration.made_moves import MadeMove
from cfepy.extra.exploration.operations import (
    AWAITS,
    BINARY,
    GETS,
    GIVES_UP,
    GIVES_WAY,
    LOSES,
    NOTIFIES,
    READS,
    RECEIVES,
    WAKES,
    WRITES,
    Deed,
)
from cfepy.extra.exploration.task_look import AT, PREEMPTED, Row
from cfepy.extra.exploration.verdict import DEADLOCK, ENDED, RAISED, Failure
from tests.extra.exploration.made import moved

ENDED_BADLY = Failure(ENDED, "A", "exit status 1")
NO_MOVES: tuple[MadeMove, ...] = ()


def deed(text: str) -> Deed:
    """Return a deed of `task verb thing line note`."""
    task, verb, thing, line, *note = text.split("|")
    ident, key = (1 + ord(thing[-1]), thing) if thing.startswith("o.") else (0, "")
    return Deed(0, task, task, verb, thing, f"a.py:{line}", "".join(note), ident, key)


def told(
    failing: Sequence[str],
    usual: Sequence[str] = (),
    failure: Failure = ENDED_BADLY,
    moves: Sequence[MadeMove] = NO_MOVES,
    rows: Sequence[Row] = (),
) -> str:
    """Return the reported cause for deeds."""
    names = {"lock 5 of A": "left (a.py:3)"}
    return cause_of(Evidence(failure, moves, rows, list(map(deed, failing)), list(map(deed, usual)), names)).text


def test_cause_is_empty_without_deeds() -> None:
    assert told([]) == ""


MS = 1_000_000
LATE = Failure("deadline", "/pose", "at_least_every 100 ms was missed", 500 * MS, span_ns=100 * MS)


@pytest.mark.parametrize(
    ("ran", "usual", "cause"),
    [
        (
            {"A": 40, "B": 60},
            {"A": 40, "B": 5},
            "B ran for 60 ms of the 100 ms before the missed deadline; under fifo it runs for 5 ms",
        ),
        ({"A": 40}, {"A": 31}, ""),
        ({}, {}, ""),
    ],
)
def test_late_task_names_the_task_that_ran_longer(ran: dict[str, int], usual: dict[str, int], cause: str) -> None:
    times = [Counter({task: ms * MS for task, ms in each.items()}) for each in (ran, usual)]
    assert cause_of(Evidence(LATE, NO_MOVES, [], [], [], {}, *times)).text == cause


def accesses(text: str) -> list[str]:
    """Return accesses of a variable: `A:R1 A>B B:W2` means that A reads it at line 1 and yields to B, which writes
    it."""
    found = []
    for word in text.split():
        task, _, what = word.partition(":")
        verb = {"R": READS, "W": WRITES, "?": RECEIVES}.get(what[:1])
        found.append(f"{task}|{verb}|x|{what[1:]}" if verb else f"{word[0]}|{GIVES_WAY}|{word[2]}|0")
    return found


def test_an_update_is_lost_between_a_read_and_a_write() -> None:
    lost, usual = accesses("A:R1 A>B B:R1 B:W2 A:W2"), accesses("B:R1 B:W2 A:R1 A:W2")
    cause = "an update of x is lost: B wrote it at a.py:2, between A's read at a.py:1 and A's write at a.py:2"
    assert told(lost, usual) == cause
    assert told(lost, lost) == ""  # it is lost under fifo as well, and nothing fails
    assert told(usual, lost) == ""


@pytest.mark.parametrize(
    "text",
    [
        "A:R1 A>B B:W2 A:R1 A:W2 A:W3",  # written after it was read again
        "A:R1 B:W2 A:W2",  # no switch let B in
        "B:W2 A>B A:R1 A:W2",
        "A:R1 A>B B:W2 A:?3 A:W2",  # with another message
        "A:R1 A>B B:R2 A:W2",
    ],
)
def test_cause_is_empty_when_no_update_is_lost(text: str) -> None:
    assert "lost" not in told(accesses(text))


@pytest.mark.parametrize(
    ("text", "cause"),
    [
        ("A:R1 A>B B:W2 A:R3", "B wrote x at a.py:2, between A's reads at a.py:1 and a.py:3"),
        ("A:W1 A>B B:W2 A:R3", "B wrote x at a.py:2, between A's write at a.py:1 and A's read at a.py:3"),
        ("A:W1 A>B B:R2 A:W3", "B read x at a.py:2, between A's writes at a.py:1 and a.py:3"),
        ("A:R1 A>B B:R2 A:R3", ""),
        ("A:W1 A>B B:W2 A:W3", ""),
        ("A:R1 A>B B:W2 A>B A:R3 A>B B:W2 A:R4", "B wrote x at a.py:2, between A's reads at a.py:3 and a.py:4"),
    ],
)
def test_two_accesses_are_torn_by_a_third(text: str, cause: str) -> None:
    assert told(accesses(text)) == cause


def test_cause_names_the_order_of_accesses_when_one_variable_explains_it() -> None:
    failing = [f"A|{GIVES_WAY}|B|0", f"B|{READS}|o.x|2", f"A|{WRITES}|o.x|1"]
    usual = [failing[2], failing[1]]
    assert told(failing, usual) == "B read o.x at a.py:2 before A wrote it at a.py:1; under fifo the order is reversed"
    assert told(failing[1:], usual) == ""  # no switch kept A back
    more = [f"B|{READS}|o.y|2", f"A|{WRITES}|o.y|1"]
    assert told([*failing, *more], [*usual, more[1], more[0]]) == ""


def test_cause_of_an_exception_names_the_write_after_its_read() -> None:
    failing = [f"A|{READS}|o.x|7", f"A|{GIVES_WAY}|B|0", f"B|{WRITES}|o.x|2"]
    raised = Failure(RAISED, "a", "RuntimeError: changed (a.py:7)", task="A")
    cause = "B wrote o.x at a.py:2, between A's read at a.py:7 and the exception there"
    assert told(failing, failure=raised) == cause
    assert told(failing, failure=Failure(RAISED, "a", "RuntimeError: changed (a.py:8)", task="A")) == ""
    assert told(failing, failure=Failure(RAISED, "b", "RuntimeError: changed (a.py:7)", task="B")) == ""


@pytest.mark.parametrize(
    ("error", "thing"),
    [
        ("AttributeError: 'Tracker' object has no attribute 'out' (a.py:7)", "Tracker.out"),
        ("NameError: name 'out' is not defined (a.py:7)", "out"),
    ],
)
def test_cause_of_a_missing_value_names_the_line_that_writes_it_later(error: str, thing: str) -> None:
    usual = [f"B|{WRITES}|{thing}|2"]
    raised = Failure(RAISED, "a", error, task="A")
    cause = f"A read {thing} at a.py:7 before B wrote it at a.py:2; under fifo it is written first"
    assert told([], usual, raised) == cause
    assert told([], [f"A|{WRITES}|{thing}|2"], raised) == cause.replace("B wrote it", "it was written")
    assert told([], [f"B|{WRITES}|other|2"], raised) == ""


def test_cause_names_the_order_of_two_writes_when_one_variable_explains_it() -> None:
    failing = [f"A|{GIVES_WAY}|B|0", f"B|{WRITES}|o.x|2", f"A|{WRITES}|o.x|1"]
    usual = [failing[2], failing[1]]
    assert told(failing, usual) == "A wrote o.x at a.py:1 after B wrote it at a.py:2; under fifo the order is reversed"
    assert told(failing, failing) == ""


def test_cause_names_a_give_that_is_lost() -> None:
    def take(task: str) -> list[str]:
        return [f"{task}|wants|semaphore S|1|{BINARY}", f"{task}|takes|semaphore S|1|{BINARY}"]

    give = f"B|gives|semaphore S|2|{BINARY}"
    usual = [give, *take("A"), give, *take("A")]
    assert told([give, give, *take("A")], usual) == (
        "B gave semaphore S at a.py:2 while it was given already, by its own give at a.py:2, so one give is lost; "
        "under fifo a task takes it in between"
    )
    assert told([give, give], [give, give]) == ""  # it is lost under fifo as well
    wait, woken = take("A")
    assert told([wait, give, give, woken], usual) == ""  # the first give woke A
    given_up = [wait, f"A|{GIVES_UP}|semaphore S|1|{BINARY}"]
    assert "while it was given already" in told([*given_up, give, give], usual)


def test_cause_names_a_notify_before_its_wait() -> None:
    early = [f"B|{NOTIFIES}|c|21|0", f"A|{AWAITS}|c|14"]
    late = [f"A|{AWAITS}|c|14", f"B|{NOTIFIES}|c|21|1", f"A|{WAKES}|c|14"]
    cause = "B's notify at a.py:21 came before A's wait at a.py:14: no task was waiting"
    assert told(early, late) == cause
    assert told([*early, f"A|{GIVES_UP}|c|14"], late) == cause
    assert told([*early, f"A|{WAKES}|c|14"], late) == ""  # it did not wait in vain
    assert told(early, early) == ""


def test_a_message_is_lost_that_is_not_lost_under_fifo() -> None:
    lost = f"A|{LOSES}|/a|7|B, 2"
    assert told([lost]).startswith(
        "a message /a that A sent at a.py:7 was lost: the pipe of B was full, with 2 messages"
    )
    assert told([lost], [lost]) == ""


def test_cause_names_a_changed_order_of_messages_to_a_task_of_the_moves() -> None:
    failing, usual = [f"A|{GETS}|/b|1|P", f"A|{GETS}|/a|1|Q"], [f"A|{GETS}|/a|1|Q", f"A|{GETS}|/b|1|P"]
    moves = [moved("A", "B"), moved("C", "A")]
    assert told(failing, usual, moves=moves) == "A got /b before /a; under fifo it gets /a first"
    assert told(failing, usual, moves=[moved("B", "C"), moved("B", "C")]) == ""


def test_cause_names_the_locks_of_a_deadlock() -> None:
    text = "A waits for lock 5 of A, held by B; B waits for mutex CARD, held by A"
    circle = Failure(DEADLOCK, "A", text)
    assert (
        told([], failure=circle)
        == "A holds mutex CARD and waits for left (a.py:3); B holds left (a.py:3) and waits for mutex CARD"
    )
    ended = Failure(DEADLOCK, "A", "A waits for lock 5 of A, held by B")
    assert told([], failure=ended) == ""  # the holder has ended: there is no circle


def test_cause_names_the_only_switch() -> None:
    rows = [Row(0, "A", AT, "a.py:7: go()"), Row(0, "A", PREEMPTED, "B")]
    cause = "B preempted A at a.py:7; without this preemption the run does not fail"
    assert told([], moves=[moved("A", "B")], rows=rows) == cause
    assert told([], moves=[moved("A", "B"), moved("B", "A")], rows=rows) == ""
    assert told([], moves=[moved("A", "B")], rows=rows[1:]) == ""
