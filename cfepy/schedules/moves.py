"""Moves: what a schedule does otherwise than fifo, each told by what it is about and not by the number of a decision.

    ODOMETER.left_tic@650/add.publish=ODOMETER.right_ti

says: from 650 ms of virtual time on, when ODOMETER.left_tic calls `publish` in its function `add` for the first time
while ODOMETER.right_ti could run, ODOMETER.right_ti runs instead. All numbers of decisions change when a node calls one
function more, or another task is there; this keeps its meaning. In full it is

    TASK[@MS[/PLACE][/N]]=OTHER

TASK        the task that fifo would run: its name without the number that tasks of nodes have, `-2` behind it for the
            second such task that lives; or the name of a question, such as `connection+of+/base+to+/arm+on+/enable`.
MS          virtual time from which on occasions count, in ms; from the start where it is left out.
PLACE       FUNCTION.CALL: the function of the mission in which it is, and what that calls; `-.CALL` in code that is not
            the mission's; `next` where it is not running but the next to run. Left out, it does not matter.
N           which of the occasions: those in which OTHER could run. Left out, it is the first.
OTHER       the task that runs instead, `hold` for none until the next timer, or the answer to the question.

A space is written `+`, and what is not a letter, a digit or one of `_ . / -` is written as in an URL: `%23`. So no
shell needs quotes around it.
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
from cfepy.rtos import HOLD, Decision, Policy, Settings, Task
from cfepy.units import NS_PER_MS

NEXT = "next"
"""The place of a task that is not running."""
_NUMBER = re.compile(r"\.\d+$")
_ORDINAL = re.compile(r"-\d+$")
_ASKS = "cfepy.schedules.exploring"
_KERNEL = ("cfepy.rtos", "cfepy.schedules")
_NO_FUNCTION = "-"


class Move(NamedTuple):
    """Not what fifo would do; see the module.

    Attributes:
        subject: the task that fifo would run, or a question.
        chosen: the task that runs, HOLD, or the answer.
        from_ms: virtual time from which on occasions count.
        place: where the task is then; empty for anywhere.
        number: which occasion, from 1.
    """

    subject: str
    chosen: str
    from_ms: int = 0
    place: str = ""
    number: int = 1

    def text(self) -> str:
        """As it stands in a schedule; `Move.parse` gives it again."""
        place = [] if not self.place else [NEXT if self.place == NEXT else _escaped(self.place)]
        number = [str(self.number)] if self.number > 1 else []
        is_anytime = not (self.from_ms or place or number)
        when = "" if is_anytime else "/".join([f"@{self.from_ms}", *place, *number])
        return f"{_escaped(self.subject)}{when}={_escaped(self.chosen)}"

    @classmethod
    def parse(cls, text: str) -> Move:
        """The move that a text means.

        Raises:
            ValueError: it means none.
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
    """A task's name without the number that tasks of ROS nodes get in the order of their making."""
    return _NUMBER.sub("", name)


def stable_name(task: Task, others: Iterable[Task]) -> str:
    """What a task is called in moves, which hangs as little as can be on what else there is in the mission.

    Args:
        task: which has just been made; its owner is known.
        others: all that live.
    """
    name = task.name
    if _NUMBER.search(name) is not None and task.owner is not None:
        head, dot, rest = plain_name(name).partition(".")
        owner = str(getattr(task.owner, "name", head))  # of which a long name has only a part
        name = f"{owner if dot and owner.startswith(head) else head}{dot}{rest}"
    name = _ORDINAL.sub(lambda found: f".{found[0][1:]}", name)
    taken = {each.alias for each in others}
    number, found = 1, name
    while found in taken or found == HOLD:
        number += 1
        found = f"{name}-{number}"
    return found


def place_of(frame: FrameType | None) -> str:
    """Where the running task is: the innermost function of the mission's own, and what that calls.

    Args:
        frame: of whoever asks, in the task.
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
    """Names all that could be done otherwise in a run, as moves."""

    def __init__(self) -> None:
        self._counted: dict[tuple[str, str], tuple[int, Counter[str]]] = {}

    def moves(self, decision: Decision) -> tuple[Move, ...]:
        """A move for each answer but fifo's; decisions are told in their order."""
        subject, others = decision.alias, decision.alias_answers[1:]
        place = _place(decision, sys._getframe(1))
        now_ms = 0 if decision.question is not None else decision.now // NS_PER_MS
        from_ms, counts = self._counted.get((subject, place), (-1, Counter[str]()))
        if from_ms != now_ms:
            from_ms, counts = self._counted[subject, place] = now_ms, Counter()
        counts.update(others)
        return tuple(Move(subject, each, from_ms, place, counts[each]) for each in others)


class _Pending:
    """A move that has not been made."""

    def __init__(self, move: Move) -> None:
        self.move = move
        self.from_ns = move.from_ms * NS_PER_MS
        self.left = move.number


class MovesToMake:
    """Moves, each until it is made.

    Args:
        moves: which ones.
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
        """Those that have not been made."""
        return [each.move for pending in self._pending.values() for each in pending]

    def concerns(self, subject: str, now_ns: int) -> bool:
        """Whether there may be a move for a decision, which `answer` must then be asked."""
        pending = self._pending.get(subject)
        return pending is not None and pending != [] and pending[0].from_ns <= now_ns

    def answer(self, subject: str, now_ns: int, others: Sequence[str], place: Callable[[], str]) -> int:
        """What a decision comes to: 0 for what fifo does, else the number of another answer, from 1.

        Args:
            subject: what it is about, as moves call it.
            now_ns: virtual time.
            others: the answers that are not fifo's.
            place: where the task is; asked when it matters.
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
    """Fifo but for some moves; one that is not possible is left out.

    Args:
        moves: which ones.
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
        return self._moves.answer(subject, decision.now, others, lambda: _place(decision, frame))

    @property
    def missed(self) -> tuple[str, ...]:
        return tuple(move.text() for move in self._moves.left)

    @property
    def notes(self) -> tuple[str, ...]:
        missed, count = self.missed, self._moves.count
        if not missed:
            return ()
        made = f"{count - len(missed)} of {count} moves of the schedule were possible"
        return (f"{made}; not possible: {', '.join(missed)}",)


def _place(decision: Decision, frame: FrameType | None) -> str:
    if decision.question is not None:
        return ""
    return place_of(frame) if decision.running else NEXT
