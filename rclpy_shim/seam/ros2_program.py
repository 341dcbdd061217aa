"""`Ros2Program`: one ROS 2 program in its cFE application, with any number of nodes (rcl's context).

It is a participant of the mission's graph, as a `Node` of rospy_shim is, and makes the entities of its nodes. Two
programs may have nodes of the same name. The program appears on the graph under the name of its first node.
"""

from __future__ import annotations

import signal
from types import ModuleType
from typing import TYPE_CHECKING, Any

from cfepy.interpreter.node_interrupt import NodeInterrupt
from rclpy_shim.interfaces import Interfaces
from rclpy_shim.seam.matching import Quality
from rclpy_shim.seam.own_topics import ROSOUT, LogLine, OwnTopics
from rclpy_shim.seam.service_ends import ServiceClient, ServiceServer
from rclpy_shim.seam.topic_ends import TopicReader, TopicWriter
from rclpy_shim.seam.waiting import WaitingNode
from rospy_shim.library_parts import FOLDER
from rospy_shim.types.msgs import OnDisk

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping

Entity = TopicWriter | TopicReader | ServiceServer | ServiceClient


class Ros2Program(WaitingNode):
    """A ROS 2 program; it takes the arguments of rospy_shim's `Node`.

    Attributes:
        interfaces: message types of the program.
    """

    def __init__(self, *args: Any, **options: Any) -> None:
        super().__init__(*args, **options)
        self.interfaces = Interfaces([OnDisk(self.packages)], self.universe.environ)
        self._entities: list[Entity] = []
        self.own_topics = OwnTopics(self)

    # -- the graph ---------------------------------------------------------------------------------------------------

    def open_node(self, full_name: str) -> None:
        """Go on the graph with the first node of the program; further nodes share its entry."""
        if self.initialized:
            return
        self.initialized = True
        self.names.name = full_name
        self.universe.name = full_name.lstrip("/")
        self.graph.nodes.setdefault(full_name, self)

    def leave_graph(self) -> None:
        """Close all entities."""
        for entity in self._entities[:]:
            self.close(entity)
        self.graph.forget_node(self)

    def abandon(self) -> None:
        """Remove everything from the graph and the bus after the end of the program."""
        self.leave_graph()

    def close(self, entity: Entity) -> None:
        """Close an entity; closing it again has no effect."""
        if entity in self._entities:
            self._entities.remove(entity)
            entity.close()

    # -- entities ----------------------------------------------------------------------------------------------------

    def add_publisher(self, name: str, data_class: Any, quality: Quality, warn: Callable[[str], object]) -> TopicWriter:
        """Make a publisher.

        Args:
            name: resolved name of the topic.
            data_class: message class.
            quality: its quality of service.
            warn: logs a warning in the name of the node.
        """
        made = TopicWriter(self, name, data_class, quality, warn)
        self._entities.append(made)
        made.connect()
        return made

    def own_writer(self, name: str, data_class: Any, quality: Quality) -> TopicWriter:
        """Make a publisher of the program itself, which is not connected yet; see `add_publisher`."""
        made = TopicWriter(self, name, data_class, quality, lambda text: None)
        self._entities.append(made)
        return made

    def add_subscription(
        self, name: str, data_class: Any, quality: Quality, warn: Callable[[str], object]
    ) -> TopicReader:
        """Make a subscription; it takes the arguments of `add_publisher`.

        Raises:
            CfeError: the bus has no room for another pipe or subscription.
        """
        made = TopicReader(self, name, data_class, quality, warn)
        self._entities.append(made)
        made.connect()
        if name == ROSOUT and made.topic is not None:
            for node in list(self.graph.nodes.values()):
                if isinstance(node, Ros2Program):
                    node.own_topics.open_rosout()
        return made

    def add_service(self, name: str, service_class: Any, depth: int, is_quiet: bool = False) -> ServiceServer:
        """Offer a service; see `ServiceServer`."""
        made = ServiceServer(self, name, service_class, depth, is_quiet)
        self._entities.append(made)
        return made

    def add_client(self, name: str, service_class: Any, depth: int) -> ServiceClient:
        """Make a client; see `ServiceClient`."""
        made = ServiceClient(self, name, service_class, depth)
        self._entities.append(made)
        return made

    # -- waiting and time --------------------------------------------------------------------------------------------

    def now_ns(self) -> int:
        """Return ROS's time in ns."""
        self.universe.charge()
        return self.clock.wall_ns()

    def catch_signals(self, on_signal: Callable[[], object], numbers: Iterable[int]) -> None:
        """Let signals shut rclpy down; a handler that was set before runs too. Only the main thread can do this."""
        table = self.universe.signals
        if self.kernel.current is not self.universe.main_task:
            return
        for number in numbers:
            table.set(number, self._handler(on_signal, table.get(number)))

    def _handler(self, on_signal: Callable[[], object], former: Any) -> Callable[[int, object], None]:
        def handle(number: int, frame: object) -> None:
            if former is not signal.default_int_handler:
                on_signal()
                if callable(former):
                    former(number, frame)
                return
            main = self.universe.main_task
            if main is None or main is self.kernel.current or not self.kernel.is_waiting(main):
                on_signal()
                raise NodeInterrupt
            self.kernel.interrupt(main, NodeInterrupt())  # as a KeyboardInterrupt, before it sees the shutdown
            on_signal()

        return handle

    def restore_signals(self, handlers: Mapping[int, Any]) -> None:
        """Set handlers of signals again, by signal; only the main thread can do this."""
        if self.kernel.current is self.universe.main_task:
            for number, handler in handlers.items():
                self.universe.signals.set(number, handler)

    def module(self) -> ModuleType:
        """Return the module `rclpy._seam` of the program."""
        module = ModuleType("rclpy._seam")
        vars(module).update(
            program=self,
            Quality=Quality,
            now_ns=self.now_ns,
            steady_ns=self.steady_ns,
            ring=self.waiting.look_again,
            write=self.universe.stderr.write,
            SHARED_LIBRARIES=str(FOLDER),
            log=lambda *line: self.own_topics.log(LogLine(*line)),
            tell_parameters=self.own_topics.tell_parameters,
        )
        return module
