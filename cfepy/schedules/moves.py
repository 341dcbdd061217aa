"""Moves: deviations of a schedule from fifo. A move names the task and the call, not the number of a decision.

    ODOMETER.left_tic@650/add.publish=ODOMETER.right_ti

This move means: from 650 ms of virtual time on, the first time that ODOMETER.left_tic calls `publish` in its function
`add` while ODOMETER.right_ti could run, ODOMETER.right_ti runs instead. Decision numbers change if a node calls one
more function or there is another task. A move keeps its meaning. The full form is

    TASK[@MS[/PLACE][/N]]=OTHER

TASK        the task that fifo would run: its name without the number of node tasks, with `-2` for the second living
            task of that name; or the name of a question, such as `connection+of+/base+to+/arm+on+/enable`.
MS          virtual time in ms from which occasions count; from the start if missing.
PLACE       FUNCTION.CALL: the current function of the mission, and the call it makes; `-.CALL` in code that is not the
            mission's; `next` if the task is not running but would run next. Any place if missing.
N           the number of the occasion among those where OTHER could run. The first if missing.
OTHER       the task that runs instead, `hold` for none until the next timer, or the answer to the question.

A space is written `+`. Characters other than letters, digits and `_ . / -` are written as in a URL: `%23`. So no shell
needs quotes around a move.
"""

from __future__ import annotations

import re
import sys
from collections import Counter
from collections.abc import Callable, Iterable, Sequence
from types import FrameType
from typing import NamedTuple
from urllib.parse import quote, unquote

from cfepy.interpreter.own_code import is_own_code
from cfepy.rtos import HOLD, Decision, Policy, Settings, Task, missed_notes
from cfepy.units import NS_PER_MS

NEXT = "next"
"""The place of a task that is not running."""
_NUMBER = re.compile(r"\.\d+$")
_ORDINAL = re.compile(r"-\d+$")
_ASKS = "cfepy.schedules.exploring"
_KERNEL = ("cfepy.rtos", "cfepy.schedules")
_NO_FUNCTION = "-"


class Move(NamedTuple):
    """A deviation from fifo; see the module.

    Attributes:
        subject: the task that fifo would run, or a question.
        chosen: the task that runs, HOLD, or the answer.
        from_ms: virtual time in ms from which occasions count.
        place: place of the task then; empty for any.
        number: number of the occasion, from 1.
    """

    subject: str
    chosen: str
    from_ms: int = 0
    place: str = ""
    number: int = 1

    def text(self) -> str:
        """Return the text of the move in a schedule, which `Move.parse` reads."""
        place = [] if not self.place else [NEXT if self.place == NEXT else _escaped(self.place)]
        number = [str(self.number)] if self.number > 1 else []
        is_anytime = not (self.from_ms or place or number)
        when = "" if is_anytime else "/".join([f"@{self.from_ms}", *place, *number])
        return f"{_escaped(self.subject)}{when}={_escaped(self.chosen)}"

    @classmethod
    def parse(cls, text: str) -> Move:
        """Return the move for a text.

        Raises:
            ValueError: if the text is not a move.
        """
        match = _MOVE.fullmatch(text)
        if match is None:
            raise ValueError(f"invalid move {text!r}")
        place = match["place"] or ""
        return cls(
            _unescaped(match["subject"]),
            _unescaped(match["chosen"]),
            int(match["ms"] or 0),
            _unescaped(place),
            int(match["number"] or 1),
        )


_WORD = r"[\w./+%-]+"
_MOVE = re.compile(
    rf"(?P<subject>{_WORD})(?:@(?P<ms>\d+)(?:/(?P<place>next|[\w+%-]+\.[\w+%-]+))?(?:/(?P<number>0*[1-9]\d*))?)?"
    rf"=(?P<chosen>{_WORD})",
    re.ASCII,
)


def _escaped(text: str) -> str:
    return quote(text, safe="/ ").replace("~", "%7E").replace(" ", "+")


def _unescaped(text: str) -> str:
    return unquote(text.replace("+", " "))


def plain_name(name: str) -> str:
    """Return a task's name without the creation number of tasks of ROS nodes."""
    return _NUMBER.sub("", name)


def stable_name(task: Task, others: Iterable[Task]) -> str:
    """Return the name of a task in moves, which depends as little as possible on the rest of the mission.

    Args:
        task: a newly created task with its owner set.
        others: all living tasks.
    """
    name = task.name
    if _NUMBER.search(name) is not None and task.owner is not None:
        head, dot, rest = plain_name(name).partition(".")
        owner = str(getattr(task.owner, "name", head))  # a task's name has only a part of a long owner name
        name = f"{owner if dot and owner.startswith(head) else head}{dot}{rest}"
    name = _ORDINAL.sub(lambda found: f".{found[0][1:]}", name)
    taken = {each.alias for each in others}
    number, found = 1, name
    while found in taken or found == HOLD:
        number += 1
        found = f"{name}-{number}"
    return found


