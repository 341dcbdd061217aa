"""`Future` and `Task`: results that come later, and callbacks that an executor runs (rclpy.task)."""

from __future__ import annotations

import inspect
import warnings
from collections.abc import Callable, Generator, Sequence
from typing import Any


class Future:
    """A result that comes later; a coroutine that an executor runs can await it.

    A coroutine that awaits it continues at the executor's next round. The result alone does not begin one, as in
    rclpy 9.1: a result that another thread sets is not seen before something else wakes the executor.

    Args:
        executor: runs the callbacks of `add_done_callback`; None runs them at once.
    """

    _is_done = False
    _is_cancelled = False
    _result: Any = None
    _exception: BaseException | None = None
    _was_read = False
    _callbacks: list[Callable[[Any], object]] | None = None
    _executor: Any = None

    def __init__(self, *, executor: Any = None) -> None:
        self._executor = executor

    def __await__(self) -> Generator[None, None, Any]:
        while self._is_pending():
            yield
        return self.result()

    def _is_pending(self) -> bool:
        return not self._is_done and not self._is_cancelled

    def cancel(self) -> None:
        """Cancel it, unless it is done."""
        if self._is_pending():
            self._is_cancelled = True
            self._finish()

    def cancelled(self) -> bool:
        """Return True if it was cancelled."""
        return self._is_cancelled

    def done(self) -> bool:
        """Return True if it has a result or an exception; a cancelled one is not done in rclpy 9.1."""
        return self._is_done

    def result(self) -> Any:
        """Return the result, or None if there is none yet.

        Raises:
            BaseException: the exception that was set.
        """
        error = self.exception()
        if error is not None:
            raise error
        return self._result

    def exception(self) -> BaseException | None:
        """Return the exception that was set, or None."""
        self._was_read = True
        return self._exception

    def set_result(self, result: Any) -> None:
        """Set the result."""
        self._result = result
        self._is_done, self._is_cancelled = True, False
        self._finish()

    def set_exception(self, exception: BaseException) -> None:
        """Set an exception as the result."""
        self._exception = exception
        self._was_read = False
        self._is_done, self._is_cancelled = True, False
        self._finish()

    def add_done_callback(self, callback: Callable[[Any], object]) -> None:
        """Add a function that is called with this object when it is done; at once if it is."""
        if not self._is_pending():
            if self._executor is not None:
                self._executor.create_task(callback, self)
            else:
                callback(self)
        elif self._callbacks is None:
            self._callbacks = [callback]
        else:
            self._callbacks.append(callback)

    def remove_done_callback(self, callback: Callable[[Any], object]) -> bool:
        """Remove such a function. Returns True if it was there."""
        if self._callbacks is None or callback not in self._callbacks:
            return False
        self._callbacks.remove(callback)
        return True

    def _set_executor(self, executor: Any) -> None:
        self._executor = executor

    def _finish(self) -> None:
        callbacks, self._callbacks = self._callbacks, None
        for callback in callbacks or ():
            if self._executor is not None:
                self._executor.create_task(callback, self)
                continue
            try:
                callback(self)
            except Exception as error:
                warnings.warn(f"Unhandled exception in done callback: {error}", stacklevel=2)


class Task(Future):
    """A function or a coroutine that an executor runs, a coroutine piece by piece.

    Args:
        handler: the function, coroutine function or coroutine.
        args: its arguments.
        kwargs: its named arguments.
        executor: runs the callbacks of `add_done_callback`.
    """

    _is_running = False
    _coroutine: Any = None

    def __init__(
        self,
        handler: Any,
        args: Sequence[Any] | None = None,
        kwargs: dict[str, Any] | None = None,
        executor: Any = None,
    ) -> None:
        super().__init__(executor=executor)
        self._args, self._kwargs = tuple(args or ()), dict(kwargs or {})
        self._handler = handler
        if inspect.iscoroutinefunction(handler):
            self._coroutine = handler(*self._args, **self._kwargs)
        elif inspect.iscoroutine(handler):
            self._coroutine = handler

    def __call__(self) -> None:
        """Run the function, or the coroutine until it waits."""
        if self._is_running or not self._is_pending():
            return
        self._is_running = True
        try:
            self._run()
        finally:
            self._is_running = False

    def _run(self) -> None:
        if self._coroutine is not None:
            self._resume()
            return
        try:
            result = self._handler(*self._args, **self._kwargs)
        except Exception as error:
            self._end(None, error)
        else:
            self._end(result, None)

    def _resume(self) -> None:
        """Run the coroutine until it waits, or to its end."""
        try:
            self._coroutine.send(None)
        except StopIteration as end:
            self._end(end.value, None)
        except Exception as error:
            self._end(None, error)

    def _end(self, result: Any, error: Exception | None) -> None:
        if error is None:
            self.set_result(result)
        else:
            self.set_exception(error)

    def _finish_with(self, result: Any) -> None:
        """End without having run."""
        self.set_result(result)

    def executing(self) -> bool:
        """Return True while it runs."""
        return self._is_running
