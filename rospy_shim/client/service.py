"""`rospy.Service`: a node offers a service, whose requests and answers are packets on the Software Bus.

A service is a command MsgId for requests and a telemetry MsgId for answers. After the header comes the number of the
call. In an answer, 1 for success or 0 for an error follows. Then comes the serialised request or response, or the
error's text, cut into segments if it is long. One task handles requests. If a request comes while all of the service's
tasks are in the handler, the service gets another task until no request waits, so that handlers run side by side as in
rospy.
"""

from __future__ import annotations

import struct
import sys
from collections.abc import Iterator
from typing import TYPE_CHECKING, Any, ClassVar

from cfepy.interpreter.node_interrupt import NodeInterrupt
from cfepy.nodes.node_tracebacks import traceback_parts, traceback_text
from cfepy.rtos import TIMEOUT, TaskExit, WaitList, is_end_of_task
from cfepy.status import CfeError
from rospy_shim.client.message import packer, unpacker
from rospy_shim.client.subscription import DEFAULT_BUFF_SIZE, ENDS_OF_THREAD, NO_PIPE
from rospy_shim.types.exceptions import ServiceException
from rospy_shim.types.genpy import Message
from rospy_shim.types.transport import FIRST, LAST, MIDDLE, WHOLE

if TYPE_CHECKING:
    from collections.abc import Callable

    from cfepy.sb import Pipe
    from rospy_shim.client.node import Node
    from rospy_shim.graph.graph import Graph, ServiceEntry
    from rospy_shim.types.msgs import MessageClass, ServiceClass

REQUEST_LEAD = 8 + 4  # command header (function code 0), call number
ANSWER_LEAD = 16 + 5  # telemetry header, call number, success
_request = struct.Struct(">HBBHBB").pack
_answer = struct.Struct(">HBBH10x").pack
_call = struct.Struct("<I")
_outcome = struct.Struct("<IB")
SERVE_TIMEOUT_NS = 500_000_000
POLL = 0
FOREVER_MS = -1
PACE_NS = 100_000  # period of looking for room for the next segment of an answer
PATIENCE = 100  # looks
WINDOW = 4  # packets of long requests and answers that may wait
NO_CALL = -1  # the ground can send a packet of any length on the MsgId of a service
MOST_BEGUN = 1000  # incomplete long requests or answers
_NOTE = (
    "cfepy: the handler of {service} raised {why}. As on ROS, the caller gets no answer, and waits until another"
    " caller connects to the node.\n"
)


def request_packets(msg_id: int, number: int, body: bytes, most: int) -> Iterator[bytes]:
    """Yield the packets of a request; the bus fills in sequence count, length and checksum.

    Args:
        msg_id: MsgId of the service's requests.
        number: number of the call.
        body: the serialised request.
        most: maximum bytes of a packet.
    """
    lead = _call.pack(number)
    for flags, piece in _pieces(body, most - REQUEST_LEAD):
        yield _request(msg_id, flags, 0, len(piece) + REQUEST_LEAD - 7, 0, 0) + lead + piece


def answer_packets(msg_id: int, number: int, good: bool, body: bytes, most: int) -> Iterator[bytes]:
    """Yield the packets of an answer; the bus fills in sequence count, length and time.

    Args:
        msg_id: MsgId of the service's answers.
        number: number of the call.
        good: True if it succeeded.
        body: the serialised response, or the error's text.
        most: maximum bytes of a packet.
    """
    lead = _outcome.pack(number, good)
    for flags, piece in _pieces(body, most - ANSWER_LEAD):
        yield _answer(msg_id, flags, 0, len(piece) + ANSWER_LEAD - 7) + lead + piece


def call_of_request(packet: bytes) -> int:
    """Return the number of a request's call; `NO_CALL` if the packet is too short."""
    if len(packet) < REQUEST_LEAD:
        return NO_CALL
    number: int = _call.unpack_from(packet, REQUEST_LEAD - 4)[0]
    return number


def call_of_answer(packet: bytes) -> tuple[int, bool]:
    """Return the number of an answer's call, or `NO_CALL` if the packet is too short, and True if the call
    succeeded.
    """
    if len(packet) < ANSWER_LEAD:
        return NO_CALL, False
    number, good = _outcome.unpack_from(packet, ANSWER_LEAD - 5)
    return number, bool(good)


