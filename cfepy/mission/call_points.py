"""The handle for apps while schedules are explored: other tasks may run before every call of a service.

They may also run after a call that gives something away, before the app continues. This reveals an app that still uses
what it gave away. Only calls through the handle are scheduling points. Calls between services are not: a service call
is one step, because NASA's code protects its tables with locks.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import fields, replace
from inspect import isroutine
from typing import Any

from cfepy.app import Cfe
from cfepy.interpreter.own_code import called_as
from cfepy.rtos import Kernel
from cfepy.schedules import ExploringKernel

GIVING = frozenset(
    {
        "bin_sem_flush",
        "bin_sem_give",
        "cond_var_broadcast",
        "cond_var_signal",
        "cond_var_unlock",
        "count_sem_give",
        "mut_sem_give",
        "queue_put",
        "release_address",
        "release_addresses",
        "rw_lock_read_give",
        "rw_lock_write_give",
        "transmit_buffer",
        "transmit_msg",
    }
)
"""Calls that release a lock, a table or a message."""
RECORDS = frozenset({"unsent"})
"""Methods that only write to the trace and are not calls of an application."""


class _Pointed:
    """A service with scheduling points around its methods; each wrapped method is cached."""

    def __init__(self, service: Any, kernel: ExploringKernel) -> None:
        vars(self).update(_service=service, _kernel=kernel)

    def __getattr__(self, name: str) -> Any:
        value = getattr(self._service, name)
        if name in RECORDS or getattr(value, "__self__", None) is not self._service or not isroutine(value):
            return value
        wrap = _giving if name in GIVING else _pointed
        call = vars(self)[name] = wrap(self._service, name, self._kernel)
        return call

    def __setattr__(self, name: str, value: Any) -> None:
        vars(self).pop(name, None)
        setattr(self._service, name, value)


def _pointed(service: Any, name: str, kernel: ExploringKernel) -> Callable[..., Any]:
    point = kernel.point

    def call(*args: Any, **options: Any) -> Any:
        point()
        observer = kernel.observer
        if observer is None:
            return getattr(service, name)(*args, **options)
        observer.called(service, name, args)
        try:
            result = getattr(service, name)(*args, **options)
        except BaseException:
            observer.failed(service, name)
            raise
        observer.returned(service, name, args, result)
        return result

    return called_as(call, name)


def _giving(service: Any, name: str, kernel: ExploringKernel) -> Callable[..., Any]:
    call = _pointed(service, name, kernel)

    def give(*args: Any, **options: Any) -> Any:
        result = call(*args, **options)
        kernel.point()
        return result

    return called_as(give, name)


def with_call_points(cfe: Cfe, kernel: Kernel) -> Cfe:
    """Return the services as apps call them, under a kernel with a policy."""
    assert isinstance(kernel, ExploringKernel)
    services: dict[str, Any] = {
        field.name: _Pointed(getattr(cfe, field.name), kernel) for field in fields(cfe) if field.name != "msg"
    }
    return replace(cfe, **services)
