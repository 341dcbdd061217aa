"""From a launch file to applications: each node that can run here with a cFE name, its script and its process's world.

The mission calls `plan_of`. May import cfepy.nodes.config, cfepy.rtos.units and cfepy.status.
"""

from __future__ import annotations

import os
import re
import shlex
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

from cfepy.nodes.config import ROSCORE_PARAMS, NodeConfig
from cfepy.rtos.units import NS_PER_S
from cfepy.status import UsageError
from rospy_shim.msgs import Packages
from rospy_shim.names import SEP
from rospy_shim.roslaunch.model import Launch, LaunchNode, LaunchTest
from rospy_shim.roslaunch.reader import read
from rospy_shim.roslaunch.scripts import ScriptError, find_file, find_script

LONGEST_NAME = 16  # of OSAL's 19 characters; the rest is for numbers
ROS_ENVIRONMENT = {"ROS_DISTRO": "noetic", "ROS_PYTHON_VERSION": "3", "ROS_VERSION": "1"}  # as ROS's setup.sh has it
_NOT_OURS = ("ROS_MASTER_URI", "ROS_HOSTNAME", "ROS_IP", "ROS_NAMESPACE")  # of the network that is not there


@dataclass(frozen=True, slots=True)
class PlannedTest:
    """A test: its names, its node, and the virtual time that it has, in ns."""

    package: str
    test_name: str
    node: NodeConfig | None
    time_limit_ns: int
    retry: int
    results: Path  # where the test writes what came of it
    problem: str = ""  # why it has no node


@dataclass(slots=True)
class Plan:
    """What to run: applications by name, tests, the tree of parameters, and what to tell the user."""

    nodes: dict[str, NodeConfig] = field(default_factory=dict)
    tests: list[PlannedTest] = field(default_factory=list)
    params: dict[str, Any] = field(default_factory=dict)
    notes: list[str] = field(default_factory=list)


def plan_of(
    file: Path,
    args: Mapping[str, str],
    environ: Mapping[str, str],
    *,
    taken: Iterable[str] = (),
    cwd: Path | None = None,
    results: Path | None = None,
) -> Plan:
    """What a launch file comes to.

    Args:
        file: the launch file.
        args: values of its arguments.
        environ: the environment: for substitutions, for ROS_PACKAGE_PATH, and for the nodes.
        taken: names of applications that are there already.
        cwd: where the launch is started; what cwd="cwd" means.
        results: folder that tests write their results to.

    Raises:
        UsageError: the file is wrong, or a required node cannot run here.
    """
    environ = {**ROS_ENVIRONMENT, **environ}
    packages = Packages(file, environ)
    planner = Planner(packages, environ, taken, cwd or file.parent, results)
    return planner.plan(read(file, args, packages, environ))


def node_file(package: str, node_type: str, near: Path, environ: Mapping[str, str]) -> Path:
    """The script of a node, as rosrun finds it.

    Args:
        package: its package.
        node_type: the file's name.
        near: a file; packages near it count first.
        environ: for ROS_PACKAGE_PATH.

    Raises:
        UsageError: there is none.
    """
    try:
        return find_script(_packages(near, environ, package), package, node_type)
    except ScriptError as error:
        raise UsageError(str(error), field=f"{package} {node_type}") from None


def launch_file(package: str, name: str, near: Path, environ: Mapping[str, str]) -> Path:
    """A launch file by its package, as roslaunch finds it.

    Args:
        package: its package.
        name: of the file.
        near: a file; packages near it count first.
        environ: for ROS_PACKAGE_PATH.

    Raises:
        UsageError: there is none.
    """
    packages = _packages(near, environ, package)
    file = find_file(packages, package, name)
    if file is None and packages.folders(package):
        raise UsageError(f"package {package!r} has no file {name!r}", field=f"{package} {name}")
    if file is None:
        text = f"there is no package {package!r}; go into its workspace, or put it on ROS_PACKAGE_PATH"
        raise UsageError(text, field=f"{package} {name}")
    return file


def _packages(near: Path, environ: Mapping[str, str], package: str) -> Packages:
    """Packages as seen from a folder: when the one that is asked for is not near, the catkin workspace counts, too."""
    packages = Packages(near, environ)
    if packages.folders(package):
        return packages
    sources = [near.parent / "src", *(folder for folder in near.parents if folder.name == "src")]
    roots = [str(source) for source in sources[:2] if source.is_dir()]
    return Packages(
        near, {**environ, "ROS_PACKAGE_PATH": os.pathsep.join([environ.get("ROS_PACKAGE_PATH", ""), *roots])}
    )


