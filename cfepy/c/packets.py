"""Messages in memory of C: zero-copy buffers, and the one image that a packet has for all applications that get it.

A packet on the Software Bus is immutable bytes of Python. When an application receives it, it gets an image of these
bytes; another one that receives the same packet gets the same image, as in C, where both point to one buffer. The image
is given back when the last pipe that has it asks for its next message and no pipe still holds the packet. A buffer
that an application filled in place and sent becomes the image of that packet.
"""

from __future__ import annotations

from typing import Any

from cfepy.c.memory import Memory
from cfepy.rtos import Task
from cfepy.sb import MessageBuffer, SoftwareBus
from cfepy.status import CFE_SB_BUFFER_INVALID, CfeError


class _Image:
    """The bytes of a packet in C memory; `holders` are the pipes whose application has it."""

    __slots__ = ("address", "holders", "packet")

    def __init__(self, address: int, packet: bytes) -> None:
        self.address = address
        self.packet = packet  # so that no other object gets its id
        self.holders = 0


class PacketImages:
    """The images of one processor.

    Args:
        heap: the engine's heap for them.
        bus: the Software Bus as applications reach it.
        core: the Software Bus itself.
    """

    def __init__(self, heap: Any, bus: SoftwareBus, core: SoftwareBus) -> None:
        self._heap = heap
        self._memory = Memory()
        self._bus = bus
        self._core = core
        self._images: dict[int, _Image] = {}
        self._held: dict[int, _Image] = {}
        self._buffers: dict[int, MessageBuffer] = {}
        self._sending: dict[Task, int] = {}
        self._listens = False

    # -- receiving ---------------------------------------------------------------------------------------------------

    def receive(self, pipe_id: int, packet: bytes) -> int:
        """The address of a packet that came out of a pipe; what that pipe had before is given back."""
        before = self._held.get(pipe_id)
        image = self._images.get(id(packet))
        if image is None:
            image = self._image_of(packet)
        image.holders += 1
        self._held[pipe_id] = image
        if before is not None:
            before.holders -= 1
            if not before.holders:
                self._give(before)
        return image.address

    def _image_of(self, packet: bytes) -> _Image:
        address = self._take(len(packet))
        self._memory.poke(address, packet)
        image = self._images[id(packet)] = _Image(address, packet)
        return image

    def _take(self, size: int) -> int:
        address = self._heap.take(size)
        if not address:
            raise MemoryError(f"no {size} bytes are left for messages of compiled applications")
        return int(address)

    def _give(self, image: _Image) -> None:
        """Nobody has it any more; it stays as long as the packet waits in another pipe."""
        packet = image.packet
        route = self._core.routes.get(packet[0] << 8 | packet[1])
        if route is not None and len(route.destinations) > 1:
            for destination in route.destinations:
                if any(item[0] is packet for item in destination.pipe.items):
                    return
        del self._images[id(packet)]
        self._heap.give(image.address)

    # -- zero copy ---------------------------------------------------------------------------------------------------

    def allocate(self, size: int) -> int:
        """A buffer to fill in place, of zeros; 0 when the bus gives none (CFE_SB_AllocateMessageBuffer)."""
        try:
            buffer = self._bus.allocate_message_buffer(size)
        except CfeError:
            return 0
        address = self._take(size)
        self._buffers[address] = buffer
        return address

    def release(self, address: int) -> None:
        """Give a buffer back that was not sent (CFE_SB_ReleaseMessageBuffer)."""
        self._bus.release_message_buffer(self._buffer(address))
        self._forget(address)

    def transmit(self, address: int, is_origination: bool) -> None:
        """Send a buffer (CFE_SB_TransmitBuffer): it becomes the packet's image, or is gone if nobody wants that."""
        buffer = self._buffer(address)
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
            self._forget(address)  # it had no route

    def _on_packet(self, packet: bytes) -> None:
        """A packet is on its way, and no pipe has it yet."""
        if not self._sending:
            return
        task = self._core.kernel.current
        address = self._sending.get(task)
        if address is not None and self._memory.peek(address, 2) == packet[:2]:  # it may be an event about it
            del self._sending[task], self._buffers[address]
            self._memory.poke(address, packet)
            self._images[id(packet)] = _Image(address, packet)

    def sweep(self) -> None:
        """Give back images of packets that no application got."""
        for image in [each for each in self._images.values() if not each.holders]:
            self._give(image)

    def _buffer(self, address: int) -> MessageBuffer:
        buffer = self._buffers.get(address)
        if buffer is None:
            raise CfeError(CFE_SB_BUFFER_INVALID, f"0x{address:x} is no buffer that an application holds")
        return buffer

    def _forget(self, address: int) -> None:
        del self._buffers[address]
        self._heap.give(address)

    # -- ends --------------------------------------------------------------------------------------------------------

    def forget_pipe(self, pipe_id: int) -> None:
        """A pipe was deleted: what it had is given back."""
        image = self._held.pop(pipe_id, None)
        if image is not None:
            image.holders -= 1
            if not image.holders:
                self._give(image)

    def close(self) -> None:
        """The processor is at its end."""
        self._images.clear()
        self._held.clear()
        self._buffers.clear()
