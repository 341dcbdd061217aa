"""Timing: the best of a few repeats, and the other load of the machine."""

from __future__ import annotations

import os
import platform
import sys
from collections.abc import Callable
from time import perf_counter

from cfepy.rtos import GREENLET, THREAD, has_greenlets

REPEATS = 5


def rate(run: Callable[[], int], repeats: int = REPEATS) -> float:
    """Return the highest rate seen.

    Args:
        run: does something and returns how often it did it.
        repeats: how many times it is run.

    Returns:
        Times a second.
    """
    best = 0.0
    for _ in range(repeats):
        begin = perf_counter()
        count = run()
        best = max(best, count / (perf_counter() - begin))
    return best


def contexts_here() -> tuple[str, ...]:
    """Return the task contexts of this installation."""
    return (THREAD, GREENLET) if has_greenlets() else (THREAD,)


def machine() -> dict[str, object]:
    """Return the machine of the measurement, and its current load."""
    load = os.getloadavg() if hasattr(os, "getloadavg") else (0.0, 0.0, 0.0)
    return {
        "python": platform.python_version(),
        "optimised_build": "--enable-optimizations" in (_config_args() or ""),
        "implementation": platform.python_implementation(),
        "system": f"{platform.system()} {platform.release()}",
        "cpus": os.cpu_count(),
        "cpu": _cpu_name(),
        "load_1_5_15_min": [round(value, 2) for value in load],
        "arguments": sys.argv[1:],
    }


def _config_args() -> str | None:
    import sysconfig

    value = sysconfig.get_config_var("CONFIG_ARGS")
    return value if isinstance(value, str) else None


def _cpu_name() -> str:
    try:
        with open("/proc/cpuinfo", encoding="utf-8") as info:
            return next((line.partition(":")[2].strip() for line in info if line.startswith("model name")), "")
    except OSError:
        return platform.processor()
