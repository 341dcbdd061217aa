"""`Schedule`: the policy of a run, as a text that you can write, read and send to a colleague.

    fifo                    first come, first served
    random:7                any of the candidates, by seed 7
    pct:7:3                 PCT, seed 7, for bugs of depth 3 (`cfepy.rtos.policies.PCT`)
    pct:7:3:5000            the same for runs of about 5000 decisions
    abreast:7               side by side, by seed 7 (`cfepy.schedules.side_by_side.Abreast`)
    at:42=1,97=2            fifo, but at decision 42 candidate 1, and at decision 97 candidate 2
    moves:A@650/add.publish=B
                            fifo, but where A, from 650 ms on, calls publish in its function add, B runs
                            (`cfepy.schedules.moves`)

Every kind but fifo takes options at its end: `any` (tasks of less urgent priority may run before more urgent ones),
`fair=50` (a task that could run is passed over in at most 50 decisions), `hold=500us` (the running task may be held up
until the next timer is due, if that is within 500 us), `late=500us` (the same for a task that a message, a timer or a
give has made ready, before it runs), `connect=50ms` (a connection between two ROS nodes may take up
to 50 ms), `points=attributes` or `points=lines,arm` (tasks may be interrupted between the calls of their code as well:
`cfepy.schedules.preemption_points`), and `from=600ms` (fifo up to 600 ms after the start of the run; what comes before
still counts as decisions).
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

from cfepy.reading.suggestions import expected
from cfepy.status import UsageError
from cfepy.units import TIME_UNITS, time_word

if TYPE_CHECKING:
    from cfepy.rtos import Policy, Settings
    from cfepy.schedules.moves import Move

ORDER = "order"
SEEDED = ("random", "pct", "abreast")
DEPTH = 3  # default depth of PCT
STEPS = 1000
_TIME = re.compile(r"(\d+)(ns|us|ms|s)")
_KINDS = {
    "fifo": "fifo alone, without options",
    "random": "random[:SEED]",
    "pct": "pct[:SEED[:DEPTH[:STEPS]]]",
    "abreast": "abreast[:SEED]",
    "moves": "moves:TASK@MS/FUNCTION.CALL=TASK,...",
    "at": "at:DECISION=CHOICE,...",
}
_OPTIONS = (
    ", then options such as :any, :fair=50, :hold=500us, :late=500us, :connect=50ms, :points=attributes or :from=600ms"
)


@dataclass(frozen=True, slots=True)
class Schedule:
    """The rule for the choice of the next task.

    Args:
        kind: "fifo", "random", "pct", "abreast", "at", "moves" or "order".
        seed: seed of random, pct and abreast.
        depth: depth of the bugs that pct looks for, at least 1.
        steps: number of decisions that pct expects in the run, at least 1.
        deviations: for at: pairs of decision and choice, in order.
        moves: for moves: the moves.
        runs: for order: pairs of a task's path and a number, made by a search of orders, without a text form; see
            `InOrder`. Such a run can also be expressed as an `at`.
        any_priority: see `Policy`.
        hold_ns: see `Policy`.
        connect_ns: see `Policy`.
        points: see `Policy`.
        from_ns: virtual ns until which it is fifo.
        fair: number of decisions in which a task may be passed over (`Fair`); 0 for no limit.
        late_ns: see `Policy`.
    """

    kind: str = "fifo"
    seed: int = 0
    depth: int = DEPTH
    steps: int = STEPS
    deviations: tuple[tuple[int, int], ...] = ()
    runs: tuple[tuple[str, int], ...] = ()
    any_priority: bool = False
    hold_ns: int = 0
    connect_ns: int = 0
    points: str = ""
    from_ns: int = 0
    moves: tuple[Move, ...] = ()
    fair: int = 0
    late_ns: int = 0

    @classmethod
    def parse(cls, text: str, seed: int = 0) -> Schedule:
        """Return the schedule for a text.

        Args:
            text: see the module.
            seed: for `random`, `pct` and `abreast` without one.

        Raises:
            UsageError: if the text is not a schedule.
        """
        if _LONG_NUMBER.search(text):
            raise UsageError("numbers must have at most 30 digits; write a smaller one", field="--schedule")
        kind, *fields = text.split(":")
        found = cls(kind, seed)
        while fields and (option := _option(fields[-1])) is not None:
            found = replace(found, **option)
            fields.pop()
        if kind == "fifo" and found == cls(kind, seed) and not fields:
            return cls()
        if kind in SEEDED and len(fields) <= (3 if kind == "pct" else 1):
            return replace(found, **_numbers(text, fields))
        if kind == "at" and len(fields) <= 1:
            return replace(found, seed=0, deviations=_deviations(text, fields[0] if fields else ""))
        if kind == "moves" and len(fields) <= 1:
            return replace(found, seed=0, moves=_moves(text, fields[0] if fields else ""))
        raise _wrong(text)

    def text(self) -> str:
        """Return the shortest text from which `parse` makes this schedule."""
        words = [self.kind]
        if self.kind in SEEDED:
            words.append(str(self.seed))
        if self.kind == "pct":
            words.append(str(self.depth))
            words += [str(self.steps)] if self.steps != STEPS else []
        if self.deviations:
            words.append(",".join(f"{decision}={choice}" for decision, choice in self.deviations))
        if self.moves:
            words.append(",".join(move.text() for move in self.moves))
        if self.runs:
            words.append(",".join(f"{path}={number}" for path, number in self.runs))
        words += ["any"] if self.any_priority else []
        words += [f"fair={self.fair}"] if self.fair else []
        words += [f"hold={time_word(self.hold_ns)}"] if self.hold_ns else []
        words += [f"late={time_word(self.late_ns)}"] if self.late_ns else []
        words += [f"connect={time_word(self.connect_ns)}"] if self.connect_ns else []
        words += [f"points={self.points}"] if self.points else []
        words += [f"from={time_word(self.from_ns)}"] if self.from_ns else []
        return ":".join(words)

    def __str__(self) -> str:
        return self.text()

    def policy(self) -> Policy | None:
        """Return a policy for one run; None for fifo."""
        if self.kind == "fifo":
            return None
        from cfepy.rtos import Fair, From

        policy = Fair(self._policy(), self.fair) if self.fair else self._policy()
        return From(policy, self.from_ns) if self.from_ns else policy

    def _policy(self) -> Policy:
        """Return the policy of the kind; fifo, the default, loads none."""
        from cfepy.rtos import PCT, Deviations, InOrder, SeededRandom

        if self.kind == "random":
            return SeededRandom(self.seed, *self.settings)
        if self.kind == "abreast":
            from cfepy.schedules.side_by_side import Abreast

            return Abreast(self.seed, *self.settings)
        if self.kind == "pct":
            return PCT(self.seed, self.depth, self.steps, *self.settings)
        if self.kind == "moves":
            from cfepy.schedules.moves import MovePolicy

            return MovePolicy(self.moves, self.settings)
        if self.kind == ORDER:
            return InOrder(self.runs, *self.settings)
        return Deviations(dict(self.deviations), *self.settings)

    @property
    def is_told(self) -> bool:
        """Whether it lists its deviations from fifo, as a shrunk schedule does."""
        return bool(self.deviations or self.moves)

    @property
    def settings(self) -> Settings:
        """The settings of its policy."""
        return self.any_priority, self.hold_ns, self.connect_ns, self.points, self.late_ns

    def at(self, deviations: Mapping[int, int]) -> Schedule:
        """Return a schedule that deviates from fifo in some decisions, with this one's options.

        Args:
            deviations: choices by decision number, as in `NotingPolicy.deviations`.
        """
        return replace(self._bare("at"), deviations=tuple(sorted(deviations.items())))

    def by_moves(self, moves: Iterable[Move]) -> Schedule:
        """Return a schedule that makes some moves and is fifo otherwise, with this one's options."""
        return replace(self._bare("moves"), moves=tuple(moves))

    def in_order(self, runs: Iterable[tuple[str, int]]) -> Schedule:
        """Return a schedule that runs tasks in an order, with this one's options."""
        return replace(self._bare(ORDER), runs=tuple(runs))

    def _bare(self, kind: str) -> Schedule:
        return replace(self, kind=kind, seed=0, depth=DEPTH, steps=STEPS, deviations=(), moves=(), runs=())

    def with_points(self, points: str) -> Schedule:
        """Return the same schedule with other points (see `Points.text`); fifo keeps its order of tasks."""
        return replace(self.at({}) if points and self.kind == "fifo" else self, points=points)

    def with_seed(self, seed: int) -> Schedule:
        """Return the same schedule with another seed."""
        return replace(self, seed=seed)


