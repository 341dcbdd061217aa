"""`rospy.Service`: a pipe of requests, a child task that calls the handler, a telemetry packet for each answer.

On the Software Bus a service is a command MsgId for requests and a telemetry MsgId for answers. A request is a command
packet (function code 0) with a call number and the serialised request; an answer carries the same number, whether the
call went well, and the serialised response or the error's text. Requests are handled one after the other. May import
cfepy.nodes, cfepy.rtos and cfepy.status.
"""

from __future__ import annotations

import struct
import sys
from typing import TYPE_CHECKING, Any, ClassVar

from cfepy.nodes.report import traceback_text
from cfepy.rtos import TIMEOUT, WaitList
from cfepy.status import CfeError
from rospy_shim.exceptions import ROSInterruptException, ServiceException
from rospy_shim.genpy import Message, SerializationError
from rospy_shim.message import packer, unpacker
from rospy_shim.subscriber import DEFAULT_BUFF_SIZE, NO_PIPE

if TYPE_CHECKING:
    from collections.abc import Callable

    from rospy_shim.graph import ServiceEntry
    from rospy_shim.node import Node

request_header = struct.Struct(">HHHBB").pack
answer_header = struct.Struct(">HHH10x").pack
call_number = struct.Struct("<I")
answer_state = struct.Struct("<IB")
REQUEST_AT = 8 + 4  # bytes in front of the serialised request: command header, call number
ANSWER_AT = 16 + 5  # bytes in front of the serialised response: telemetry header, call number, success
SERVE_TIMEOUT_NS = 500_000_000


def response_of(value: Any, response_class: Any) -> Any:
    """The response that a handler's return value means.

    Args:
        value: a response, or what it is made of: a list or tuple, a dictionary, or the value of its only field.
        response_class: its class.

    Raises:
        ServiceException: the value does not fit.
    """
    if isinstance(value, Message) and value._type == response_class._type:
        return value
    if value is None:
        raise ServiceException("service handler returned None")
    try:
        if isinstance(value, dict):
            return response_class(**value)
        if isinstance(value, (list, tuple)):
            return response_class(*value)
        return response_class(value)
    except (TypeError, AttributeError) as error:
        what = "wrong number of values" if isinstance(value, (list, tuple)) else "invalid value"
        raise ServiceException(f"handler returned {what}: {error}") from None


class Service:
    """Offers a service; each node has a subclass that knows the node."""

    __module__ = "rospy.impl.tcpros_service"
    _node: ClassVar[Node]

    def __init__(
        self,
        name: str,
        service_class: Any,
        handler: Callable[[Any], Any],
        buff_size: int = DEFAULT_BUFF_SIZE,
        error_handler: Callable[..., Any] | None = None,
    ) -> None:
        """Offer a service.

        Args:
            name: of the service.
            service_class: its type.
            handler: takes the request and returns what `response_of` understands.
            buff_size: accepted.
            error_handler: takes (error, type, value, traceback) of an exception in the handler; None logs it.

        Raises:
            ROSInitException: before `init_node`.
            ServiceException: the node offers it already.
        """
        node = self._node
        node.require_initialized()
        self.resolved_name = node.names.resolve_name(name)
        self.service_class = service_class
        self.request_class = service_class._request_class
        self.response_class = service_class._response_class
        self.handler = handler
        self.buff_size = buff_size
        if error_handler is not None:
            self.error_handler = error_handler  # type: ignore[method-assign]  # as in rospy, an instance's own
        self.uri = f"rosrpc://{node.universe.host_name}:{node.universe.pid}"
        self._done = False
        self._pipe = NO_PIPE
        self._entry: ServiceEntry = node.graph.register_service(self)
        self._open()

    @property
    def node(self) -> Node:
        """The node that offers it."""
        return self._node

    def _open(self) -> None:
        node, bus = self._node, self._node.cfe.sb
        depth = bus.config.os_queue_max_depth
        self._pipe = bus.create_pipe(depth, node.task_name(self.resolved_name))
        bus.subscribe_ex(self._entry.request_id, self._pipe, 0, depth)
        node.services.append(self)
        node.start_child(self.resolved_name, self._serve)

    def error_handler(self, error: Exception, exc_type: Any, exc_value: Any, tb: Any) -> None:
        """Log an exception in the handler."""
        self._node.logs.logerr("Error processing request: %s\n%s", error, traceback_text(error))

    def shutdown(self, reason: str = "") -> None:
        """Offer the service no longer; callers whose requests wait get an error."""
        if self._done:
            return
        self._done = True
        self._node.graph.forget_service(self)
        if self in self._node.services:
            self._node.services.remove(self)
        pipe = self._node.cfe.sb.find_pipe(self._pipe)
        if pipe is not None:
            self._node.kernel.wake_all(pipe.waits, TIMEOUT)

    def spin(self) -> None:
        """Wait until the service or the node is shut down."""
        waits = WaitList(f"the end of service {self.resolved_name}")
        try:
            while not self._node.life.is_shutdown() and not self._done:
                self._node.life.wait(waits, SERVE_TIMEOUT_NS)
        except KeyboardInterrupt:
            self._node.life.signal_shutdown("keyboard interrupt")

    # -- in the task -------------------------------------------------------------------------------------------------

    def _serve(self) -> None:
        receive, pipe = self._node.cfe.sb.receive_buffer, self._pipe
        try:
            while not self._done:
                packet = receive(pipe)
                if packet is not None and not self._done:
                    self._answer(packet)
        except CfeError as error:
            if not self._done:
                self._node.logs.logerr("service %s ends: %s", self.resolved_name, error)
        finally:
            self.release()

    def release(self) -> None:
        """Give the pipe back."""
        pipe, self._pipe = self._pipe, NO_PIPE
        if pipe != NO_PIPE and self._node.cfe.sb.find_pipe(pipe) is not None:
            self._node.cfe.sb.delete_pipe(pipe)

    def _answer(self, packet: bytes) -> None:
        (number,) = call_number.unpack_from(packet, 8)
        try:
            request = unpacker(self.request_class)(packet, REQUEST_AT)
            request._connection_header = {
                "callerid": self._entry.callers.get(number, ""),
                "md5sum": self.service_class._md5sum,
                "service": self.resolved_name,
            }
            good, body = True, packer(self.response_class)(response_of(self.handler(request), self.response_class))
        except (ServiceException, SerializationError, ROSInterruptException) as error:
            good, body = False, f"service cannot process request: {error}".encode()
        except Exception as error:
            self.error_handler(error, *sys.exc_info())
            good, body = False, f"error processing request: {error}".encode()
        room = self._node.cfe.sb.config.sb_max_msg_size - ANSWER_AT
        if len(body) > room:
            good, body = False, f"service response of {len(body)} bytes: a packet has room for {room}".encode()
        payload = answer_state.pack(number, good) + body
        self._node.cfe.sb.transmit_msg(answer_header(self._entry.answer_id, 0xC000, len(payload) + 9) + payload)


def make_service(node: Node) -> type[Service]:
    """The class `rospy.Service` of a node."""
    return type("Service", (Service,), {"__module__": Service.__module__, "_node": node})
