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
        path: while it is not decided whether it is kept.
        plan: what is flown.
        policy: decides which task goes first.

    Attributes:
        recorder: to be attached to the mission, with its own `policy`.
        flight: the mission; set when it was made.
    """

    flight: Flight

    def __init__(self, path: Path, plan: RunPlan, policy: Policy | None) -> None:
        self.recorder = JournalRecorder(path, plan, policy=policy)
        self.recorder.__enter__()
        self._path = path
        self._ended = False

    def end(self) -> None:
        """The run is over, whatever it came to."""
        if not self._ended:
            self._ended = True
            self.recorder.end(self.flight.flown())
            self.recorder.__exit__(None, None, None)

    def keep(self, path: Path) -> Path:
        """Give it the name that it keeps."""
        self.end()
        return self._path.replace(path)

    def drop(self) -> None:
        """End the journal and delete it, since it is not needed."""
        if not self._ended:
            self._ended = True
            self.recorder.__exit__(None, None, None)
        self._path.unlink()


class FlightJournals:
    """Writes a journal for each mission, and keeps those of tests that fail.

    Args:
        folder: where; it is made if it is not there.

    Raises:
        UsageError: it cannot be made.

    Attributes:
        kept: paths of the journals of the test that has failed last.
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
        self._failed: list[FlightJournal] = []  # of the last example of Hypothesis that has failed
        self._count = 0

    def begin(self, plan: RunPlan, policy: Policy | None) -> FlightJournal:
        """The journal of a mission that is about to be made."""
        self._count += 1
        journal = FlightJournal(self._folder / f"{self._count}{UNDECIDED}", plan, policy)
        self._open.append(journal)
        return journal

    def set_aside(self) -> None:
        """What was written so far is of an example that has failed; the test may go on with others."""
        for journal in self._failed:
            journal.drop()
        self._failed, self._open = self._open, []
        for journal in self._failed:
            journal.end()

    def keep(self, item: pytest.Item) -> None:
        """The test has failed: name its journals after it."""
        found = self._open or self._failed
        name = re.sub(r"[^\w.-]+", "-", item.nodeid).strip("-")
        numbered = [f"{name}-{number}" for number in range(1, len(found) + 1)] if len(found) > 1 else [name]
        self.kept = [each.keep(self._folder / f"{own}.cfepy") for each, own in zip(found, numbered, strict=True)]
        found.clear()

    def drop(self, first: int = 0) -> None:
        """What is left, from this number on, is of missions that did well."""
        for journal in self._open[first:]:
            journal.drop()
        del self._open[first:]

    def end_test(self) -> None:
        """The test is over."""
        self.drop()
        for journal in self._failed:
            journal.drop()
        self._failed.clear()
        self.kept = []
