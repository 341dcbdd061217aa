"""Trials for tests of campaigns: their verdicts are functions of the schedule, and some end or stop their process."""

from __future__ import annotations

import os
import signal
import time
from dataclasses import dataclass, field
from pathlib import Path

from cfepy.extra.exploration.verdict import Failure, Verdict
from cfepy.schedules import Schedule
from cfepy.status import UsageError


class Seeds:
    """Schedules random:0, random:1 and so on; keeps the reported results."""

    def __init__(self) -> None:
        self.given = 0
        self.told: list[int] = []

    def next(self) -> Schedule | None:
        self.given += 1
        return Schedule("random", self.given - 1)

    def tell(self, number: int, verdict: Verdict) -> None:
        self.told.append(number)


@dataclass(frozen=True)
class FakeTrial:
    """Fails under some seeds, and does worse under others.

    Attributes:
        fails, raises: seeds under which the mission fails, and cfepy does.
        exits, hangs, killed: seeds that end their process, never end, and get their process killed.
        once: folder of notes; a seed that ends its process leaves one there and does not do it again.
        unusable: the mission cannot fly.
    """

    fails: tuple[int, ...] = ()
    raises: tuple[int, ...] = ()
    exits: tuple[int, ...] = ()
    hangs: tuple[int, ...] = ()
    killed: tuple[int, ...] = ()
    once: Path | None = None
    unusable: bool = False
    log: Path | None = field(default=None)

    def run(self, schedule: Schedule) -> Verdict:
        if self.unusable:
            raise UsageError("no such mission", file="nowhere.scr", line=3, field="words")
        seed = schedule.seed
        self._note(seed)
        if self._is_due(seed, self.exits):
            os._exit(7)
        if self._is_due(seed, self.killed):
            os.kill(os.getpid(), signal.SIGKILL)
        if self._is_due(seed, self.hangs):
            while True:
                time.sleep(1)
        if seed in self.raises:
            raise ZeroDivisionError(f"seed {seed}")
        failures = (Failure("died", "APP", f"seed {seed}"),) if seed in self.fails else ()
        return Verdict(schedule, failures, trace=f"trace of {seed}", decisions=seed)

    def _note(self, seed: int) -> None:
        if self.log is not None:
            with self.log.open("a") as log:
                log.write(f"{seed}\n")

    def _is_due(self, seed: int, seeds: tuple[int, ...]) -> bool:
        if seed not in seeds:
            return False
        if self.once is None:
            return True
        try:
            (self.once / str(seed)).touch(exist_ok=False)
        except FileExistsError:
            return False
        return True


class Environment:
    """A trial that reports the hash seed of its process."""

    def run(self, schedule: Schedule) -> Verdict:
        return Verdict(schedule, trace=os.environ.get("PYTHONHASHSEED", "none"))