def node_environment(environ: Mapping[str, str], namespace: str = SEP) -> dict[str, str]:
    """The environment of a node that a user starts: the user's, but for the network of another ROS."""
    kept = {name: value for name, value in (ROS_ENVIRONMENT | dict(environ)).items() if name not in _NOT_OURS}
    return {**kept, "ROS_NAMESPACE": namespace.rstrip(SEP)} if namespace != SEP else kept


class Planner:
    """Makes applications of nodes.

    Args:
        packages: where their scripts are.
        environ: the environment that nodes get.
        taken: names of applications that are there already.
        cwd: what cwd="cwd" means.
        results: folder that tests write their results to.
    """

    def __init__(
        self,
        packages: Packages,
        environ: Mapping[str, str],
        taken: Iterable[str],
        cwd: Path,
        results: Path | None = None,
    ) -> None:
        self._results = results or cwd
        self._packages = packages
        self._environ = environ
        self._taken = set(taken)
        self._cwd = cwd

    def plan(self, launch: Launch) -> Plan:
        """Everything in a launch file; see `plan_of`.

        Raises:
            UsageError: a required node cannot run here.
        """
        plan = Plan(params=_tree({**ROSCORE_PARAMS, **launch.params}, launch), notes=launch.notes)
        for node in launch.nodes:
            try:
                config = self.config(node)
            except ScriptError as error:
                if node.required:
                    raise _failure(node, f"{node.full_name} is required, but {error}") from None
                plan.notes.append(f"{node.file}:{node.line}: node {node.full_name} is left out: {error}")
            else:
                plan.nodes[config.app] = config
        plan.tests += [self._test(test) for test in launch.tests]
        return plan

    def _test(self, test: LaunchTest) -> PlannedTest:
        """A test; it is told where to write, and its end is the end of its run."""
        node, name, limit = test.node, test.test_name, round(test.time_limit * NS_PER_S)
        results = self._results / f"{node.package}-{name}.xml"
        try:
            config = self.config(replace(node, required=True), (f"--gtest_output=xml:{results}",))
        except ScriptError as error:
            return PlannedTest(node.package, name, None, limit, test.retry, results, str(error))
        return PlannedTest(node.package, name, config, limit, test.retry, results)

    def config(self, node: LaunchNode, more_args: tuple[str, ...] = ()) -> NodeConfig:
        """The application of one node; `more_args` are put behind its own arguments.

        Raises:
            ScriptError: it cannot run here.
            UsageError: its arguments are not well quoted.
        """
        script = find_script(self._packages, node.package, node.type)
        return NodeConfig(
            self._app_name(node),
            name=node.full_name.lstrip(SEP),
            args=self._arguments(node, more_args),
            env={**node_environment(self._environ, node.namespace), **node.env},
            script=script,
            cwd=self._folder(node),
            respawn=node.respawn,
            respawn_delay_ns=round(node.respawn_delay * NS_PER_S),
            required=node.required,
        )

    def _arguments(self, node: LaunchNode, more_args: tuple[str, ...]) -> tuple[str, ...]:
        """The command line in roslaunch's order."""
        try:
            words = shlex.split(node.args)
        except ValueError as error:
            raise _failure(node, f"args={node.args!r}: {error}") from None
        remaps = [f"{source}:={target}" for source, target in node.remaps]
        return (*words, *more_args, *remaps, f"__name:={node.name}")

    def _folder(self, node: LaunchNode) -> Path | None:
        if node.cwd == "ROS_HOME":
            return Path(self._environ.get("ROS_HOME") or os.path.join(self._environ.get("HOME", SEP), ".ros"))
        return self._cwd if node.cwd == "cwd" else None

    def _app_name(self, node: LaunchNode) -> str:
        """A name for the application that no other has."""
        base = re.sub(r"\W", "_", node.full_name.strip(SEP), flags=re.ASCII).upper()[:LONGEST_NAME]
        name, number = base, 1
        while name in self._taken:
            number += 1
            name = f"{base[: 19 - len(str(number))]}{number}"
        self._taken.add(name)
        return name


def _failure(node: LaunchNode, text: str) -> UsageError:
    return UsageError(text, file=node.file, line=node.line, field="<node>")


def _tree(params: Mapping[str, Any], launch: Launch) -> dict[str, Any]:
    """Parameters by name as a tree; a later one replaces what is in its way."""
    root: dict[str, Any] = {}
    for name, value in params.items():
        if value is None:
            launch.notes.append(f"parameter {name} is left out: it has no value (null)")
            continue
        *path, last = [part for part in name.split(SEP) if part]
        place = root
        for part in path:
            if not isinstance(place.get(part), dict):
                place[part] = {}
            place = place[part]
        place[last] = value
    return root
