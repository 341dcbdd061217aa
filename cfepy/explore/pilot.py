"""Flies the schedules of a trial one after the other, in the quickest way there is.

When schedules part from an instant on (`from=600ms`) and tasks are greenlets, what comes before is flown once, and a
process is forked for each schedule (`cfepy.rtos.fork_server`). The verdicts are those of whole flights.
"""

from __future__ import annotations

import os
from dataclasses import replace

from cfepy.explore.campaign import Trial as AnyTrial
from cfepy.explore.campaign import judge
from cfepy.explore.trial import Trial
from cfepy.explore.verdict import Verdict
from cfepy.rtos.fork_server import ForkServer, LateSchedule
from cfepy.rtos.schedule import Schedule


class Pilot:
    """Gives verdicts; `close` ends the processes that it has.

    Args:
        trial: what is tried.
    """

    def __init__(self, trial: AnyTrial) -> None:
        self._trial = trial
        self._servers: dict[Schedule, ForkServer] = {}

    def judge(self, schedule: str) -> Verdict:
        """The verdict on a schedule; see `cfepy.explore.campaign.judge`."""
        trial = self._trial
        if isinstance(trial, Trial) and trial.plan.tasks == "greenlet" and hasattr(os, "fork"):
            parsed = Schedule.parse(schedule)
            if parsed.from_ns:
                return self._forked(trial, parsed)
        return judge(trial, schedule)

    def close(self) -> None:
        """End the processes that wait for schedules, the last one first: it has copies of the pipes of the others."""
        for server in reversed(self._servers.values()):
            server.close()
        self._servers.clear()

    def _forked(self, trial: Trial, schedule: Schedule) -> Verdict:
        def body(late: LateSchedule) -> Verdict:
            return trial.run(late)  # type: ignore[arg-type]  # it stands in the place of a Schedule

        options = schedule.at({})
        if options not in self._servers:
            self._servers[options] = ForkServer(body, options)
        try:
            verdict: Verdict = self._servers[options].run(schedule)
        except ChildProcessError:
            return judge(trial, schedule.text())  # whatever ended that process does it here, where it is looked at
        return replace(verdict, schedule=schedule.text())
