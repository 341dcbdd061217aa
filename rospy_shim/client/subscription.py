"""`Subscription`: from a packet in a pipe to a node's callbacks; shared by all handles of a node on one topic.

It has one pipe and one child task, which calls the callbacks in the order of their registration, all with the same
message object, as rospy's receiving thread does. With a queue size, a full pipe loses the oldest message. Without one,
it loses the newest, and the bus reports it.
"""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Any

from cfepy.interpreter.node_interrupt import NodeInterrupt
from cfepy.nodes.node_tracebacks import traceback_text
from cfepy.rtos import TaskExit, is_end_of_task
from cfepy.status import CfeError
from rospy_shim.client import connection_setup as connecting
from rospy_shim.client.message import packer, unpacker
from rospy_shim.client.socket_buffers import LENGTH_BYTES, Lag, SocketBuffers, is_full, wire_bytes
from rospy_shim.client.topic_side import INBOUND, TopicConnection, TopicSide
from rospy_shim.types.exceptions import ROSException
from rospy_shim.types.transport import EVERYBODY, HEADER_BYTES, SPARE_AT, Assembler, is_for_another, sequence_of

if TYPE_CHECKING:
    from collections.abc import Callable

    from cfepy.sb import Destination, Pipe
    from rospy_shim.client.link import Link
    from rospy_shim.client.node import Node
    from rospy_shim.graph.compiled import CompiledNode
    from rospy_shim.graph.graph import Header, TopicEntry
    from rospy_shim.types.msgs import MessageClass

DEFAULT_BUFF_SIZE = 65536
WHOLE = 0xC0
NO_PIPE = -1
NO_LIMIT = 0xFFFF
POLL = 0
ENDS_OF_THREAD = (SystemExit, NodeInterrupt, GeneratorExit)
"""Exceptions of a callback or handler that rospy's `except Exception` does not catch."""
MOST_TOLD = 16  # messages that could not be read, each of which is logged
_ADDRESS = re.compile(r"0x[0-9a-f]+")


