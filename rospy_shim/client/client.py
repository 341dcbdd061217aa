"""Functions that a node calls once: `init_node`, command line, topics of the graph, `wait_for_message`
(rospy.client).
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from cfepy.reading.plain_yaml import plain_yaml
from cfepy.rtos import FOREVER, WaitList
from rospy_shim.client.logs import LoggerServices
from rospy_shim.client.rostime import limit_of
from rospy_shim.types.exceptions import ROSException, ROSInitException, ROSInterruptException
from rospy_shim.types.names import SEP, command_line_params, program_arguments

if TYPE_CHECKING:
    from rospy_shim.client.node import Node

LOOK_NS = 10_000_000  # period at which wait_for_message looks, as on ROS


class Client:
    """The client functions of one node.

    Args:
        node: the node.
    """

    def __init__(self, node: Node) -> None:
        self._node = node
        self._arguments: tuple[Any, ...] | None = None
        self._uri: str | None = None

    def init_node(
        self,
        name: str,
        argv: Sequence[str] | None = None,
        anonymous: bool = False,
        log_level: int | None = None,
        disable_rostime: bool = False,
        disable_rosout: bool = False,
        disable_signals: bool = False,
        xmlrpc_port: int = 0,
        tcpros_port: int = 0,
    ) -> None:
        """Make this program a node of the graph.

        Args:
            name: name without a namespace; `__name:=` on the command line takes precedence.
            argv: command line to take remappings from instead of sys.argv.
            anonymous: make the name unique.
            log_level: rospy.DEBUG to rospy.FATAL.
            disable_rostime: do not follow /clock, regardless of the parameter /use_sim_time.
            disable_rosout: do not publish on /rosout.
            disable_signals: leave SIGINT and SIGTERM alone.
            xmlrpc_port: accepted.
            tcpros_port: accepted.

        Raises:
            ValueError: an empty name, or one with a namespace; outside of the main thread, unless signals are disabled.
            ROSException: called before with other arguments.
        """
        node = self._node
        if argv is None:
            argv = node.argv()
        else:
            node.names.reload_mappings(argv)
        if not name:
            raise ValueError("name must not be empty")
        if SEP in name:
            raise ValueError("namespaces are not allowed in node names")
        arguments = (name, argv, anonymous, log_level, disable_rostime, disable_signals)
        if self._arguments is not None:
            if self._arguments != arguments:
                raise ROSException(
                    f"rospy.init_node() has already been called with different arguments: {self._arguments}"
                )
            return
        self._arguments = arguments
        if not disable_signals:
            node.life.register_signals()
        node.names.give(self._base_name(name, anonymous))
        self._uri = f"http://{node.universe.host_name}:{node.universe.pid}/"
        node.clock.set_rostime_initialized(True)
        self._load_params(argv)
        node.logs.configure(log_level, not disable_rosout)
        node.go_on_graph()
        LoggerServices(node).offer()
        if not disable_rostime:
            node.clock.init_simtime()

    def _base_name(self, name: str, anonymous: bool) -> str:
        insisted = self._node.names.insisted_name
        if insisted is not None:
            return insisted
        if not anonymous:
            return name
        universe = self._node.universe
        return f"{name}_{universe.pid}_{(universe.clock.epoch_ns + universe.kernel.now) // 1_000_000}"

    def _load_params(self, argv: Sequence[str]) -> None:
        """Set the private parameters given in the mission file, and then the ones on the command line."""
        self._node.params.give(self._node.config.params)
        for name, value in self.load_command_line_node_params(argv).items():
            self._node.params.set_param(f"~{name}", value)

    def load_command_line_node_params(self, argv: Sequence[str]) -> dict[str, Any]:
        """Return the private parameters on a command line, given as `_name:=value`, with the value in YAML.

        Raises:
            ROSInitException: an argument that has ":=" twice, or whose value is not YAML.
        """
        try:
            return {name: plain_yaml(text) for name, text in command_line_params(argv).items()}
        except Exception as error:
            raise ROSInitException(f"invalid command-line parameters: {error}") from error

    def myargv(self, argv: Sequence[str] | None = None) -> list[str]:
        """Return the command line without remappings and parameters."""
        return program_arguments(self._node.argv() if argv is None else argv)

    def get_node_uri(self) -> str | None:
        """Return an address that is unique to the node; None before `init_node`."""
        return self._uri

    def set_node_uri(self, uri: str | None) -> None:
        """Set another address of the node."""
        self._uri = uri

    def is_initialized(self) -> bool:
        """Return True if `init_node` has run."""
        return self._node.initialized

    def set_initialized(self, initialized: bool) -> None:
        """Set whether `init_node` has run."""
        self._node.initialized = initialized

    def get_published_topics(self, namespace: str = SEP) -> list[list[str]]:
        """Return [topic, type] of all topics below a namespace that have a publisher."""
        return self._node.graph.published(namespace)

    def wait_for_message(self, topic: str, topic_type: Any, timeout: Any = None) -> Any:
        """Wait for the next message of a topic, or return its latched one.

        Args:
            topic: its name.
            topic_type: its message class.
            timeout: longest time, seconds or a Duration; None waits without limit.

        Raises:
            ROSException: no message came in time.
            ROSInterruptException: the node is shut down.
        """
        life, kernel = self._node.life, self._node.kernel
        waits = WaitList(f"a message on {topic}")
        found: list[Any] = []

        def keep(message: Any) -> None:
            if not found:
                found.append(message)
                kernel.wake_all(waits)

        begin = kernel.now
        limit = None if timeout != timeout else limit_of(timeout)  # nothing is later than NaN
        subscriber = self._node.Subscriber(topic, topic_type, keep)
        try:
            while not found and not life.is_shutdown():
                life.wait(waits, FOREVER if limit is None else _till_look(limit) - (kernel.now - begin))
                kernel.delay(_till_look(kernel.now - begin) - (kernel.now - begin))
                if limit is not None and kernel.now - begin >= limit:
                    raise ROSException(f"timeout exceeded while waiting for message on topic {topic}")
        finally:
            subscriber.unregister()
        if life.is_shutdown():
            raise ROSInterruptException("rospy shutdown")
        return found[0]


def _till_look(after_ns: int) -> int:
    """Return when `wait_for_message` looks at or after a time, both in ns from its beginning; not at once."""
    return max(-(-after_ns // LOOK_NS), 1) * LOOK_NS