def place_of(frame: FrameType | None) -> str:
    """Return the place of the running task: the innermost function of the mission's own code, and the call it makes.

    Args:
        frame: a frame of the task, from the caller.
    """
    while frame is not None and frame.f_globals.get("__name__") != _ASKS:
        frame = frame.f_back
    called = innermost = ""
    while frame is not None:
        code = frame.f_code
        module = frame.f_globals.get("__name__", "")
        if is_own_code(code.co_filename):
            if not (code.co_name.startswith("<") and code.co_name not in ("<module>", "<lambda>")):
                return f"{code.co_name.strip('<>')}.{called or 'line'}"
        elif not module.startswith(_KERNEL):
            called = code.co_name.strip("<>")
            innermost = innermost or called
        frame = frame.f_back
    return f"{_NO_FUNCTION}.{innermost or 'line'}"


class MoveNumbers:
    """Names all possible deviations of a run as moves."""

    def __init__(self) -> None:
        self._counted: dict[tuple[str, str], tuple[int, Counter[str]]] = {}

    def moves(self, decision: Decision) -> tuple[Move, ...]:
        """Return a move for each answer other than fifo's; call it for decisions in order."""
        subject, others = decision.alias, decision.alias_answers[1:]
        place = place_at(decision, sys._getframe(1))
        now_ms = 0 if decision.question is not None else decision.now // NS_PER_MS
        from_ms, counts = self._counted.get((subject, place), (-1, Counter[str]()))
        if from_ms != now_ms:
            from_ms, counts = self._counted[subject, place] = now_ms, Counter()
        counts.update(others)
        return tuple(Move(subject, each, from_ms, place, counts[each]) for each in others)


class _Pending:
    """A move still to be made."""

    def __init__(self, move: Move) -> None:
        self.move = move
        self.from_ns = move.from_ms * NS_PER_MS
        self.left = move.number


class MovesToMake:
    """Moves, each kept until it is made.

    Args:
        moves: the moves.
    """

    def __init__(self, moves: Iterable[Move]) -> None:
        self.count = 0
        self._pending: dict[str, list[_Pending]] = {}
        for move in moves:
            self._pending.setdefault(move.subject, []).append(_Pending(move))
            self.count += 1
        for each in self._pending.values():
            each.sort(key=lambda pending: pending.from_ns)

    @property
    def left(self) -> list[Move]:
        """The moves that have not been made."""
        return [each.move for pending in self._pending.values() for each in pending]

    def concerns(self, subject: str, now_ns: int) -> bool:
        """Return whether there may be a move for a decision, so that `answer` must be called."""
        pending = self._pending.get(subject)
        return pending is not None and pending != [] and pending[0].from_ns <= now_ns

    def answer(self, subject: str, now_ns: int, others: Sequence[str], place: Callable[[], str]) -> int:
        """Return the answer to a decision: 0 for fifo, otherwise the number of another answer, from 1.

        Args:
            subject: the subject of the decision, as in moves.
            now_ns: virtual time in ns.
            others: the answers other than fifo's.
            place: returns the place of the task; called only if needed.
        """
        found: _Pending | None = None
        where = ""
        for each in self._pending[subject]:
            move = each.move
            if each.from_ns > now_ns:
                break
            if move.chosen not in others or (move.place and move.place != (where := where or place())):
                continue
            each.left -= 1
            if each.left == 0 and found is None:
                found = each
        if found is None:
            return 0
        self._pending[subject].remove(found)
        return 1 + others.index(found.move.chosen)


class MovePolicy(Policy):
    """Fifo except for some moves; impossible moves are skipped.

    Args:
        moves: the moves.
        settings: the arguments of `Policy`.
    """

    def __init__(self, moves: Iterable[Move], settings: Settings | tuple[()] = ()) -> None:
        super().__init__(*settings)
        self._moves = MovesToMake(moves)

    def choose(self, decision: Decision) -> int:
        subject = decision.alias
        if not self._moves.concerns(subject, decision.now):
            return 0
        frame = sys._getframe(1)
        others = decision.alias_answers[1:]
        return self._moves.answer(subject, decision.now, others, lambda: place_at(decision, frame))

    @property
    def missed(self) -> tuple[str, ...]:
        return tuple(move.text() for move in self._moves.left)

    @property
    def notes(self) -> tuple[str, ...]:
        return missed_notes("moves", self._moves.count, self.missed)


def place_at(decision: Decision, frame: FrameType | None) -> str:
    """Return the place of the task that fifo would run, as in a move: NEXT if it is not running, empty for a question.

    Args:
        decision: the decision.
        frame: the frame in which the policy decides.
    """
    if decision.question is not None:
        return ""
    return place_of(frame) if decision.running else NEXT
