"""Schedules are tested with kernels on both task contexts, as kernels are."""

from __future__ import annotations

from tests.rtos.conftest import context, kernel, log, make_kernel

__all__ = ["context", "kernel", "log", "make_kernel"]
