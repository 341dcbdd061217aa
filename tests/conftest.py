"""Common configuration of all tests: both cores, the quick loop, and no clock that could fail a test on a busy
machine."""

from __future__ import annotations

import importlib
import os
import signal
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest
from hypothesis import settings

from cfepy.interpreter.garbage import collect_every
from cfepy.interpreter.host_system import ending_signals

# Helpers of tests report failures in the same detail, and python -O does not remove their assertions.
pytest.register_assert_rewrite(
    "dev", *(f"tests.{each.stem}" for each in Path(__file__).parent.iterdir() if each.stem.isidentifier())
)

from tests import costs  # noqa: E402
from tests.add_ons import MISSING, lacks_add_on  # noqa: E402

importlib.import_module("numpy")  # pytester forgets modules that its runs load first; numpy cannot be loaded twice
pytest_plugins = ["pytester", "cfepy.testing.plugin"]  # an installed plugin has this name, too

settings.register_profile("cfepy", settings.default, deadline=None)
settings.load_profile("cfepy")

TESTS = Path(__file__).parent
METER = "dev.costs.meter"
RUNS_IN_MEMORY = 8  # missions that are over, before garbage is looked for
collect_every(RUNS_IN_MEMORY)
ENDING = tuple(ending_signals())
signal.signal(signal.SIGINT, signal.default_int_handler)  # a shell ignores it in background commands

if sys.dont_write_bytecode:  # each process that a test starts would compile all of cfepy, and each run all tests
    CACHE = Path(__file__).parents[1] / ".pytest_cache" / "bytecode"
    sys.dont_write_bytecode, sys.pycache_prefix = False, str(CACHE)
    os.environ.pop("PYTHONDONTWRITEBYTECODE", None)
    os.environ["PYTHONPYCACHEPREFIX"] = str(CACHE)


@pytest.hookimpl(tryfirst=True)
def pytest_cmdline_main(config: pytest.Config) -> None:
    """Use all cores for runs of the whole suite, if pytest-xdist is installed and no option requires one process."""
    option = config.option
    whole = all(Path(config.invocation_params.dir, arg).resolve() == Path(__file__).parent for arg in config.args)
    looked_at = option.usepdb or option.trace or option.capture == "no" or option.collectonly
    if not config.pluginmanager.has_plugin("xdist") or hasattr(config, "workerinput") or not whole or looked_at:
        return
    cores = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
    if option.numprocesses is None and option.dist == "no" and not option.tx and cores > 1:
        # the slow tests of a file share what they build, so each file is in one process
        option.numprocesses, option.dist = cores, "loadfile" if option.markexpr == "slow" else "worksteal"


def pytest_terminal_summary(terminalreporter: pytest.TerminalReporter, config: pytest.Config) -> None:
    """Print the seed of the order at the end, since `-q` leaves out the header that has it."""
    if config.pluginmanager.has_plugin("randomly"):
        terminalreporter.write_line(f"order of the tests: --randomly-seed={config.getoption('randomly_seed')}")


@pytest.fixture(autouse=True)
def _nobody_is_followed() -> Iterator[None]:
    """Assert that no debugger of a mission is still active, which would slow down the whole process."""
    yield
    owner = getattr(sys.gettrace(), "__self__", None)
    assert type(owner).__name__ != "AppDebugger"


@pytest.fixture(autouse=True)
def _signals_are_answered_as_before() -> Iterator[None]:
    """Fail a test that leaves other signal handlers, after restoring them: later tests need Ctrl-C."""
    before = {each: signal.getsignal(each) for each in ENDING}
    yield
    after = {each: signal.getsignal(each) for each in ENDING}
    if after != before:
        for each, answer in before.items():
            signal.signal(each, answer)  # of the tests that come after it none fails
    assert after == before


def pytest_ignore_collect(collection_path: Path, config: pytest.Config) -> bool | None:
    """Skip the import of files that need a missing add-on, and of files without a test in this run."""
    named = any("::" in word for word in config.args)  # then the marks do not apply to whole files
    is_vain = not named and costs.is_read_in_vain(collection_path, config.getoption("markexpr"))
    return True if is_vain or lacks_add_on(collection_path.relative_to(TESTS).as_posix()) else None


def test_of(item: pytest.Item) -> str:
    """Return the file of a test below `tests`, and its function."""
    return f"{item.path.relative_to(TESTS).as_posix()}::{getattr(item, 'originalname', item.name)}"


@pytest.hookimpl(tryfirst=True)
def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    """Mark the tests of the quick loop, and check that the table of costs only lists existing tests."""
    if MISSING:
        items[:] = [item for item in items if not lacks_add_on(test_of(item))]
    for item in costs.quick_ones(items):
        item.add_marker(costs.QUICK)
    if not any("::" in word for word in config.args) and not config.getoption("lf", False):
        config.stash[costs.STALE] = costs.stale_lines(items)
    if not config.pluginmanager.hasplugin(METER):  # the meter measures them, too
        for item in costs.slow_ones(items):
            item.add_marker(costs.SLOW)
