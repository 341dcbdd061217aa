"""The dask worker's side of a campaign: it flies batches in its own worker processes.

So the dask worker survives a mission that ends its process, and reports the schedule under which that happened. Only
this module and `worker_pools` know dask; this one is only imported where dask is installed.
"""

from __future__ import annotations

import pickle
import tempfile
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from queue import Empty, SimpleQueue
from typing import Any

from distributed import WorkerPlugin, get_worker

from cfepy.extra.exploration.batch import Lot
from cfepy.extra.exploration.campaign import Experiment, Job, NumberedVerdict
from cfepy.extra.exploration.mission_transfer import Shipment, Unpacked, comparable_versions
from cfepy.extra.exploration.workers import Processes
from cfepy.status import UsageError


class Desk(WorkerPlugin):
    """A campaign's place on a dask worker: the mission's files, and a process for each of its threads.

    Args:
        name: name of the campaign, unique on the cluster.
        trial: the pickled trial.
        shipment: the mission's files; None if the trial needs none.
        longest_s: see `Processes`.
    """

    def __init__(self, name: str, trial: bytes, shipment: Shipment | None, longest_s: float) -> None:
        self.name = name
        self._trial = trial
        self._shipment = shipment
        self._longest_s = longest_s
        self._versions = comparable_versions()

    def setup(self, worker: Any) -> None:
        """Unpack the mission's files when the dask worker receives this plugin."""
        self._address = str(worker.address)
        self._idle: SimpleQueue[Processes] = SimpleQueue()
        self._folder = tempfile.TemporaryDirectory(prefix="cfepy-")
        self._inside: Unpacked | None = None
        self._environ: dict[str, str] | None = None
        self._moved: Experiment = pickle.loads(self._trial)
        if self._shipment is not None:
            self._inside = inside = self._shipment.unpack(Path(self._folder.name))
            self._environ = self._shipment.environ_in(inside)
            self._moved = _with_plan(self._moved, self._shipment, inside)

    def teardown(self, worker: Any) -> None:
        """End the processes and remove the files when the campaign is over or the dask worker ends."""
        while (crew := self._idle_crew()) is not None:
            crew.close()
        self._folder.cleanup()

    def run(self, jobs: Sequence[Job]) -> list[NumberedVerdict]:
        """Fly a batch.

        Raises:
            UsageError: the trial cannot run, or cannot run on this worker.
        """
        check_versions(self._address, comparable_versions(), self._versions)
        left = list(jobs)
        crew = self._idle_crew() or self._new_crew()
        try:
            results = list(crew.run(self._moved, lambda count: [left.pop(0) for _ in left[:count]]))
        finally:
            self._idle.put(crew)
        inside = self._inside
        if inside is None or isinstance(self._moved, Lot):
            return results
        return [(number, inside.told(verdict)) for number, verdict in results]

    def _idle_crew(self) -> Processes | None:
        try:
            return self._idle.get_nowait()
        except Empty:
            return None

    def _new_crew(self) -> Processes:
        folder = None if self._inside is None else self._inside.folder
        return Processes(1, self._longest_s, folder, self._environ)


def _with_plan(trial: Any, shipment: Shipment, inside: Unpacked) -> Experiment:
    moved: Experiment = replace(trial, plan=shipment.plan_in(inside))
    return moved


def fly(name: str, jobs: Sequence[Job]) -> list[NumberedVerdict]:
    """Fly a batch of a campaign on the current dask worker."""
    desk = get_worker().plugins[name]
    assert isinstance(desk, Desk)
    return desk.run(jobs)


def check_versions(address: str, there: Mapping[str, str], here: Mapping[str, str]) -> None:
    """Check that a dask worker has the client's versions, because only then are results comparable.

    Args:
        address: address of the dask worker.
        there: its versions; see `comparable_versions`.
        here: versions of the process that began the campaign.

    Raises:
        UsageError: they differ.
    """
    if there != here:
        texts = [", ".join(f"{name} {version}" for name, version in each.items()) for each in (there, here)]
        text = f"worker {address} has {texts[0]}, but the client has {texts[1]}; install the same on all computers"
        raise UsageError(text, field="--cluster")
