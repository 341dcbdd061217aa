"""Executors: they wait for work of their nodes and run the callbacks (rclpy.executors).

An executor works in rounds, as rclpy 9.1 does. A round resumes each coroutine that is not done, once. Then it waits,
and takes all entities that are ready at that moment: waitables first, then for each node timers, subscriptions, guard
conditions, clients and services. A message is taken when its callback begins, not before.
"""

from __future__ import annotations

import inspect
import threading
import warnings
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from typing import Any

from rclpy import _seam
from rclpy.context import Context, get_default_context
from rclpy.exceptions import NotInitializedException
from rclpy.task import Future, Task
from rclpy.utilities import timeout_sec_to_nsec

_USUAL_THREADS = 4
Work = tuple[Task, Any, Any]
"""A task, its entity and its node; the latter two are None for a task of the program."""


class TimeoutException(Exception):
    """There was no work in time."""


class ShutdownException(Exception):
    """The executor is shut down."""


class ExternalShutdownException(Exception):
    """The context was shut down."""


class ConditionReachedException(Exception):
    """A condition became true."""


class TimeoutObject:
    """A time-out that changes while an executor spins.

    Args:
        timeout: the time in s.
    """

    def __init__(self, timeout: float) -> None:
        self.timeout = timeout


class EntityTask(Task):
    """One callback of an entity. It takes the work of the entity when it begins.

    Args:
        entity: the entity.
        executor: its executor.
        coroutine: its work, if that was taken already.
    """

    def __init__(self, entity: Any, executor: Executor, coroutine: Any = None) -> None:
        self._executor = executor
        self._entity = entity
        self._coroutine = coroutine
        self._has_begun = coroutine is not None
        if coroutine is None:
            entity._executor_event = True

    def _run(self) -> None:
        entity = self._entity
        if not self._has_begun:
            bell = self._executor._bell
            group = entity.callback_group
            if self._executor._is_shut_down or (group is not None and not group.beginning_execution(entity)):
                entity._executor_event = False
                bell.ring()
                self._finish_with(None)
                return
            self._has_begun = True
            try:
                work = entity.take_work(self._executor)
            finally:
                entity._executor_event = False
                bell.note_work()
            if work is None:
                self._end(None, None)
                return
            function, arguments = work
            if not _is_coroutine_function(function):
                try:
                    function(*arguments)
                except Exception as error:
                    self._end(None, error)
                except BaseException:
                    self._release()
                    raise
                else:
                    self._end(None, None)
                return
            self._coroutine = function(*arguments)
        self._resume()

    def _end(self, result: Any, error: Exception | None) -> None:
        self._release()
        super()._end(result, error)

    def _release(self) -> None:
        """Let the other callbacks of the group run."""
        group = self._entity.callback_group
        if group is not None:
            group.ending_execution(self._entity)
        self._executor._bell.note_work()


