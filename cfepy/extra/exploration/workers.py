"""A crew of worker processes on this computer.

Each worker is a new Python interpreter: forking a process that has run missions would copy its threads' locks without
the threads. It stays for the whole campaign, with all that it has imported and compiled. Work goes out in small
batches, some tenth of a second each. If a worker dies or hangs, the schedules of its batch are tried again, each alone.
A schedule that ends its worker alone twice gets that as its verdict.
"""

from __future__ import annotations

import os
import pickle
import signal
import subprocess
import sys
import tempfile
from collections import Counter, deque
from collections.abc import Callable, Generator, Iterator, Mapping, Sequence
from multiprocessing import Pipe
from multiprocessing.connection import wait
from pathlib import Path
from typing import IO, Any

from cfepy.extra.exploration.batch import Lot
from cfepy.extra.exploration.campaign import Experiment, Job, NumberedVerdict, Take
from cfepy.extra.exploration.verdict import Failure, Verdict
from cfepy.extra.exploration.worker import READY
from cfepy.interpreter.child_pipes import popen_options
from cfepy.interpreter.host_system import signal_number
from cfepy.reading.resources import import_path, python_command
from cfepy.rtos import Stopwatch, allowed_cpus, kept_waiting_ns
from cfepy.schedules import Schedule
from cfepy.status import UsageError
from cfepy.units import NS_PER_S

PROCESS_DIED = "process died"
LONGEST_S = 120.0
BATCH_NS = NS_PER_S // 10  # wall time that a batch should take
MOST = 64  # schedules in a batch
TRIES = 2  # deaths alone until a schedule is blamed; one death may be the computer's fault
FALSE_STARTS = 3  # successive workers that do not start before the crew gives up
LAST_WORDS = 4000  # bytes of a worker's standard error
START_NS = 60 * NS_PER_S  # wall time that a worker may take to start
ABORT_S = 5.0  # wall time to write down the stacks

_GROUP: dict[str, Any] = {"process_group": 0}
"""A group of its own for the worker and its children; Ctrl-C on the terminal goes to this process alone."""
if sys.platform == "win32":
    _GROUP = {"creationflags": subprocess.CREATE_NEW_PROCESS_GROUP}


def usable_cpus() -> int:
    """Return the number of CPUs that this process may use."""
    return len(allowed_cpus())


def _let_append(file: IO[bytes]) -> None:
    """Make all writes to a file append. On Windows, they continue after zeros if the file was emptied."""
    if os.name == "posix":
        import fcntl

        fcntl.fcntl(file, fcntl.F_SETFL, os.O_APPEND)


class Worker:
    """A worker process, as its parent process uses it.

    Args:
        trial: pickled.
        folder: working directory; None for the one of this process.
        environ: its variables, without those that Python needs; None takes those of this process.

    Attributes:
        connection: to it; readable when it has answered or is dead.
        jobs: the batch that it works on, empty when it is idle.
        ready: it has started and has the trial.
    """

    def __init__(self, trial: bytes, folder: Path | None = None, environ: Mapping[str, str] | None = None) -> None:
        self.jobs: list[Job] = []
        self.ready = False
        self._watch, self._waited_ns = Stopwatch(), 0
        self._said = tempfile.TemporaryFile(buffering=0)  # noqa: SIM115  # as long as the worker
        self._scratch = tempfile.TemporaryDirectory(prefix="cfepy-worker-")  # a killed worker cannot clean up
        _let_append(self._said)  # so that it can be emptied while the worker writes
        self.connection, theirs = Pipe()
        with theirs:
            self._process = subprocess.Popen(
                [*python_command(), "-m", __package__ + ".worker", str(theirs.fileno()), self._scratch.name],
                stdin=subprocess.DEVNULL,
                stdout=self._said,
                stderr=self._said,
                cwd=folder,
                env={
                    "PYTHONHASHSEED": "0",
                    **(os.environ if environ is None else environ),
                    "PYTHONPATH": import_path(),
                },
                **popen_options(theirs.fileno()),
                **_GROUP,
            )
        self._send(trial)

    @property
    def pid(self) -> int:
        """Its process id."""
        return self._process.pid

    @property
    def busy_ns(self) -> int:
        """Wall time since it began with its batch."""
        return self._watch.elapsed_ns()

    @property
    def own_ns(self) -> int:
        """The same without the time in which other programs kept it from the CPU."""
        return self.busy_ns - max(0, kept_waiting_ns(self.pid) - self._waited_ns)

    def give(self, jobs: Sequence[Job]) -> None:
        """Give it a batch."""
        self.jobs = list(jobs)
        self._begin()
        self._send(pickle.dumps(self.jobs))

    def _begin(self) -> None:
        self._watch, self._waited_ns = Stopwatch(), kept_waiting_ns(self.pid)

    def answer(self) -> list[NumberedVerdict]:
        """Return its verdicts; an empty list for its message that it has started.

        Raises:
            EOFError: it is dead.
            UsageError: the trial cannot run.
        """
        try:
            answer = self.connection.recv()
        except OSError:
            raise EOFError from None
        if answer == READY:
            self.ready = True
            self._begin()
            return []
        if isinstance(answer, UsageError):
            raise answer
        self.jobs = []
        self._said.truncate(0)
        found: list[NumberedVerdict] = answer
        return found

    def fate(self) -> str:
        """Return how it ended. Call this only when it is about to end."""
        status = self._process.wait()
        if status >= 0:
            return f"ended with exit status {status}"
        name = signal.Signals(-status).name
        return f"killed by {name}" + (" (no memory left?)" if name == "SIGKILL" else "")

    def last_words(self) -> str:
        """Return the end of its standard error output."""
        size = self._said.seek(0, os.SEEK_END)
        self._said.seek(max(0, size - LAST_WORDS))
        return self._said.read().decode("utf-8", "replace").strip("\0 \t\r\n")

    def abort(self) -> None:
        """Abort it, so that it writes its stacks before it ends."""
        self._end_with("SIGABRT")
        try:
            self._process.wait(ABORT_S)
        except subprocess.TimeoutExpired:
            self._end_with("SIGKILL")

    def close(self) -> None:
        """End it and its child processes."""
        self._end_with("SIGKILL")
        self._process.wait()
        self.connection.close()
        self._said.close()
        self._scratch.cleanup()

    def _end_with(self, name: str) -> None:
        """Send a signal to it and its child processes; on Windows, which has neither, end it."""
        if os.name == "nt":
            self._process.kill()
            return
        try:
            os.killpg(self.pid, signal_number(name))
        except ProcessLookupError:
            pass  # all of them have ended

    def _send(self, data: bytes) -> None:
        try:
            self.connection.send_bytes(data)
        except OSError:
            pass  # it is dead; the caller notices when it waits for the answer


