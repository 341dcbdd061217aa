"""`rospy.ServiceProxy` and `rospy.wait_for_service`: calling a service over the Software Bus; see `rospy_shim.service`.

The caller waits for the answer in a pipe of its own. May import cfepy.status.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, ClassVar

from cfepy.status import CfeError
from rospy_shim.exceptions import ROSException, ROSInterruptException, ServiceException
from rospy_shim.message import args_kwds_to_message, packer, unpacker
from rospy_shim.rostime import nanoseconds
from rospy_shim.service import ANSWER_AT, REQUEST_AT, answer_state, call_number, request_header
from rospy_shim.subscriber import NO_PIPE

if TYPE_CHECKING:
    from rospy_shim.graph import ServiceEntry
    from rospy_shim.node import Node

LOOK_MS = 500  # how often a caller looks whether the service is still there
POLL_NS = 20_000_000  # how often wait_for_service looks
ANSWERS = 8  # answers to all callers pass through each caller's pipe


class ServiceProxy:
    """Calls a service; each node has a subclass that knows the node."""

    __module__ = "rospy.impl.tcpros_service"
    _node: ClassVar[Node]

    def __init__(
        self, name: str, service_class: Any, persistent: bool = False, headers: dict[str, str] | None = None
    ) -> None:
        """Prepare to call a service.

        Args:
            name: of the service.
            service_class: its type.
            persistent: keep the pipe for answers from call to call.
            headers: accepted.
        """
        self.resolved_name = self._node.names.resolve_name(name)
        self.service_class = service_class
        self.request_class = service_class._request_class
        self.response_class = service_class._response_class
        self.persistent = persistent
        self._pipe = NO_PIPE

    def __call__(self, *args: Any, **kwds: Any) -> Any:
        """See `call`."""
        return self.call(*args, **kwds)

    def call(self, *args: Any, **kwds: Any) -> Any:
        """Call the service with a request, or with its fields; the response.

        Raises:
            TypeError, AttributeError: the arguments do not make a request.
            SerializationError: a field holds what its type cannot carry.
            ServiceException: there is no such service, or it failed.
        """
        node = self._node
        node.universe.charge()
        body = packer(self.request_class)(args_kwds_to_message(self.request_class, args, kwds))
        entry = node.graph.services.get(self.resolved_name)
        if entry is None:
            raise ServiceException(f"service [{self.resolved_name}] unavailable")
        self._check_type(entry)
        pipe = self._open(entry)
        try:
            good, answer = self._exchange(entry, pipe, body)
        finally:
            if not self.persistent:
                self.close()
        if not good:
            raise ServiceException(f"service [{self.resolved_name}] responded with an error: {answer!r}")
        response = unpacker(self.response_class)(answer, 0)
        response._connection_header = {
            "callerid": entry.service.node.names.name,
            "md5sum": self.service_class._md5sum,
            "service": self.resolved_name,
            "type": self.service_class._type,
        }
        return response

    def _check_type(self, entry: ServiceEntry) -> None:
        ours, theirs = self.service_class._md5sum, entry.service.service_class._md5sum
        if ours != theirs:
            raise ServiceException(
                f"unable to connect to service: remote error reported: request from [{self._node.names.name}]:"
                f" md5sums do not match: [{ours}] vs. [{theirs}]"
            )

    def _open(self, entry: ServiceEntry) -> int:
        if self._pipe == NO_PIPE:
            bus = self._node.cfe.sb
            self._pipe = bus.create_pipe(ANSWERS, self._node.task_name(self.resolved_name))
            bus.subscribe_ex(entry.answer_id, self._pipe, 0, ANSWERS)
        return self._pipe

    def _exchange(self, entry: ServiceEntry, pipe: int, body: bytes) -> tuple[bool, bytes]:
        """Send a request and wait for the answer that carries its number."""
        bus, graph = self._node.cfe.sb, self._node.graph
        room = bus.config.sb_max_msg_size - REQUEST_AT
        if len(body) > room:
            raise ServiceException(f"request of {len(body)} bytes: a packet has room for {room}")
        number = entry.begin(self._node.names.name)
        packet = request_header(entry.request_id, 0xC000, len(body) + 5, 0, 0) + call_number.pack(number) + body
        try:
            bus.transmit_msg(packet)
            while graph.services.get(self.resolved_name) is entry:
                answer = bus.receive_buffer(pipe, LOOK_MS)
                if answer is not None:
                    answered, good = answer_state.unpack_from(answer, 16)
                    if answered == number:
                        return bool(good), answer[ANSWER_AT:]
        except CfeError as error:
            raise ServiceException(f"service [{self.resolved_name}]: {error}") from error
        finally:
            entry.callers.pop(number, None)
        raise ServiceException("transport error completing service call: the service has ended")

    def close(self) -> None:
        """Give the pipe of a persistent proxy back."""
        pipe, self._pipe = self._pipe, NO_PIPE
        if pipe != NO_PIPE and self._node.cfe.sb.find_pipe(pipe) is not None:
            self._node.cfe.sb.delete_pipe(pipe)

    def wait_for_service(self, timeout: Any = None) -> None:
        """Wait until the service is there; see the function of that name."""
        wait_for_service(self._node, self.resolved_name, timeout)


def wait_for_service(node: Node, service: str, timeout: Any = None) -> None:
    """Wait until somebody offers a service.

    Args:
        node: who waits.
        service: its name.
        timeout: longest time, seconds or a Duration; None waits for as long as it takes.

    Raises:
        ROSException: nobody did in time.
        ROSInterruptException: the node is shut down.
    """
    name, kernel = node.names.resolve_name(service), node.kernel
    deadline = None if timeout is None else kernel.now + nanoseconds(timeout)
    while not node.life.is_shutdown():
        if name in node.graph.services:
            return
        if deadline is not None and kernel.now >= deadline:
            raise ROSException(f"timeout exceeded while waiting for service {name}")
        kernel.delay(POLL_NS if deadline is None else min(POLL_NS, deadline - kernel.now))
    raise ROSInterruptException("rospy shutdown")


def make_service_proxy(node: Node) -> type[ServiceProxy]:
    """The class `rospy.ServiceProxy` of a node."""
    return type("ServiceProxy", (ServiceProxy,), {"__module__": ServiceProxy.__module__, "_node": node})
