"""`RosRuntime`: ROS on one mission. It runs the scripts of nodes inside their cFE applications.

A mission imports this module when the first node starts. The `ProcessMonitor` (roslaunch.pmon) decides whether a node
that ended is started again, left alone, or ends the whole run.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import replace
from itertools import count
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple, Protocol

from cfepy.es import StartParams
from cfepy.interpreter.cached import CachedProperty
from cfepy.nodes import NodeConfig, ProcessNumbers, RosConfig, Universe, show_only
from cfepy.rtos import InjectedCrash
from cfepy.status import UsageError
from cfepy.units import NS_PER_S
from rospy_shim.client.modules import RosModules
from rospy_shim.client.node import Node
from rospy_shim.client.tasks import NodeTasks
from rospy_shim.graph.compiled import CompiledNodes
from rospy_shim.graph.graph import Graph, TopicEntry, TopicRow
from rospy_shim.library_parts import FOLDER, STAND_INS, ConfigModules, library_names, library_parts, shown_names
from rospy_shim.master import MASTER_PORT, Switchboard, xmlrpc_client
from rospy_shim.parameters.app import ParameterApp
from rospy_shim.types.entry_points import entry_of
from rospy_shim.types.msgs import make_module
from rospy_shim.types.msgs.modules import MessageModule
from rospy_shim.types.worlds import is_of_ros2

if TYPE_CHECKING:
    from types import ModuleType

    from cfepy.app import Cfe
    from cfepy.nodes import Accesses, Factory, Overlay
    from cfepy.osal import Network
    from cfepy.rtos import Kernel
    from cfepy.writing.console import Console
    from rospy_shim.graph.outside import OutsideGraph
    from rospy_shim.types.msgs import Packages
    from rospy_shim.types.msgs.definition_sources import Kind

CRASHED = 139  # 128 + SIGSEGV, as in a shell
APP_ERROR = 3  # CFE_ES_RunStatus_APP_ERROR
ENVIRONMENT = {
    "LANG": "C.UTF-8",
    "PATH": "/usr/local/bin:/usr/bin:/bin",
    "ROS_DISTRO": "noetic",
    "ROS_ETC_DIR": "/opt/ros/noetic/etc/ros",
    "ROS_MASTER_URI": f"http://cfepy:{MASTER_PORT}",
    "ROS_PYTHON_VERSION": "3",
    "ROS_ROOT": "/opt/ros/noetic/share/ros",
    "ROS_VERSION": "1",
    "USER": "ros",
}
"""The environment of a login and of the set-up file of an installed ROS, the same on every host."""
STACK_BYTES, PRIORITY = 16384, 100  # of nodes that nodes start, as in a startup script
SHORTEST_RESPAWN_NS = 100_000_000  # period at which roslaunch checks its processes


class ProcessMonitor:
    """Monitors the nodes of one mission.

    Args:
        config: the mission file's ROS section.
        console: receives its messages.
        stop: ends the run at once.

    Attributes:
        statuses: the exit status of each node that has ended without a request, by cFE name.
        restarts: number of restarts of each node, by cFE name.
        over: True if the run has ended.
        closing: True if the nodes were asked to end, so that their exit statuses are not failures.
    """

    def __init__(self, config: RosConfig, console: Console, stop: Callable[[], object]) -> None:
        self.statuses: dict[str, int] = {}
        self.restarts: dict[str, int] = {}
        self.over = False
        self._config = config
        self._console = console
        self._stop = stop
        self.closing = False

    def close(self) -> None:
        """Prepare the end of the run: nodes are not started again, and their ends are not reported."""
        self.closing = True

    def starts_again(self, node: NodeConfig, status: int) -> bool:
        """Note the end of a node. Returns True if it is to be started again.

        Args:
            node: the node.
            status: its exit status.
        """
        if self.closing:
            return False
        self.statuses[node.app] = status
        name = node.name or node.app  # if no launch file names it
        if node.respawn:
            self.restarts[node.app] = self.restarts.get(node.app, 0) + 1
            self._say(f"{name} ended with exit status {status} and is restarted")
            return True
        if node.required:
            self._say(f"{name} ended with exit status {status}; it is required, so the run ends")
            self._end()
        elif self._config.ends_with_nodes and all(app in self.statuses for app in self._apps()):
            self._end()
        return False

    def _apps(self) -> list[str]:
        """Return the applications of all nodes."""
        return [*self._config.nodes, *self._config.compiled]

    def _end(self) -> None:
        self.over = True
        self._stop()

    def _say(self, text: str) -> None:
        self._console.write(f"launch: {text}")


class TypeNames(Protocol):
    """The names of message types."""

    def packages(self) -> Iterable[str]:
        """Return the names of all packages."""

    def names(self, package: str, kind: Kind) -> Sequence[str] | None:
        """Return the names of the types of a package, if it has any.

        Args:
            package: its name.
            kind: "msg", "srv", or for ROS 2 also "action".
        """


class Ros2(Protocol):
    """The world of nodes of ROS 2 (`rclpy_shim.ros2_world`), which stands above this package."""

    @property
    def library_paths(self) -> Sequence[Path]:
        """Folders of the libraries."""

    @property
    def fallback_paths(self) -> Sequence[Path]:
        """Folders of replacements for packages that may not be installed."""

    @property
    def node_class(self) -> type[Node]:
        """Class of a program."""

    def environment(self, ros1: Mapping[str, str]) -> dict[str, str]:
        """Return the environment of a program, from the one of a node of ROS 1."""

    def command_line(self, config: NodeConfig) -> list[str]:
        """Return the arguments of a program."""

    def finder(self, program: Any) -> Callable[[str], Factory | None]:
        """Return the finder of the program's modules."""

    def library_names(self) -> frozenset[str]:
        """Return the names of the libraries."""

    def types_near(self, packages: Packages, environ: Mapping[str, str]) -> TypeNames:
        """Return the message types of a program, for the packages near it and its environment."""

    def refusal(self, name: str) -> str:
        """Return why a program cannot import a module; empty if nothing refuses it."""


