"""Executors: they wait for work of their nodes and run the callbacks (rclpy.executors).

An executor takes the work of a node in the order timers, subscriptions, guard conditions, clients, services. All that
is ready at one look is run before it looks again.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import partial
from typing import Any

from rclpy import _seam
from rclpy.context import Context, get_default_context
from rclpy.exceptions import NotInitializedException
from rclpy.task import Future, Task
from rclpy.utilities import S_TO_NS

Work = tuple[Task, Any, Any]
"""A task, its entity and its node; the latter two are None for a task of the program."""


class ShutdownException(Exception):
    """The executor is shut down."""


class ExternalShutdownException(Exception):
    """The context was shut down."""


class TimeoutException(Exception):
    """There was no work in time."""


class ConditionReachedException(Exception):
    """A condition became true."""


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
        self._batch: Iterator[tuple[Any, Any]] = iter(())
        self._is_shut_down = False

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
        _seam.ring()
        return task

    def shutdown(self, timeout_sec: float | None = None) -> bool:
        """Run no more callbacks. Returns True."""
        self._is_shut_down = True
        for node in self._nodes:
            node._forget_executor(self)
        self._nodes = []
        _seam.ring()
        return True

    def add_node(self, node: Any) -> bool:
        """Run the callbacks of a node, too. Returns False if it has them already."""
        if node in self._nodes:
            return False
        self._nodes.append(node)
        node.executor = self
        _seam.ring()
        return True

    def remove_node(self, node: Any) -> None:
        """Run the callbacks of a node no more."""
        if node in self._nodes:
            self._nodes.remove(node)
            node._forget_executor(self)
            _seam.ring()

    def wake(self) -> None:
        """Let the executor look for work now."""
        _seam.ring()

    def get_nodes(self) -> list[Any]:
        """Return its nodes."""
        return list(self._nodes)

    def spin(self) -> None:
        """Run callbacks until the context is shut down.

        Raises:
            ExternalShutdownException: the context was shut down during a wait.
        """
        while self._context.ok() and not self._is_shut_down:
            self.spin_once()

    def spin_until_future_complete(self, future: Future, timeout_sec: float | None = None) -> None:
        """Run callbacks until a future is done.

        Args:
            future: the future.
            timeout_sec: longest time in s; None or a negative one waits without limit.
        """
        future.add_done_callback(lambda done: _seam.ring())
        end = _end_of(timeout_sec)
        while self._context.ok() and not future.done() and not self._is_shut_down:
            left = None if end is None else end - _seam.steady_ns()
            if left is not None and left <= 0:
                return
            self._spin_once(left, future.done)

    def spin_once(self, timeout_sec: float | None = None) -> None:
        """Run one callback, or wait for one.

        Args:
            timeout_sec: longest time in s; None or a negative one waits without limit.

        Raises:
            ExternalShutdownException: the context was shut down during the wait.
        """
        end = _end_of(timeout_sec)
        self._spin_once(None if end is None else end - _seam.steady_ns(), lambda: False)

    def spin_once_until_future_complete(self, future: Future, timeout_sec: float | None = None) -> None:
        """Run one callback, or wait for one, or until a future is done; see `spin_once`."""
        future.add_done_callback(lambda done: _seam.ring())
        end = _end_of(timeout_sec)
        self._spin_once(None if end is None else end - _seam.steady_ns(), future.done)

    def _spin_once(self, left_ns: int | None, condition: Callable[[], bool]) -> None:
        try:
            task, entity, node = self._next_work(left_ns, condition)
        except (ShutdownException, TimeoutException, ConditionReachedException):
            return
        self._run(task, entity, node)

    def _run(self, task: Task, entity: Any, node: Any) -> None:
        task()
        if not task.done():
            self._tasks.append((task, entity, node))
            return
        error = task.exception()
        if error is not None:
            raise error

    # -- looking for work --------------------------------------------------------------------------------------------

    def wait_for_ready_callbacks(
        self,
        timeout_sec: float | None = None,
        nodes: list[Any] | None = None,
        condition: Callable[[], bool] = lambda: False,
    ) -> Work:
        """Wait for work, which an executor of the program's own runs by calling the task.

        Args:
            timeout_sec: longest time in s; None or a negative one waits without limit.
            nodes: must be None, for the nodes of this executor.
            condition: ends the wait when it is true.

        Returns:
            The task, its entity and its node. The work has been taken from its entity.

        Raises:
            ShutdownException, ExternalShutdownException, TimeoutException, ConditionReachedException: there is none.
            NotImplementedError: `nodes` is given.
        """
        if nodes is not None:
            raise NotImplementedError("cfepy does not have executors that wait for some of their nodes yet")
        end = _end_of(timeout_sec)
        return self._next_work(None if end is None else end - _seam.steady_ns(), condition)

    def _next_work(self, left_ns: int | None, condition: Callable[[], bool]) -> Work:
        """Wait for work, at most so many ns; see `wait_for_ready_callbacks`."""
        end = None if left_ns is None else _seam.steady_ns() + left_ns
        while True:
            if self._is_shut_down:
                raise ShutdownException
            if not self._context.ok():
                raise ExternalShutdownException
            if condition():
                raise ConditionReachedException
            seen = _seam.program.waiting.rings
            found = self._ready_task() or self._next_of_batch()
            if found is not None:
                return found
            self._batch = self._look()
            found = self._next_of_batch()
            if found is not None:
                return found
            now = _seam.steady_ns()
            if end is not None and now >= end:
                raise TimeoutException
            self._wait(seen, now, end)

    def _wait(self, seen: int, now: int, end: int | None) -> None:
        times = [timer.due_ns for node in self._nodes for timer in node.timers if self._may_run(timer)]
        if end is not None:
            times.append(end)
        waitables = []
        for node in self._nodes:
            for kind in (node.subscriptions, node.guards, node.clients, node.services):
                for each in kind:
                    if each.callback_group.can_execute(each):
                        waitables.append(each)
                    else:
                        each.callback_group.is_awaited = True
        _seam.program.wait(seen, waitables, min(times) - now if times else None)

    @staticmethod
    def _may_run(timer: Any) -> bool:
        if timer.is_canceled():
            return False
        may_run = bool(timer.callback_group.can_execute(timer))
        timer.callback_group.is_awaited |= not may_run
        return may_run

    def _ready_task(self) -> Work | None:
        for index, (task, _, _) in enumerate(self._tasks):
            if task.done() or task.is_ready():
                return self._tasks.pop(index)
        return None

    def _next_of_batch(self) -> Work | None:
        for entity, node in self._batch:
            if node not in self._nodes or not entity.callback_group.can_execute(entity):
                continue
            task = self._take(entity)
            if task is not None:
                entity.callback_group.beginning_execution(entity)
                task.on_end = partial(self._end_work, entity)
                return task, entity, node
        return None

    @staticmethod
    def _end_work(entity: Any) -> None:
        """Note the end of a callback; others of its group may run now, which only other threads wait for."""
        entity.callback_group.ending_execution(entity)
        if entity.callback_group.is_awaited:
            entity.callback_group.is_awaited = False
            _seam.ring()

    def _look(self) -> Iterator[tuple[Any, Any]]:
        """Return the entities with work, in the order of their turns."""
        return iter(
            [
                (each, node)
                for node in self._nodes
                for kind in (node.timers, node.subscriptions, node.guards, node.clients, node.services)
                for each in kind
                if each.ready()
            ]
        )

    def _take(self, entity: Any) -> Task | None:
        """Take the work of an entity."""
        taken = entity.take()
        if taken is None:
            return None
        maker = getattr(entity, "srv_type", None)
        if maker is None:
            return Task(entity.callback or _nothing, taken, None, self)
        if hasattr(entity, "send_response"):
            return Task(_answer(entity, *taken), None, None, self)
        return Task(_finish, (self, *taken), None, self)


def _nothing() -> None:
    """Stand for the callback of a guard condition or timer without one."""


def _finish(executor: Executor, future: Future, response: Any, error: str) -> None:
    """Finish the future of a call."""
    future._set_executor(executor)
    if error:
        future.set_exception(RuntimeError(error))
    else:
        future.set_result(response)


async def _answer(service: Any, number: int, request: Any) -> None:
    """Call the callback of a service and send the response."""
    response = service.callback(request, service.srv_type.Response())
    if hasattr(response, "__await__"):
        response = await response
    service.send_response(response, number)


def _end_of(timeout_sec: float | None) -> int | None:
    if timeout_sec is None or timeout_sec < 0:
        return None
    return int(_seam.steady_ns()) + int(timeout_sec * S_TO_NS)


class SingleThreadedExecutor(Executor):
    """Runs callbacks in the thread that spins."""


class MultiThreadedExecutor(Executor):
    """Refuses: callbacks in several threads are not there yet."""

    def __init__(self, num_threads: int | None = None, *, context: Context | None = None) -> None:
        raise NotImplementedError(
            "cfepy does not have the MultiThreadedExecutor for nodes of ROS 2 yet; use a SingleThreadedExecutor"
        )
