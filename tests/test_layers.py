"""The rules of the house: who imports whom, no circles, one name for one thing, and who may touch the host.

Floors and figures are those of `dev.house`. Numbers here hold what has been reached: lower one when its figure has
become lower, and never raise one.
"""

from __future__ import annotations

import ast
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

from dev.house import figures
from dev.house.floors import homeless, wrong_arrows
from dev.house.tree import ROOT, Module, Tree, the_tree

LONGEST = 600  # lines of a module: more than that is more than one idea
PAST_FACES = 61  # pairs of modules that meet past the face of a package
ONE_USER = 53  # modules that only one other imports, except for protocols, tables of facts and entry points
CIRCLES_OF_TYPES = 4  # groups of modules that know each other's types
NAMED_TWICE = 50  # names of modules that stand for two, but for the patterns of `figures.modules_named_twice`
ENTRIES = 39  # modules and packages right below cfepy/
ABOUT_IMPORTS = 2  # docstrings that say what a module imports, which this test says

TYPES_IN_CIRCLES = {
    "apps": "SBN's network and its subscriptions know each other",
    "cfepy.extra.c": "the functions of the API are declared for the C side of a processor, which has them declared",
    "cfepy.extra.ros_host": "what stands for a node, and the master, know the host that they belong to",
    "cfepy.nodes": "a universe is made of modules that know their universe",
    "cfepy.rtos": "a kernel and its tasks know each other",
    "rospy_shim": "a node of rospy and what belongs to it know each other",
}
"""Packages whose modules know each other's types in a circle; what is imported when they run has none."""

NAMES_FROM_OUTSIDE = {
    "cfepy.interpreter.faces": "a package gives it its own modules, which it names for type checkers too",
    "cfepy.cli.main": "a command is loaded by its name when it is given",
    "cfepy.plugins": "an add-on says by name where it is",
    "cfepy.extra.procedures.procedure_loader": "procedures import what they like",
    "cfepy.nodes.app_modules": "apps import what they like",
    "cfepy.nodes.importer": "nodes import what they like",
    "rospy_shim.types.msgs.modules": "nodes import messages by name",
}
"""Modules that import by a name which cannot be read off their text."""

MAY_TOUCH_THE_HOST = {
    "interpreter": "counts the threads that hold up the collection of garbage",
    "rtos": "task contexts, pacing and the stall watch are made of the host's threads and clock",
    "schedules": "a policy draws from the seed of its schedule",
    "io": "joins the virtual network of a paced run to real sockets on the loopback interface",
    "ros_host": "speaks ROS's protocols on real sockets, and does in threads of the host what must wait for others",
    "attach": "listens for programs of the same user at a socket in the file system",
    "procedures": "gives procedures the mission's clock as their module `time`, and flies a real computer over UDP",
    "profiler": "measures the wall time of tasks, and looks at their stacks in a thread of the host",
    "viewers": "listens for viewers on real sockets, at the pace of the wall clock, and makes tokens",
    "exploration": "spreads trials over processes and computers, sees when one of them ends, tells how far it has come",
    "faults": "draws from random streams that follow from the seed of the run",
    "nodes": "puts virtual modules in the place of these, and takes constants and types from the real ones",
}
HOST_MODULES = {"time", "random", "threading", "_thread", "socket", "select", "datetime", "secrets", "uuid", "asyncio"}
HEAVY_MODULES = {"numpy", "pytest", "hypothesis", "rich", "textual", "yaml"}
TOOLS = ROOT / "rospy_shim" / "roslaunch" / "tools"  # nodes that launch files take for granted


@pytest.fixture(scope="module")
def tree() -> Tree:
    return the_tree()


def test_every_package_has_a_floor(tree: Tree) -> None:
    assert not homeless(tree), "give it a place in dev/house/floors.py and in docs/explanation/design.md"


def test_imports_go_down(tree: Tree) -> None:
    assert not list(map(str, wrong_arrows(tree))), "an import goes to a floor below"


