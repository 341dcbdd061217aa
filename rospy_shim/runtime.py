"""`RosRuntime`: ROS on one mission. It runs the scripts of nodes inside their cFE applications.

The mission loads this module by name when the first node starts. May import cfepy.nodes, cfepy.rtos and rospy_shim,
never cfepy.mission.
"""

from __future__ import annotations

from collections.abc import Callable
from itertools import count
from pathlib import Path
from types import ModuleType
from typing import TYPE_CHECKING, Any

from cfepy.nodes import Universe
from cfepy.nodes.config import NodeConfig, RosConfig
from cfepy.rtos.units import NS_PER_S
from rospy_shim import library_path
from rospy_shim.graph import Graph, Topic, TopicRow
from rospy_shim.modules import RosModules
from rospy_shim.msgs import make_module
from rospy_shim.node import Node
from rospy_shim.tasks import NodeTasks

if TYPE_CHECKING:
    from cfepy.app import Cfe
    from cfepy.console import Console
    from cfepy.rtos import Kernel

APP_ERROR = 3  # CFE_ES_RunStatus_APP_ERROR


class RosRuntime:
    """ROS on one mission.

    Args:
        cfe: the handle of cFE's services.
        kernel: the simulated computer's.
        config: what the mission file says about nodes and topics.
        seed: of the run; the nodes' random numbers come from it.
        epoch_ns: ROS time in ns when the kernel's clock is 0.
        node_call_ns: virtual CPU time of a call of ROS's or Python's API in a node.
        max_publish_hz: messages a second that a publisher may send; it is held back at more. 0 for no limit.
        console: where nodes print and log.
    """

    def __init__(
        self,
        cfe: Cfe,
        kernel: Kernel,
        config: RosConfig,
        *,
        seed: int,
        epoch_ns: int,
        node_call_ns: int,
        max_publish_hz: int = 0,
        console: Console,
    ) -> None:
        self.graph = Graph(config)
        self._cfe = cfe
        self._kernel = kernel
        self._config = config
        self._seed = seed
        self._epoch_ns = epoch_ns
        self._call_ns = node_call_ns
        self._publish_slot_ns = NS_PER_S // max_publish_hz if max_publish_hz else 0
        self._console = console
        self._running: list[Node] = []
        self._task_numbers = count(1)

    def run_node(self, script: Path, app_name: str) -> None:
        """Run a node's script to its end, in the main task of its cFE application.

        Args:
            script: the Python file.
            app_name: cFE name of the application.

        A node that fails ends its application with CFE_ES_RunStatus_APP_ERROR.
        """
        config = self._config.nodes.get(app_name) or NodeConfig(app_name)
        self._cfe.es.run_loop()  # tells ES that the application runs, so that the mission can become operational
        node = self._make_node(script, app_name, config)
        self._running.append(node)
        try:
            status = node.universe.run_script()
        finally:
            self._running.remove(node)
            node.abandon()
        if status != 0:
            self._cfe.es.exit_app(APP_ERROR)

    def _make_node(self, script: Path, app_name: str, config: NodeConfig) -> Node:
        tasks = NodeTasks(self._cfe, self._kernel, lambda: next(self._task_numbers))
        universe = Universe(
            self._kernel,
            name=config.name or app_name,
            script=script,
            argv=_command_line(config),
            env={"ROS_MASTER_URI": "http://cfepy:11311", **config.env},
            cwd=script.parent,
            library_paths=[library_path.FOLDER],
            seed=self._seed,
            epoch_ns=self._epoch_ns,
            call_cost_ns=self._call_ns,
            stdout=self._console.write,
            find_module=lambda name: find(name),
            priority=tasks.priority,
            on_thread_start=tasks.thread,
        )
        node = Node(self._cfe, self.graph, universe, config, tasks, self._call_ns, self._publish_slot_ns)
        universe.importer.path[1:1] = map(str, node.packages.code_folders())
        find = _finder(node)
        return node

    def begin_shutdown(self, reason: str) -> None:
        """Ask all nodes to end, as Ctrl-C ends a roslaunch.

        Args:
            reason: what their shutdown hooks are told.
        """
        for node in self._running[:]:
            node.ask_to_shut_down(reason)

    def all_finished(self) -> bool:
        """Whether no node's program runs any more."""
        return not self._running

    def topics(self) -> list[TopicRow]:
        """A row for each topic there ever was, by name."""
        return [self._row(topic) for _, topic in sorted(self.graph.topics.items())]

    def _row(self, topic: Topic) -> TopicRow:
        return TopicRow(
            topic.name,
            topic.msg_id,
            topic.type,
            tuple(topic.publisher_names),
            tuple(topic.subscriber_names),
            topic.lost,
            topic.held_back,
            topic.definition,
        )


def _command_line(config: NodeConfig) -> list[str]:
    """The arguments that roslaunch would give the node."""
    found = [*config.args, *(f"{name}:={target}" for name, target in config.remap.items())]
    for special, value in (("__name", config.name), ("__ns", config.namespace if config.namespace != "/" else None)):
        if value and not any(argument.startswith(f"{special}:=") for argument in config.args):
            found.append(f"{special}:={value}")
    return found


def _finder(node: Node) -> Callable[[str], Callable[[Any], ModuleType] | None]:
    """Finds what makes a module of ROS: rospy's own, genpy, message packages that have no code as well."""
    rospy = RosModules(node)

    def find(name: str) -> Callable[[Any], ModuleType] | None:
        factory = rospy.find(name)
        if factory is not None:
            return factory
        if name in library_path.names():
            return None  # a package with code; its messages are made here all the same
        module = make_module(name, node.library)
        if module is None or ("." not in name and node.universe.importer.has_own(name)):
            return None
        return lambda universe: module

    return find
