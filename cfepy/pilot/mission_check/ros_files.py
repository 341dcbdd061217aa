"""Checks of launch files, of node scripts, and of the message definitions that they use.

Packages and definitions are searched like the node does: near its script, then along its ROS_PACKAGE_PATH.
"""

from __future__ import annotations

import ast
import importlib.util
import os
from collections.abc import Iterable, Iterator, Mapping
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from cfepy.mission import CppNodesConfig, CppNodesError, make_ros2
from cfepy.mission import app_sources as sources
from cfepy.nodes import CppNode
from cfepy.pilot.mission_check.problem import MissionProblem, problem_of
from cfepy.pilot.plan import built_node
from cfepy.reading.mistakes import Mistakes
from cfepy.reading.suggestions import did_you_mean, expected
from cfepy.status import UsageError

if TYPE_CHECKING:
    from rospy_shim.roslaunch.launch_plan import LaunchPlan
    from rospy_shim.runtime import Ros2, TypeNames
    from rospy_shim.types.msgs import Packages
    from rospy_shim.types.msgs.definition_sources import Kind

_KINDS: tuple[Kind, ...] = ("msg", "srv", "action")


class NodeScript(NamedTuple):
    """A node's script.

    Attributes:
        file: the script.
        environ: its environment.
        ros: version of ROS in the mission file, 1 or 2; None if it has none.
    """

    file: Path
    environ: Mapping[str, str]
    ros: int | None = None

    def ros2(self) -> Ros2 | None:
        """Return the world of ROS 2 if the node is written for it, else None.

        Raises:
            UsageError: this installation has no rclpy_shim.
        """
        from rospy_shim.types.worlds import is_of_ros2

        return make_ros2() if is_of_ros2(self.file, self.ros) else None


def check_launch(
    file: Path,
    args: Mapping[str, str],
    environ: Mapping[str, str],
    alone: bool,
    config: CppNodesConfig | None = None,
) -> tuple[list[MissionProblem], list[NodeScript]]:
    """Check a launch file and all included files.

    Args:
        file: the launch file.
        args: values of its arguments.
        environ: its environment variables.
        alone: whether it is the whole mission, and so needs a node or a test.
        config: how the mission's nodes in C++ are built; None without a mission file.

    Returns:
        The problems, and the scripts of the nodes that can run.
    """
    from rospy_shim.roslaunch.launch_plan import plan_of

    mistakes = Mistakes()
    plan = mistakes.attempt(
        partial(plan_of, file, args, environ, cwd=Path.cwd(), mistakes=mistakes, with_compiled=True)
    )
    found = [problem_of(error, file) for error in mistakes.errors]
    if plan is None:
        return found, []
    found += [MissionProblem(each.file, each.line, each.text, not each.is_error) for each in plan.remarks]
    found += _built(plan, config or CppNodesConfig())
    scripts = _scripts_of(plan)
    if alone and not scripts and not plan.compiled and not _tests_of(plan) and all(each.is_warning for each in found):
        found.append(MissionProblem(file, 0, "has no node that cfepy can run"))
    return found, scripts


def _tests_of(plan: LaunchPlan) -> list[CppNode]:
    """Return the tests in C++."""
    return [test.compiled for test in plan.tests if test.compiled is not None]


def _built(plan: LaunchPlan, config: CppNodesConfig) -> Iterator[MissionProblem]:
    """Build the nodes in C++; a run omits a node that cannot be built, unless it is required."""
    for node in (*plan.compiled.values(), *_tests_of(plan)):
        try:
            built_node(node, plan.params, (), config)
        except CppNodesError:
            return  # an error of the mission file, which is reported there
        except UsageError as error:
            text = f"node {node.full_name} is left out: it cannot be built: {error}"
            yield MissionProblem(node.near, node.line, text, not node.required)


def _scripts_of(plan: LaunchPlan) -> list[NodeScript]:
    nodes = [*plan.nodes.values(), *(test.node for test in plan.tests)]
    return [NodeScript(node.script, node.env) for node in nodes if node is not None and node.script is not None]


