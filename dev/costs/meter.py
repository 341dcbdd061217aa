"""A plugin of pytest that measures the cost of each test: `-p dev.costs.meter`, in all processes of pytest-xdist.

A cost is the CPU time of set-up, call and teardown, in this process and in the child processes that it waited for.
Unlike wall time, it excludes other programs, although a busy computer increases it. All users of a module or session
fixture share its cost, because the order of tests decides which of them is the first.
"""

from __future__ import annotations

import json
import os
import resource
import time
from collections.abc import Generator, Iterable, Iterator
from pathlib import Path

import pytest

FOLDER = "CFEPY_COSTS"
"""The environment variable that has the folder for what is measured, a file for each process."""


def cpu_time() -> float:
    """Return the CPU time of this process and of the children that it waited for, in seconds."""
    children = resource.getrusage(resource.RUSAGE_CHILDREN)
    return time.process_time() + children.ru_utime + children.ru_stime  # os.times counts in steps of 10 ms


class Meter:
    """Measures the tests of one process, and writes down each when it is over."""

    def __init__(self, folder: Path) -> None:
        self._file = (folder / f"{os.getpid()}.jsonl").open("a", encoding="utf-8", buffering=1)
        self._of_fixtures = 0.0  # spent in fixtures that several tests share, while the present test was run

    def _write(self, tests: Iterable[str], part: str, cost: float) -> None:
        print(json.dumps([list(tests), part, cost]), file=self._file)

    @pytest.hookimpl(wrapper=True, tryfirst=True)
    def pytest_runtest_protocol(self, item: pytest.Item) -> Generator[None, object, object]:
        """Measure all of a test."""
        self._of_fixtures, before = 0.0, cpu_time()
        result = yield
        self._write([item.nodeid], "", cpu_time() - before - self._of_fixtures)
        return result

    @pytest.hookimpl(wrapper=True, tryfirst=True)
    def pytest_fixture_setup(
        self, fixturedef: pytest.FixtureDef[object], request: pytest.FixtureRequest
    ) -> Generator[None, object, object]:
        """Measure a fixture that is made once for several tests."""
        if fixturedef.scope == "function":
            return (yield)
        before = cpu_time() - self._of_fixtures  # less those that this one needs
        result = yield
        cost = cpu_time() - self._of_fixtures - before
        self._of_fixtures += cost
        users = [item.nodeid for item in request.session.items if uses(item, fixturedef, request.node)]
        self._write(users, f"{fixturedef.baseid}::{fixturedef.argname}", cost / max(len(users), 1))
        return result


def uses(item: pytest.Item, fixture: pytest.FixtureDef[object], scope: pytest.Item | pytest.Collector) -> bool:
    """Return whether a test gets the fixture that was made for a module, class, package or session."""
    return fixture.argname in getattr(item, "fixturenames", ()) and scope in item.listchain()


def pytest_configure(config: pytest.Config) -> None:
    """Measure in this process, unless the tests are run in others."""
    if hasattr(config, "workerinput") or not config.getoption("numprocesses", None):
        config.pluginmanager.register(Meter(Path(os.environ[FOLDER])))


def measured(folder: Path) -> dict[str, float]:
    """Return the CPU time in seconds of each test, by id.

    Of several runs the minimum counts, since only the first fills caches.
    """
    parts: dict[str, dict[str, float]] = {}
    for tests, part, cost in rows(folder):
        for test in tests:
            of_test = parts.setdefault(test, {})
            of_test[part] = min(cost, of_test.get(part, cost))
    return {test: sum(costs.values()) for test, costs in parts.items() if "" in costs}


def rows(folder: Path) -> Iterator[tuple[list[str], str, float]]:
    """Yield the measurements: tests, the part of their cost (a fixture, or "" for the test itself), and the cost."""
    for path in sorted(folder.glob("*.jsonl")):
        for line in path.read_text(encoding="utf-8").splitlines():
            tests, part, cost = json.loads(line)
            yield tests, part, cost
