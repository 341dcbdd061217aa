"""A campaign: one trial under many schedules. Its verdicts are in order, whichever process runs them.

The report of a campaign does not depend on how it was run. A crew (`workers`, `worker_pools`) gives verdicts as they
arrive. The campaign puts them in order, keeps them in the results file, and takes the results of an earlier run from
there. It holds only verdicts that wait for their turn, so its memory does not grow with the number of schedules.
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
"""Gives at most the requested number of jobs; fewer or none if there are no more at the moment."""


class Experiment(Protocol):
    """The work that is tried under each schedule. It is pickled for crews of other processes."""

    def run(self, schedule: Schedule) -> Verdict:
        """Fly the mission under a schedule.

        Raises:
            UsageError: it cannot fly at all, which ends the campaign.
        """


class Search(Protocol):
    """Chooses the schedules that are tried, and their order."""

    def next(self) -> Schedule | None:
        """Return the next schedule. None if the search needs more verdicts first, or is at its end."""

    def tell(self, number: int, verdict: Verdict) -> None:
        """Take the verdict on the schedule of this number, from 0. Verdicts arrive in the order of numbers."""


class Crew(Protocol):
    """Runs trials."""

    def run(self, trial: Experiment, take: Take) -> Generator[NumberedVerdict, None, None]:
        """Run jobs until there are none. Verdicts come in any order, exactly one for each job.

        Args:
            trial: the same one in every call.
            take: source of jobs; asked again after every result.

        Raises:
            UsageError: the trial cannot run, or no worker can run it.
        """

    def close(self) -> None:
        """End all processes of this crew."""


class Inline:
    """A crew without workers, which runs in this process. A mission that ends its process also ends this one."""

    def run(self, trial: Experiment, take: Take) -> Generator[NumberedVerdict, None, None]:
        while jobs := take(16):
            yield from ((number, judge(trial, schedule)) for number, schedule in jobs)

    def close(self) -> None:
        """Do nothing: there are no other processes."""


def judge(trial: Experiment, schedule: Schedule) -> Verdict:
    """Return the verdict of a trial. It includes an error that is not the mission's, so that the campaign goes on.

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
    """Counts of the results of a campaign.

    Attributes:
        done: schedules with a verdict, in order from the first one.
        failed: schedules among these under which the mission failed.
        troubled: schedules among these that ended in an error of cfepy.
        resumed: schedules among these that an earlier run had flown.
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
        trial: the trial.
        search: the schedules; a new search from its start, also when a results file is resumed.
        count: the most schedules that are tried.
        crew: runs them; closed by `run`.
        file: takes the verdicts, and gives the verdicts of an earlier run; closed by `run`.
        progress: shows the number of finished schedules.
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
        self._waiting: dict[int, Verdict] = {}  # they wait for a verdict before them
        self._resumed: set[int] = set()  # numbers of waiting verdicts from an earlier run
        self._drawn = 0  # schedules that the search gave
        self._tally = Tally()

    def run(self, on_verdict: Callable[[int, Verdict], bool | None]) -> Tally:
        """Run until there are no more schedules, the user presses Ctrl-C, or `on_verdict` returns True.

        Args:
            on_verdict: gets number and verdict in the order of numbers; True ends the campaign. It gets the same calls
                from every crew.

        Raises:
            UsageError: the trial cannot run, or no worker can run it; earlier verdicts are in the file.
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
        """Yield all verdicts in order. A crew without jobs stops; later verdicts may give it more jobs."""
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