class Processes:
    """A crew of worker processes.

    Args:
        count: number of processes; None for one on each CPU.
        longest_s: wall time in seconds that a schedule may take.
        folder: working directory of workers; None for the one of this process.
        environ: variables of workers; None takes those of this process.
    """

    def __init__(
        self,
        count: int | None = None,
        longest_s: float = LONGEST_S,
        folder: Path | None = None,
        environ: Mapping[str, str] | None = None,
    ) -> None:
        self._count = usable_cpus() if count is None else count
        self._died: Callable[[Any, str, str], Any] = died
        self._longest_ns = round(longest_s * NS_PER_S)
        self._folder = folder
        self._environ = environ
        self.workers: list[Worker] = []
        self._alone: deque[Job] = deque()  # to be tried without others
        self._deaths: Counter[int] = Counter()
        self._false_starts = 0
        self._batch = 1

    def run(self, trial: Experiment, take: Take) -> Generator[NumberedVerdict, None, None]:
        pickled = pickle.dumps(trial)
        self._died = trial.died if isinstance(trial, Lot) else died
        try:
            while True:
                self._hand_out(pickled, take)
                if not any(worker.jobs for worker in self.workers):
                    return
                yield from self._wait()
        finally:
            for worker in [worker for worker in self.workers if worker.jobs]:
                self._drop(worker)  # its verdicts are no longer wanted
            self._alone.clear()

    def close(self) -> None:
        for worker in list(self.workers):
            self._drop(worker)

    def _hand_out(self, trial: bytes, take: Take) -> None:
        idle = [worker for worker in self.workers if not worker.jobs]
        while idle or len(self.workers) < self._count:
            jobs = [self._alone.popleft()] if self._alone else take(self._batch)
            if not jobs:
                return
            worker = idle.pop() if idle else self._start(trial)
            worker.give(jobs)

    def _start(self, trial: bytes) -> Worker:
        worker = Worker(trial, self._folder, self._environ)
        self.workers.append(worker)
        return worker

    def _drop(self, worker: Worker) -> None:
        self.workers.remove(worker)
        worker.close()

    def _wait(self) -> Iterator[NumberedVerdict]:
        """Wait for an answer or the end of a worker. Yields the verdicts."""
        busy = {worker.connection: worker for worker in self.workers}
        left_ns = min(self._left_ns(worker) for worker in self.workers if worker.jobs)
        for connection in wait(list(busy), max(0, left_ns) / NS_PER_S):
            worker = busy.pop(connection)  # type: ignore[call-overload]  # one of those that went in
            yield from self._listen(worker)
        for worker in busy.values():
            if worker.jobs and self._left_ns(worker) <= 0:
                worker.abort()
                yield from self._bury(worker, f"did not end within {self._longest_ns / NS_PER_S:g} s of wall time")

    def _left_ns(self, worker: Worker) -> int:
        longest_ns = self._longest_ns if worker.ready else START_NS
        left_ns = longest_ns - worker.busy_ns
        return left_ns if left_ns > 0 else longest_ns - worker.own_ns

    def _listen(self, worker: Worker) -> list[NumberedVerdict]:
        busy_ns, size = worker.busy_ns, len(worker.jobs)
        try:
            results = worker.answer()
        except EOFError:
            return self._bury(worker, worker.fate())
        self._false_starts = 0
        if results:
            fitting = size * BATCH_NS // max(busy_ns, 1)
            self._batch = max(1, min(fitting, 2 * self._batch, MOST))
        return results

    def _bury(self, worker: Worker, fate: str) -> list[NumberedVerdict]:
        """Remove a dead worker. Returns verdicts on the schedules to blame; the others are tried again.

        Raises:
            UsageError: workers do not start at all.
        """
        jobs, ready, words = worker.jobs, worker.ready, worker.last_words()
        self._drop(worker)
        if not ready:
            self._false_starts += 1
            if self._false_starts >= FALSE_STARTS:
                raise UsageError(f"worker processes do not start: {fate}\n{words}")
        elif len(jobs) == 1:
            self._deaths[jobs[0][0]] += 1
        blamed = [job for job in jobs if self._deaths[job[0]] >= TRIES]
        self._alone.extend(job for job in jobs if job not in blamed)
        return [(number, self._died(schedule, fate, words)) for number, schedule in blamed]


def died(schedule: Schedule, fate: str, words: str) -> Verdict:
    """Return the verdict on a schedule that ended the process in which it was flown.

    Args:
        schedule: the schedule.
        fate: how the process ended.
        words: the last output of the process, such as its stacks.
    """
    return Verdict(schedule, (Failure(PROCESS_DIED, "", f"the process died: {fate}", detail=words),))
