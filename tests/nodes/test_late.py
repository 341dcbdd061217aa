"""Modules whose code runs late: a node cannot detect it, whatever it does with them first."""

from __future__ import annotations

from types import ModuleType

import pytest

from cfepy.nodes import Universe
from cfepy.nodes.importer import LateModule, postpone
from cfepy.rtos import Kernel


def late(log: list[str], fails: bool = False) -> ModuleType:
    module = ModuleType("late")

    def run() -> None:
        log.append("run")
        if fails and len(log) == 1:
            raise ValueError("not yet")
        vars(module).update(a=1, b=2)

    return postpone(module, run)


def test_first_access_runs_the_code_once() -> None:
    log: list[str] = []
    module = late(log)
    assert (hasattr(module, "__path__"), module.__name__, log) == (False, "late", [])
    assert (module.a, module.b, log) == (1, 2, ["run"])
    assert type(module) is ModuleType
    with pytest.raises(AttributeError, match="module 'late' has no attribute 'c'"):
        module.c  # noqa: B018


def test_value_set_before_the_code_runs_is_kept() -> None:
    module = late([])
    module.a = 5  # type: ignore[attr-defined]
    assert (module.a, module.b) == (5, 2)


def test_dir_and_del() -> None:
    assert {"a", "b"} <= set(dir(late([])))
    module = late([])
    del module.a
    assert not hasattr(module, "a")


def test_failed_code_is_run_again() -> None:
    module = late([], fails=True)
    with pytest.raises(ValueError, match="not yet"):
        module.a  # noqa: B018
    assert isinstance(module, LateModule)
    assert module.a == 1


def test_logging_loads_no_unneeded_module_and_shows_errors() -> None:
    with Kernel() as kernel:
        universe = Universe(kernel, name="n")
        logging = universe.importer.load("logging")
        assert isinstance(universe.importer.modules["traceback"], LateModule)

        def log() -> None:
            try:
                raise ZeroDivisionError("here")
            except ZeroDivisionError:
                logging.basicConfig(format="%(message)s")
                logging.exception("failed")

        kernel.spawn("log", log)
        kernel.run(10**9)
        assert universe.output[0] == "[n] failed"
        assert universe.output[-1] == "[n] ZeroDivisionError: here"