def check_nodes(scripts: Iterable[NodeScript]) -> Iterator[MissionProblem]:
    """Check node scripts: their syntax, and the messages that they import.

    Args:
        scripts: the scripts, in any order. A script that is given twice is read twice.

    Yields:
        The problems.
    """
    for script in scripts:
        error = sources.syntax_error(script.file)
        if error is not None:
            yield MissionProblem(script.file, error[0], f"is not Python: {error[1]}")
        else:
            yield from _check_imports(script)


def check_definitions_of(scripts: Iterable[NodeScript], near: Path) -> Iterator[MissionProblem]:
    """Check the message definitions of the packages that nodes use or belong to.

    Args:
        scripts: the nodes.
        near: the startup script, launch file or node of the mission; definitions below its folder are checked too.
    """
    from rospy_shim.types.msgs import Packages, check_definitions

    for script in scripts:
        if script.ros2() is not None:
            continue  # the rules of ROS 2 are others
        packages = Packages(script.file, script.environ)
        imported = {package for package, _, _, _ in _message_imports(script.file)}
        own = packages.package_of(script.file)
        for fault in check_definitions(packages, sorted(imported if own is None else {own, *imported})):
            yield problem_of(fault.error, script.file, fault.is_warning)
    packages = Packages(near, {})
    inside = [name for name in packages.names() if _is_below(packages.folders(name), near.parent)]
    for fault in check_definitions(packages, inside):
        yield problem_of(fault.error, near, fault.is_warning)


def _is_below(folders: list[Path], top: Path) -> bool:
    return any(folder.is_relative_to(top) for folder in folders)


def _message_imports(file: Path) -> Iterator[tuple[str, Kind, list[str], int]]:
    """Yield the messages, services and actions that a script imports unconditionally: (package, kind, names, line)."""
    for node in sources.tree_of(file).body:
        if isinstance(node, ast.ImportFrom) and node.level == 0 and node.module is not None:
            package, kind = _type_module(node.module)
            if kind is not None:
                yield package, kind, [alias.name for alias in node.names if alias.name != "*"], node.lineno
        elif isinstance(node, ast.Import):
            for alias in node.names:
                package, kind = _type_module(alias.name)
                if kind is not None:
                    yield package, kind, [], node.lineno


def _type_module(name: str) -> tuple[str, Kind | None]:
    """Return the package and the kind of a module's types; the kind is None if the module has none."""
    package, _, part = name.partition(".")
    return package, next((kind for kind in _KINDS if kind == part), None)


def _check_imports(script: NodeScript) -> Iterator[MissionProblem]:
    """Yield message packages, and types in them, that a script imports but that do not exist."""
    from rospy_shim.types.msgs import Library, OnDisk, Packages, shipped

    imports = list(_message_imports(script.file))
    if not imports:
        return
    packages = Packages(script.file, script.environ)
    ros2 = script.ros2()
    types: TypeNames = (
        Library([OnDisk(packages, Mistakes())], base=shipped())
        if ros2 is None
        else ros2.types_near(packages, script.environ)
    )
    for package, kind, names, line in imports:
        if _is_code(package, script, packages):
            continue
        if package not in types.packages():
            what_to_do = "add it beside the node, or put it on ROS_PACKAGE_PATH"
            hint = did_you_mean(package, types.packages(), what_to_do)
            yield MissionProblem(script.file, line, f"unknown message package {package}; {hint}")
            continue
        known = types.names(package, kind) or []
        parts = {f"{name}{part}" for name in known for part in ("Request", "Response") if kind == "srv"}
        for name in names:
            if name not in known and name not in parts and not name.startswith("_"):
                hint = expected(name, known, subject="it has", last="and")
                yield MissionProblem(script.file, line, f"package {package} has no {kind} {name}; {hint}")


def _is_code(package: str, script: NodeScript, packages: Packages) -> bool:
    """Return whether there is Python code that may provide messages under this name."""
    paths = [Path(each) for each in script.environ.get("PYTHONPATH", "").split(os.pathsep) if each]
    if any(os.path.isfile(folder / package / "__init__.py") for folder in (script.file.parent, *paths)):
        return True
    if any(
        os.path.isfile(folder / package / kind / "__init__.py") for folder in packages.code_folders() for kind in _KINDS
    ):
        return True
    try:
        return any(importlib.util.find_spec(f"{package}.{kind}") is not None for kind in _KINDS)
    except (ImportError, ValueError, AttributeError):
        return False
