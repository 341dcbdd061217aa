"""The handle that apps get while schedules are explored: others may get in at every call of a service.

Only calls that come in through the handle are scheduling points, not those that services make among themselves: what a
service does is one step, as in NASA's code, which guards its tables with locks.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import fields, replace
from types import MethodType
from typing import Any

from cfepy.app import Cfe
from cfepy.rtos import ExploringKernel, Kernel


class _Pointed:
    """A service, with a scheduling point before each call of a method. What was called once is kept."""

    def __init__(self, service: Any, kernel: ExploringKernel) -> None:
        vars(self).update(_service=service, _kernel=kernel)

    def __getattr__(self, name: str) -> Any:
        value = getattr(self._service, name)
        if not isinstance(value, MethodType):
            return value
        call = vars(self)[name] = _pointed(self._service, name, self._kernel.point)
        return call

    def __setattr__(self, name: str, value: Any) -> None:
        vars(self).pop(name, None)
        setattr(self._service, name, value)


def _pointed(service: Any, name: str, point: Callable[[], None]) -> Callable[..., Any]:
    def call(*args: Any, **options: Any) -> Any:
        point()
        return getattr(service, name)(*args, **options)

    return call


def handle_for_apps(cfe: Cfe, kernel: Kernel) -> Cfe:
    """The services as apps call them: themselves, unless the kernel explores."""
    if not isinstance(kernel, ExploringKernel):
        return cfe
    services: dict[str, Any] = {
        field.name: _Pointed(getattr(cfe, field.name), kernel) for field in fields(cfe) if field.name != "msg"
    }
    return replace(cfe, **services)