def _shows_all(module: str) -> None:
    """Return None: modules of ROS 2 show all of their names."""
    return


def _no_ros2() -> Ros2:
    raise UsageError("nodes of ROS 2 cannot run here; start them in a mission")


class NodeEnd(NamedTuple):
    """The end of a node's program.

    Attributes:
        name: the last label of its output.
        status: its exit status; None if it was ended from outside.
        last_words: the last line of its standard error; empty for none, and for a node in C++.
    """

    name: str
    status: int | None
    last_words: str = ""


class RosRuntime:
    """ROS on one mission.

    Args:
        cfe: the handle of cFE's services.
        kernel: the kernel of the simulated computer.
        config: the mission file's ROS section, with nodes and topics.
        seed: seed of the run; the nodes' random numbers come from it.
        epoch_ns: ROS time in ns when the kernel's clock is 0.
        node_call_ns: virtual CPU time of a call of ROS's or Python's API in a node.
        max_publish_hz: maximum messages a second of a publisher, which waits at more. 0 for no limit.
        console: output of nodes, including their logs.
        network: network of their sockets; None refuses sockets.
        files: their view of files; None is the computer's own.
        accesses: receives the accesses of their code to data, or None.
        traps: receives their loops that wait without a sleep, and similar traps.
        on_bad_end: called with the application of a node in Python whose program has just ended with an error.
        make_ros2: returns the world of nodes of ROS 2, when the first one starts.

    Attributes:
        graph: publishers, subscribers and services.
        switchboard: finds the object that answers at a URI.
        parameters: the application ROS, which starts before the first node.
        ended: the ends of programs, by cFE application; of several starts, the last one.
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
        network: Network | None = None,
        files: Overlay | None = None,
        accesses: Accesses | None = None,
        traps: list[object] | None = None,
        on_bad_end: Callable[[str], object] = lambda app: None,
        make_ros2: Callable[[], Ros2] = _no_ros2,
    ) -> None:
        self.graph = Graph(config)
        self.switchboard = Switchboard(self.graph)
        self._cfe = cfe
        self._kernel = kernel
        self._config = config
        self._seed = seed
        self._epoch_ns = epoch_ns
        self._call_ns = node_call_ns
        self._publish_slot_ns = NS_PER_S // max_publish_hz if max_publish_hz else 0
        self._console = console
        self._network = network
        self._files = files
        self._accesses = accesses
        self._on_bad_end = on_bad_end
        self._make_ros2 = make_ros2
        self.traps = self.graph.traps = [] if traps is None else traps
        if files is not None:
            files.stamps.now_ns = lambda: self._epoch_ns + kernel.now
        self.monitor = ProcessMonitor(config, console, kernel.stop)
        self._pids = ProcessNumbers({MASTER_PORT})
        compiled = CompiledNodes(self.graph, cfe.sb, self._compiled_ended, self._pids)
        self.compiled_sender = compiled.sender
        self.parameters = ParameterApp(cfe, self.graph.params, compiled)
        self._started: dict[str, NodeConfig] = {}
        self._running: list[Node] = []
        self.ended: dict[str, NodeEnd] = {}
        self._task_numbers = count(1)

    def _compiled_ended(self, app: str, status: int) -> int | None:
        """Note the end of a node in C++. Returns the ns until it starts again, or None."""
        config = self._config.compiled.get(app)
        if config is None:
            return None
        if self.monitor.starts_again(config, status):
            return max(config.respawn_delay_ns, SHORTEST_RESPAWN_NS)
        self.ended[app] = NodeEnd(config.name or app, status)
        return None

    @CachedProperty
    def outside(self) -> OutsideGraph:
        """The entries of outside nodes in the mission's graph; only a run that is joined to some imports its module."""
        from rospy_shim.graph.outside import OutsideGraph

        return OutsideGraph(self.graph, self.switchboard, self._cfe, self._kernel)

    def run_node(self, script: Path, app_name: str) -> None:
        """Run a node's script to its end, in the main task of its cFE application.

        A node that fails ends its application with CFE_ES_RunStatus_APP_ERROR. One that crashes and is not to respawn
        is an exception to ES, which takes the action in its line of the startup script.

        Args:
            script: the Python file.
            app_name: cFE name of the application.
        """
        config = self._started.get(app_name) or self._config.nodes.get(app_name) or NodeConfig(app_name)
        self._cfe.es.run_loop()  # reports to ES that the application runs, so that the mission can become operational
        self.parameters.wait()
        status = self._run_process(script, app_name, config)
        while self.monitor.starts_again(self._started.get(app_name, config), status):
            self._kernel.delay(max(config.respawn_delay_ns, SHORTEST_RESPAWN_NS))
            status = self._run_process(script, app_name, config)
        if status == CRASHED and config.is_of_startup_script and not self.monitor.closing:
            raise InjectedCrash(f"node {self.ended[app_name].name}")
        if status != 0 and not self.monitor.closing:
            self._cfe.es.exit_app(APP_ERROR)

    def _run_process(self, script: Path, app_name: str, config: NodeConfig) -> int:
        """Run a node's script once, in a universe of its own. Returns its exit status."""
        node = self._make_node(script, app_name, config)
        self._running.append(node)
        node.universe.on_bad_end = lambda: self._on_bad_end(app_name)
        try:
            return node.universe.run_script()
        except InjectedCrash as error:
            return self._crashed(node, error)
        finally:
            self._running.remove(node)
            self._pids.give(node.universe.pid)
            universe = node.universe
            self.ended[app_name] = NodeEnd(universe.name, universe.exit_status, universe.last_words)
            node.abandon()

    def _crashed(self, node: Node, error: InjectedCrash) -> int:
        """Handle a process that crashes; its threads have ended already, and no exit hook was called."""
        self._console.write(f"[{node.universe.name}] Segmentation fault ({error})")
        node.universe.exit_status = CRASHED
        return CRASHED

    @CachedProperty
    def _ros2(self) -> Ros2:
        """The world of nodes of ROS 2; only a run with some imports its modules."""
        return self._make_ros2()

    def _make_node(self, script: Path, app_name: str, config: NodeConfig) -> Node:
        ros2 = self._ros2 if is_of_ros2(script, config.ros) else None
        tasks = NodeTasks(self._cfe, self._kernel, lambda: next(self._task_numbers))
        cwd = config.cwd or script.parent
        home = str(cwd).removeprefix(self._config.root)
        homes = {"HOME": home, "PWD": home}
        entry = entry_of(script, config.executable) if config.executable else None
        universe = Universe(
            self._kernel,
            name=config.name or app_name,
            script=script,
            argv=_command_line(config) if ros2 is None else ros2.command_line(config),
            env={**(ENVIRONMENT if ros2 is None else ros2.environment(ENVIRONMENT)), **homes, **config.env},
            cwd=cwd,
            library_paths=[FOLDER] if ros2 is None else ros2.library_paths,
            fallback_paths=[STAND_INS] if ros2 is None else ros2.fallback_paths,
            seed=self._seed,
            epoch_ns=self._epoch_ns,
            call_cost_ns=self._call_ns,
            stdout=self._console.write,
            find_module=lambda name: find(name),
            shown_names=shown_names if ros2 is None else _shows_all,
            priority=tasks.priority,
            ordered_sets=self._config.ordered_sets if config.ordered_sets is None else config.ordered_sets,
            keys=config.keys,
            network=self._network,
            root=self._config.root,
            overlay=None if config.on_disk else self._files,
            accesses=self._accesses,
            traps=self.traps,
            on_thread_start=tasks.thread,
            entry=entry,
            program=script.parent / config.executable if config.executable else "",
        )
        universe.pid = self._pids.take(universe.pid)
        if ros2 is None:
            universe.make_hidden_objects = lambda: universe.importer.load("rospy.impl.masterslave")
        node_class = Node if ros2 is None else ros2.node_class
        node = node_class(self._cfe, self.graph, universe, config, tasks, self._call_ns, self._publish_slot_ns)
        universe.importer.path[1:1] = [*_python_path(universe), *map(str, node.packages.code_folders())]
        find = self._finder_of_ros1(node) if ros2 is None else ros2.finder(node)
        return node

    def _finder_of_ros1(self, node: Node) -> Callable[[str], Factory | None]:
        """Return the finder of the modules of a node of ROS 1."""
        made = {"xmlrpc.client": xmlrpc_client(node, self.switchboard), **library_parts(node), **self._starter(node)}
        return _finder(node, made)

    def _starter(self, node: Node) -> dict[str, Factory]:
        """Return the module by which a node starts other nodes; only a node that does so imports its dependencies."""

        def make(universe: Universe) -> ModuleType:
            from rospy_shim.roslaunch.starter import Starter

            return Starter(self, node).module()(universe)

        return {"roslaunch._processes": make}

    def start_node(self, config: NodeConfig) -> None:
        """Start a node that neither a startup script nor a launch file of the mission names (CFE_ES_AppCreate).

        Raises:
            CfeError: there is no room for another application.
        """
        self._started[config.app] = config
        self._cfe.es.create_app(config.app, StartParams(f"/cf/{config.app}.so", "__main__", STACK_BYTES, PRIORITY))

    def node_of(self, owner: object) -> Node | None:
        """Return the node whose program an application runs, by the owner of its tasks."""
        return next((node for node in self._running if node.owner is owner), None)

    def shift_clock(self, by_ns: int) -> None:
        """Shift the mission's clock by so many ns; all nodes read another time of day from now on."""
        self._epoch_ns += by_ns
        for node in self._running:
            node.universe.clock.epoch_ns += by_ns
            node.clock.shift(by_ns)

    def forget_start(self, app_name: str) -> None:
        """Do not restart a node that was started while the mission runs."""
        config = self._started.get(app_name)
        if config is not None:
            self._started[app_name] = replace(config, respawn=False)

    def script_of(self, file: str) -> Path | None:
        """Return the script of a node that was started while the mission runs, by its virtual path."""
        config = self._started.get(Path(file).stem)
        return None if config is None else config.script

    def app_names(self) -> list[str]:
        """Return the names that a new node's application cannot have."""
        return [*(app.name for app in self._cfe.es.apps), *self._config.nodes, *self._started]

    def begin_shutdown(self, reason: str, app_name: str | None = None) -> None:
        """Ask all nodes to end, as Ctrl-C ends a roslaunch, or the node of one application.

        Args:
            reason: the reason for their shutdown hooks.
            app_name: cFE name of the application; None for all nodes.
        """
        if app_name is None:
            self.monitor.close()
        for node in self._running[:]:
            if app_name in (None, node.config.app):
                node.ask_to_shut_down(reason)

    def all_finished(self) -> bool:
        """Return True if no node's program runs any more."""
        return not self._running

    def topics(self) -> list[TopicRow]:
        """Return a row for each topic so far, by name."""
        return [self._row(topic) for _, topic in sorted(self.graph.topics.items())]

    def _row(self, topic: TopicEntry) -> TopicRow:
        return TopicRow(
            topic.name,
            topic.msg_id,
            topic.type,
            tuple(topic.publisher_names),
            tuple(topic.subscriber_names),
            topic.lost,
            topic.held_back,
            topic.definition,
            topic.latched,
            topic.unsent,
            tuple(topic.mistyped),
        )


