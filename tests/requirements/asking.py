"""An application that queries a running executive, for requirements about the API."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from cfepy.app import Cfe
from tests.es.harness import Lab

Make = Callable[..., Lab]


def idle(cfe: Cfe) -> None:
    """The main function of an application that only runs."""
    while cfe.es.run_loop():
        cfe.os.task_delay(100)


def ask(
    make_lab: Make, question: Callable[[Cfe], Any], seconds: float = 1, **mains: Callable[[Cfe], Any]
) -> tuple[Any, Lab]:
    """Return the answer for the application ONE, and the mission, which also has IDLE and the library LIB.

    Args:
        make_lab: the fixture.
        question: called by ONE.
        seconds: how long the mission continues then.
        mains: code of more files, or in place of idle.
    """
    found: list[Any] = []

    def one(cfe: Cfe) -> None:
        cfe.es.run_loop()
        found.append(question(cfe))
        idle(cfe)

    lab = make_lab(**{"one": one, "idle": idle, "lib": lambda cfe: 0, **mains})
    lab.es.load_library("LIB", "/cf/lib.so", "lib_init")
    lab.start("idle")
    lab.mission.run_for(0.3)
    lab.start("one")
    lab.mission.run_for(seconds)
    assert found, "the application died"
    return found[0], lab
