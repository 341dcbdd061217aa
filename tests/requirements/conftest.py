"""Missions that end with their test."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

from tests.es.harness import Lab
from tests.requirements.flight import Flight


@pytest.fixture
def fly(tmp_path: Path) -> Iterator[Callable[..., Flight]]:
    """Start missions. The arguments are those of `Flight`, without the folder."""
    flights: list[Flight] = []

    def start(*listen: int, **options: Any) -> Flight:
        folder = tmp_path / str(len(flights))
        folder.mkdir()
        flights.append(Flight(folder, *listen, **options))
        return flights[-1]

    yield start
    for flight in flights:
        flight.mission.close()


@pytest.fixture
def make_lab(tmp_path: Path) -> Iterator[Callable[..., Lab]]:
    """Start missions whose applications are functions. The arguments are those of `Lab`, without the folder."""
    labs: list[Lab] = []

    def make(**mains: Any) -> Lab:
        labs.append(Lab(tmp_path, **mains))
        return labs[-1]

    yield make
    for lab in labs:
        lab.mission.close()
