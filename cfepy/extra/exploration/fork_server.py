"""Fork server: runs that are the same up to an instant share that part, and a process is forked for each.

    this process  --schedules-->  template (has run up to the instant)  --fork-->  one child a schedule
         ^------------------------------------ answers ------------------------------------'

Only tasks on greenlets can be forked, because a fork copies one thread only, and the system must have fork. A
`ForkingJudge` flies the schedules of a trial this way when they differ from an instant on (`from=600ms`), and each
separately otherwise. `ForkingNotes` does the same for runs that are shrunk. The results are the same as without forks.
"""

from __future__ import annotations

import gc
import os
import pickle
import warnings
from collections.abc import Callable, Sequence
from contextlib import AbstractContextManager, nullcontext
from dataclasses import replace
from typing import Any, Generic, TypeVar

from cfepy.attachment import Attachment
from cfepy.extra.exploration.campaign import Experiment, judge
from cfepy.extra.exploration.made_moves import MoveNotingPolicy
from cfepy.extra.exploration.shrink import NotedFlight, fly_noting
from cfepy.extra.exploration.trial import Trial, told_as
from cfepy.extra.exploration.verdict import Verdict
from cfepy.interpreter.garbage import freeze
from cfepy.interpreter.host_system import end_process
from cfepy.mission import Mission
from cfepy.rtos import GREENLET, Decision, From, Policy, task_kind
from cfepy.schedules import Schedule

LENGTH_BYTES = 8


class LateSchedule:
    """A stand-in for a `Schedule` that becomes known only at the instant from which schedules differ."""

    def __init__(self, server: ForkServer) -> None:
        self._gate = _Gate(server)

    @property
    def decided(self) -> Schedule:
        """The schedule; fifo until one is decided."""
        return self._gate.schedule

    def text(self) -> str:
        return self.decided.text()

    def policy(self) -> Policy:
        return self._gate

    def watched(self) -> Attachment:
        """Return an attachment that turns off the stall watch while the template waits for schedules."""
        return _Pause(self._gate)


class _Gate(Policy):
    """Decides as fifo until schedules differ. Then this process waits for schedules, and its children follow them."""

    def __init__(self, server: ForkServer) -> None:
        super().__init__(*server.options.settings)
        self._server = server
        self._from_ns = server.options.from_ns
        self._early = From(Policy(), server.options.from_ns)
        self._inner: Policy | None = None
        self.schedule = Schedule()
        self.paused: Callable[[], AbstractContextManager[None]] = nullcontext

    def choose(self, decision: Decision) -> int:
        if self._inner is None:
            if decision.now < self._from_ns:
                return self._early.choose(decision)
            with self.paused():
                self.schedule = self._server.wait_for_schedule()
            self._inner = self.schedule.policy() or Policy()
        return self._inner.choose(decision)


class _Pause(Attachment):
    def __init__(self, gate: _Gate) -> None:
        self._gate = gate

    def begin(self, mission: Mission) -> None:
        self._gate.paused = mission.stall_watch.paused


class ForkServer:
    """Runs a body under schedules that are the same up to an instant.

    Args:
        body: does the whole run with a schedule that is decided late, on greenlets; its value can be pickled.
        options: a schedule with the options (`from`, `any`, `hold`, `connect`) that all schedules have.

    Raises:
        ValueError: `options` has no `from`, or this system has no fork.
    """

    def __init__(self, body: Callable[[LateSchedule], Any], options: Schedule) -> None:
        if not options.from_ns:
            raise ValueError("missing option `from` of the schedule; add it, such as from=600ms")
        if not hasattr(os, "fork"):
            raise ValueError("this system cannot fork processes, so a fork server is not available")
        self.options = options.at({})
        self._body = body
        self._requests = _Channel()
        self._answers = _Channel()
        self._in_child = False
        self._template = _fork()
        if not self._template:
            self._be_template()
        self._requests.stop_receiving()  # so that a broken pipe shows that the template has ended
        self._answers.stop_sending()

    def run(self, schedule: Schedule) -> Any:
        """Return the value of the body under a schedule. If the run does not end, this call does not return.

        Raises:
            ValueError: the schedule has other options.
            ChildProcessError: the process of this run ended without an answer.
            Exception: the exception that the body raised.
        """
        if schedule.at({}) != self.options:
            raise ValueError(f"schedule {schedule} must have the options of {self.options}")
        try:
            self._requests.send(schedule)
            answer = self._answers.receive()
        except BrokenPipeError:  # the template has ended
            answer = None
        if answer is None:
            raise ChildProcessError(f"the run under schedule {schedule} ended without an answer")
        value, error = answer
        if error is not None:
            raise error
        return value

    def close(self) -> None:
        """End the template. Do not call `run` after that."""
        self._requests.stop_sending()
        os.waitpid(self._template, 0)
        self._answers.stop_receiving()

    # -- in the template and its children --------------------------------------------------------------------------

    def _be_template(self) -> None:
        """Run the body up to the instant and, in each child, to its end. This process and its children end here."""
        status = 1
        gc.disable()  # else it visits all objects at the end of each short-lived child
        try:
            self._requests.stop_sending()
            answer = self._outcome()
            if self._in_child:
                self._answers.send(answer)
            else:  # the run ended without a decision after the instant, so all runs are the same
                while self._requests.receive() is not None:
                    self._answers.send(answer)
            status = 0
        finally:
            end_process(status)

    def _outcome(self) -> tuple[Any, BaseException | None]:
        try:
            return self._body(LateSchedule(self)), None
        except BaseException as error:
            return None, error

    def wait_for_schedule(self) -> Schedule:
        """Return the schedule in each child. The template stays in this call until the server is closed."""
        gc.collect()
        freeze()  # a garbage collection in a child would have to copy these objects
        while (schedule := self._requests.receive()) is not None:
            child = _fork()
            if not child:
                self._in_child = True
                return schedule  # type: ignore[no-any-return]  # a value from `run`
            _, status = os.waitpid(child, 0)
            if status:
                self._answers.send(None)
        end_process(0)