class Executor:
    """Base of the executors.

    Args:
        context: its context; None takes the default one.

    Raises:
        NotInitializedException: the context is not initialized.
    """

    def __init__(self, *, context: Context | None = None) -> None:
        self._context = context or get_default_context()
        if not self._context.ok():
            raise NotInitializedException
        self._nodes: list[Any] = []
        self._tasks: list[Work] = []
        self._is_shut_down = False
        self._bell = _seam.program.waiting.bell()
        self._rounds: Iterator[Work] | None = None
        self._asked: tuple[Any, ...] = ()
        self._entities: list[Any] = []
        self._known_version = -1
        self._context.on_shutdown(self.wake)

    @property
    def context(self) -> Context:
        """Its context."""
        return self._context

    def create_future(self) -> Future:
        """Return a future whose callbacks this executor runs."""
        return Future(executor=self)

    def create_task(self, callback: Any, *args: Any, **kwargs: Any) -> Task:
        """Run a function or coroutine soon.

        Returns:
            A task with its result.
        """
        task = Task(callback, args, kwargs, executor=self)
        self._tasks.append((task, None, None))
        self._bell.ring()
        return task

    def shutdown(self, timeout_sec: float | None = None) -> bool:
        """Run no more callbacks. Returns True at once; callbacks that run are not waited for, as in rclpy 9.1.

        Args:
            timeout_sec: accepted.
        """
        self._is_shut_down = True
        self._bell.ring()
        self._nodes = []
        self._known_version = -1
        self._rounds = None
        return True

    def add_node(self, node: Any) -> bool:
        """Run the callbacks of a node, too. Returns False if it has them already."""
        if node in self._nodes:
            return False
        self._nodes.append(node)
        self._known_version = -1
        node.executor = self
        self._bell.ring()
        return True

    def remove_node(self, node: Any) -> None:
        """Run the callbacks of a node no more."""
        if node in self._nodes:
            self._nodes.remove(node)
            self._known_version = -1
            self._bell.ring()

    def wake(self) -> None:
        """Let the executor look for work now."""
        self._bell.ring()

    def get_nodes(self) -> list[Any]:
        """Return its nodes."""
        return list(self._nodes)

    def spin(self) -> None:
        """Run callbacks until the context is shut down.

        Raises:
            ExternalShutdownException: the context was shut down during a wait.
        """
        while self._context.is_alive() and not self._is_shut_down:
            self.spin_once()

    def spin_until_future_complete(self, future: Future, timeout_sec: float | None = None) -> None:
        """Run callbacks until a future is done.

        Args:
            future: the future.
            timeout_sec: longest time in s; None or a negative one waits without limit.
        """
        future.add_done_callback(lambda done: self.wake())
        is_limited = timeout_sec is not None and timeout_sec >= 0
        left = TimeoutObject(timeout_sec or 0.0) if is_limited else None
        end = _seam.steady_ns() + timeout_sec_to_nsec(timeout_sec)
        while self._context.ok() and not future.done() and not future.cancelled() and not self._is_shut_down:
            self._spin_once_until_future_complete(future, left)
            if left is not None:
                now = _seam.steady_ns()
                if now >= end:
                    return
                left.timeout = (end - now) / 1e9

    def spin_once(self, timeout_sec: float | None = None) -> None:
        """Run one callback, or wait for one.

        Args:
            timeout_sec: longest time in s; None or a negative one waits without limit.

        Raises:
            ExternalShutdownException: the context was shut down during the wait.
        """
        raise NotImplementedError

    def spin_once_until_future_complete(self, future: Future, timeout_sec: Any = None) -> None:
        """Run one callback, or wait for one, or until a future is done; see `spin_once`."""
        future.add_done_callback(lambda done: self.wake())
        self._spin_once_until_future_complete(future, timeout_sec)

    def _spin_once_until_future_complete(self, future: Future, timeout_sec: Any = None) -> None:
        raise NotImplementedError

    # -- looking for work --------------------------------------------------------------------------------------------

    def wait_for_ready_callbacks(
        self,
        timeout_sec: float | TimeoutObject | None = None,
        nodes: list[Any] | None = None,
        condition: Callable[[], bool] | None = None,
    ) -> Work:
        """Wait for work, which an executor of the program's own runs by calling the task.

        Args:
            timeout_sec: longest time in s; None or a negative one waits without limit.
            nodes: the nodes that count; None for all of this executor.
            condition: ends the wait when it is true.

        Returns:
            The task, its entity and its node.

        Raises:
            ShutdownException, ExternalShutdownException, TimeoutException, ConditionReachedException: there is none.
        """
        asked = (timeout_sec, nodes, condition)
        while True:
            if self._rounds is None or self._asked != asked:
                self._asked = asked
                limit = timeout_sec.timeout if isinstance(timeout_sec, TimeoutObject) else timeout_sec
                self._rounds = self._work(timeout_sec_to_nsec(limit), nodes, condition)
            found = next(self._rounds, None)
            if found is not None:
                return found
            self._rounds = None

    def _work(self, limit_ns: int, nodes: list[Any] | None, condition: Callable[[], bool] | None) -> Iterator[Work]:
        """Yield the work of one round, after rounds without work; without a limit in time, of all rounds."""
        is_endless = limit_ns < 0
        end = None if is_endless else _seam.steady_ns() + limit_ns
        waiting = _seam.program.waiting
        has_worked = False
        while (is_endless or not has_worked) and not self._is_shut_down and (condition is None or not condition()):
            if self._tasks:
                for work in self._tasks[:]:
                    task, _, node = work
                    if not task._is_running and not task.done() and self._counts(node, nodes):
                        has_worked = True
                        yield work
                self._tasks = [each for each in self._tasks if each[0]._is_pending()]
            if not self._tasks and condition is None:
                self._bell.worked = False  # another round would do nothing
            candidates = self._candidates(nodes)
            ready, end_reached = waiting.wait(self._bell, candidates, end, self._known_version)
            if self._is_shut_down:
                raise ShutdownException
            if not self._context.is_alive():
                raise ExternalShutdownException
            for entity in ready:
                if entity.is_still_ready() and entity.callback_group.can_execute(entity):
                    has_worked = True
                    yield self._begun(entity)
            if end_reached:
                raise TimeoutException
        if self._is_shut_down:
            raise ShutdownException
        if condition is not None and condition():
            raise ConditionReachedException

    def _counts(self, node: Any, nodes: list[Any] | None) -> bool:
        return node is None or node in (self._nodes if nodes is None else nodes)

    def _begun(self, entity: Any) -> Work:
        task = EntityTask(entity, self)
        work = (task, entity, entity._of_node)
        self._tasks.append(work)
        return work

    def can_execute(self, entity: Any) -> bool:
        """Return True if the callback of an entity may begin now."""
        group = entity.callback_group
        return not entity._executor_event and group is not None and bool(group.can_execute(entity))

    def _candidates(self, nodes: list[Any] | None) -> list[Any]:
        """Return the entities that may begin, in the order of their turns."""
        version = _seam.program.waiting.version
        if self._known_version != version:
            self._known_version = version
            self._entities = [each for node in self._nodes for each in node._waitables if each.may_have_work()]
            for node in self._nodes:
                for kind in (node._timers, node._subscriptions, node._guards, node._clients, node._services):
                    self._entities += [each for each in kind if each.may_have_work()]
        return [
            each
            for each in self._entities
            if not each._executor_event
            and each.callback_group.can_execute(each)
            and (nodes is None or each._of_node in nodes)
        ]

    def __enter__(self) -> Executor:
        return self

    def __exit__(self, *error: object) -> None:
        self.shutdown()


