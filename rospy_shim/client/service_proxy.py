"""`rospy.ServiceProxy` and `rospy.wait_for_service`: calling a service over the Software Bus.

The caller waits for the answer in a pipe of its node that has subscribed to the service's answers.
"""

from __future__ import annotations

from enum import IntEnum
from typing import TYPE_CHECKING, Any, ClassVar, NoReturn

from cfepy.rtos import FOREVER, WaitList
from cfepy.status import CfeError
from rospy_shim.client.message import args_kwds_to_message, packer, unpacker
from rospy_shim.client.rostime import limit_of
from rospy_shim.client.service import ANSWER_LEAD, Pieces, Service, call_of_answer, request_packets
from rospy_shim.graph.graph import ServiceCall
from rospy_shim.types.exceptions import ROSException, ROSInterruptException, ServiceException, TransportTerminated
from rospy_shim.types.genpy import DeserializationError

if TYPE_CHECKING:
    from rospy_shim.client.node import Node
    from rospy_shim.graph.graph import Header, ServiceEntry
    from rospy_shim.types.msgs import ServiceClass

LOOK_MS = 500  # period at which a caller checks that the service still exists
POLL_NS = 300_000_000  # period at which wait_for_service looks, as on ROS
PACE_NS = 100_000  # period at which a caller looks for room for its request
NO_LIMIT = 0xFFFF
POLL = 0
_NOTE = (
    "cfepy: a request for {service} could not be serialized. As on ROS, the half of it that was written stays in the"
    " buffer of the persistent connection: the next call of this proxy waits for ever.\n"
)


_NO_DATA = (
    "transport error completing service call: unable to receive data from sender, check sender's logs for details"
)


class PersistentConnection(IntEnum):
    """State of the connection of a persistent proxy, as in rospy."""

    NONE = 0
    OPEN = 1
    HALF_A_RESPONSE = 2
    HALF_A_REQUEST = 3
    BROKEN = 4
    """The service's side has closed it; sending the next request works."""
    RESET = 5
    """The service's side has refused a request since."""
    CLOSED = 6


class AnswerPipes:
    """The pipes of a node for answers. One is kept from call to call, ready for the same service.

    Args:
        node: the node.
    """

    def __init__(self, node: Node) -> None:
        self._node = node
        self._spare: tuple[int, int] | None = None  # pipe, and the MsgId that it has subscribed to

    def open(self, answer_id: int) -> int:
        """Return a pipe that gets the answers of a service.

        Raises:
            CfeError: the bus has no room for another pipe or subscription.
        """
        bus = self._node.cfe.sb
        spare, self._spare = self._spare, None
        if spare is not None and spare[1] == answer_id:
            while bus.receive_buffer(spare[0], POLL) is not None:
                pass  # answers to others
            return spare[0]
        if spare is not None:
            bus.delete_pipe(spare[0])
        pipe: int = bus.create_pipe(bus.config.os_queue_max_depth, self._node.task_name("answers"))
        made = bus.find_pipe(pipe)
        if made is not None:
            made.keeps_newest = True
        bus.subscribe_ex(answer_id, pipe, 0, NO_LIMIT)
        return pipe

    def close(self, answer_id: int, pipe: int) -> None:
        """Release the pipe of a call. It is kept as long as the service has room for callers on the bus."""
        bus = self._node.cfe.sb
        if bus.find_pipe(pipe) is None:
            return
        if self._spare is None and 2 * len(bus.routes[answer_id].destinations) <= bus.config.sb_max_dest_per_pkt:
            self._spare = pipe, answer_id
        else:
            bus.delete_pipe(pipe)


