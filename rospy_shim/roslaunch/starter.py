"""Nodes that a node starts: the mission's functions for the library roslaunch, which is code of nodes.

The library finds these functions in its module `roslaunch._processes`.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from itertools import count
from pathlib import Path
from types import ModuleType
from typing import TYPE_CHECKING, Any, Protocol

from cfepy.nodes import NodeConfig
from cfepy.units import NS_PER_MS, NS_PER_S
from rospy_shim.roslaunch.launch_plan import Planner, ScriptError, plan_of
from rospy_shim.roslaunch.model import LaunchNode
from rospy_shim.roslaunch.substitution import SubstitutionError, Substitutions, UnsetArgument, World
from rospy_shim.types.msgs import Packages

if TYPE_CHECKING:
    from rospy_shim.client.node import Node

LOOK_NS = 50 * NS_PER_MS  # period at which the end of a node is checked


class NodeStarts(Protocol):
    """Starts nodes on the mission, and ends them."""

    def app_names(self) -> list[str]:
        """Return the names that a new node's application cannot have."""

    def start_node(self, config: NodeConfig) -> None:
        """Start a node that no other part of the mission names.

        Raises:
            CfeError: there is no room for another application.
        """

    def forget_start(self, app: str) -> None:
        """Forget the application of a node that was started here."""

    def begin_shutdown(self, reason: str, app_name: str | None = None) -> None:
        """Ask all nodes to end, or the node of one application."""


class Starter:
    """Starts nodes for one node.

    Args:
        runtime: ROS on the mission.
        node: the caller.
    """

    def __init__(self, runtime: NodeStarts, node: Node) -> None:
        self._runtime = runtime
        self._node = node

    def start_node(self, fields: Mapping[str, Any]) -> str:
        """Start one node.

        Args:
            fields: the fields of a `LaunchNode`, without `file` and `line`.

        Returns:
            The cFE name of its application.

        Raises:
            ValueError: there is no such node, or it cannot run here.
        """
        node = LaunchNode(**fields, file=self._here, line=0)
        planner = Planner(
            Packages(self._here, self._environ), self._environ, self._runtime.app_names(), self._here.parent
        )
        try:
            return self._start(planner.config(node))
        except ScriptError as error:
            raise ValueError(f"cannot launch node of type [{node.package}/{node.type}]: {error}") from None

    def start_file(self, file: str, args: Sequence[str]) -> list[str]:
        """Set the parameters of a launch file and start its nodes.

        Args:
            file: its path.
            args: `name:=value` each.

        Returns:
            The cFE names of the applications.

        Raises:
            ValueError: the file is wrong.
        """
        path = Path(self._node.universe.resolve(file))
        values = dict(arg.split(":=", 1) for arg in args if ":=" in arg)
        plan = plan_of(path, values, self._environ, taken=self._runtime.app_names(), cwd=self._here.parent)
        for name, value in _leaves("", plan.params):
            self._node.params.set_param(name, value)
        for note in plan.notes:
            self._node.universe.print_error(f"{note}\n")
        return [self._start(config) for config in plan.nodes.values()]

    def is_alive(self, app: str) -> bool:
        """Return True if the application of a node that was started still runs."""
        return self._node.cfe.es.app_named(app) is not None

    def stop(self, app: str, seconds: float) -> None:
        """Ask a node to end, and wait until it has; after some seconds its application is deleted."""
        kernel, es = self._node.kernel, self._node.cfe.es
        self._runtime.forget_start(app)
        self._runtime.begin_shutdown("roslaunch", app)
        end = kernel.now + round(seconds * NS_PER_S)
        while self.is_alive(app) and kernel.now < end:
            kernel.delay(LOOK_NS)
        if self.is_alive(app):
            es.delete_app(es.get_app_id_by_name(app))

    def resolve(self, text: str, args: dict[str, str], anonymous: dict[str, str], file: str | None) -> str:
        """Return a text with roslaunch's substitutions made.

        Raises:
            KeyError: an argument has no value.
            ValueError: a substitution cannot be made.
        """
        packages = Packages(self._here, self._environ)
        made = count(1)
        world = World(self._environ, packages.path, lambda name: f"{name}_cfepy_{next(made)}", [0], packages.names)
        path = Path(self._node.universe.resolve(file or str(self._here)))
        try:
            return Substitutions(world, path, args, anonymous).resolve(text)
        except UnsetArgument as error:
            raise KeyError(error.name) from None
        except SubstitutionError as error:
            raise ValueError(str(error)) from None

    def module(self) -> Callable[[Any], ModuleType]:
        """Return the factory of `roslaunch._processes`."""
        names = {name: getattr(self, name) for name in ("start_node", "start_file", "is_alive", "stop", "resolve")}

        def make(universe: Any) -> ModuleType:
            module = ModuleType("roslaunch._processes")
            vars(module).update(names)
            return module

        return make

    @property
    def _environ(self) -> dict[str, str]:
        return dict(self._node.universe.environ)

    @property
    def _here(self) -> Path:
        return Path(self._node.universe.script)

    def _start(self, config: NodeConfig) -> str:
        self._runtime.start_node(config)
        return config.app


def _leaves(prefix: str, tree: Mapping[str, Any]) -> Iterator[tuple[str, Any]]:
    """Yield the parameters of a tree by their full names, so that other parameters in the same namespaces stay."""
    for name, value in tree.items():
        if isinstance(value, dict) and value:
            yield from _leaves(f"{prefix}/{name}", value)
        else:
            yield f"{prefix}/{name}", value