def _is_coroutine_function(function: Any) -> bool:
    """Return True for a coroutine function; the usual case of a function or method needs no search."""
    code = getattr(function, "__code__", None)
    return bool(code.co_flags & inspect.CO_COROUTINE) if code is not None else inspect.iscoroutinefunction(function)


class SingleThreadedExecutor(Executor):
    """Runs callbacks in the thread that spins."""

    _is_spinning = False

    def _spin_once(self, timeout_sec: Any, condition: Callable[[], bool] | None = None) -> None:
        self._is_spinning = True
        try:
            task, entity, _ = self.wait_for_ready_callbacks(timeout_sec, None, condition)
        except (ShutdownException, TimeoutException, ConditionReachedException):
            return
        finally:
            self._is_spinning = False
        if task is None:
            self._run_entity(entity)
            return
        task()
        error = task.exception()
        if error is not None:
            raise error

    def spin_while_alive(self) -> None:
        """Run callbacks until the context is shut down, as calls of `spin_once` do, and faster.

        Raises:
            ExternalShutdownException: the context was shut down during a wait.
        """
        context, bell, waiting = self._context, self._bell, _seam.program.waiting
        while context.is_alive():
            if self._tasks or self._rounds is not None or self._is_shut_down:
                self.spin_once()  # with coroutines, or in the midst of a round
                continue
            bell.worked = False
            ready, _ = waiting.wait(bell, self._candidates(None), None, self._known_version)
            if not self._is_shut_down and not context.is_alive():
                raise ExternalShutdownException
            for entity in ready:
                if entity.is_still_ready() and entity.callback_group.can_execute(entity):
                    self._run_entity(entity)
                    if not context.is_alive() or self._is_shut_down:
                        break

    def _begun(self, entity: Any) -> Work:
        return (None, entity, None) if self._is_spinning else super()._begun(entity)  # type: ignore[return-value]

    def _run_entity(self, entity: Any) -> None:
        """Run the callback of an entity at once. Only a coroutine needs a task, which is faster for all others."""
        place = len(self._tasks)
        group = entity.callback_group
        if not group.beginning_execution(entity):
            return
        is_over = True
        try:
            work = entity.take_work(self)
            if work is None:
                return
            function, arguments = work
            if not _is_coroutine_function(function):
                function(*arguments)
                return
            is_over = False
        finally:
            if is_over:
                group.ending_execution(entity)
            self._bell.worked = True
        task = EntityTask(entity, self, function(*arguments))
        task()
        if task._is_pending():
            self._tasks.insert(place, (task, entity, entity._of_node))
        error = task.exception()
        if error is not None:
            raise error

    def spin_once(self, timeout_sec: float | None = None) -> None:
        """Run one callback, or wait for one; see `Executor.spin_once`."""
        self._spin_once(timeout_sec)

    def _spin_once_until_future_complete(self, future: Future, timeout_sec: Any = None) -> None:
        self._spin_once(timeout_sec, future.done)


