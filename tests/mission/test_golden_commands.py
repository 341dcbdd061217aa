"""Ground commands recorded on the real cFE, byte for byte, and their events there: ours are the same."""

from __future__ import annotations

import re
from typing import Any

import pytest

from tests.mission.golden_session import Session, commands, fly

BUILD = re.compile(r"Build .*")
LONGEST = 131  # characters of an event on the recorded console, which truncated its lines; ours does not


def comparable(event: str) -> str:
    return BUILD.sub("Build <build>", event)[:LONGEST]


@pytest.fixture(scope="module")
def session(tmp_path_factory: pytest.TempPathFactory) -> Session:
    return fly(tmp_path_factory.mktemp("session"))


@pytest.mark.parametrize("number", range(len(commands())), ids=lambda number: commands()[number]["desc"][:40])
def test_command_causes_the_recorded_events(session: Session, number: int) -> None:
    command: dict[str, Any] = commands()[number]
    ours, recorded = (list(map(comparable, texts)) for texts in (session.events[number], command["events"]))
    assert ours == recorded