class Subscription(TopicSide):
    """The subscribing side of one node on one topic (rospy.topics._SubscriberImpl).

    Args:
        node: the node.
        name: resolved name of the topic.
        data_class: message class.
    """

    def __init__(self, node: Node, name: str, data_class: MessageClass) -> None:
        super().__init__(node, name, data_class)
        self._unpack = self._paid(unpacker(data_class))
        self.queue_size: int | None = None  # messages that may wait; None is as many as the platform allows
        self.buff_size = DEFAULT_BUFF_SIZE
        self.tcp_nodelay = False
        self.callbacks: list[tuple[Callable[..., Any], Any]] = []
        self._calls: list[tuple[Callable[..., Any], Any]] = []  # those, after one that measures; replaced, not changed
        self.connected = False
        self.latest: Any = None  # kept while there is a latching publisher
        self._backlog: list[tuple[int, bytes, Header]] = []  # after the packet with that sequence count
        self.has_begun = False  # latched messages of existing publishers are given at the beginning
        self._late: list[Link] = []  # publishers that give their latched message at another time
        self._attention = False  # the task has other work than receiving
        self._segments = 1  # packets of the longest message so far
        self._sockets: SocketBuffers | None = None  # while it is behind with long messages
        self._lag: Lag | None = None
        self._dropped_since: tuple[Destination, int] | None = None  # and the number of packets taken at that time
        self._dropped_bytes = 0  # since then, which wait in ROS's sockets
        self._pipe = NO_PIPE
        self._assembler = Assembler()
        self._unreadable = 0  # messages

    def _paid(self, unpack: Callable[[bytes, int], Any]) -> Callable[[bytes, int], Any]:
        """Return `unpack` with the virtual time of a call for each message in arrays, which genpy makes one by one."""
        unpack = self.node.working(self.name, unpack)
        count, cost, charge = (
            getattr(self.data_class, "__count_items__", None),
            self.node.call_ns,
            self.node.kernel.charge,
        )
        if count is None or not cost:
            return unpack

        def unpack_and_pay(data: bytes, at: int) -> Any:
            message = unpack(data, at)
            charge(cost * count(message))
            return message

        return unpack_and_pay

    def set_queue_size(self, queue_size: object) -> None:
        """Let so many messages wait, and drop the oldest one when another comes.

        Args:
            queue_size: messages; -1 or None is as many as the platform allows.

        Raises:
            ROSException: it is 0, or not an integer.
        """
        most = queue_size if type(queue_size) is int else None
        if queue_size is not most:
            raise ROSException("queue size must be an integer")
        if most == 0:
            raise ROSException("queue size may not be set to zero")
        self.queue_size = None if most == -1 else most
        self._size_pipe()

    def expect_segments(self, count: int) -> None:
        """Expect a message of so many packets: enlarge the queue to hold as many messages as before."""
        if count > self._segments:
            self._segments = count
            self._size_pipe()

    def _size_pipe(self) -> None:
        pipe = self._find_pipe()
        if pipe is not None:
            pipe.depth, pipe.keeps_newest, pipe.spill = self._depth(), self.queue_size is not None, self._spill

    def _find_pipe(self) -> Pipe | None:
        pipe: Pipe | None = self._bus.find_pipe(self._pipe) if self._pipe != NO_PIPE else None
        return pipe

    def _depth(self) -> int:
        """Return the number of packets that the pipe holds."""
        most: int = self._bus.config.os_queue_max_depth
        return most if self.queue_size is None else min(self.queue_size * self._segments, most)

    def is_cut_short(self, pipe: Pipe) -> bool:
        """Return True if a pipe is its own and holds less than was asked for, so that the rest should wait
        elsewhere.
        """
        size = self.queue_size
        return size is not None and pipe.depth < size * self._segments and self._find_pipe() is pipe

    def set_buff_size(self, buff_size: object) -> None:
        """Read so many bytes at once.

        Raises:
            ROSException: it is not a positive integer.
        """
        if type(buff_size) is not int:
            raise ROSException("buffer size must be an integer")
        if buff_size <= 0:
            raise ROSException("buffer size must be a positive integer")
        self.buff_size = buff_size

    def set_tcp_nodelay(self, tcp_nodelay: bool) -> None:
        """Keep the setting; the bus never delays."""
        self.tcp_nodelay = tcp_nodelay

    def add_callback(self, callback: Callable[..., Any], argument: Any) -> None:
        """Add a callback, and call it at once with a latched message that has arrived already.

        Raises:
            ROSException: the subscription is closed.
        """
        if self.closed:
            raise ROSException(f"subscriber [{self.name}] has been closed")
        self.callbacks = [*self.callbacks, (callback, argument)]
        self._calls = [*self._calls, (callback, argument)]
        self.node.kernel.tell(self, "add_callback")
        if self.latest is not None:
            self._call(callback, argument, self.latest)

    def remove_callback(self, callback: Callable[..., Any], argument: Any) -> None:
        """Remove a callback."""
        for each in ("callbacks", "_calls"):
            kept = list(getattr(self, each))
            if (callback, argument) in kept:
                kept.remove((callback, argument))
            setattr(self, each, kept)

    def connect(self) -> None:
        """Go on the graph when the node is initialised.

        Raises:
            UsageError: the topic's MsgId belongs to another topic.
        """
        self.connected = True
        topic = self.topic = self.node.topic_for(self.name, self.data_class, "subscription")
        if topic is not None:
            if self.node.params.get_param("/enable_statistics", False):
                self._measure()
            name = self.node.task_name(self.name)
            self._open(topic, name)
            self.node.start_child(name, lambda: self._serve(topic))

    def _open(self, topic: TopicEntry, name: str) -> None:
        """Make the pipe and join the topic; messages from now on wait for the task."""
        bus = self._bus
        self._pipe = bus.create_pipe(self._depth(), name)
        self._size_pipe()
        delays = {link: connecting.delay_of(link, self) for link in topic.links}
        for link in delays:
            if delays[link]:
                self.ignore(link)  # before the first message may come
        bus.subscribe_ex(topic.msg_id, self._pipe, 0, NO_LIMIT)  # the pipe's depth is the limit, and can be changed
        topic.add_subscription(self)
        for link in list(topic.links):
            connecting.begin(link, self, delays.get(link, 0), late=True)

    def _measure(self) -> None:
        """Pass each message through the statistics first (rospy.impl.statistics)."""
        statistics = self.node.universe.importer.load("rospy.impl.statistics").SubscriberStatisticsLogger(self)
        pack = packer(self.data_class)
        received: dict[str, int] = {}  # bytes by sender

        def count(message: Any) -> None:
            sender = message._connection_header["callerid"]
            received[sender] = received.get(sender, 0) + len(pack(message))
            statistics.callback(message, sender, received[sender])

        self._calls = [(count, None), *self._calls]

    # -- messages that wait in sockets -------------------------------------------------------------------------------

    def _spill(self, size: int) -> bool:
        """Let the messages of the full pipe wait in the sockets, if one read would not bring all that were sent.

        Args:
            size: bytes of the next packet.

        Returns:
            False if the pipe should drop its oldest message.
        """
        pipe, topic = self._find_pipe(), self.topic
        if pipe is None or topic is None or topic.raw:
            return False
        if self._sockets is None:
            destination = pipe.items[0][1]
            if (destination, destination.gets) != self._dropped_since:
                self._dropped_since, self._dropped_bytes = (destination, destination.gets), 0
            left = self.buff_size - self._dropped_bytes - sum(map(wire_bytes, pipe.items))
            if size - HEADER_BYTES + LENGTH_BYTES <= left:
                self._dropped_bytes += wire_bytes(pipe.items[0])
                return False
            self._use_sockets(pipe).begin_with(max(0, left))
        else:
            self._set_aside(self._sockets, pipe)
        return True

    def fall_behind(self, has_memory: bool) -> None:
        """Let messages wait in the sockets, if the pipe is full or the bus has no memory for a long message."""
        pipe = self._find_pipe()
        if pipe is not None and pipe.items and not (has_memory and len(pipe.items) < pipe.depth):
            self._use_sockets(pipe)

    def _use_sockets(self, pipe: Pipe) -> SocketBuffers:
        if self._sockets is None:
            self._sockets = SocketBuffers(self.node.kernel, f"{self.name} to {self.node.names.name}")
            self._attention = True
            if self.topic is not None:
                self.topic.lags(self)
        self._set_aside(self._sockets, pipe)
        return self._sockets

    def _set_aside(self, sockets: SocketBuffers, pipe: Pipe) -> None:
        """Move the packets in the pipe behind those in the sockets, except those that were just read from there."""
        packets = self._bus.set_aside(pipe)
        loose = sockets.loose
        self._bus.put_back(pipe, packets[:loose])
        self._bus.discard(pipe, sockets.add(packets[loose:], self.topic.queue_size if self.topic is not None else 1))

    def expect_message(self, link: Link, size: int) -> None:
        """Wait until the sockets have room for a message, if its publisher has no queue.

        Args:
            link: the publisher.
            size: bytes of the message; 0 if they are not known.
        """
        sockets, pipe = self._sockets, self._find_pipe()
        if sockets is None and pipe is not None and is_full(pipe.items, size):
            sockets = self._use_sockets(pipe)
        if sockets is None or link.queue_size is not None or self not in link.peers:
            return
        kernel = self.node.kernel
        begun, name = kernel.now, link.node.names.name
        sockets.wait_for_room(size)
        if kernel.now > begun and self._lag is not None and name not in self._lag.held_up:
            self._lag.held_up = (*self._lag.held_up, name)

    def has_sent(self) -> None:
        """Handle the end of a long message: if the subscription is behind, the message waits in its sockets."""
        sockets, pipe = self._sockets, self._find_pipe()
        if sockets is not None and pipe is not None:
            self._set_aside(sockets, pipe)

    def _read_sockets(self, sockets: SocketBuffers, pipe: Pipe) -> None:
        """Put the next message back into the pipe."""
        self._attention = True
        if sockets.loose:
            return
        self._set_aside(sockets, pipe)
        self._bus.discard(pipe, sockets.read(self.buff_size, self.queue_size))
        packets, late_ns = sockets.take()
        self._bus.put_back(pipe, packets)
        if sockets.leaves_newer and self.queue_size is not None:
            self._note_lag(sum(len(packet) - HEADER_BYTES for packet, _ in packets), late_ns)
        if not sockets:
            self._catch_up()

    def _note_lag(self, size: int, late_ns: int) -> None:
        """Note that an old message is handled although there is a newer one."""
        lag = self._lag
        if lag is None:
            assert self.queue_size is not None
            lag = self._lag = Lag(self.name, self.node.names.name, self.queue_size, self.buff_size)
            self.node.graph.traps.append(lag)
        lag.size, lag.worst_ns = max(lag.size, size), max(lag.worst_ns, late_ns)

    def _catch_up(self) -> None:
        """Use the pipe alone again."""
        sockets, self._sockets = self._sockets, None
        if sockets is not None:
            sockets.wake()
            if self.topic is not None:
                self.topic.has_caught_up(self)

    def close(self) -> None:
        """Leave the graph. After this, the serving task ends once it has returned from its callbacks."""
        self._catch_up()
        topic, self.topic = self.topic, None
        if self.node.subscriptions.get(self.name) is self:
            del self.node.subscriptions[self.name]
        if topic is not None:
            topic.remove_subscription(self)
            topic.leave()
            pipe = self._pipe
            if pipe != NO_PIPE:
                self._bus.unsubscribe(topic.msg_id, pipe)
                topic.tell_left(self._bus, pipe)
        self.closed = True  # not earlier: the task deletes the pipe as soon as it sees this
        self._call_attention()

    @property
    def connections(self) -> list[TopicConnection]:
        """The connections to publishing nodes."""
        compiled = self.topic.compiled_publishers if self.topic is not None else []
        peers: list[Node | CompiledNode] = [*(each.node for each in self.peers), *compiled]
        return [self.connection(node, INBOUND) for node in peers]

    @property
    def peers(self) -> list[Link]:
        """The publishing sides that are connected."""
        if self.topic is None or self not in self.topic.subscriptions:
            return []
        return [each for each in self.topic.links if self not in each.expected]

    def ignore(self, link: Link) -> None:
        """Ignore a publisher that is not connected yet."""
        self.is_welcomed_by(link)
        pipe = self._find_pipe()
        if pipe is not None:
            pipe.ignore(link.node.owner)

    def heed(self, link: Link) -> None:
        """Accept a publisher that has connected."""
        pipe = self._find_pipe()
        if pipe is not None:
            pipe.heed(link.node.owner)

    def get_stats(self) -> tuple[str, list[tuple[int, int, int, int, bool]]]:
        """Return the data of getBusStats: topic, and for each connection number, bytes, messages, drops, state."""
        rows = zip(self.connections, self.peers, strict=False)  # messages of compiled nodes are not counted
        return self.name, [(each.id, link.message_data_sent, link.seq, -1, True) for each, link in rows]

    def deliver(self, payload: bytes, header: Header) -> None:
        """Give a message to this subscriber alone: a latched one, or one of a SubscribeListener."""
        route = self._bus.routes.get(self.topic.msg_id) if self.topic is not None else None
        self._backlog.append((route.sequence if route is not None else 0, payload, header))
        self._call_attention()

    @property
    def takes_any_type(self) -> bool:
        """True if it reads messages of any type."""
        return self.data_class._type == "*"

    def is_welcomed_by(self, link: Link) -> None:
        """Let the listeners of a publisher see this subscription first; the publisher gives its latched message
        then.
        """
        if link not in self._late:
            self._late.append(link)

    def _call_attention(self) -> None:
        self._attention = True
        pipe = self._find_pipe()
        if pipe is not None:
            pipe.call_reader()

    # -- in the task -------------------------------------------------------------------------------------------------

    def _serve(self, topic: TopicEntry) -> None:
        try:
            self._take_latched(topic)
            self._receive(topic)
        except CfeError as error:
            if self._pipe != NO_PIPE:
                self.node.logs.logerr("subscription of %s ends: %s", self.name, error)
        finally:
            self.__give_back__()

    def _take_latched(self, topic: TopicEntry) -> None:
        """Take latched messages as a new subscriber in ROS does: of all earlier messages, only the last counts."""
        self.has_begun = True
        at_once = [link for link in topic.links if link.is_latch and link not in self._late]
        if at_once and not self.closed:
            while self._bus.receive_buffer(self._pipe, POLL) is not None:
                pass
            for link in at_once:
                link.give_latched(self)

    def __give_back__(self) -> None:
        """Delete the pipe."""
        pipe, self._pipe = self._pipe, NO_PIPE
        if pipe != NO_PIPE and self._bus.find_pipe(pipe) is not None:
            self._bus.delete_pipe(pipe)

    def _receive(self, topic: TopicEntry) -> None:
        """Receive packet after packet; every received message passes through this loop."""
        receive, pipe = self._bus.receive_buffer, self._pipe
        unpack = self._unpack if not topic.raw else self._packet_as_message
        while True:
            if self._attention and not self._attend():
                return
            packet = receive(pipe)
            if packet is None:
                continue
            if packet[SPARE_AT:HEADER_BYTES] != EVERYBODY and not topic.raw and is_for_another(packet, pipe):
                continue
            if packet[2] < WHOLE and not topic.raw:
                packet = self._assemble(packet, topic)
                if packet is None:
                    continue
            try:
                message = unpack(packet, HEADER_BYTES)
            except Exception as error:
                self._tell_unreadable(error)
                continue
            message._connection_header = topic.header or topic.sender_of(packet)
            if topic.latching:
                self.latest = message
            for callback, argument in self._calls:
                try:
                    if argument is None:
                        callback(message)
                    else:
                        callback(message, argument)
                except Exception as error:
                    self._bad_callback(callback, error)
                except ENDS_OF_THREAD:
                    break  # it ends only this message; rospy's connection catches it, and is made anew

    def _attend(self) -> bool:
        """Handle work between two messages. Returns False if the task is to end."""
        self._attention = False
        pipe = self._find_pipe()
        if pipe is not None:
            pipe.is_called = False
            if self._sockets is not None:
                self._read_sockets(self._sockets, pipe)
        while self._backlog and not self.closed:
            if self._has_earlier(self._backlog[0][0]):
                self._attention = True
                return True
            _, payload, header = self._backlog.pop(0)
            self._hand_over(payload, header)
        return not self.closed

    def _has_earlier(self, count: int) -> bool:
        """Return True if the pipe has a packet that was sent before, or with, a sequence count."""
        pipe = self._find_pipe()
        return pipe is not None and bool(pipe.items) and (count - sequence_of(pipe.items[0][0])) & 0x3FFF < 0x2000

    def _hand_over(self, payload: bytes, header: Header) -> None:
        try:
            message = self._unpack(payload, 0)
        except Exception as error:
            self._tell_unreadable(error)
            return
        message._connection_header = header
        if header.get("latching") == "1":
            self.latest = message
        for callback, argument in self._calls:
            try:
                self._call(callback, argument, message)
            except ENDS_OF_THREAD:
                break

    def _tell_unreadable(self, error: Exception) -> None:
        """Log a message that cannot be read: each of the first ones, and ever fewer of the others."""
        self._unreadable = count = self._unreadable + 1
        if count <= MOST_TOLD:
            self.node.logs.logerr("cannot read a message on %s: %s", self.name, error)
        elif not count & count - 1:
            self.node.logs.logerr("cannot read a message on %s, the %s. of its kind: %s", self.name, count, error)

    def _assemble(self, packet: bytes, topic: TopicEntry) -> bytes | None:
        header, index = topic.notes.get(sequence_of(packet), (None, None))
        before = self._assembler.lost
        whole = self._assembler.add(packet, header["callerid"] if header is not None else "", index)
        topic.lost += self._assembler.lost - before
        return whole

    def _packet_as_message(self, packet: bytes, at: int) -> Any:
        """Make a message from a packet of a raw topic; its data are the whole packet."""
        message = self.data_class()
        message.data = packet
        return message

    def _call(self, callback: Callable[..., Any], argument: Any, message: Any) -> None:
        try:
            if argument is None:
                callback(message)
            else:
                callback(message, argument)
        except Exception as error:
            self._bad_callback(callback, error)

    def _bad_callback(self, callback: Callable[..., Any], error: Exception) -> None:
        """Log an exception in a callback; the next message is delivered all the same."""
        if is_end_of_task(error):
            raise TaskExit from error
        where = error.__traceback__
        text = traceback_text(error.with_traceback(where.tb_next if where is not None else None))
        name = _ADDRESS.sub("0x0", str(callback))  # an address would differ in each run
        self.node.logs.logerr("bad callback: %s\n%s", name, text)
