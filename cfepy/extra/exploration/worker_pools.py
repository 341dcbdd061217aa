"""The crew for the options of a command: worker processes of this computer, or a cluster of computers.

A cluster is reached through dask.distributed, which comes with the extra `cluster` and is imported when one is asked
for. It hands batches to its workers, and hands them out again when a worker is lost. `cluster_worker` is the worker's
side.
"""

from __future__ import annotations

import logging
import os
import pickle
from collections.abc import Callable, Generator, Iterator
from concurrent.futures import CancelledError
from contextlib import contextmanager
from importlib import import_module
from queue import Empty, SimpleQueue
from typing import Any

from cfepy.extra.exploration.batch import Lot
from cfepy.extra.exploration.campaign import Crew, Experiment, Job, NumberedVerdict, Take
from cfepy.extra.exploration.mission_transfer import Shipment
from cfepy.extra.exploration.workers import LONGEST_S, Processes, died, usable_cpus
from cfepy.rtos import Stopwatch
from cfepy.status import UsageError
from cfepy.units import NS_PER_S

OPTION = "--cluster"
LOCAL = "local:"
CONNECT_S = 15  # wall time until the scheduler of the cluster must answer
FETCH_S = 5  # wall time until a worker that has done a batch must have sent its verdicts
LOOK_S = 1.0  # wall time between two looks at the cluster while no results come
PATIENCE_NS = 60 * NS_PER_S  # wall time for which a cluster may be without a worker
BATCH_NS = NS_PER_S  # wall time that a batch should take; the transfer takes some hundredths of a second
MOST = 256  # schedules in a batch
QUEUED = 2  # batches for each thread of the cluster, so that the next one is there when one is done
_KEPT = "a results file keeps the findings so far; run the same command again to continue"


def make_crew(
    count: int,
    jobs: int | None = None,
    cluster: str | None = None,
    shipment: Callable[[], Shipment] | None = None,
    longest_s: float = LONGEST_S,
) -> Crew:
    """Return worker processes of this computer, or a cluster.

    Args:
        count: the most schedules.
        jobs: `--jobs`: processes on this computer; None for one on each CPU.
        cluster: `--cluster`: address of a dask scheduler, or local:N; None for none.
        shipment: packs the mission's files; called for a cluster only.
        longest_s: wall time in seconds that a schedule may take.

    Raises:
        UsageError: the options are invalid, or there is no such cluster.
    """
    if jobs is not None and jobs < 1:
        raise UsageError(f"must be 1 or more, not {jobs}", field="--jobs")
    if longest_s <= 0:
        raise UsageError(f"must be greater than 0 s, not {longest_s:g} s", field="--longest")
    if cluster is None:
        return Processes(max(1, min(count, usable_cpus() if jobs is None else jobs)), longest_s)
    if jobs is not None:
        raise UsageError("cannot be combined with --cluster", field="--jobs")
    return Cluster(cluster, None if shipment is None else shipment(), longest_s)


@contextmanager
def _own_environment() -> Iterator[None]:
    """Restore the environment of this process: dask's nannies write the variables of their workers into it."""
    before = dict(os.environ)
    try:
        yield
    finally:
        os.environ.clear()
        os.environ.update(before)