class Pieces:
    """Reassembles segments, separately for each call.

    Args:
        lead: bytes of a packet in front of the segment.
    """

    def __init__(self, lead: int) -> None:
        self._lead = lead
        self._parts: dict[int, list[bytes]] = {}

    def add(self, number: int, packet: bytes) -> bytes | None:
        """Add a packet of a call. Returns the whole request or answer if it was the last one."""
        if number == NO_CALL:
            return None
        flags, piece = packet[2] & WHOLE, packet[self._lead :]
        if flags == WHOLE:
            return piece
        if flags == FIRST:
            self._parts[number] = [piece]
            if len(self._parts) > MOST_BEGUN:
                del self._parts[next(iter(self._parts))]
            return None
        parts = self._parts.get(number)
        if parts is None:
            return None  # its beginning came before this side existed
        parts.append(piece)
        return b"".join(self._parts.pop(number)) if flags == LAST else None


def _pieces(body: bytes, room: int) -> Iterator[tuple[int, bytes]]:
    """Yield the contents of each packet, with its sequence flags."""
    size = len(body)
    if size <= room:
        yield WHOLE, body
        return
    for start in range(0, size, room):
        yield FIRST if start == 0 else LAST if start + room >= size else MIDDLE, body[start : start + room]


def response_of(response: Any, response_class: MessageClass) -> Any:
    """Make the response from a handler's return value.

    Args:
        response: a response, or its contents: a list or tuple, a dictionary, or the value of its only field.
        response_class: its class.

    Raises:
        ServiceException: the value does not fit.
    """
    if isinstance(response, Message) and response._type == response_class._type:
        return response
    if response is None:
        raise ServiceException("service handler returned None")
    try:
        if isinstance(response, dict):
            return response_class(**response)
        if isinstance(response, (list, tuple)):
            return response_class(*response)
        return response_class(response)
    except (TypeError, AttributeError) as error:
        what = "wrong number of values" if isinstance(response, (list, tuple)) else "invalid value"
        raise ServiceException(f"handler returned {what}: {error}") from None


def room_of(pipe: Pipe, packet: bytes) -> int:
    """Return how many packets may wait in a pipe for another to be sent; only a few of long messages, as they fill
    the bus.
    """
    return pipe.depth if packet[2] & WHOLE == WHOLE else min(pipe.depth, WINDOW)


