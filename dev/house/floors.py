"""The floors (layers) of the house, lowest first, and the violations of their order.

A package imports only from floors below its own. Packages on one floor are peers and do not import each other, except
for the modules at the bottom, which count as one package.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

from dev.house.tree import Tree

FLOORS: tuple[tuple[str, ...], ...] = (
    (
        *("status", "ids", "units", "trace", "ports", "core_app", "plugins", "config", "reading", "writing"),
        "interpreter",
    ),
    ("rtos",),
    ("osal",),
    ("psp", "msg", "fs"),
    ("es", "sb", "evs", "time", "tbl"),
    ("app", "attachment"),
    ("schedules", "types"),
    ("nodes",),
    ("rospy_shim", "apps"),
    ("rclpy_shim",),
    ("mission",),
    ("ground",),
    ("monitors",),
    ("script", "faults"),
    ("pilot",),
    ("journal",),
    ("io",),
    ("flight",),
    ("testing",),
    ("cli", "__main__"),
    (
        "extra",
        "c",
        "convert",
        "exploration",
        "reports",
        "debugger",
        "viewers",
        "ros_host",
        "profiler",
        "attach",
        "dictionaries",
        "procedures",
    ),
    ("__init__",),  # the public API of the library
)
LEVEL = {part: level for level, floor in enumerate(FLOORS) for part in floor}
GROUND_FLOOR = 0

PEERS_THAT_MEET: dict[tuple[str, str], str] = {
    ("convert", "c"): "nodes in C++ are compiled as applications in C are",
    ("dictionaries", "c"): "the packets of a compiled application are in its debug data",
    ("reports", "c"): "a report about a board reads how large compiled code is",
    ("exploration", "reports"): "a sweep is drawn with the curves of reports",
    ("procedures", "exploration"): "the cause of a racy test is found as the cause of any failure of a run",
    ("__main__", "cli"): "`python -m cfepy` is the command",
}
"""Who may import a peer, and why."""

APPS_STAND_ON = "app"
"""Apps see cFE as their handle shows it: nothing above this part, though they stand on a higher floor."""


class Arrow(NamedTuple):
    """An import from one module to another, and where it is."""

    source: str
    target: str
    where: str

    def __str__(self) -> str:
        return f"{self.where}: {self.source} imports {self.target}"


def allowed(source: str, target: str) -> bool:
    """Return whether a part may import another."""
    if source == target or (source, target) in PEERS_THAT_MEET:
        return True
    top = LEVEL[APPS_STAND_ON] if source == "apps" else LEVEL[source]
    if LEVEL[source] == LEVEL[target] == GROUND_FLOOR:
        return True
    return LEVEL[target] < top or (source == "apps" and LEVEL[target] == top)


def wrong_arrows(tree: Tree) -> Iterator[Arrow]:
    """Yield imports that go up or to a peer."""
    for module in tree.modules.values():
        for name, imports in tree.arrows(module).items():
            if not allowed(module.part, tree.modules[name].part):
                yield Arrow(module.name, name, f"{module.where}:{imports[0].line}")


def homeless(tree: Tree) -> list[str]:
    """Return parts that have no place on a floor."""
    return sorted({module.part for module in tree.modules.values()} - set(LEVEL))