_LONG_NUMBER = re.compile(r"\d{31}")
_HIGHEST = {"depth": 10_000, "steps": 10**12}


def _option(field: str) -> dict[str, Any] | None:
    """Return the values that an option at the end of the text sets, or None if it is not an option."""
    if field == "any":
        return {"any_priority": True}
    name, _, time = field.partition("=")
    if name == "fair":
        if re.fullmatch(r"\d+", time, re.ASCII) is None or not int(time):
            raise UsageError(
                f"invalid option {field!r}; expected a number of decisions of at least 1, such as fair=50",
                field="--schedule",
            )
        return {"fair": int(time)}
    if name == "points":
        from cfepy.schedules.preemption_points import Points  # only schedules with such points load it

        return {"points": Points.parse(time, "--schedule").text()}
    if name not in ("hold", "late", "connect", "from"):
        return None
    match = _TIME.fullmatch(time)
    if match is None or not int(match[1]):
        raise UsageError(
            f"invalid option {field!r}; expected a time in ns, us, ms or s, such as {name}=500us", field="--schedule"
        )
    return {f"{name}_ns": int(match[1]) * TIME_UNITS[match[2]]}


def _numbers(text: str, fields: list[str]) -> dict[str, Any]:
    names = ("seed", "depth", "steps")
    found: dict[str, int] = {}
    for name, field in zip(names, fields, strict=False):
        if re.fullmatch(r"\d+", field, re.ASCII) is None or (name != "seed" and not int(field)):
            least = "0" if name == "seed" else "1"
            wrong = f"{name.upper()} must be a whole number of at least {least}, not {field!r}"
            raise UsageError(f"invalid schedule {text!r}: {wrong}", field="--schedule")
        if name in _HIGHEST and int(field) > _HIGHEST[name]:
            wrong = f"{name.upper()} must be at most {_HIGHEST[name]:,}, not {field}"
            raise UsageError(f"invalid schedule {text!r}: {wrong}", field="--schedule")
        found[name] = int(field)
    return found