class Service:
    """Offers a service; each node has a subclass that knows the node."""

    __module__ = "rospy.impl.tcpros_service"
    __node__: ClassVar[Node]
    __is_quiet__: ClassVar[bool] = False

    def __init__(
        self,
        name: str,
        service_class: ServiceClass,
        handler: Callable[[Any], Any],
        buff_size: int = DEFAULT_BUFF_SIZE,
        error_handler: Callable[..., Any] | None = None,
    ) -> None:
        """Offer a service. Before `init_node`, it is offered from then on.

        Args:
            name: name of the service.
            service_class: its type.
            handler: takes the request and returns a value that `response_of` accepts.
            buff_size: accepted.
            error_handler: takes (error, type, value, traceback) of an exception in the handler; None logs it.

        Raises:
            ServiceException: the node offers it already.
            ValueError: an empty name.
        """
        node = self.__node__
        if not name or not isinstance(name, str):
            raise ValueError("service name is not a non-empty string")
        self.resolved_name = node.names.resolve_name(name)
        self.service_class = service_class
        self.request_class = service_class._request_class
        self.response_class = service_class._response_class
        self.handler = handler
        self.buff_size = buff_size
        if error_handler is not None:
            self.error_handler = error_handler  # type: ignore[method-assign]  # as in rospy, an instance's own
        self.uri = f"rosrpc://{node.universe.host_name}:{node.universe.pid}"
        self.__done = False
        self.__pipe = NO_PIPE
        self.__tasks = 0  # tasks that serve
        self.__busy = 0  # tasks in the handler
        self.__pieces = Pieces(REQUEST_LEAD)
        self.__unpack = node.working(self.resolved_name, unpacker(self.request_class))
        self.__pack = packer(self.response_class)
        self.__entry: ServiceEntry
        self.__refused = False  # by the master
        node.warn_of_illegal(name)
        if any(each.resolved_name == self.resolved_name for each in node.services):
            raise ServiceException(f"service [{self.resolved_name}] already registered")
        if node.initialized:
            self.__connect__()
        node.services.append(self)

    def __connect__(self) -> None:
        """Offer the service when the node is initialised, unless the master refuses its name."""
        self.__refused = self.__node__.is_refused("service", self.resolved_name, "service")
        if not self.__refused:
            self.__entry = self.__node__.graph.register_service(self)
            if not self.__is_quiet__:
                self.__begin()

    def __begin(self) -> None:
        name = self.__node__.task_name(self.resolved_name)
        self.__open(name)
        self.__node__.start_child(name, self.__serve)

    def __open(self, name: str) -> None:
        if self.__pipe == NO_PIPE:
            bus = self.__node__.cfe.sb
            depth = bus.config.os_queue_max_depth
            self.__pipe = bus.create_pipe(depth, name)
            bus.subscribe_ex(self.__entry.request_id, self.__pipe, 0, depth)

    def error_handler(self, e: Exception, exc_type: Any, exc_value: Any, tb: Any) -> None:
        """Log an exception in the handler; the traceback is a list in brackets, as in rospy."""
        self.__node__.logs.logerr("Error processing request: %s\n%s", e, traceback_parts(e))

    def shutdown(self, reason: str = "") -> None:
        """Stop offering the service. A handler that runs still answers its caller; requests that wait get an error."""
        if self.__done:
            return
        self.__done = True
        self.__node__.graph.forget_service(self)
        if self in self.__node__.services:
            self.__node__.services.remove(self)
        if not self.__node__.initialized or self.__refused:
            return
        own = self.__node__.cfe.sb.find_pipe(self.__pipe)
        if own is not None:
            own.call_reader()
        for pipe in map(self.__node__.cfe.sb.find_pipe, [call.pipe for call in self.__entry.calls.values()]):
            if pipe is not None:
                self.__node__.kernel.wake_all(pipe.waits, TIMEOUT)

    def spin(self) -> None:
        """Wait until the service or the node is shut down."""
        waits = WaitList(f"the end of service {self.resolved_name}")
        try:
            while not self.__node__.life.is_shutdown() and not self.__done:
                self.__node__.life.wait(waits, SERVE_TIMEOUT_NS)
        except (KeyboardInterrupt, NodeInterrupt):
            self.__node__.life.signal_shutdown("keyboard interrupt")

    # -- in its tasks ------------------------------------------------------------------------------------------------

    def __attend__(self) -> None:
        """Provide a free task for a waiting request."""
        if self.__busy >= self.__tasks and not self.__done:
            self.__tasks += 1
            self.__node__.start_task(self.resolved_name, self.__help)

    def __has_room__(self, packet: bytes) -> bool:
        """Return True if a packet of a request may be sent; False before the first task has made the pipe."""
        pipe = self.__node__.cfe.sb.find_pipe(self.__pipe)
        return pipe is not None and len(pipe.items) < room_of(pipe, packet)

    def __serve(self) -> None:
        """Serve as the first task, as long as the service is offered."""
        self.__tasks += 1
        self.__work(FOREVER_MS)
        self.__give_back__()

    def __help(self) -> None:
        """Serve as a further task until no request waits."""
        self.__open(self.__node__.kernel.current.name)
        self.__work(POLL)

    def __work(self, timeout_ms: int) -> None:
        receive = self.__node__.cfe.sb.receive_buffer
        try:
            while not self.__done:
                packet = receive(self.__pipe, timeout_ms)
                if packet is not None and not self.__done:
                    self.__take(packet)
                elif timeout_ms == POLL:
                    return
        except CfeError as error:
            if not self.__done:
                self.__node__.logs.logerr("service %s ends: %s", self.resolved_name, error)
        finally:
            self.__tasks -= 1
            self.__attend_waiting()

    def __attend_waiting(self) -> None:
        pipe = self.__node__.cfe.sb.find_pipe(self.__pipe)
        if pipe is not None and pipe.items:
            self.__attend__()

    def __give_back__(self) -> None:
        """Delete the pipe."""
        pipe, self.__pipe = self.__pipe, NO_PIPE
        if pipe != NO_PIPE and self.__node__.cfe.sb.find_pipe(pipe) is not None:
            self.__node__.cfe.sb.delete_pipe(pipe)

    def __take(self, packet: bytes) -> None:
        number = call_of_request(packet)
        request = self.__pieces.add(number, packet)
        if request is None:
            return
        self.__entry.serving[number] = (self.__node__.kernel.current,)
        try:
            self.__busy += 1
            try:
                self.__attend_waiting()
                result = self.__result(number, request)
            finally:
                self.__busy -= 1
            if result is not None:
                self.__answer(number, *result)
        finally:
            self.__entry.serving.pop(number, None)  # the ground may have sent a second request of that number

    def __result(self, number: int, data: bytes) -> tuple[bool, bytes] | None:
        """Call the handler.

        Returns:
            True and the serialised response; False and the error's text; None if the caller gets no answer.
        """
        try:
            request = self.__unpack(data, 0)
        except Exception as error:  # an external caller may send any bytes, and the type's code may raise any error
            return False, f"service cannot process request: {error}".encode()
        call = self.__entry.calls.get(number)
        request._connection_header = call.header if call is not None else {}
        try:
            response = response_of(self.handler(request), self.response_class)
            self.__entry.half_answered.add(number)
            body = self.__pack(response)
            self.__entry.half_answered.discard(number)
            return True, body
        except ServiceException as error:
            return False, f"service cannot process request: {error}".encode()
        except Exception as error:
            if is_end_of_task(error):
                raise TaskExit from error
            self.error_handler(error, *sys.exc_info())
            return False, f"error processing request: {error}".encode()
        except ENDS_OF_THREAD as error:
            if not isinstance(error, SystemExit):  # as Python's threads end
                self.__node__.universe.print_error(f"Exception in thread:\n{traceback_text(error)}")
            if call is None or call.pipe == NO_PIPE:  # callers outside of the mission must not take its resources
                return False, f"error processing request: {type(error).__name__}".encode()
            self.__leave(number, type(error).__name__)
            return None

    def __leave(self, number: int, why: str) -> None:
        """Leave a call without an answer, because rospy's thread of the connection ends."""
        self.__node__.universe.print_error(_NOTE.format(service=self.resolved_name, why=why))
        self.__entry.unanswered.add(number)
        self.__wake(number)

    def __wake(self, number: int) -> None:
        """Let the caller of an unanswered call look whether its connection is still open."""
        call = self.__entry.calls.get(number)
        pipe = self.__node__.cfe.sb.find_pipe(call.pipe) if call is not None else None
        if pipe is not None:
            self.__node__.kernel.wake_all(pipe.waits, TIMEOUT)

    @staticmethod
    def __accept__(graph: Graph, entry: ServiceEntry, connection: object) -> None:
        """Note a new connection to the node of a service.

        A thread of rospy that ended leaves its socket open as long as the node's server refers to it: until the next
        connection. Its caller waits until then.
        """
        server = entry.service.__node__.names.name
        graph.accepted[server] = connection
        for each in graph.services.values():
            if each.unanswered and isinstance(each.service, Service) and each.service.__node__.names.name == server:
                for number in sorted(each.unanswered):
                    each.service.__wake(number)

    def __answer(self, number: int, good: bool, body: bytes) -> None:
        bus, answer_id = self.__node__.cfe.sb, self.__entry.answer_id
        for packet in answer_packets(answer_id, number, good, body, bus.config.sb_max_msg_size):
            self.__wait_for_room(packet)
            bus.transmit_msg(packet)

    def __wait_for_room(self, packet: bytes) -> None:
        """Give the callers time to take their packets; each of them receives the answers to all."""
        find = self.__node__.cfe.sb.find_pipe
        for _ in range(PATIENCE):
            pipes = [find(call.pipe) for call in list(self.__entry.calls.values())]  # callers come and go
            if all(pipe is None or len(pipe.items) < room_of(pipe, packet) for pipe in pipes):
                return
            self.__node__.kernel.delay(PACE_NS)


class QuietService(Service):
    """A service that every node has but few use: it costs no pipe, task or MsgId before the first call.

    `attend` starts a task at the first call.
    """

    __is_quiet__ = True


def make_service(node: Node) -> type[Service]:
    """Make the class `rospy.Service` of a node."""
    return type("Service", (Service,), {"__module__": Service.__module__, "__node__": node})


def make_quiet_service(node: Node) -> type[QuietService]:
    """Make the class of a node's services that wait for their first call."""
    return type("Service", (QuietService,), {"__module__": Service.__module__, "__node__": node})