class ServiceProxy:
    """Calls a service; each node has a subclass that knows the node."""

    __module__ = "rospy.impl.tcpros_service"
    __node__: ClassVar[Node]

    def __init__(
        self, name: str, service_class: ServiceClass, persistent: bool = False, headers: dict[str, str] | None = None
    ) -> None:
        """Prepare to call a service.

        Args:
            name: name of the service.
            service_class: its type.
            persistent: reported to the service. The bus needs no persistent connection, but the errors that corrupt one
                on ROS have the same effect.
            headers: added to the `_connection_header` of the requests.
        """
        self.resolved_name = self.__node__.names.resolve_name(name)
        self.service_class = service_class
        self.request_class = service_class._request_class
        self.response_class = service_class._response_class
        self.persistent = persistent
        if persistent:
            headers = headers or {}
            headers["persistent"] = "1"
        self.__header: Header = {
            "callerid": "",
            "md5sum": service_class._md5sum,
            "service": self.resolved_name,
            **(headers if isinstance(headers, dict) else {}),
        }
        self.__pack = packer(self.request_class)
        self.__unpack = unpacker(self.response_class)
        self.__connection = PersistentConnection.NONE  # of a persistent proxy
        self.__is_accepted = False

    def __call__(self, *args: Any, **kwds: Any) -> Any:
        """Call the service; see `call`."""
        return self.call(*args, **kwds)

    def call(self, *args: Any, **kwds: Any) -> Any:
        """Call the service with a request, or with its fields. Returns the response.

        Raises:
            TypeError, AttributeError: the arguments do not make a request.
            SerializationError: a field holds a value that its type cannot carry.
            ServiceException: there is no such service, or it failed.
            ROSInterruptException: the node was shut down meanwhile.
        """
        node = self.__node__
        node.universe.charge()
        request = args_kwds_to_message(self.request_class, args, kwds)
        if self.__connection is PersistentConnection.CLOSED:
            raise AttributeError("'NoneType' object has no attribute 'tell'")
        if self.__connection is PersistentConnection.HALF_A_REQUEST:
            self.__wait_in_vain()
        if self.__connection in (PersistentConnection.BROKEN, PersistentConnection.RESET):
            raise self.__send_in_vain()
        entry = node.graph.services.get(self.resolved_name)
        if entry is None:
            master_error = node.universe.importer.load("rosgraph.masterapi").MasterError
            try:
                raise master_error("no provider")
            except master_error:  # as in rospy, a traceback shows both
                raise ServiceException(f"service [{self.resolved_name}] unavailable")  # noqa: B904
        self.__check_type(entry)
        body = self.__packed(request)
        try:
            good, answer, half = self.__exchange(entry, body)
        except CfeError as error:
            raise ServiceException(f"service [{self.resolved_name}]: {error}") from error
        if self.__connection is PersistentConnection.HALF_A_RESPONSE:
            self.__read_half()
        if half and self.persistent:
            self.__connection = PersistentConnection.HALF_A_RESPONSE
        if not good:
            raise ServiceException(f"service [{self.resolved_name}] responded with an error: {answer!r}")
        response = self.__read(answer)
        response._connection_header = {
            "callerid": entry.service.__node__.names.name,
            "md5sum": self.service_class._md5sum,
            "service": self.resolved_name,
            "type": self.service_class._type,
        }
        return response

    def __packed(self, request: Any) -> bytes:
        """Serialize a request. If it fails, half of it stays in the buffer of the connection."""
        if self.persistent:
            self.__connection = max(self.__connection, PersistentConnection.OPEN)
        try:
            return self.__pack(request)
        except Exception:
            if self.persistent:
                self.__connection = PersistentConnection.HALF_A_REQUEST
                self.__node__.universe.print_error(_NOTE.format(service=self.resolved_name))
            raise

    def __read(self, answer: bytes) -> Any:
        """Make the response from its bytes.

        Raises:
            ServiceException: they are not a response; a service outside of the mission may send any bytes.
        """
        try:
            return self.__unpack(answer, 0)
        except Exception as error:  # the type's code may raise any error
            raise self.__unreadable(error) from None

    def __unreadable(self, error: Exception) -> ServiceException:
        kind = (
            "DeserializationError cannot deserialize:"
            if isinstance(error, DeserializationError)
            else "unexpected error"
        )
        what = f"receive_once[{self.resolved_name}]: {kind} {error}"
        return ServiceException(f"transport error completing service call: {what}")

    def __wait_in_vain(self) -> NoReturn:
        """Wait forever: the service could not read a request that follows half of another one, and does not answer."""
        life, waits = (
            self.__node__.life,
            WaitList(f"an answer of service {self.resolved_name}, which got half a request"),
        )
        while not life.is_shutdown():
            life.wait(waits, FOREVER)
        raise ROSInterruptException("node shutdown interrupted service call")

    def __send_in_vain(self) -> Exception:
        """Return the error of a call over a connection that the service's side has closed."""
        if self.__connection is PersistentConnection.BROKEN:
            self.__connection = PersistentConnection.RESET
            return ServiceException(_NO_DATA)
        self.__connection = PersistentConnection.CLOSED
        return TransportTerminated("32Broken pipe")

    def __read_half(self) -> None:
        """Read a response that follows half of another one, as an empty message.

        Raises:
            ServiceException: an empty message is not a response.
        """
        try:
            self.response_class().deserialize(b"")
        except DeserializationError as error:
            raise self.__unreadable(error) from None

    def __check_type(self, entry: ServiceEntry) -> None:
        ours, theirs = self.service_class._md5sum, entry.service.service_class._md5sum
        if ours not in (theirs, "*"):
            raise ServiceException(
                f"unable to connect to service: remote error reported: request from [{self.__node__.names.name}]:"
                f" md5sums do not match: [{ours}] vs. [{theirs}]"
            )

    def __exchange(self, entry: ServiceEntry, body: bytes) -> tuple[bool, bytes, bool]:
        """Send a request and wait for the answer with its number.

        Returns:
            True if it succeeded; the answer; True if half a response stays in the buffer of the service's connection.
        """
        node = self.__node__
        pipes, answer_id = node.answer_pipes, entry.answer_id
        pipe = pipes.open(answer_id)
        is_open = self.persistent and self.__is_accepted
        connection = self if self.persistent else object()
        if not is_open:
            Service.__accept__(node.graph, entry, connection)
            self.__is_accepted = True
        number = entry.begin(ServiceCall(pipe, {**self.__header, "callerid": node.names.name}, connection))
        task = node.kernel.current
        before, task.awaits = task.awaits, (waits := WaitList(f"an answer of service {self.resolved_name}"))
        waits.holders = lambda: entry.serving.get(number, ())
        task.since = node.kernel.now
        try:
            self.__send(entry, number, body)
            good, answer = self.__await(entry, number, pipe)
            return good, answer, number in entry.half_answered
        finally:
            task.awaits = before
            entry.calls.pop(number, None)
            entry.half_answered.discard(number)
            entry.unanswered.discard(number)
            pipes.close(answer_id, pipe)

    def __send(self, entry: ServiceEntry, number: int, body: bytes) -> None:
        bus = self.__node__.cfe.sb
        for packet in request_packets(entry.request_id, number, body, bus.config.sb_max_msg_size):
            while not entry.service.__has_room__(packet):
                if (error := self.__end(entry, number)) is not None:
                    raise error
                entry.service.__attend__()
                self.__node__.kernel.delay(PACE_NS)
            bus.transmit_msg(packet)
            entry.service.__attend__()

    def __await(self, entry: ServiceEntry, number: int, pipe: int) -> tuple[bool, bytes]:
        receive, pieces = self.__node__.cfe.sb.receive_buffer, Pieces(ANSWER_LEAD)
        while True:
            packet = receive(pipe, LOOK_MS)
            if packet is None:
                error = self.__end(entry, number)
                if error is None:
                    continue
                packet = receive(pipe, POLL)  # the answer may have come just before the end
                if packet is None:
                    raise error
            answered, good = call_of_answer(packet)
            answer = pieces.add(answered, packet) if answered == number else None
            if answer is not None:
                if self.__node__.life.is_shutdown():
                    raise ServiceException(f"service [{self.resolved_name}] returned no response")
                return good, answer

    def __end(self, entry: ServiceEntry, number: int) -> ServiceException | ROSInterruptException | None:
        """Return the error of a call if a node or the service has ended; a service answers the calls it works on."""
        if self.__node__.life.over:
            return ROSInterruptException("node shutdown interrupted service call")
        if number in entry.unanswered:
            return self.__end_of_unanswered(entry, number)
        if self.__node__.graph.services.get(self.resolved_name) is entry or number in entry.serving:
            return None
        return ServiceException("transport error completing service call: the service has ended")

    def __end_of_unanswered(self, entry: ServiceEntry, number: int) -> ServiceException | None:
        """Return the error of a call without an answer; None as long as its connection is open on the other side."""
        graph, server = self.__node__.graph, entry.service.__node__
        is_newest = graph.accepted.get(server.names.name) is entry.calls[number].connection
        if is_newest and graph.nodes.get(server.names.name) is server:
            return None
        if self.persistent:
            self.__connection = PersistentConnection.BROKEN
        return ServiceException(_NO_DATA)

    def close(self) -> None:
        """End a persistent connection; on ROS, calls fail then."""
        if self.__connection is not PersistentConnection.NONE:
            self.__connection = PersistentConnection.CLOSED

    def wait_for_service(self, timeout: Any = None) -> None:
        """Wait until the service is offered; see the function of that name."""
        wait_for_service(self.__node__, self.resolved_name, timeout)


