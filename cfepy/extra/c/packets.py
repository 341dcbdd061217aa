"""Messages in memory of C: zero-copy buffers, and one image of a packet for all applications that receive it.

A packet on the Software Bus is immutable bytes of Python. When an application receives it, it gets an image of these
bytes. Another application that receives the same packet gets the same image, as in C, where both point to one buffer.
The image is given back when the last pipe that has it asks for its next message and no pipe still holds the packet. A
buffer that an application filled in place and sent becomes the image of that packet. The engine receives messages
(`engine/images.c`).
"""

from __future__ import annotations

from typing import Any

from cfepy.extra.c.crashes import CFault
from cfepy.extra.c.engine import engine
from cfepy.extra.c.memory import CMemory
from cfepy.msg import PRIMARY_HEADER_SIZE, get_size
from cfepy.rtos import Task
from cfepy.sb import MessageBuffer, SoftwareBus
from cfepy.status import CFE_SB_BUFFER_INVALID, CfeError


class PacketImages:
    """The images of one processor.

    Args:
        heap: the engine's heap for them.
        bus: the Software Bus as applications reach it.
        core: the Software Bus itself.
        guard: a use of a buffer after it was sent or released is a fault, not a status.

    Attributes:
        images: the engine's part.
    """

    def __init__(self, heap: Any, bus: SoftwareBus, core: SoftwareBus, guard: bool) -> None:
        self._heap = heap
        self.images = engine().Images(heap, core.routes, self._waits)
        self._memory = CMemory()
        self._bus = bus
        self._core = core
        self._buffers: dict[int, MessageBuffer] = {}
        self._sending: dict[Task, int] = {}
        self._listens = False
        self._gone: dict[int, str] | None = {} if guard else None

    def _waits(self, packet: bytes) -> bool:
        """Return True if a packet with several destinations still waits in a pipe."""
        route = self._core.routes.get(packet[0] << 8 | packet[1])
        destinations = () if route is None else route.destinations
        return any(item[0] is packet for each in destinations for item in each.pipe.items)

    # -- zero copy ---------------------------------------------------------------------------------------------------

    def allocate(self, size: int) -> int:
        """Return a buffer of zeros to fill in place; 0 if the bus gives none (CFE_SB_AllocateMessageBuffer)."""
        try:
            buffer = self._bus.allocate_message_buffer(size)
        except CfeError:
            return 0
        address = int(self._heap.take(size))
        if not address:
            raise MemoryError(f"not enough memory for {size} more bytes of messages of compiled applications")
        self._buffers[address] = buffer
        return address

    def release(self, address: int) -> None:
        """Give a buffer back that was not sent (CFE_SB_ReleaseMessageBuffer)."""
        buffer = self._buffer(address)
        self._check(address, "CFE_SB_ReleaseMessageBuffer")
        self._bus.release_message_buffer(buffer)
        self._forget(address)

    def transmit(self, address: int, is_origination: bool) -> None:
        """Send a buffer (CFE_SB_TransmitBuffer). It becomes the packet's image, or is freed without a subscriber.

        A header that claims more bytes than the buffer has sends the memory behind it, as in NASA's code.
        """
        buffer = self._buffer(address)
        self._check(address, "CFE_SB_TransmitBuffer")
        claimed = get_size(self._memory.peek(address, PRIMARY_HEADER_SIZE))
        if len(buffer) < claimed <= self._core.config.sb_max_msg_size:
            buffer.extend(bytes(claimed - len(buffer)))
            buffer.reach = claimed
        buffer[:] = self._memory.peek(address, len(buffer))
        if not self._listens:
            self._listens = True
            self._core.listen(self._on_packet)
        task = self._core.kernel.current
        self._sending[task] = address
        try:
            self._bus.transmit_buffer(buffer, is_origination)
        except CfeError:
            self._sending.pop(task, None)
            raise
        if self._sending.pop(task, None) is not None:
            self._forget(address, "sent")  # it had no route

    def _on_packet(self, packet: bytes) -> None:
        """Use the buffer as the image of a packet that is being sent and is in no pipe yet."""
        if not self._sending:
            return
        task = self._core.kernel.current
        address = self._sending.get(task)
        if address is not None and self._memory.peek(address, 2) == packet[:2]:  # it may be an event about it
            del self._sending[task], self._buffers[address]
            if self._gone is not None:
                self._gone[address] = "sent"
            self.images.keep(packet, address)

    def _buffer(self, address: int) -> MessageBuffer:
        buffer = self._buffers.get(address)
        if buffer is None:
            if self._gone is not None and address in self._gone:
                raise CFault(f"the message buffer 0x{address:x} is used after it was {self._gone[address]}")
            raise CfeError(CFE_SB_BUFFER_INVALID, f"0x{address:x} is not a buffer that an application holds")
        return buffer

    def _check(self, address: int, function: str) -> None:
        found = self._heap.damage(address)
        if found is not None:
            size = self._heap.size_of(address)
            raise CFault(f"{function}() of 0x{address:x}, a message buffer of {size} bytes that was written {found}")

    def _forget(self, address: int, why: str = "released") -> None:
        del self._buffers[address]
        if self._gone is not None:
            self._gone[address] = why
        self._heap.give(address)

    # -- ends --------------------------------------------------------------------------------------------------------

    def forget_pipe(self, pipe_id: int) -> None:
        """Give back the images of a deleted pipe."""
        self.images.forget_pipe(pipe_id)

    def clean_up(self) -> None:
        """Give back the images and buffers of an ended application."""
        for pipe_id in self.images.pipes():
            if self._core.find_pipe(pipe_id) is None:
                self.images.forget_pipe(pipe_id)
        for address in [each for each, buffer in self._buffers.items() if not self._core.is_held(buffer)]:
            self._forget(address)
        self.images.sweep()
