"""Every test here that takes `cfe` is the main function of an application: it runs in a task of a mission.

The tests stand for the segments of NASA's functional tests (cfe_testcase): a file for each of theirs, and a test with
the same name for each segment. `python -m dev.pages.requirements` counts them. test_misuse.py goes beyond them.
"""

from __future__ import annotations

import inspect
from collections.abc import Iterator
from pathlib import Path

import pytest

from cfepy.app import Cfe
from cfepy.mission import Mission
from tests.functional.harness import make_mission, run_as_application


@pytest.fixture
def mission(tmp_path: Path) -> Iterator[Mission]:
    """Return a mission that is ready to boot. It boots when the test begins."""
    with make_mission(tmp_path) as made:
        yield made


@pytest.fixture
def cfe(mission: Mission) -> Cfe:
    """Return an application's handle."""
    return mission.cfe


@pytest.hookimpl(tryfirst=True)
def pytest_pyfunc_call(pyfuncitem: pytest.Function) -> bool | None:
    """Call a test in the application CFE_TEST. Returns True, which tells pytest that the call is done."""
    found = pyfuncitem.funcargs
    if "cfe" not in found:
        return None
    arguments = {name: found[name] for name in inspect.signature(pyfuncitem.obj).parameters}
    run_as_application(found["mission"], lambda: pyfuncitem.obj(**arguments))
    return True
