"""A campaign: one trial under many schedules, and its verdicts in order, whichever process runs them.

What a campaign reports does not depend on how it was run: a crew (`workers`, `worker_pools`) gives verdicts as they
come, the campaign puts them in order, keeps them in the results file, and takes from there what an earlier run found.
It holds only verdicts that wait for their turn, so its memory does not grow with the number of schedules.
"""

from __future__ import annotations

import contextlib
import traceback
from collections.abc import Callable, Generator, Iterator
from dataclasses import dataclass
from typing import Protocol

from cfepy.extra.exploration.progress import NoProgress, Progress
from cfepy.extra.exploration.results_file import ResultsFile
from cfepy.extra.exploration.verdict import Verdict
from cfepy.schedules import Schedule
from cfepy.status import UsageError

AHEAD = 4096  # schedules that may be handed out beyond the first whose verdict is missing

Job = tuple[int, Schedule]
"""Number of a schedule in its campaign, from 0, and the schedule."""
NumberedVerdict = tuple[int, Verdict]
Take = Callable[[int], list[Job]]
"""Gives at most so many jobs; fewer or none when there are no more just now."""


class Experiment(Protocol):
    """What is tried under each schedule. It is pickled for crews of other processes."""

    def run(self, schedule: Schedule) -> Verdict:
        """Fly the mission under a schedule.

        Raises:
            UsageError: it cannot fly at all, which ends the campaign.
        """


class Search(Protocol):
    """Which schedules are tried, in which order."""

    def next(self) -> Schedule | None:
        """The next schedule; None when there is none before more verdicts are told, or at all."""

    def tell(self, number: int, verdict: Verdict) -> None:
        """The verdict on the schedule of this number, from 0, was found; told in the order of numbers."""


class Crew(Protocol):
    """Runs trials."""

    def run(self, trial: Experiment, take: Take) -> Generator[NumberedVerdict, None, None]:
        """Run jobs until there are none; verdicts come in any order, each job has exactly one.

        Args:
            trial: the same one in every call.
            take: where jobs come from; asked again after every result.

        Raises:
            UsageError: the trial cannot run, or no worker can run it.
        """

    def close(self) -> None:
        """End everything that runs for this crew."""


class Inline:
    """A crew without workers: runs in this process, which a mission that ends its process takes with it."""

    def run(self, trial: Experiment, take: Take) -> Generator[NumberedVerdict, None, None]:
        while jobs := take(16):
            yield from ((number, judge(trial, schedule)) for number, schedule in jobs)

    def close(self) -> None:
        """Nothing runs beside this process."""


def judge(trial: Experiment, schedule: Schedule) -> Verdict:
    """The verdict of a trial; an error that is not the mission's is kept in it, so that a campaign goes on.

    Raises:
        UsageError: the mission cannot fly at all.
    """
    try:
        return trial.run(schedule)
    except UsageError:
        raise
    except Exception:
        return Verdict(schedule, trouble=traceback.format_exc())


@dataclass(slots=True)
class Tally:
    """What a campaign came to.

    Attributes:
        done: schedules with a verdict, in order from the first one.
        failed: those of them under which the mission failed.
        troubled: those of them that ended in an error of cfepy.
        resumed: those of them that an earlier run had found.
        interrupted: the user pressed Ctrl-C.
    """

    done: int = 0
    failed: int = 0
    troubled: int = 0
    resumed: int = 0
    interrupted: bool = False


class Campaign:
    """Runs a trial under the schedules of a search.

    Args:
        trial: what is tried.
        search: which schedules; a new one, from its start also when a results file is resumed.
        count: how many schedules at most.
        crew: runs them; closed by `run`.
        file: takes the verdicts, and gives those of an earlier run; closed by `run`.
        progress: is told how far it is.
    """

    def __init__(
        self,
        trial: Experiment,
        search: Search,
        count: int,
        crew: Crew,
        file: ResultsFile | None = None,
        progress: Progress | None = None,
    ) -> None:
        self._trial = trial
        self._search = search
        self._count = count
        self._crew = crew
        self._file = file
        self._progress = progress if progress is not None else NoProgress()
        self._waiting: dict[int, Verdict] = {}  # for a verdict before them
        self._resumed: set[int] = set()  # which of these were found earlier
        self._drawn = 0  # schedules that the search gave
        self._tally = Tally()

    def run(self, on_verdict: Callable[[int, Verdict], bool | None]) -> Tally:
        """Run until there are no more schedules, the user presses Ctrl-C, or `on_verdict` has seen enough.

        Args:
            on_verdict: gets number and verdict in the order of numbers; True ends the campaign. Whatever the crew,
                it gets the same calls.

        Raises:
            UsageError: the trial cannot run, or no worker can run it; what was found is in the file.
        """
        try:
            with contextlib.closing(self._verdicts()) as verdicts:
                for number, verdict in verdicts:
                    if on_verdict(number, verdict):
                        break
        except KeyboardInterrupt:
            self._tally.interrupted = True
        finally:
            self._crew.close()
            self._progress.close()
            if self._file is not None:
                self._file.close()
        return self._tally

    def _verdicts(self) -> Generator[NumberedVerdict, None, None]:
        """All verdicts in order. A crew that has nothing to do stops; what is told then may give it more."""
        before = -1
        while before != self._tally.done:
            before = self._tally.done
            with contextlib.closing(self._results()) as results:
                for number, verdict in results:
                    if self._file is not None:
                        self._file.append(number, verdict.to_dict())
                    self._arrived(number, verdict)
                    yield from self._in_order()
            yield from self._in_order()

    def _results(self) -> Generator[NumberedVerdict, None, None]:
        yield from self._crew.run(self._trial, self._take)

    def _take(self, limit: int) -> list[Job]:
        jobs: list[Job] = []
        while len(jobs) < limit and self._drawn < min(self._count, self._tally.done + AHEAD):
            schedule = self._search.next()
            if schedule is None:
                break
            number, self._drawn = self._drawn, self._drawn + 1
            found = None if self._file is None else self._file.verdict(number)
            if found is None:
                jobs.append((number, schedule))
            else:
                self._resumed.add(number)
                self._arrived(number, Verdict.from_dict(found))
        return jobs

    def _arrived(self, number: int, verdict: Verdict) -> None:
        self._waiting[number] = verdict
        self._progress.arrived(verdict.failed or bool(verdict.trouble))

    def _in_order(self) -> Iterator[NumberedVerdict]:
        while (number := self._tally.done) in self._waiting:
            verdict = self._waiting.pop(number)
            self._tally.done += 1
            self._tally.failed += verdict.failed
            self._tally.troubled += bool(verdict.trouble)
            if number in self._resumed:
                self._resumed.remove(number)
                self._tally.resumed += 1
            self._search.tell(number, verdict)
            yield number, verdict