class _Channel:
    """A one-way channel between processes, for values that can be pickled."""

    def __init__(self) -> None:
        self._reader, self._writer = os.pipe()

    def send(self, value: Any) -> None:
        """Send a value, whole or not at all."""
        packed = pickle.dumps(value)
        data = memoryview(len(packed).to_bytes(LENGTH_BYTES, "little") + packed)
        while data:
            data = data[os.write(self._writer, data) :]

    def receive(self) -> Any:
        """Return the next value, or None if the other end is closed."""
        head = self._read(LENGTH_BYTES)
        return pickle.loads(self._read(int.from_bytes(head, "little"))) if head else None

    def _read(self, count: int) -> bytes:
        data = b""
        while len(data) < count and (more := os.read(self._reader, count - len(data))):
            data += more
        return data

    def stop_sending(self) -> None:
        """Close the sending end; this process only receives."""
        os.close(self._writer)

    def stop_receiving(self) -> None:
        """Close the receiving end; this process only sends."""
        os.close(self._reader)


def _fork() -> int:
    with warnings.catch_warnings():  # Python 3.12 warns of other threads: here they only watch, and hold no lock
        warnings.simplefilter("ignore", DeprecationWarning)
        return os.fork()


T = TypeVar("T")

Fly = Callable[[Trial, Schedule, Policy | None, Sequence[Attachment]], T]
"""Flies a trial under a schedule, with a policy in its place (None for its own) and other observers."""


class Forks(Generic[T]):
    """Flies trials under schedules, in forked processes if possible. `close` ends the processes that wait.

    Args:
        fly: a flight, whose value can be pickled.
    """

    def __init__(self, fly: Fly[T]) -> None:
        self._fly = fly
        self._servers: dict[tuple[int, Schedule], ForkServer] = {}

    def fly(self, trial: Trial, schedule: Schedule) -> T:
        """Return the value of the flight. A forked flight raises the errors of `ForkServer.run`."""
        if not self.can_fork(trial, schedule):
            return self._fly(trial, schedule, None, ())
        options = schedule.at({})

        def body(late: LateSchedule) -> T:
            return self._fly(trial, options, late.policy(), [late.watched()])

        key = id(trial), options  # which lives as long as its server
        if key not in self._servers:
            self._servers[key] = ForkServer(body, options)
        found: T = self._servers[key].run(schedule)
        return found

    @staticmethod
    def can_fork(trial: object, schedule: Schedule) -> bool:
        """Return True if the schedule begins at an instant, tasks are greenlets, and the system can fork."""
        has_instant = schedule.from_ns and isinstance(trial, Trial) and task_kind(trial.plan.tasks).name == GREENLET
        return bool(has_instant and hasattr(os, "fork"))

    def close(self) -> None:
        """End the processes that wait for schedules, the last one first: it has copies of the pipes of the others."""
        for server in reversed(self._servers.values()):
            server.close()
        self._servers.clear()


class ForkingJudge:
    """Gives verdicts. `close` ends its processes.

    Args:
        trial: the trial.
    """

    def __init__(self, trial: Experiment) -> None:
        self._trial = trial
        self._forks = Forks(_verdict)

    def judge(self, schedule: Schedule) -> Verdict:
        """Return the verdict on a schedule; see `cfepy.extra.exploration.campaign.judge`."""
        trial = self._trial
        if not isinstance(trial, Trial) or not Forks.can_fork(trial, schedule):
            return judge(trial, schedule)
        try:
            verdict = self._forks.fly(trial, schedule)
        except ChildProcessError:
            return judge(trial, schedule)  # the same end happens here, where it is examined
        return replace(verdict, schedule=told_as(schedule, dict(verdict.deviations)))

    def close(self) -> None:
        """End the processes that wait for schedules."""
        self._forks.close()


class ForkingNotes:
    """Flies runs for shrinking (`cfepy.extra.exploration.shrink.fly_noting`). `close` ends its processes."""

    def __init__(self) -> None:
        self._forks = Forks(_noted)

    def fly(self, trial: Trial, schedule: Schedule) -> NotedFlight:
        """Return a flight with its moves."""
        try:
            noted = self._forks.fly(trial, schedule)
        except ChildProcessError:
            return fly_noting(trial, schedule)
        return noted._replace(verdict=replace(noted.verdict, schedule=schedule))

    def close(self) -> None:
        """End the processes that wait for schedules."""
        self._forks.close()


def _noted(trial: Trial, schedule: Schedule, policy: Policy | None, attachments: Sequence[Attachment]) -> NotedFlight:
    recorder = MoveNotingPolicy(policy or schedule.policy() or Policy())
    return NotedFlight.of(trial.fly(schedule, attachments, recorder).verdict, recorder)


def _verdict(trial: Trial, schedule: Schedule, policy: Policy | None, attachments: Sequence[Attachment]) -> Verdict:
    return trial.fly(schedule, attachments, policy).verdict
