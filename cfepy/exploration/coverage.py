"""Coverage: what runs did that other runs of the same mission have not done, and how much of it a campaign has seen.

What a run covers is a set of numbers, each a digest of something that it did:

    uses        a task used a thing in a line: took a lock, sent a message, read a variable
    outcomes    how it ended: its failures, its results, the last message of each topic, the tasks that are left
    pairs       two tasks used one thing directly one after the other: who did what in which line, and who then; a kind
                each for locks, messages, variables, parameters and counters
    answers     a question of the schedule had another answer than under fifo
    lines       a line of a function of the mission was executed

The default schedule covers something as well, so only what it does not cover is kept of the others.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from hashlib import blake2b
from pathlib import PurePath
from typing import Any, NamedTuple

from cfepy.input_files import read_limited
from cfepy.input_limits import PYTHON_BYTES
from cfepy.nodes import lines_to_reach

OUTCOMES, LINES, ANSWERS, USES = "outcomes", "lines", "answers", "uses"
MOST = 2000  # numbers of one kind that are kept of a run: the least ones, so that they are the same ones in each run
_BYTES = 4


class Covered(NamedTuple):
    """Something that a run did.

    Attributes:
        kind: OUTCOMES, LINES, ANSWERS, or a kind of pairs.
        number: which one, a digest of 32 bits.
        decision: how many decisions there were before it; those of the run for what is known at its end alone.
    """

    kind: str
    number: int
    decision: int


class ThingUse(NamedTuple):
    """What a task did to a thing.

    Attributes:
        kind: of the pairs that it belongs to.
        thing: what the thing is called, in all runs.
        task: by its name in aims (`cfepy.rtos.child_name`).
        verb: what it did.
        file: name of the source file, without its folder; empty where it is not the mission's own code.
        line: of that.
        is_read: whether it changed nothing.
    """

    kind: str
    thing: str
    task: str
    verb: str
    file: str
    line: int
    is_read: bool

    @property
    def number(self) -> int:
        """As of `Covered`."""
        return number_of(*self[1:-1])

    @property
    def known(self) -> tuple[str, int]:
        """As it is among what is covered."""
        return USES, self.number

    def before(self, other: ThingUse) -> tuple[str, int]:
        """The pair of this use and the next one of the thing, as it is among what is covered."""
        return other.kind, number_of(other.thing, self[2:-1], other[2:-1])

    @classmethod
    def of(cls, plain: Sequence[Any]) -> ThingUse:
        """A use from plain data."""
        kind, thing, task, verb, file, line, is_read = plain
        return cls(str(kind), str(thing), str(task), str(verb), str(file), int(line), bool(is_read))


Known = frozenset[tuple[str, int]]
"""What is covered, as kinds and numbers."""


def number_of(*parts: object) -> int:
    """The number of something that a run did."""
    return int.from_bytes(blake2b(repr(parts).encode("utf-8", "surrogatepass"), digest_size=_BYTES).digest())


def number_of_line(file: str, line: int | str) -> int:
    """The number of a line; it is the same on another computer, where the mission's folder lies elsewhere."""
    return number_of(*PurePath(file).parts[-2:], int(line))


def kept_of(found: Iterable[Covered], usual: Known = frozenset()) -> tuple[Covered, ...]:
    """What is kept of a run: each once, by kind and number.

    Args:
        found: all that it did.
        usual: what the default schedule covers.
    """
    by_kind: dict[str, dict[int, Covered]] = {}
    for each in found:
        if each[:2] not in usual:
            by_kind.setdefault(each.kind, {}).setdefault(each.number, each)
    return tuple(by_kind[kind][number] for kind in sorted(by_kind) for number in sorted(by_kind[kind])[:MOST])


def to_plain(covered: Sequence[Covered]) -> dict[str, list[int]]:
    """By kind a number and its decision by turns, for JSON."""
    found: dict[str, list[int]] = {}
    for each in covered:
        found.setdefault(each.kind, []).extend((each.number, each.decision))
    return found


def from_plain(plain: Mapping[str, Sequence[int]]) -> tuple[Covered, ...]:
    """The other way round.

    Raises:
        ValueError: the numbers are not pairs.
    """
    return tuple(
        Covered(str(kind), int(number), int(decision))
        for kind, numbers in plain.items()
        for number, decision in zip(numbers[::2], numbers[1::2], strict=True)
    )


