"""Services and clients of ROS 2 on the services of the mission's graph.

The packets have the form of rospy's services, so nodes of both worlds can call each other. A service has a pipe for its
requests, a client one for the answers. An executor takes both. As in ROS 2, an answer comes only when the callback
returns, and a request that is sent while there is no server is lost.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from cfepy.status import CfeError
from rclpy_shim.seam.waiting import WaitingNode
from rospy_shim.client.message import packer, unpacker
from rospy_shim.client.service import (
    ANSWER_LEAD,
    REQUEST_LEAD,
    Pieces,
    answer_packets,
    call_of_answer,
    call_of_request,
    request_packets,
    room_of,
)
from rospy_shim.client.subscription import NO_LIMIT, NO_PIPE, POLL
from rospy_shim.graph.graph import ServiceCall

if TYPE_CHECKING:
    from collections.abc import Callable, Sized

    from rospy_shim.graph.graph import ServiceEntry

PACE_NS = 100_000  # period at which a client looks for room for its request
PATIENCE = 100  # looks
MOST_CALLS = 10_000
"""Calls without an answer that a client remembers; a server may never answer."""


class PipeOfService:
    """A pipe of a service or client, which wakes the program's tasks.

    Args:
        program: the program.
        label: label of the pipe's name.
        depth: number of messages.
    """

    def __init__(self, program: WaitingNode, label: str, depth: int) -> None:
        self._program = program
        self._label = label
        self._depth = depth
        self._pipe = NO_PIPE
        self._items: Sized = ()  # the packets in the pipe

    @property
    def number(self) -> int:
        """The pipe's id; NO_PIPE before `open`."""
        return self._pipe

    def open(self, msg_id: int) -> None:
        """Make the pipe and subscribe to a MsgId, once.

        Raises:
            CfeError: the bus has no room for another pipe or subscription.
        """
        if self._pipe != NO_PIPE:
            return
        bus = self._program.cfe.sb
        depth = min(self._depth, bus.config.os_queue_max_depth)
        self._pipe = bus.create_pipe(depth, self._program.task_name(self._label))
        pipe = bus.find_pipe(self._pipe)
        if pipe is not None:
            pipe.keeps_newest = True
            self._items = pipe.items
            self._program.waiting.adopt(pipe)
        bus.subscribe_ex(msg_id, self._pipe, 0, NO_LIMIT)

    def is_filled(self) -> bool:
        """Return True if a packet waits."""
        return bool(self._items)

    def has_room(self, packet: bytes) -> bool:
        """Return True if the pipe exists and takes a packet."""
        pipe = self._program.cfe.sb.find_pipe(self._pipe)
        return pipe is not None and len(pipe.items) < room_of(pipe, packet)

    def receive(self) -> bytes | None:
        """Take the oldest packet, or None."""
        if self._pipe == NO_PIPE:
            return None
        packet: bytes | None = self._program.cfe.sb.receive_buffer(self._pipe, POLL)
        return packet

    def close(self) -> None:
        """Delete the pipe."""
        number, self._pipe, self._items = self._pipe, NO_PIPE, ()
        pipe = self._program.cfe.sb.find_pipe(number)
        if pipe is not None:
            self._program.waiting.release(pipe)
            try:
                self._program.cfe.sb.delete_pipe(number)
            except CfeError:
                pass  # a task of another application closes it; ES deletes the pipe with the application


class ServiceServer:
    """Offers a service (rcl_service_t).

    Args:
        program: the program.
        name: resolved name.
        service_class: its type.
        depth: number of requests that may wait; another one displaces the oldest.
        is_quiet: True for a service that few clients call: it has no pipe before the first call.

    Raises:
        ServiceException: the program offers it already.
    """

    def __init__(self, program: WaitingNode, name: str, service_class: Any, depth: int, is_quiet: bool = False) -> None:
        self.__node__ = program
        self.resolved_name = name
        self.service_class = service_class
        self.request_class = service_class.Request
        self.response_class = service_class.Response
        self.uri = f"rosrpc://{program.universe.host_name}:{program.universe.pid}"
        self._unpack = program.working(name, unpacker(self.request_class))
        self._pack = packer(self.response_class)
        self._pieces = Pieces(REQUEST_LEAD)
        self._pipe = PipeOfService(program, name, depth)
        self._is_opening = False
        self._entry: ServiceEntry = program.graph.register_service(self)  # type: ignore[arg-type]  # in rospy's place
        if not is_quiet:
            self._pipe.open(self._entry.request_id)

    def __has_room__(self, packet: bytes) -> bool:
        """Return True if a packet of a request may be sent."""
        return self._pipe.has_room(packet)

    def __attend__(self) -> None:
        """Make the pipe for the first request, in the name of the program."""
        if self._pipe.number == NO_PIPE and not self._is_opening:
            self._is_opening = True
            self.__node__.start_task(self.resolved_name, lambda: self._pipe.open(self._entry.request_id))

    def is_open(self) -> bool:
        """Return True if the pipe exists. A full one drops its oldest request, so that no client waits."""
        return self._pipe.number != NO_PIPE

    def __give_back__(self) -> None:
        """Delete the pipe."""
        self._pipe.close()

    def shutdown(self, reason: str = "") -> None:
        """Stop offering the service."""
        self.__node__.graph.forget_service(self)  # type: ignore[arg-type]
        self._pipe.close()

    close = shutdown

    def ready(self) -> bool:
        """Return True if a request waits."""
        return self._pipe.is_filled()

    def take(self) -> tuple[int, Any] | None:
        """Take the oldest request (rcl_take_request).

        Returns:
            The number of the call, and the request; None if no whole request waits.
        """
        while (packet := self._pipe.receive()) is not None:
            number = call_of_request(packet)
            body = self._pieces.add(number, packet)
            if body is None:
                continue
            try:
                request = self._unpack(body, 0)
            except Exception:  # the ground may send any bytes
                self._send(number, False, b"service cannot process request: its bytes are not a request")
                continue
            self._entry.serving[number] = (self.__node__.kernel.current,)
            return number, request
        return None

    def answer(self, number: int, response: Any) -> None:
        """Answer a call (rcl_send_response).

        Args:
            number: number of the call.
            response: the response.

        Raises:
            TypeError, AssertionError: a field holds a value that its type cannot carry.
        """
        self._entry.serving.pop(number, None)
        self._send(number, True, self._pack(response))

    def _send(self, number: int, good: bool, body: bytes) -> None:
        bus = self.__node__.cfe.sb
        for packet in answer_packets(self._entry.answer_id, number, good, body, bus.config.sb_max_msg_size):
            bus.transmit_msg(packet)


