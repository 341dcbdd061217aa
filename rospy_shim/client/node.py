"""One ROS node: the object behind the functions and classes of its own `rospy`.

Every node of a mission has one; two nodes share only the graph.
"""

from __future__ import annotations

import sys
from collections.abc import Callable
from itertools import count
from pathlib import Path
from typing import TYPE_CHECKING, Any
from xml.parsers.expat import ExpatError

from cfepy.rtos import Mutex, Task
from cfepy.status import CfeError
from rospy_shim.client.client import Client
from rospy_shim.client.link import Link, link_class
from rospy_shim.client.logs import Logs
from rospy_shim.client.params import Params
from rospy_shim.client.rostime import RosClock
from rospy_shim.client.service import Service, make_service
from rospy_shim.client.service_proxy import AnswerPipes, make_service_proxy, wait_for_service
from rospy_shim.client.shutdown import Life
from rospy_shim.client.subscription import Subscription
from rospy_shim.client.timer import make_rate, make_timer
from rospy_shim.client.topics import make_publisher, make_subscriber
from rospy_shim.parameters.values import through_xml
from rospy_shim.types.exceptions import ROSInitException
from rospy_shim.types.msgs import Library, OnDisk, Packages, shipped
from rospy_shim.types.names import Names, is_legal_name, refusal

if TYPE_CHECKING:
    from cfepy.app import Cfe
    from cfepy.nodes import NodeConfig, Universe
    from rospy_shim.client.tasks import NodeTasks
    from rospy_shim.graph.graph import Graph, TopicEntry
    from rospy_shim.types.msgs import MessageClass


NO_MASTER = "Unable to immediately register with master node [%s]: master may not be running yet. Will keep trying."
AGAIN_NS = 200_000_000