@dataclass(slots=True)
class Coverage:
    """What a campaign has covered.

    Attributes:
        code: the lines of functions of the mission, by file.
        usual: what the default schedule covers.
        schedules: how many others there were.
        last: the number of the last one that covered something new, from 0; by kind.
        runs: of each thing that was covered, how many of the others did it.
    """

    code: Mapping[str, Sequence[int]]
    usual: Known
    schedules: int = 0
    last: dict[str, int] = field(default_factory=dict)
    runs: Counter[tuple[str, int]] = field(default_factory=Counter)

    @classmethod
    def beside(cls, usual: Iterable[Covered], files: Iterable[tuple[str, bool]]) -> Coverage:
        """That of a campaign that begins.

        Args:
            usual: all that the default schedule covers.
            files: those of mission code, and whether each is a node's script.
        """
        code = {file: lines for file, is_main in files if (lines := _lines_of(file, is_main))}
        return cls(code, frozenset(each[:2] for each in usual))

    def take(self, number: int, covered: Sequence[Covered]) -> list[Covered]:
        """Take what a schedule covered; of that what is new.

        Args:
            number: of the schedule, from 0.
            covered: as its verdict has it.
        """
        self.schedules += 1
        new = [each for each in covered if each[:2] not in self.runs and each[:2] not in self.usual]
        self.runs.update(each[:2] for each in covered)
        for each in new:
            self.last[each.kind] = number
        return new

    def has(self, known: tuple[str, int]) -> bool:
        """Whether some run did it, that of fifo as well."""
        return known in self.usual or known in self.runs

    def rarity(self, each: Covered) -> float:
        """1 for what one run alone did, less for what many did."""
        return 1 / max(self.runs[each[:2]], 1)

    def counts(self) -> dict[str, int]:
        """How much there is of each kind; of lines those of the mission's functions."""
        found = Counter(kind for kind, _ in self.usual | self.runs.keys())
        found[LINES] = sum(map(len, self.code.values())) - sum(map(len, self.never.values()))
        return dict(sorted(found.items()))

    @property
    def never(self) -> dict[str, list[int]]:
        """The lines that no schedule has executed, by file."""
        left = {
            file: [
                line
                for line in lines
                if (key := (LINES, number_of_line(file, line))) not in self.usual and key not in self.runs
            ]
            for file, lines in self.code.items()
        }
        return {file: lines for file, lines in left.items() if lines}

    @property
    def pairs(self) -> dict[str, int]:
        """How many pairs there are of each kind."""
        others = (OUTCOMES, LINES, ANSWERS, USES)
        return {kind: count for kind, count in self.counts().items() if kind not in others}

    def lines(self) -> list[str]:
        """A line or two for a person."""
        counts, pairs = self.counts(), self.pairs
        kinds = ", ".join(f"{count} of {kind}" for kind, count in sorted(pairs.items(), key=lambda each: -each[1]))
        found = [f"{sum(pairs.values())} ordered pairs ({kinds})"] if pairs else []
        found.append(_counted(counts.get(OUTCOMES, 0), "outcome"))
        if self.code:
            found.append(f"{counts[LINES]} of {sum(map(len, self.code.values()))} lines")
        latest = max(self.last.values(), default=None)
        until = "nothing new beside fifo" if latest is None else f"the last new one in schedule {latest + 1}"
        told = [f"covered: {', '.join(found)}; {until} of {self.schedules}"]
        if self.never:
            where = (f"{PurePath(file).name}:{_ranges(lines)}" for file, lines in self.never.items())
            told.append(f"never executed: {', '.join(where)}")
        return told

    def to_dict(self) -> dict[str, Any]:
        """Plain data."""
        return {
            "pairs": self.pairs,
            "outcomes": self.counts().get(OUTCOMES, 0),
            "answers": self.counts().get(ANSWERS, 0),
            "lines": self.counts()[LINES],
            "lines_of_code": sum(map(len, self.code.values())),
            "never": self.never,
            "last_new": self.last,
            "seen_once": sum(count == 1 for count in self.runs.values()),
        }


def _lines_of(file: str, is_main: bool) -> list[int]:
    """The lines of functions of a file; none where it cannot be read any more."""
    try:
        return lines_to_reach(read_limited(file, PYTHON_BYTES), file, is_main)
    except (OSError, SyntaxError, ValueError):
        return []


def _counted(count: int, name: str) -> str:
    return f"{count} {name if count == 1 else f'{name}s'}"


def _ranges(lines: Sequence[int]) -> str:
    """Numbers of lines in short: 3, 7-9."""
    found: list[list[int]] = []
    for line in lines:
        if found and found[-1][1] == line - 1:
            found[-1][1] = line
        else:
            found.append([line, line])
    return ",".join(str(first) if first == last else f"{first}-{last}" for first, last in found)
