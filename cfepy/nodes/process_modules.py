"""Standard modules whose settings belong to a whole process, which a node has not: `gc`, `locale` and `resource`.

The kernel collects garbage at fixed virtual times; were a node to switch the collector on, finalizers would run at
times that depend on the host. Settings are remembered for the node that made them, and have no effect.
"""

from __future__ import annotations

import gc
import locale
from types import ModuleType
from typing import TYPE_CHECKING, Any

from cfepy.nodes.synth import proxy, rebind

if TYPE_CHECKING:
    from cfepy.nodes.universe import Universe


def gc_module(universe: Universe) -> ModuleType:
    """`gc`: `collect` collects, all else is as if it did."""
    state = {"enabled": True, "debug": 0}
    threshold = [700, 10, 10]

    def set_enabled(value: bool) -> None:
        state["enabled"] = value

    def set_threshold(*values: int) -> None:
        threshold[: len(values)] = values

    def set_debug(flags: int) -> None:
        state["debug"] = flags

    return proxy(
        gc,
        callbacks=[],
        disable=lambda: set_enabled(False),
        enable=lambda: set_enabled(True),
        freeze=lambda: None,
        get_debug=lambda: state["debug"],
        get_threshold=lambda: tuple(threshold),
        isenabled=lambda: state["enabled"],
        set_debug=set_debug,
        set_threshold=set_threshold,
        unfreeze=lambda: None,
    )


def locale_module(universe: Universe) -> ModuleType:
    """`locale`: numbers and dates are written as in the locale "C", whatever a node sets."""
    chosen: dict[int, str] = {}

    def setlocale(category: int, wanted: Any = None) -> str:
        if wanted is not None:
            name = wanted if isinstance(wanted, str) else locale.normalize(".".join(filter(None, wanted)))
            chosen[category] = name or "C.UTF-8"
        return chosen.get(category, chosen.get(locale.LC_ALL, "C"))

    return rebind(locale, setlocale=setlocale, resetlocale=lambda category=locale.LC_ALL: chosen.pop(category, None))


def resource_module(universe: Universe) -> ModuleType:
    """`resource`: the processor time that the node used; there are no limits, and setting them does nothing."""
    import resource

    def getrusage(who: int) -> Any:
        own = universe.cpu_ns / 1e9 if who != resource.RUSAGE_CHILDREN else 0.0
        return resource.struct_rusage((own, *[0] * 15))

    unlimited = (resource.RLIM_INFINITY, resource.RLIM_INFINITY)
    return proxy(
        resource,
        getrlimit=lambda kind: unlimited,
        getrusage=getrusage,
        prlimit=lambda pid, kind, limits=None: unlimited,
        setrlimit=lambda kind, limits: None,
    )