class Cluster:
    """A crew of dask workers.

    Args:
        address: of the scheduler, such as tcp://10.0.0.1:8786; local:N starts a cluster of N processes here.
        shipment: files that the trial needs on other computers; None for a trial that needs none.
        longest_s: wall time in seconds that a schedule may take.

    Raises:
        UsageError: dask is not installed, the cluster does not answer, or there are no workers.
    """

    def __init__(self, address: str, shipment: Shipment | None = None, longest_s: float = LONGEST_S) -> None:
        self._distributed = _distributed()
        self._address = address
        self._shipment = shipment
        self._longest_s = longest_s
        self._local: Any = None
        self._name = ""
        self._client = self._connected()
        self._threads = 0
        self._looked: Stopwatch | None = None
        self._deserted: Stopwatch | None = None  # time since the last worker was lost
        self._batch = 1
        self._given: dict[Any, tuple[list[Job], Stopwatch]] = {}  # by future
        self._again: list[Job] = []
        self._died: Callable[[Any, str, str], Any] = died
        self._done: SimpleQueue[Any] = SimpleQueue()

    def run(self, trial: Experiment, take: Take) -> Generator[NumberedVerdict, None, None]:
        if not self._name:
            self._set_up(trial)
        self._died = trial.died if isinstance(trial, Lot) else died
        try:
            while True:
                self._hand_out(take)
                if not self._given:
                    return
                yield from self._wait()
        finally:
            self._give_up()

    def close(self) -> None:
        try:
            if self._name and self._client.status == "running":
                self._client.unregister_worker_plugin(self._name)
        except Exception:
            pass  # the cluster has stopped, and its plugin with it
        self._client.close()
        if self._local is not None:
            with _own_environment():
                self._local.close()

    def _connected(self) -> Any:
        try:
            target: Any = self._address
            if self._address.startswith(LOCAL):
                target = self._local = self._started(self._address.removeprefix(LOCAL))
            else:  # check first: a client with an invalid address would leave its threads running
                self._distributed.comm.get_address_host_port(self._address)
            client = self._distributed.Client(target, timeout=CONNECT_S, set_as_default=False)
        except UsageError:
            raise
        except (OSError, ValueError) as error:
            text = f"no dask scheduler answers at {self._address}: {error}"
            raise UsageError(text, field=OPTION) from None
        try:
            client.wait_for_workers(1, timeout=CONNECT_S)
        except self._distributed.TimeoutError:
            client.close()
            text = f"the scheduler at {self._address} has no workers; start some (dask worker {self._address})"
            raise UsageError(text, field=OPTION) from None
        return client

    def _started(self, count: str) -> Any:
        if not count.isdecimal() or int(count) == 0:
            raise UsageError(
                f"invalid number of processes in {LOCAL}{count}; write for instance {LOCAL}4", field=OPTION
            )
        # Port 0 is any free one: None would be the well-known 8787, which another cluster may have.
        options = {"threads_per_worker": 1, "processes": True, "host": "127.0.0.1", "dashboard_address": "127.0.0.1:0"}
        safe_path = {"distributed.nanny.pre-spawn-environ.PYTHONSAFEPATH": "1"}  # see `python_command`
        with _own_environment(), import_module("dask").config.set(safe_path):
            return self._distributed.LocalCluster(n_workers=int(count), **options)

    def _set_up(self, trial: Experiment) -> None:
        """Send the trial and its files to all workers, including later ones."""
        from cfepy.extra.exploration.cluster_worker import Desk

        name = f"cfepy-{self._client.id}"
        try:
            self._client.register_plugin(Desk(name, pickle.dumps(trial), self._shipment, self._longest_s))
        except UsageError:
            raise
        except Exception as error:
            text = (
                f"workers at {self._address} cannot load the campaign; check that cfepy is installed there: {error!r}"
            )
            raise UsageError(text, field=OPTION) from None
        self._name = name

    def _hand_out(self, take: Take) -> None:
        from cfepy.extra.exploration.cluster_worker import fly

        while len(self._given) < max(1, QUEUED * self._count_threads()):
            jobs = [self._again.pop(0)] if self._again else take(self._batch)
            if not jobs:
                return
            future = self._client.submit(fly, self._name, jobs, pure=False)
            self._given[future] = jobs, Stopwatch()
            future.add_done_callback(self._done.put)

    def _wait(self) -> list[NumberedVerdict]:
        """Wait for a batch, and check the cluster regularly."""
        try:
            future = self._done.get(timeout=LOOK_S)
        except Empty:
            self._check()
            return []
        if future not in self._given:
            return []
        jobs, watch = self._given.pop(future)
        if future.status == "error":
            return self._failed(jobs, future.exception())
        self._adapt(len(jobs), watch.elapsed_ns())
        try:
            results: list[NumberedVerdict] = future.result(timeout=FETCH_S)
        except self._distributed.TimeoutError:  # the worker that had them is gone
            self._again += jobs
            return []
        except (OSError, CancelledError):
            raise self._lost() from None
        return results

    def _failed(self, jobs: list[Job], error: Any) -> list[NumberedVerdict]:
        """Handle a batch without verdicts: try its schedules again one by one; a single schedule counts as died.

        Raises:
            UsageError: the workers cannot run the campaign at all.
        """
        if isinstance(error, UsageError):
            raise error
        if not isinstance(error, self._distributed.KilledWorker):
            raise UsageError(f"workers at {self._address} cannot run the campaign: {error!r}", field=OPTION)
        if len(jobs) > 1:
            self._again += jobs
            return []
        fate = "each cluster worker that flew the schedule died"
        return [(number, self._died(schedule, fate, str(error))) for number, schedule in jobs]

    def _give_up(self) -> None:
        """Cancel the unfinished batches."""
        try:
            if self._client.status == "running":
                self._client.cancel(list(self._given), force=True)
        except (OSError, CancelledError):
            pass  # the scheduler has stopped, so there is nothing to cancel
        self._given.clear()
        self._again.clear()

    def _adapt(self, size: int, elapsed_ns: int) -> None:
        """Adapt the batch size. The elapsed time includes the wait behind other batches of the same thread."""
        fitting = QUEUED * size * BATCH_NS // max(elapsed_ns, 1)
        self._batch = max(1, min(fitting, 2 * self._batch, MOST))

    def _count_threads(self) -> int:
        if self._looked is None or self._looked.elapsed_ns() > LOOK_S * NS_PER_S:
            self._check()
        return self._threads

    def _check(self) -> None:
        """Check that there is still a scheduler with workers.

        Raises:
            UsageError: there is none.
        """
        if self._client.status != "running":
            raise self._lost()
        try:
            self._threads = sum(self._client.nthreads().values())
        except (OSError, self._distributed.TimeoutError):
            raise self._lost() from None
        self._looked = Stopwatch()
        if self._threads:
            self._deserted = None
        elif self._deserted is None:
            self._deserted = Stopwatch()
        elif self._deserted.elapsed_ns() > PATIENCE_NS:
            raise UsageError(f"the cluster at {self._address} has lost all its workers; {_KEPT}", field=OPTION)

    def _lost(self) -> UsageError:
        return UsageError(f"the scheduler at {self._address} has stopped; {_KEPT}", field=OPTION)


def _distributed() -> Any:
    """Return dask.distributed, with its own long log messages turned off, because a `UsageError` reports the error.

    Raises:
        UsageError: it is not installed.
    """
    try:
        import distributed
    except ImportError:
        text = "requires dask.distributed, which is not installed: pip install 'cfepy[cluster]'"
        raise UsageError(text, field=OPTION) from None
    for name in ("distributed", "distributed.client", "tornado"):
        logging.getLogger(name).setLevel(logging.CRITICAL)
    return distributed