def _deviations(text: str, field: str) -> tuple[tuple[int, int], ...]:
    found: dict[int, int] = {}
    for pair in field.split(",") if field else ():
        match = re.fullmatch(r"(\d+)=(\d+)", pair, re.ASCII)
        if match is None or int(match[1]) in found:
            wrong = f"{pair!r} is not DECISION=CHOICE" if match is None else f"decision {match[1]} is given twice"
            raise UsageError(f"invalid schedule {text!r}: {wrong}; write for instance at:42=1,97=2", field="--schedule")
        found[int(match[1])] = int(match[2])
    return tuple((decision, choice) for decision, choice in sorted(found.items()) if choice)


def _moves(text: str, field: str) -> tuple[Move, ...]:
    from cfepy.schedules.moves import Move

    try:
        return tuple(Move.parse(each) for each in field.split(",")) if field else ()
    except ValueError as error:
        wrong = f"{error}; write for instance moves:ARM@650/add.publish=ARM.commands"
        raise UsageError(f"invalid schedule {text!r}: {wrong}", field="--schedule") from None


def _wrong(text: str) -> UsageError:
    kind = text.partition(":")[0]
    if kind in _KINDS:
        options = "" if kind == "fifo" else _OPTIONS
        return UsageError(f"invalid schedule {text!r}; expected {_KINDS[kind]}{options}", field="--schedule")
    return UsageError(f"unknown schedule {kind!r}; {expected(kind, _KINDS)}", field="--schedule")