def _python_path(universe: Universe) -> list[str]:
    """Return the folders in PYTHONPATH, which Python searches after the script's own."""
    return [universe.resolve(folder) for folder in universe.environ.get("PYTHONPATH", "").split(os.pathsep) if folder]


def _command_line(config: NodeConfig) -> list[str]:
    """Return the arguments that roslaunch would give the node."""
    found = [*config.args, *(f"{name}:={target}" for name, target in config.remap.items())]
    for special, value in (("__name", config.name), ("__ns", config.namespace if config.namespace != "/" else None)):
        if value and not any(argument.startswith(f"{special}:=") for argument in config.args):
            found.append(f"{special}:={value}")
    return found


def _finder(node: Node, made: dict[str, Factory]) -> Callable[[str], Factory | None]:
    """Return the finder of ROS's modules: rospy's own, genpy, and message packages, also those without code.

    Args:
        node: the node.
        made: factories of further modules by name.
    """
    rospy, configs = RosModules(node), ConfigModules(node.packages)

    def find(name: str) -> Factory | None:
        factory = rospy.find(name) or made.get(name)
        if factory is not None:
            return factory
        if name == "logging":
            return None if node.universe.importer.has_own(name) else lambda universe: node.logs.load_logging()
        if name in library_names():
            return None  # a package with code; its messages are made here all the same
        config = configs.find(name)
        if config is not None and ("." in name or not node.universe.importer.has_own(name)):
            return config
        module = make_module(name, node.library)
        if module is None or ("." not in name and node.universe.importer.has_own(name)):
            return None
        if isinstance(module, MessageModule):
            module.hand_on(node.universe.importer.load)
        elif (shown := shown_names(name)) is not None:
            show_only(module, shown, node.universe.importer.load)
        return lambda universe: module

    return find