class Node:
    """A node.

    Args:
        cfe: the handle of cFE's services.
        graph: the mission's ROS graph.
        universe: the module universe that the node's program runs in.
        config: its configuration in the mission file.
        tasks: starts tasks in the name of the node's application.
        call_ns: virtual CPU time of a call.
        publish_slot_ns: a publisher sends at most one message in each interval of so many ns; 0 for no limit.
    """

    def __init__(
        self,
        cfe: Cfe,
        graph: Graph,
        universe: Universe,
        config: NodeConfig,
        tasks: NodeTasks,
        call_ns: int,
        publish_slot_ns: int = 0,
    ) -> None:
        self.cfe = cfe
        self.graph = graph
        self.universe = universe
        self.config = config
        self.kernel = universe.kernel
        self.call_ns = call_ns
        self.publish_slot_ns = publish_slot_ns
        self.initialized = False
        self._is_stuck = False
        self.links: dict[str, Link] = {}
        self.handler: Any = None  # its ROSHandler, once a program of the node has loaded the class
        self.subscriptions: dict[str, Subscription] = {}
        self.services: list[Service] = []
        self.connection_numbers = count(1)
        self.takes_connections = Mutex(universe.kernel, "connections")  # rospy has one thread for it
        self._tasks = tasks
        self.owner = tasks.owner
        self._timer: type | None = None
        self.place = config.near or (Path(universe.resolve(universe.script)) if universe.script else None)
        self.packages = Packages(self.place, universe.environ, universe.resolve)
        self.library = Library([OnDisk(self.packages)], base=shipped())
        self.names = Names(universe.argv, universe.environ)
        self.life = Life(self)
        self.clock = RosClock(self)
        self.params = Params(self, graph.params)
        self.logs = Logs(self)
        self.client = Client(self)
        self.Publisher = make_publisher(self)
        self.Subscriber = make_subscriber(self)
        self.Service = make_service(self)
        self.ServiceProxy = make_service_proxy(self)
        self.answer_pipes = AnswerPipes(self)
        self.Rate = make_rate(self)

    def working(self, name: str, unpack: Callable[[bytes, int], Any]) -> Callable[[bytes, int], Any]:
        """Return `unpack` of a topic or a service, extended by the configured computing time of its callbacks."""
        said = {self.names.resolve_name(each): time_ns for each, time_ns in self.config.compute.items()}
        time_ns, compute = said.get(name, 0), self.kernel.compute
        if not time_ns:
            return unpack

        def unpack_and_work(data: bytes, at: int) -> Any:
            message = unpack(data, at)
            compute(time_ns)
            return message

        return unpack_and_work

    @property
    def Timer(self) -> type:  # rospy's name
        """The node's class `rospy.Timer`, made at first use because it needs `threading`."""
        if self._timer is None:
            self._timer = make_timer(self)
        return self._timer

    def argv(self) -> list[str]:
        """Return the node's present `sys.argv`."""
        return list(self.universe.importer.modules["sys"].argv)

    # -- the graph ---------------------------------------------------------------------------------------------------

    def go_on_graph(self) -> None:
        """Register the node, and its topics and services made so far; called by `init_node`."""
        self.initialized = True
        self.universe.name = self.names.name.lstrip("/")
        self.graph.register_node(self)
        for service in self.services:
            service.__connect__()
        for link in list(self.links.values()):
            link.connect()
        for subscription in list(self.subscriptions.values()):
            subscription.connect()

    def leave_graph(self) -> None:
        """Close all publishers, subscribers and services at shutdown."""
        for subscription in list(self.subscriptions.values()):
            subscription.close()
        for link in list(self.links.values()):
            link.close()
        for service in self.services[:]:
            service.shutdown()
        self.graph.forget_node(self)

    def abandon(self) -> None:
        """Remove everything from the graph and the bus after the end of the program."""
        holders: list[Subscription | Service] = [*self.subscriptions.values(), *self.services]
        self.leave_graph()
        for holder in holders:
            try:
                holder.__give_back__()
            except CfeError:
                pass  # ES has cleaned up before

    def link(self, name: str, data_class: MessageClass) -> Link:
        """Return the publishing side of a topic; make it at first use."""
        link = self.links.get(name)
        if link is None or link.data_class._md5sum != data_class._md5sum:
            link = self.links[name] = link_class(self)(self, name, data_class)
            if self.initialized:
                link.connect()
        return link

    def subscription(self, name: str, data_class: MessageClass) -> Subscription:
        """Return the subscribing side of a topic; make it at first use."""
        found = self.subscriptions.get(name)
        if found is None or found.data_class is not data_class:
            found = Subscription(self, name, data_class)
            if self.initialized:
                found.connect()
            self.subscriptions.setdefault(name, found)
        return found

    def topic_for(self, name: str, data_class: MessageClass, registration: str) -> TopicEntry | None:
        """Return the topic to connect to.

        It is None if the node is shut down, if the master refuses the name, or if the topic has another type. The
        latter two are logged, and the rest of the graph goes on.

        Args:
            name: resolved name.
            data_class: message class.
            registration: the kind of registration, "publication" or "subscription".

        Raises:
            UsageError: the topic's MsgId belongs to another topic.
        """
        if self.life.over or self.is_refused("topic", name, registration):
            return None
        topic = self.graph.topic(name)
        if topic.join(data_class):
            return topic
        topic.mistyped.append((self.names.name, data_class._type))
        self.logs.logerr(
            "[%s] has the type %s [%s] for topic %s, which is %s [%s] on the graph: not connected",
            self.names.name,
            data_class._type,
            data_class._md5sum,
            topic.name,
            topic.type,
            topic.md5sum,
        )
        return None

    def is_refused(self, kind: str, name: str, registration: str) -> bool:
        """Return True if the master refuses the resolved name of a "topic" or "service"; the refusal is logged.

        XML cannot carry some characters. With one, rospy tries again until the node shuts down, and so does this; the
        node can make no other topic meanwhile.
        """
        if not _fits_in_xml(name):
            self.logs.logerr(NO_MASTER, self.universe.environ.get("ROS_MASTER_URI", ""))
            self._is_stuck = True
        self.wait_for_registration()
        reason = refusal(kind, name)
        if reason is not None:
            self.logs.logfatal("unable to register %s [%s] with master: %s", registration, name, reason)
        return reason is not None

    def wait_for_registration(self) -> None:
        """Wait while a name cannot be registered: until the shutdown."""
        while self._is_stuck and not self.life.is_shutdown():
            self.kernel.delay(AGAIN_NS)

    def wait_for_service(self, service: str, timeout: Any = None) -> None:
        """Wait until a node offers a service; see `rospy_shim.client.service_proxy.wait_for_service`."""
        wait_for_service(self, service, timeout)

    def require_initialized(self) -> None:
        """Check that `init_node` has run.

        Raises:
            ROSInitException: it has not.
        """
        if not self.initialized:
            raise ROSInitException("client code must call rospy.init_node() first")

    # -- warnings ----------------------------------------------------------------------------------------------------

    def warn(self, text: str, category: type[Warning]) -> None:
        """Warn through the node's own `warnings`, at the line of the node that called."""
        self.universe.importer.load("warnings").warn(text, category, stacklevel=_depth_of_rospy() + 1)

    def warn_of_illegal(self, name: str) -> None:
        """Warn about a name that breaks ROS's rules."""
        if not is_legal_name(name):
            text = f"'{name}' is not a legal ROS graph resource name. This may cause problems with other ROS tools"
            self.warn(text, UserWarning)

    # -- tasks -------------------------------------------------------------------------------------------------------

    def task_name(self, label: str) -> str:
        """Return a name for a task or a pipe that is unique in the mission."""
        return self._tasks.name(label)

    def start_child(self, name: str, body: Callable[[], None]) -> None:
        """Start a child task of the node's application, with a name from `task_name`."""
        self._tasks.child(self, name, body)

    def start_task(self, label: str, body: Callable[[], None]) -> Task:
        """Start a task of the node from any task, or from the host."""
        return self._tasks.helper(self, label, body)

    def ask_to_shut_down(self, reason: str) -> None:
        """Shut the node down from outside; its hooks run in a task of its own."""
        if not self.life.is_shutdown_requested():
            self.start_task("shutdown", lambda: self.life.interrupt(reason))

    def give_way(self) -> None:
        """Shut down as ROS's master asks of a node whose name another node has taken."""
        request = f"[{self.names.name}] Reason: new node registered with same name"
        self.universe.stdout.write(f"shutdown request: {request}\n")
        reason = f"external shutdown request from [/master]: [{request}]"
        self.start_task("shutdown", lambda: self.life.signal_shutdown(reason))


def _fits_in_xml(name: str) -> bool:
    try:
        through_xml("register", name, name)
    except ExpatError:
        return False
    return True


def _depth_of_rospy() -> int:
    """Return the number of rospy's innermost frames, without this function's."""
    frame, depth = sys._getframe(1), 0
    while frame.f_back is not None and frame.f_globals.get("__name__", "").startswith("rospy_shim."):
        frame, depth = frame.f_back, depth + 1
    return depth
