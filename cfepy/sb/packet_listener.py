"""The life of packet objects, told to a listener: made, put into pipes, taken out or dropped, gone with a pipe.

`listened` makes a class of Software Bus that tells a `PacketListener`. It is for code that keeps something for each
packet on its way, such as an image of it in the memory of compiled applications, and must know when no application can
use it any more. A bus without listener is not changed, and pays nothing.

A packet is `made` once, by a transmission, before it is handed to its first receiver. For each pipe that it should go
to it is then either `put` or `dropped`; `sent` says that there are no more of these. A packet that was put into a pipe
leaves it by exactly one of three: it is `taken` by a receiver, `dropped` when the pipe makes room for a newer one, or
among those of which `pipe_gone` tells. Tasks change in between: a receiver that is more urgent than the sender has
`taken` the packet before the next pipe gets it.

Two cases are out of the ordinary. A task that is ended when it was woken with a packet and has not run yet takes the
packet along; `pipe_gone` tells of the pipe later, so count by pipe. And a packet that a fault plan changes where it is
taken out is another object than the one that was put; for that object `made` was not called.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Protocol

from cfepy.ports import PEND_FOREVER
from cfepy.rtos import Task
from cfepy.sb.bus import SoftwareBus
from cfepy.sb.pipe import Pipe
from cfepy.sb.routing import Destination, PutHook


class PacketListener(Protocol):
    """What is told of packets, in the task that sends, receives or deletes."""

    def made(self, packet: bytes) -> None:
        """The bus made this object for a transmission of the running task; all receivers get this very object."""

    def put(self, packet: bytes, pipe: Pipe) -> None:
        """It is about to be put into a pipe, or to be handed to a task that waits there."""

    def dropped(self, packet: bytes, pipe: Pipe) -> None:
        """It did not get into a pipe (message limit, full, deleted meanwhile), or had to leave it for a newer one."""

    def sent(self, packet: bytes) -> None:
        """The transmission is over: it will be put into no more pipes."""

    def taken(self, packet: bytes, pipe: Pipe) -> None:
        """The running task took it out of a pipe."""

    def pipe_gone(self, pipe: Pipe, packets: list[bytes]) -> None:
        """A pipe was deleted, with these packets still in it, oldest first."""


LONGEST_MARK = 6
"""Bytes: a record of the trace with more is a packet."""


def listened(base: type[SoftwareBus], listener: PacketListener) -> type[SoftwareBus]:
    """A class of Software Bus that tells a listener of packets.

    Args:
        base: the class to start from. Classes with faults or observers are derived from the one that this makes, so
            that the listener sees the packets that go into pipes.
        listener: is told. It must not use the bus, nor wait.
    """

    class ListenedBus(base):  # type: ignore[misc, valid-type]  # mypy does not follow a class that is an argument
        """A Software Bus with a listener."""

        put_hook: PutHook | None
        _record: Callable[[bytes], object] | None

        def __init__(self, *args: Any) -> None:
            super().__init__(*args)
            self._transmissions: dict[Task, list[bytes | None]] = {}  # of each task; the innermost is the last
            self._record_before = self._record
            self._record = self._recorded
            self.put_hook = _Telling(self._put, self.put_hook)

        def _recorded(self, record: bytes) -> None:
            """Get what goes into the trace, which is a packet at the moment before the first receiver gets it."""
            if self._record_before is not None:
                self._record_before(record)
            if len(record) > LONGEST_MARK:
                self._transmissions[self.kernel.current][-1] = record
                listener.made(record)

        def _put(self, pipe: Pipe) -> None:
            """A packet is about to go into a pipe."""
            packet = self._packet_of_caller()
            if packet is not None:
                listener.put(packet, pipe)

        def _packet_of_caller(self) -> bytes | None:
            """The packet of the innermost transmission that the running task is in."""
            under_way = self._transmissions.get(self.kernel.current)
            return under_way[-1] if under_way else None

        def transmit_msg(self, packet: bytes | bytearray, is_origination: bool = True) -> None:
            task = self.kernel.current
            under_way = self._transmissions.setdefault(task, [])
            under_way.append(None)
            try:
                super().transmit_msg(packet, is_origination)
            finally:
                made = under_way.pop()
                if not under_way:
                    del self._transmissions[task]
                if made is not None:
                    listener.sent(made)

        def receive_buffer(self, pipe_id: int, timeout_ms: int = PEND_FOREVER) -> bytes | None:
            pipe = self.find_pipe(pipe_id)
            packet: bytes | None = super().receive_buffer(pipe_id, timeout_ms)
            if packet is not None and pipe is not None:
                listener.taken(packet, pipe)
            return packet

        def hand_on(self, packet: bytes, destination: Destination) -> None:
            super().hand_on(packet, destination)
            listener.taken(packet, destination.pipe)

        def remove_pipe(self, pipe: Pipe) -> None:
            packets = [item[0] for item in pipe.items]
            super().remove_pipe(pipe)
            listener.pipe_gone(pipe, packets)

        def _report_failures(self, msg_id: int, failures: list[tuple[int, Destination]]) -> None:
            packet = self._packet_of_caller()
            if packet is not None:
                for _, destination in failures:
                    listener.dropped(packet, destination.pipe)
            super()._report_failures(msg_id, failures)

        def _drop_oldest(self, pipe: Pipe) -> int:
            before = [item[0] for item in pipe.items]
            left: int = super()._drop_oldest(pipe)
            for packet in before[: len(before) - left]:
                listener.dropped(packet, pipe)
            return left

    return ListenedBus


class _Telling(PutHook):
    """Tells a bus of each packet that is about to go into a pipe."""

    def __init__(self, told: Callable[[Pipe], None], inner: PutHook | None) -> None:
        super().__init__(inner)
        self._told = told

    def put(self, destination: Destination) -> None:
        super().put(destination)
        self._told(destination.pipe)
