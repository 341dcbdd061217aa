"""The lifecycle of packet objects for a listener: made, put into pipes, taken out or dropped, deleted with a pipe.

`listened` makes a Software Bus class that notifies a `PacketListener`. It is for code that keeps data for each packet
in transit, such as an image in the memory of compiled applications. Such code must know when no application can use the
packet any more. A bus without a listener is unchanged and pays nothing.

A packet is `made` once, by a transmission, before its first receiver gets it. Then it is either `put` or `dropped` for
each of its pipes, and `sent` marks the end of this. A packet in a pipe leaves it in exactly one of three ways: it is
`taken` by a receiver, `dropped` for a newer packet, or in the list of `pipe_gone`. Tasks can switch in between: a
receiver more urgent than the sender has `taken` the packet before the next pipe gets it.

There are two special cases. A task that is ended after it was woken with a packet, and before it ran, takes the packet
along. `pipe_gone` reports the pipe later, so count by pipe. And if a fault plan changes a packet when it is taken out,
the result is a different object, for which `made` was not called.
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
    """The notifications about packets, called in the task that sends, receives or deletes."""

    def made(self, packet: bytes) -> None:
        """Handle a new packet object of the running task's transmission; all receivers get this object."""

    def put(self, packet: bytes, pipe: Pipe) -> None:
        """Handle a packet that is about to be put into a pipe, or passed to a task that waits there."""

    def dropped(self, packet: bytes, pipe: Pipe) -> None:
        """Handle a packet that did not get into a pipe (message limit, full, deleted), or left it for a newer one."""

    def sent(self, packet: bytes) -> None:
        """Handle the end of a transmission: the packet will be put into no more pipes."""

    def taken(self, packet: bytes, pipe: Pipe) -> None:
        """Handle a packet that the running task took from a pipe."""

    def pipe_gone(self, pipe: Pipe, packets: list[bytes]) -> None:
        """Handle a deleted pipe, with the packets still in it, the oldest first."""


LONGEST_MARK = 6
"""A longer record of the trace is a packet, in bytes."""


def listened(base: type[SoftwareBus], listener: PacketListener) -> type[SoftwareBus]:
    """Return a Software Bus class that notifies a listener of packets.

    Args:
        base: the class to derive from. Classes with faults or observers must be derived from the result, so that the
            listener sees the packets that really go into pipes.
        listener: the listener. It must not use the bus or wait.
    """

    class ListenedBus(base):  # type: ignore[misc, valid-type]  # mypy does not follow a class that is an argument
        """A Software Bus with a listener."""

        put_hook: PutHook | None
        _record: Callable[[bytes], object] | None

        def __init__(self, *args: Any) -> None:
            super().__init__(*args)
            self._transmissions: dict[Task, list[bytes | None]] = {}  # by task; the innermost is the last
            self._record_before = self._record
            self._record = self._recorded
            self.put_hook = _Telling(self._put, self.put_hook)

        def _recorded(self, record: bytes) -> None:
            """Get each record of the trace; a packet is recorded before its first receiver gets it."""
            if self._record_before is not None:
                self._record_before(record)
            if len(record) > LONGEST_MARK:
                self._transmissions[self.kernel.current][-1] = record
                listener.made(record)

        def _put(self, pipe: Pipe) -> None:
            """Handle a packet that is about to go into a pipe."""
            packet = self._packet_of_caller()
            if packet is not None:
                listener.put(packet, pipe)

        def _packet_of_caller(self) -> bytes | None:
            """Return the packet of the innermost transmission of the running task."""
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
    """Notifies a bus of each packet that is about to go into a pipe."""

    def __init__(self, told: Callable[[Pipe], None], inner: PutHook | None) -> None:
        super().__init__(inner)
        self._told = told

    def put(self, destination: Destination) -> None:
        super().put(destination)
        self._told(destination.pipe)
