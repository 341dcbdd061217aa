"""The table of costs, `tests/costs.tsv`: the tests that the quick loop leaves out, and the slow ones among them.

A line is a cost in milliseconds and its subject: a case of a test, a test, or a file. A test stands for most of its
cases, and the most expensive case counts. A file stands there if none of its tests is quick. Tests without a line are
quick, or were not measured yet.
"""

from __future__ import annotations

import functools
import math
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).parents[2]
PATH = ROOT / "tests/costs.tsv"
DEAR_S = 0.015  # of CPU time: the quick loop has no such test
SLOW_S = 0.05  # of CPU time: such a test is a slow one


def file_of(test: str) -> str:
    """Return the file of a test, relative to the root of the checkout."""
    return test.partition("::")[0]


def function_of(test: str) -> str:
    """Return a test without its case."""
    return test.partition("[")[0]


@dataclass(frozen=True)
class Table:
    """The lines of the table."""

    costs: Mapping[str, float]
    """CPU time in seconds, by the case, test or file that needs it."""

    @classmethod
    def read(cls, path: Path = PATH) -> Table:
        """Return the table of a file."""
        rows = (line.split("\t") for line in path.read_text(encoding="utf-8").splitlines())
        return cls({name: int(cost) / 1000 for cost, name in rows})

    def write(self, path: Path = PATH) -> None:
        """Write the table, sorted by subject so that a change of one test changes one line."""
        rows = (f"{math.ceil(cost * 1000)}\t{name}\n" for name, cost in sorted(self.costs.items()))
        path.write_text("".join(rows), encoding="utf-8")

    def __contains__(self, test: object) -> bool:
        """Return whether a test is a dear one, by its id (or a whole file, by its path)."""
        return isinstance(test, str) and not self.costs.keys().isdisjoint((test, function_of(test), file_of(test)))

    def is_slow(self, test: str) -> bool:
        """Return whether a test, given by its id, needs so much CPU time that it counts as slow."""
        return any(self.costs.get(name, 0.0) >= SLOW_S for name in (test, function_of(test), file_of(test)))

    @functools.cached_property
    def slow_files(self) -> frozenset[str]:
        """The files with tests that are slow because of their costs."""
        return frozenset(file_of(name) for name, cost in self.costs.items() if cost >= SLOW_S)

    def merged(self, measured: Mapping[str, float]) -> Table:
        """Return this table with new lines for the measured files.

        Args:
            measured: CPU time in seconds of each test that was run, by its id.
        """
        files = set(map(file_of, measured))
        kept = {name: cost for name, cost in self.costs.items() if file_of(name) not in files}
        return Table(kept | dict(lines(measured)))


def lines(measured: Mapping[str, float]) -> Iterator[tuple[str, float]]:
    """Yield as few lines as possible for tests, each with the highest cost of its tests.

    A line never covers both slow tests and others.
    """
    for file, tests in grouped(measured, file_of):
        if all(cost >= DEAR_S for cost in tests.values()) and _are_alike(tests.values()):
            yield file, max(tests.values())
            continue
        for function, cases in grouped(tests, function_of):
            yield from _lines_of(function, cases)


def _lines_of(function: str, cases: Mapping[str, float]) -> Iterator[tuple[str, float]]:
    slow = {case: cost for case, cost in cases.items() if cost >= SLOW_S}
    if len(slow) == len(cases):
        yield function, max(slow.values())
        return
    yield from slow.items()
    dear = {case: cost for case, cost in cases.items() if DEAR_S <= cost < SLOW_S}
    if dear and 2 * len(dear) >= len(cases) - len(slow):
        yield function, max(dear.values())
    else:
        yield from dear.items()


def _are_alike(costs: Collection[float]) -> bool:
    """Return whether all tests are slow, or none is."""
    return min(costs) >= SLOW_S or max(costs) < SLOW_S


def grouped(tests: Mapping[str, float], name_of: Callable[[str], str]) -> Iterable[tuple[str, dict[str, float]]]:
    """Group tests by their containing test or file."""
    groups: dict[str, dict[str, float]] = {}
    for test, cost in tests.items():
        groups.setdefault(name_of(test), {})[test] = cost
    return groups.items()