class ServiceClient:
    """Calls a service (rcl_client_t).

    Args:
        program: the program.
        name: resolved name.
        service_class: its type.
        depth: number of answers that may wait.
    """

    def __init__(self, program: WaitingNode, name: str, service_class: Any, depth: int) -> None:
        self._program = program
        self.name = name
        self.service_class = service_class
        self._pack = packer(service_class.Request)
        self._unpack = unpacker(service_class.Response)
        self._pipe = PipeOfService(program, name, depth)
        self._pieces = Pieces(ANSWER_LEAD)
        self._mine: dict[int, ServiceEntry] = {}
        self._lost = -1

    def is_available(self) -> bool:
        """Return True if a node offers the service with the same type (rcl_service_server_is_available)."""
        entry = self._program.graph.services.get(self.name)
        return entry is not None and entry.service.service_class._md5sum == self.service_class._md5sum

    def send(self, request: Any, begin: Callable[[int], object]) -> int:
        """Send a request (rcl_send_request).

        Args:
            request: the request.
            begin: called with the number of the call before the request is sent, since the answer may come before this
                method returns.

        Returns:
            The number of the call. Without a server the request is lost, and the number is negative.

        Raises:
            TypeError, AssertionError: a field holds a value that its type cannot carry.
            CfeError: the bus has no room for the pipe of the answers.
        """
        body = self._pack(request)
        entry = self._program.graph.services.get(self.name)
        if entry is None or not self.is_available():
            self._lost -= 1
            begin(self._lost)
            return self._lost
        self._pipe.open(entry.answer_id)
        header = {
            "callerid": self._program.names.name,
            "md5sum": self.service_class._md5sum,
            "service": self.name,
        }
        number = entry.begin(ServiceCall(self._pipe.number, header))
        if len(self._mine) >= MOST_CALLS:
            self.forget(next(iter(self._mine)))
        self._mine[number] = entry
        begin(number)
        bus = self._program.cfe.sb
        for packet in request_packets(entry.request_id, number, body, bus.config.sb_max_msg_size):
            self._wait_for_room(entry, packet)
            bus.transmit_msg(packet)
            entry.service.__attend__()
        return number

    def _wait_for_room(self, entry: ServiceEntry, packet: bytes) -> None:
        """Wait until a quiet service has made its pipe, or until a service of ROS 1 has room for a request."""
        service = entry.service
        for _ in range(PATIENCE):
            if service.is_open() if isinstance(service, ServiceServer) else service.__has_room__(packet):
                return
            service.__attend__()
            self._program.kernel.delay(PACE_NS)

    def forget(self, number: int) -> None:
        """Ignore the answer of a call."""
        entry = self._mine.pop(number, None)
        if entry is not None:
            entry.calls.pop(number, None)

    def is_open(self) -> bool:
        """Return True if the pipe exists; it is made at the first call."""
        return self._pipe.number != NO_PIPE

    def ready(self) -> bool:
        """Return True if an answer waits, which may be for another client."""
        return self._pipe.is_filled()

    def take(self) -> tuple[int, Any, str] | None:
        """Take the oldest answer to this client (rcl_take_response).

        Returns:
            The number of the call, the response, and the error's text if a service of ROS 1 failed; None if no answer
            waits.
        """
        while (packet := self._pipe.receive()) is not None:
            number, good = call_of_answer(packet)
            body = self._pieces.add(number, packet)
            if body is None or number not in self._mine:
                continue
            self.forget(number)
            if not good:
                return number, None, body.decode("utf-8", "replace")
            return number, self._unpack(body, 0), ""
        return None

    def close(self) -> None:
        """Forget all calls and delete the pipe."""
        for number in list(self._mine):
            self.forget(number)
        self._pipe.close()