def test_names_given_to_import_module_can_be_read(tree: Tree) -> None:
    unread = {f"{name}:{line}" for name, module in tree.modules.items() for line in module.unread}
    known = {place for place in unread if place.rpartition(":")[0] in NAMES_FROM_OUTSIDE}
    assert unread == known, "an arrow must not hide in a name that is made at run time"


def test_imports_have_no_circles(tree: Tree) -> None:
    assert not figures.circles(tree), "imports go in a circle, lazy ones included"


def test_circles_of_types_stay_inside_packages(tree: Tree) -> None:
    for ring in figures.circles(tree, for_types=True):
        packages = {tree.modules[name].room for name in ring}
        assert len(packages) == 1, ring
        assert packages <= set(TYPES_IN_CIRCLES), ring


def test_few_circles_of_types(tree: Tree) -> None:
    assert len(figures.circles(tree, for_types=True)) <= CIRCLES_OF_TYPES, "name what is needed in a Protocol"


def test_name_of_a_module_is_unique(tree: Tree) -> None:
    twice = figures.modules_named_twice(tree)
    assert len(twice) <= NAMED_TWICE, twice


def test_few_modules_are_directly_in_cfepy(tree: Tree) -> None:
    assert len(figures.entries(tree)) <= ENTRIES, "put it into the package that it belongs to"


def test_faces(tree: Tree) -> None:
    assert figures.faces(tree).past <= PAST_FACES, "import from the package, or offer it in its __init__"


def test_module_imported_by_one_other_belongs_to_its_package(tree: Tree) -> None:
    alone = figures.with_one_user(tree)
    assert len(alone) <= ONE_USER, "\n".join(module.where for module in alone)


def test_modules_are_at_most_600_lines_long(tree: Tree) -> None:
    long = [f"{module.where}: {module.lines}" for module in tree.modules.values() if module.lines > LONGEST]
    assert not long


def test_docstrings_do_not_list_imports(tree: Tree) -> None:
    told = figures.sentences_about_imports(tree)
    assert len(told) <= ABOUT_IMPORTS, f"dev/house/floors.py says it: {told}"


def test_public_name_is_unique(tree: Tree) -> None:
    twice = figures.names_twice(tree)
    assert set(twice) <= set(figures.NAMES_OF_NODES), twice


def test_locks_of_the_host_are_known(tree: Tree) -> None:
    """On Python 3.11 `cached_property` does: a fork in the middle of it hung every mission in the child."""
    locking = {"functools.cached_property", "queue.Queue", "queue.SimpleQueue", "threading.local"}
    for module in tree.modules.values():
        touched = {each.name for each in module.imports} & locking
        assert not touched or module.part in MAY_TOUCH_THE_HOST, (
            f"{module.where}: {touched}; see cfepy/interpreter/cached.py"
        )


def test_package_needs_no_programs_benchmarks_or_tests(tree: Tree) -> None:
    for module in tree.modules.values():
        found = {each.name.split(".")[0] for each in module.imports} & {"benchmarks", "dev", "tests"}
        assert not found, f"{module.where}: {found} are of the checkout alone"


def test_host_modules_are_imported_only_by_permitted_packages(tree: Tree) -> None:
    for module in tree.modules.values():
        touched = {each.name.split(".")[0] for each in module.imports} & HOST_MODULES
        assert not touched or module.part in MAY_TOUCH_THE_HOST, (
            f"{module.where}: {touched} belong to the host; only {', '.join(MAY_TOUCH_THE_HOST)} may use them"
        )


def test_libraries_are_imported_only_as_code_of_nodes(tree: Tree) -> None:
    """They run in a node's universe, with its rospy and its clock.

    They import the modules of nodes, none of the house.
    """
    libraries = ROOT / "ros_libraries"
    others = {folder.name for folder in libraries.iterdir()} | {path.stem for path in TOOLS.glob("*.py")}
    others |= {"rclpy", "rospy", "genpy", "lz4", "zstandard", "numpy", "yaml"}
    for module in tree.node_code.values():
        if module.where.startswith("rospy_shim/stand_ins"):
            continue
        for name in imported(module):
            top, _, rest = name.removeprefix("ros_libraries.").partition(".")
            known = top in sys.stdlib_module_names or top in others
            assert known or rest.split(".")[0] in ("msg", "srv"), f"{module.where}: a library must not import {name}"