def wait_for_service(node: Node, service: str, timeout: Any = None) -> None:
    """Wait until a node offers a service.

    Args:
        node: the caller.
        service: its name.
        timeout: longest time, seconds or a Duration; None waits without limit. It looks every 0.3 s, and returns after
            such a look.

    Raises:
        ValueError: the timeout is 0.
        ROSException: no node offered it in time.
        ROSInterruptException: the node is shut down.
    """
    limit = None if isinstance(timeout, list | tuple | dict | str) and not timeout else limit_of(timeout)
    if limit == 0:
        raise ValueError("timeout must be non-zero")
    name, kernel = node.names.resolve_name(service), node.kernel
    deadline = None if limit is None else kernel.now + limit
    # After the last look it sleeps once more, without another look.
    while not node.life.is_shutdown() and (deadline is None or kernel.now < deadline):
        entry = node.graph.services.get(name)
        if entry is not None:
            Service.__accept__(node.graph, entry, None)
            return
        kernel.delay(POLL_NS)
    if node.life.is_shutdown():
        raise ROSInterruptException("rospy shutdown")
    raise ROSException(f"timeout exceeded while waiting for service {name}")


def make_service_proxy(node: Node) -> type[ServiceProxy]:
    """Make the class `rospy.ServiceProxy` of a node."""
    return type("ServiceProxy", (ServiceProxy,), {"__module__": ServiceProxy.__module__, "__node__": node})
