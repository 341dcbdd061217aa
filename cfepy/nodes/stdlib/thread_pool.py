"""`multiprocessing.pool` of a node: `ThreadPool`, which uses the node's own threads and no processes.

This file is executed in each node. `cfepy.nodes.refused_modules` refuses processes. The semantics are those of Python's
library reference, "multiprocessing.pool".
"""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import Future, ThreadPoolExecutor
from concurrent.futures import TimeoutError as FutureTimeoutError
from multiprocessing import Pool, TimeoutError
from types import TracebackType
from typing import Any

__all__ = ["ApplyResult", "AsyncResult", "MapResult", "Pool", "ThreadPool"]

Done = Callable[[Any], object] | None


class AsyncResult:
    """Result of a call that may not have ended.

    Args:
        parts: futures of the calls; several for `map`.
        single: whether there is one part, whose result is the whole result.
        callback: called with the result once it is available.
        error_callback: called with the exception if a call fails.
    """

    def __init__(self, parts: list[Future[Any]], single: bool, callback: Done, error_callback: Done) -> None:
        self._parts, self._single = parts, single
        self._callback, self._error_callback = callback, error_callback
        self._missing = len(parts)
        self._lock, self._event = threading.Lock(), threading.Event()
        if not parts:
            self._finish()
        for part in parts:
            part.add_done_callback(self._count)

    def _count(self, part: Future[Any]) -> None:
        with self._lock:
            self._missing -= 1
            last = self._missing == 0
        if last:
            self._finish()

    def _finish(self) -> None:
        error = self._error()
        if error is None and self._callback is not None:
            self._callback(self._value())
        elif error is not None and self._error_callback is not None:
            self._error_callback(error)
        self._event.set()

    def _error(self) -> BaseException | None:
        return next((error for part in self._parts if (error := part.exception()) is not None), None)

    def _value(self) -> Any:
        found = [part.result() for part in self._parts]
        return found[0] if self._single else found

    def ready(self) -> bool:
        """Return whether the result is there."""
        return self._event.is_set()

    def successful(self) -> bool:
        """Return whether the call ended without an exception.

        Raises:
            ValueError: if the result is not available yet.
        """
        if not self.ready():
            raise ValueError(f"{self!r} not ready")
        return self._error() is None

    def wait(self, timeout: float | None = None) -> None:
        """Wait for the result, at most so many s."""
        self._event.wait(timeout)

    def get(self, timeout: float | None = None) -> Any:
        """Return the result, or raise the exception of the call.

        Args:
            timeout: longest wait in seconds; None for no limit.

        Raises:
            multiprocessing.TimeoutError: if the result is not available in time.
        """
        if not self._event.wait(timeout):
            raise TimeoutError
        error = self._error()
        if error is not None:
            raise error
        return self._value()


ApplyResult = MapResult = AsyncResult


class _Results(Iterator[Any]):
    """Iterator returned by `imap`: results one by one."""

    def __init__(self, parts: Iterable[Future[Any]]) -> None:
        self._parts = iter(parts)

    def __next__(self) -> Any:
        return next(self._parts).result()

    def next(self, timeout: float | None = None) -> Any:
        """Return the next result, waiting at most `timeout` seconds, None for no limit.

        Raises:
            multiprocessing.TimeoutError: if the result is not available in time.
        """
        try:
            return next(self._parts).result(timeout)
        except FutureTimeoutError:
            raise TimeoutError from None


class ThreadPool:
    """Pool of threads.

    Args:
        processes: number of threads; None for one, because there is one processor.
        initializer: called in each thread with `initargs`.
        initargs: arguments of `initializer`.
    """

    def __init__(
        self,
        processes: int | None = None,
        initializer: Callable[..., object] | None = None,
        initargs: Iterable[Any] = (),
    ) -> None:
        if processes is not None and processes < 1:
            raise ValueError("Number of processes must be at least 1")
        self._running = True
        self._threads = ThreadPoolExecutor(processes or 1, initializer=initializer, initargs=tuple(initargs))

    def _submit(self, func: Callable[..., Any], args: Iterable[Any], kwds: dict[str, Any]) -> Future[Any]:
        if not self._running:
            raise ValueError("Pool not running")
        return self._threads.submit(func, *args, **kwds)

    def apply_async(
        self,
        func: Callable[..., Any],
        args: Iterable[Any] = (),
        kwds: dict[str, Any] | None = None,
        callback: Done = None,
        error_callback: Done = None,
    ) -> AsyncResult:
        """Call a function in a thread."""
        return AsyncResult([self._submit(func, args, kwds or {})], True, callback, error_callback)

    def starmap_async(
        self,
        func: Callable[..., Any],
        iterable: Iterable[Iterable[Any]],
        chunksize: int | None = None,
        callback: Done = None,
        error_callback: Done = None,
    ) -> AsyncResult:
        """Call a function for each tuple of arguments."""
        return AsyncResult([self._submit(func, args, {}) for args in iterable], False, callback, error_callback)

    def map_async(
        self,
        func: Callable[..., Any],
        iterable: Iterable[Any],
        chunksize: int | None = None,
        callback: Done = None,
        error_callback: Done = None,
    ) -> AsyncResult:
        """Call a function for each item."""
        return self.starmap_async(func, ((item,) for item in iterable), chunksize, callback, error_callback)

    def apply(self, func: Callable[..., Any], args: Iterable[Any] = (), kwds: dict[str, Any] | None = None) -> Any:
        """As `apply_async`, and wait for the result."""
        return self.apply_async(func, args, kwds).get()

    def map(self, func: Callable[..., Any], iterable: Iterable[Any], chunksize: int | None = None) -> list[Any]:
        """As `map_async`, and wait for the results."""
        return list(self.map_async(func, iterable).get())

    def starmap(
        self, func: Callable[..., Any], iterable: Iterable[Iterable[Any]], chunksize: int | None = None
    ) -> list[Any]:
        """As `starmap_async`, and wait for the results."""
        return list(self.starmap_async(func, iterable).get())

    def imap(self, func: Callable[..., Any], iterable: Iterable[Any], chunksize: int = 1) -> _Results:
        """Return an iterator over the results, in the order of the items."""
        return _Results([self._submit(func, (item,), {}) for item in iterable])

    def imap_unordered(self, func: Callable[..., Any], iterable: Iterable[Any], chunksize: int = 1) -> _Results:
        """Return an iterator over the results, in the order of the items, which is one of the allowed orders."""
        return self.imap(func, iterable)

    def close(self) -> None:
        """Accept no more work."""
        self._running = False

    def terminate(self) -> None:
        """Accept no more work, and drop work that has not started."""
        self._running = False
        self._threads.shutdown(wait=False, cancel_futures=True)

    def join(self) -> None:
        """Wait for the threads.

        Raises:
            ValueError: the pool still takes work.
        """
        if self._running:
            raise ValueError("Pool is still running")
        self._threads.shutdown()

    def __enter__(self) -> ThreadPool:
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, at: TracebackType | None) -> None:
        self.terminate()