class MultiThreadedExecutor(Executor):
    """Runs callbacks in a pool of threads. An exception of a callback is raised by a later turn of `spin_once`.

    Args:
        num_threads: number of threads; None takes 4, as on a computer with so many CPUs.
        context: its context; None takes the default one.
    """

    def __init__(self, num_threads: int | None = None, *, context: Context | None = None) -> None:
        super().__init__(context=context)
        if num_threads is None:
            num_threads = _USUAL_THREADS
        if num_threads == 1:
            warnings.warn(
                "MultiThreadedExecutor is used with a single thread.\nUse the SingleThreadedExecutor instead.",
                stacklevel=2,
            )
        self._futures: list[Task] = []
        self._pool = ThreadPoolExecutor(num_threads)
        self._lock = threading.Lock()

    def _spin_once(self, timeout_sec: Any, condition: Callable[[], bool] | None = None) -> None:
        try:
            task, _, _ = self.wait_for_ready_callbacks(timeout_sec, None, condition)
        except (ExternalShutdownException, ShutdownException, TimeoutException, ConditionReachedException):
            return
        self._pool.submit(task)
        self._futures.append(task)
        for each in self._futures[:]:
            if each.done():
                self._futures.remove(each)
                each.result()

    def spin_once(self, timeout_sec: float | None = None) -> None:
        """Start one callback, or wait for one; see `Executor.spin_once`."""
        self._spin_once(timeout_sec)

    def _spin_once_until_future_complete(self, future: Future, timeout_sec: Any = None) -> None:
        self._spin_once(timeout_sec, future.done)

    def shutdown(self, timeout_sec: float | None = None, *, wait_for_threads: bool = True) -> bool:
        """Begin no more callbacks.

        Args:
            timeout_sec: accepted.
            wait_for_threads: wait until the callbacks that run have ended.

        Returns:
            True.
        """
        is_done = super().shutdown(timeout_sec)
        self._pool.shutdown(wait=wait_for_threads)
        return is_done
