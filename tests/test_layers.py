"""The layer rule: a package imports only from those to its left, and the host's clock stays outside the simulation."""

from __future__ import annotations

import ast
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]

LAYERS = [
    {
        "status",
        "ids",
        "trace",
        "console",
        "versions",
        "config",
        "config_api",
        "ports",
        "core_app",
        "resources",
        "__init__",
    },
    {"rtos"},
    {"osal"},
    {"psp", "msg", "fs"},
    {"es", "sb", "evs", "time", "tbl"},
    {"app", "attachment"},
    {"nodes", "apps", "faults"},
    {"mission"},
    {"journal"},
    {"io", "explore", "reports", "debugger"},
    {"testing"},
    {"cli", "__main__"},
]
LEVEL = {name: level for level, names in enumerate(LAYERS) for name in names}
SERVICES = {"es", "sb", "evs", "time", "tbl"}
HOST_MODULES = {"time", "random", "threading", "_thread", "socket", "select", "datetime", "secrets", "uuid", "asyncio"}
MAY_TOUCH_THE_HOST = {
    "rtos": "task contexts, pacing and the stall watch are made of the host's threads and clock",
    "io": "joins the virtual network of a paced run to real sockets on the loopback interface",
    "explore": "spreads trials over processes and computers, sees when one of them ends, and tells how far it has come",
    "faults": "draws from random streams that follow from the seed of the run",
    "nodes": "puts virtual modules in the place of these, and takes constants and types from the real ones",
}


LIBRARIES = ROOT / "rospy_shim" / "libraries"
INNER = ROOT / "rospy_shim" / "inner"  # modules of rospy that are code of nodes
TOOLS = ROOT / "rospy_shim" / "roslaunch" / "tools"  # nodes that launch files take for granted


def sources(package: str) -> list[Path]:
    """Modules of a package; libraries and tools are code of nodes, and stand below a rule of their own."""
    nodes = (LIBRARIES, TOOLS, INNER)
    return sorted(path for path in (ROOT / package).rglob("*.py") if not any(map(path.is_relative_to, nodes)))


def imported(path: Path) -> Iterator[str]:
    """Full names of what a module imports, relative imports resolved."""
    package = ".".join(path.relative_to(ROOT).with_suffix("").parts[:-1])
    for node in ast.walk(ast.parse(path.read_text())):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            base = ".".join(package.split(".")[: len(package.split(".")) - node.level + 1]) if node.level else ""
            module = ".".join(part for part in (base, node.module or "") if part)
            yield from (f"{module}.{alias.name}" for alias in node.names)


def part_of(name: str) -> str:
    """cfepy.sb.bus.SoftwareBus is of part sb; cfepy itself of __init__."""
    parts = name.split(".")
    return parts[1] if len(parts) > 1 and parts[1] in LEVEL else "__init__"


def own_part(path: Path) -> str:
    inside = path.relative_to(ROOT / "cfepy")
    return inside.parts[0] if len(inside.parts) > 1 else inside.stem


@pytest.mark.parametrize("path", sources("cfepy"), ids=lambda path: str(path.relative_to(ROOT)))
def test_imports_go_left(path: Path) -> None:
    if "templates" in path.parts:
        return
    part = own_part(path)
    assert part in LEVEL, f"{part} has no place in the layer rule; give it one in this test and in docs/design.md"
    for name in imported(path):
        if name.split(".")[0] == "cfepy":
            other = part_of(name)
            assert LEVEL[other] <= LEVEL[part], f"{part} must not import {name}: it stands further right"
            if part in SERVICES and other in SERVICES:
                assert part == other, f"{part} must not import {name}: services meet in cfepy.ports only"
        assert not name.startswith("rospy_shim"), f"{name}: a mission loads ROS by name"


@pytest.mark.parametrize("path", sources("apps"), ids=lambda path: str(path.relative_to(ROOT)))
def test_apps_stand_on_the_app_handle(path: Path) -> None:
    for name in imported(path):
        if name.split(".")[0] == "cfepy":
            assert LEVEL[part_of(name)] <= LEVEL["app"], f"an app must not import {name}"


@pytest.mark.parametrize("path", sources("rospy_shim"), ids=lambda path: str(path.relative_to(ROOT)))
def test_rospy_stands_on_app_and_nodes(path: Path) -> None:
    for name in imported(path):
        if name.split(".")[0] == "cfepy":
            assert LEVEL[part_of(name)] <= LEVEL["nodes"], f"rospy_shim must not import {name}"


@pytest.mark.parametrize(
    "path",
    [*sources("cfepy"), *sources("rospy_shim"), *sources("apps")],
    ids=lambda path: str(path.relative_to(ROOT)),
)
def test_only_the_kernel_knows_the_host(path: Path) -> None:
    if path.is_relative_to(ROOT / "cfepy") and own_part(path) in MAY_TOUCH_THE_HOST:
        return
    if "templates" in path.parts:
        return
    touched = {name.split(".")[0] for name in imported(path)} & HOST_MODULES
    assert not touched, f"{touched} belong to the host; only {', '.join(MAY_TOUCH_THE_HOST)} may use them"


@pytest.mark.parametrize(
    "path",
    sorted([*LIBRARIES.rglob("*.py"), *TOOLS.glob("*.py"), *INNER.rglob("*.py")]),
    ids=lambda path: str(path.relative_to(ROOT / "rospy_shim")),
)
def test_libraries_are_code_of_nodes(path: Path) -> None:
    """They run in a node's universe, with its rospy and its clock: they import what a node does, none of the house."""
    others = {folder.name for folder in LIBRARIES.iterdir()} | {path.stem for path in TOOLS.glob("*.py")}
    for name in imported(path):
        top, _, rest = name.removeprefix("rospy_shim.libraries.").partition(".")
        known = top in sys.stdlib_module_names or top in others or top in ("rospy", "genpy", "lz4", "numpy", "yaml")
        assert known or rest.split(".")[0] in ("msg", "srv"), f"a library must not import {name}"


def test_numpy_and_test_libraries_are_imported_lazily() -> None:
    for path in [*sources("cfepy"), *sources("rospy_shim")]:
        for node in ast.parse(path.read_text()).body:
            if isinstance(node, ast.Import | ast.ImportFrom):
                names = [alias.name for alias in node.names] if isinstance(node, ast.Import) else [node.module or ""]
                heavy = {name.split(".")[0] for name in names} & {"numpy", "pytest", "hypothesis", "rich", "yaml"}
                assert not heavy or is_imported_late(path), f"{path}: import {heavy} where it is used"


def is_imported_late(path: Path) -> bool:
    """The display is itself imported only when it is needed; so are the tools for tests, by tests."""
    return (path.name in {"display.py", "tables.py"} and "cli" in path.parts) or "testing" in path.parts