def imported(module: Module) -> Iterator[str]:
    return (each.name for each in module.imports if each.when != "by name")


def test_numpy_and_test_libraries_are_imported_lazily(tree: Tree) -> None:
    for module in tree.modules.values():
        for node in module.tree.body:
            if isinstance(node, ast.Import | ast.ImportFrom):
                names = [alias.name for alias in node.names] if isinstance(node, ast.Import) else [node.module or ""]
                heavy = {name.split(".")[0] for name in names} & HEAVY_MODULES
                assert not heavy or is_imported_late(module.path), f"{module.where}: import {heavy} where it is used"


def is_imported_late(path: Path) -> bool:
    """Return whether a module is imported late: the display and the screen only when needed, tools for tests by
    tests."""
    return (
        (path.name in {"display.py", "screen.py", "tables.py"} and "cli" in path.parts)
        or path.name in {"in_tests.py", "procedure_items.py"}
        or "testing" in path.parts
    )


# -- output ------------------------------------------------------------------------------------------------------------

PRINT_PAST = {
    "cfepy.writing.escapes": "it is the place",
    "cfepy.writing.console": "lines of nodes have colours",
    "cfepy.writing.work_progress": "it erases its line; the text is made visible there",
    "cfepy.cli.display": "lines of nodes have colours",
    "cfepy.cli.ros.node": "the node's lines have colours",
    "cfepy.cli.main": "settings of the stream itself",
    "cfepy.cli.parser": "help and usage are cfepy's own, and Python colours them",
    "cfepy.cli.json_output": "data for another program",
    "cfepy.cli.watched_host": "a process that cannot be ended: the text is made visible there",
    "cfepy.cli.ground.console.screen": "a process that cannot be ended: a text of cfepy's own",
    "cfepy.rtos.stall_signals": "the file for Python's faulthandler, which writes escapes of its own",
}
"""Modules that write to a stream of the process without `SafeStream`, and why."""
_PAST_NAMES = {"raw", "for_data", "__stdout__", "__stderr__"}


def ways_past(tree: ast.AST) -> Iterator[str]:
    """Yield statements of a module that write past the safe streams, or make an unsafe stream."""
    for node in ast.walk(tree):
        if isinstance(node, ast.ImportFrom) and node.module == "cfepy.writing.escapes":
            yield from (each.name for each in node.names if each.name in _PAST_NAMES)
        elif isinstance(node, ast.ImportFrom) and node.module == "rich.console":
            yield from (each.name for each in node.names if each.name == "Console")
        elif isinstance(node, ast.Attribute) and node.attr in _PAST_NAMES and _is(node.value, "sys"):
            yield node.attr
        elif isinstance(node, ast.Attribute) and node.attr == "buffer" and isinstance(node.value, ast.Attribute):
            if _is(node.value.value, "sys"):
                yield "buffer"
        elif isinstance(node, ast.Call) and isinstance(node.func, ast.Attribute):
            if node.func.attr == "write" and _is(node.func.value, "os") and _is_standard(node.args[0]):
                yield "os.write"
            elif node.func.attr in ("StreamHandler", "basicConfig"):
                yield node.func.attr


def _is(node: ast.expr, name: str) -> bool:
    return isinstance(node, ast.Name) and node.id == name


def _is_standard(node: ast.expr) -> bool:
    return (isinstance(node, ast.Constant) and node.value in (1, 2)) or _is(node, "STDERR") or _is(node, "STDOUT")


def test_output_is_printed_only_through_the_safe_streams(tree: Tree) -> None:
    found = {
        name: sorted(set(ways))
        for name, module in tree.modules.items()
        if name.startswith("cfepy") and (ways := list(ways_past(module.tree)))
    }
    assert {name: ways for name, ways in found.items() if name not in PRINT_PAST} == {}
    assert set(PRINT_PAST) == set(found), "a module of the table does not need its place any more"
