"""The pytest plugin: options, the fixture `mission`, and parts that are loaded only for tests that need them.

A suite that does not use cfepy only pays for some options and a check of its collected tests: the code for missions is
loaded when a test asks for one.

PYTEST_DONT_REWRITE: it is loaded by its entry point or by name, and pytest warns if it was loaded in both ways.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import pytest

if TYPE_CHECKING:
    from cfepy.testing.missions import Missions

EXPLORE_MARK = "cfepy_explore"  # as in `cfepy.testing.explore_mark`, which is loaded for tests with this mark
CURRENT = pytest.StashKey[pytest.Item]()
"""In the stash of the configuration: the running test."""


def pytest_addoption(parser: pytest.Parser) -> None:
    """Add the options of cfepy."""
    group = parser.getgroup("cfepy", "cfepy: missions under test")
    group.addoption(
        "--cfepy-seed", type=int, default=0, metavar="N", help="seed of missions for which the test sets none"
    )
    group.addoption(
        "--cfepy-schedule",
        default=None,
        metavar="TEXT",
        help="schedule of missions for which the test sets none: fifo, random:SEED, pct:SEED:DEPTH, "
        "at:DECISION=CHOICE,...; separate several missions of one test by ';'. Tests with @explore run under it only",
    )
    group.addoption("--cfepy-tasks", choices=["auto", "thread", "greenlet"], help="kind of the tasks of missions")
    stall = (
        "seconds of CPU time after which a task that does not give up the CPU fails its test; 0: never (default: 10)"
    )
    group.addoption("--cfepy-stall", type=float, default=None, metavar="SECONDS", help=stall)
    parser.addini("cfepy_stall", f"as --cfepy-stall: {stall}", default="10")
    group.addoption("--cfepy-schedules", type=int, metavar="N", help="number of schedules of each @explore")
    group.addoption("--cfepy-record", metavar="DIR", help="folder for the journals of missions of failed tests")
    _add_procedures(parser.getgroup("cfepy procedures", "cfepy: test procedures of COSMOS"))
    group.addoption("--cfepy-example", metavar="CODE", help="the Hypothesis example to run, as printed with a failure")


def _add_procedures(group: pytest.OptionGroup) -> None:
    """Add the options for procedures."""
    group.addoption(
        "--procedures",
        metavar="PATH",
        action="append",
        default=[],
        help="run the test procedures of this file or folder; again for more",
    )
    group.addoption("--mission", metavar="NAME", default="lab", help="mission of procedures (default: lab)")
    group.addoption("--explore", metavar="N", type=int, help="fly each suite of procedures under N schedules")
    group.addoption("--faults", metavar="FILE|seed:N", help="faults in the missions of procedures")
    group.addoption("--answers", metavar="FILE", help="answers to questions of procedures, in YAML")
    group.addoption("--requirements", metavar="FILE", help="ids and texts of requirements, in YAML")
    group.addoption("--matrix-html", metavar="FILE", help="write the requirement matrix of procedures as a page")
    group.addoption("--matrix-csv", metavar="FILE", help="write the requirement matrix of procedures as CSV")


def pytest_configure(config: pytest.Config) -> None:
    """Register the mark that `cfepy.testing.explore` makes, and load the module for procedures if they are asked for.

    Without other paths, pytest then collects the procedures only.
    """
    config.addinivalue_line("markers", f"{EXPLORE_MARK}(exploration): made by @cfepy.testing.explore(...)")
    paths = config.getoption("--procedures")
    if paths:
        from cfepy.plugins import Hook
        from cfepy.status import UsageError

        tests: Hook[type] = Hook("procedure_tests")
        try:
            _add_configured(config, "cfepy-procedures", tests.need("--procedures"))
        except UsageError as error:
            raise pytest.UsageError(str(error)) from None
        if config.args_source is not pytest.Config.ArgsSource.ARGS:
            config.args = list(paths)


def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    """Load the modules for tests with @explore, if there are any."""
    if any(item.get_closest_marker(EXPLORE_MARK) for item in items):
        from cfepy.plugins import Hook

        runner: Hook[type] = Hook("explored_tests")
        _add(config, "cfepy-explore", runner.need("@explore"))


@pytest.hookimpl(tryfirst=True)
def pytest_runtest_setup(item: pytest.Item) -> None:
    """Note the running test."""
    item.config.stash[CURRENT] = item


def _add_configured(config: pytest.Config, name: str, plugin: type) -> None:
    if not config.pluginmanager.has_plugin(name):
        config.pluginmanager.register(plugin(config), name)


def _add(config: pytest.Config, name: str, plugin: type) -> None:
    if not config.pluginmanager.has_plugin(name):
        config.pluginmanager.register(plugin(), name)


@pytest.fixture(scope="session")
def mission(request: pytest.FixtureRequest) -> Iterator[Missions]:
    """Boot missions: `flight = mission("capture", seed=1)`, by folder, launch file, node or shipped name.

    A relative path starts at the folder of the test's file. The flight ends with the test, or with the fixture that
    made it. Give board=, seed=, schedule=, tasks=, faults=, args= (of a launch file) or attachments= as needed.
    docs/how_to/testing.md has examples.
    """
    from cfepy.testing.missions import Missions, reported_progress

    found = request.config.pluginmanager.get_plugin("cfepy-missions")
    if found is None:
        found = Missions(request.config, CURRENT)
        request.config.pluginmanager.register(found, "cfepy-missions")
    assert isinstance(found, Missions)
    with reported_progress(request.config):
        yield found
