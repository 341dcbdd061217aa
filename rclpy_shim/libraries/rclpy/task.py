"""`Future` and `Task`: results that come later, and callbacks that an executor runs (rclpy.task)."""

from __future__ import annotations

import inspect
import warnings
from collections.abc import Callable, Generator, Sequence
from typing import Any


class Future:
    """A result that comes later; a coroutine that an executor runs can await it.

    Args:
        executor: runs the callbacks of `add_done_callback`; None runs them at once.
    """

    def __init__(self, *, executor: Any = None) -> None:
        self._is_done = False
        self._is_cancelled = False
        self._result: Any = None
        self._exception: BaseException | None = None
        self._was_read = False
        self._callbacks: list[Callable[[Any], object]] = []
        self._executor = executor

    def __await__(self) -> Generator[Any, None, Any]:
        while self._is_pending():
            yield self
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
        """Return True if it is done or cancelled."""
        return not self._is_pending()

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
        if self._is_pending():
            self._callbacks.append(callback)
        else:
            self._call(callback)

    def remove_done_callback(self, callback: Callable[[Any], object]) -> bool:
        """Remove such a function. Returns True if it was there."""
        if callback not in self._callbacks:
            return False
        self._callbacks.remove(callback)
        return True

    def _set_executor(self, executor: Any) -> None:
        self._executor = executor

    def _finish(self) -> None:
        callbacks, self._callbacks = self._callbacks, []
        for callback in callbacks:
            self._call(callback)

    def _call(self, callback: Callable[[Any], object]) -> None:
        if self._executor is not None:
            self._executor.create_task(callback, self)
            return
        try:
            callback(self)
        except Exception as error:
            warnings.warn(f"Unhandled exception in done callback: {error}", RuntimeWarning, stacklevel=2)


class Task(Future):
    """A function or a coroutine that an executor runs, a coroutine piece by piece.

    Args:
        handler: the function, coroutine function or coroutine.
        args: its arguments.
        kwargs: its named arguments.
        executor: runs the callbacks of `add_done_callback`.
    """

    def __init__(
        self,
        handler: Any,
        args: Sequence[Any] | None = None,
        kwargs: dict[str, Any] | None = None,
        executor: Any = None,
    ) -> None:
        super().__init__(executor=executor)
        self._args, self._kwargs = tuple(args or ()), dict(kwargs or {})
        is_function = _is_coroutine_function(handler)
        self._is_coroutine = is_function or inspect.iscoroutine(handler)
        self._handler = handler(*self._args, **self._kwargs) if is_function else handler
        self._awaited: Any = None
        self._is_running = False
        self.on_end: Callable[[], object] | None = None  # called once, at the end

    def __call__(self) -> None:
        """Run the function, or the coroutine until it waits."""
        if self._is_running or not self._is_pending():
            return
        self._is_running = True
        try:
            if self._is_coroutine:
                self._awaited = self._handler.send(None)
            else:
                self.set_result(self._handler(*self._args, **self._kwargs))
        except StopIteration as end:
            if not self._is_coroutine:
                self.set_exception(end)
            else:
                self.set_result(end.value)
        except Exception as error:
            self.set_exception(error)
        finally:
            self._is_running = False
            if self.on_end is not None and not self._is_pending():
                ended, self.on_end = self.on_end, None
                ended()

    def cancel(self) -> None:
        """Cancel it; a coroutine is closed."""
        if self._is_pending() and self._is_coroutine and not self._is_running:
            self._handler.close()
        super().cancel()

    def executing(self) -> bool:
        """Return True while it runs."""
        return self._is_running

    def is_ready(self) -> bool:
        """Return True if it can run now: the future that its coroutine awaits is done."""
        if self._is_running or not self._is_pending():
            return False
        return not isinstance(self._awaited, Future) or self._awaited.done()


def _is_coroutine_function(handler: Any) -> bool:
    """Return True for a coroutine function; the usual case of a function or method needs no search."""
    code = getattr(handler, "__code__", None)
    return bool(code.co_flags & inspect.CO_COROUTINE) if code is not None else inspect.iscoroutinefunction(handler)
