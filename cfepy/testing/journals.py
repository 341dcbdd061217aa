"""Journals of the missions of failed tests, for `--cfepy-record`."""

from __future__ import annotations

import re
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

from cfepy.journal import JournalRecorder
from cfepy.pilot import RunPlan
from cfepy.rtos import Policy
from cfepy.status import UsageError

if TYPE_CHECKING:
    from cfepy.flight import Flight

UNDECIDED = ".undecided"  # while the test runs


class FlightJournal:
    """The journal of one mission.

    Args:
        path: its path until it is decided whether to keep it.
        plan: plan of the flight.
        policy: decides which task goes first.

    Attributes:
        recorder: attach it to the mission, with its own `policy`.
        flight: the mission, once it was created.
    """

    flight: Flight

    def __init__(self, path: Path, plan: RunPlan, policy: Policy | None) -> None:
        self.recorder = JournalRecorder(path, plan, policy=policy)
        self.recorder.__enter__()
        self._path = path
        self._ended = False

    def end(self) -> None:
        """Write the end of the run, whatever its result."""
        if not self._ended:
            self._ended = True
            self.recorder.end(self.flight.flown())
            self.recorder.__exit__(None, None, None)

    def keep(self, path: Path) -> Path:
        """Give it its final name."""
        self.end()
        return self._path.replace(path)

    def drop(self) -> None:
        """End the journal and delete it, because it is not needed."""
        if not self._ended:
            self._ended = True
            self.recorder.__exit__(None, None, None)
        self._path.unlink()


class FlightJournals:
    """Writes a journal for each mission, and keeps the journals of tests that fail.

    Args:
        folder: folder of the journals; it is created if necessary.

    Raises:
        UsageError: if it cannot be created.

    Attributes:
        kept: paths of the journals of the last failed test.
    """

    def __init__(self, folder: str) -> None:
        self.kept: list[Path] = []
        self._folder = Path(folder)
        try:
            self._folder.mkdir(parents=True, exist_ok=True)
        except OSError as error:
            text = f"cannot be made: {error.strerror}; name a folder that you may write to"
            raise UsageError(text, file=folder, field="--cfepy-record") from None
        self._open: list[FlightJournal] = []
        self._failed: list[FlightJournal] = []  # of the last failed Hypothesis example
        self._count = 0

    def begin(self, plan: RunPlan, policy: Policy | None) -> FlightJournal:
        """Return the journal of a mission that is about to be created."""
        self._count += 1
        journal = FlightJournal(self._folder / f"{self._count}{UNDECIDED}", plan, policy)
        self._open.append(journal)
        return journal

    def set_aside(self) -> None:
        """Mark the journals so far as those of a failed example; the test may continue with others."""
        for journal in self._failed:
            journal.drop()
        self._failed, self._open = self._open, []
        for journal in self._failed:
            journal.end()

    def keep(self, item: pytest.Item) -> None:
        """Name the journals after the failed test."""
        found = self._open or self._failed
        name = re.sub(r"[^\w.-]+", "-", item.nodeid).strip("-")
        numbered = [f"{name}-{number}" for number in range(1, len(found) + 1)] if len(found) > 1 else [name]
        self.kept = [each.keep(self._folder / f"{own}.cfepy") for each, own in zip(found, numbered, strict=True)]
        found.clear()

    def drop(self, first: int = 0) -> None:
        """Drop the journals from this number on, whose missions did not fail."""
        for journal in self._open[first:]:
            journal.drop()
        del self._open[first:]

    def end_test(self) -> None:
        """End the test."""
        self.drop()
        for journal in self._failed:
            journal.drop()
        self._failed.clear()
        self.kept = []
