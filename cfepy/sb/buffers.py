"""The message pool of the Software Bus, and buffers that applications fill in place (cfe_sb_buf.c, zero copy).

Subscriptions and zero-copy buffers take blocks of a memory pool of ES. Messages in transit are immutable Python bytes.
The memory they would take is counted, once for a message in several pipes, and added to the use of the pool.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from cfepy.config.platform import SB_LARGEST_BLOCK_MORE, SB_MEM_BLOCK_SIZES, PlatformConfig
from cfepy.interpreter.compiled import mypyc_attr
from cfepy.msg import PRIMARY_HEADER_SIZE, Packet, get_size, set_msg_time
from cfepy.osal import NOBODY, ObjectSizes
from cfepy.ports import Block, Ports
from cfepy.rtos import CpuCosts, Kernel
from cfepy.sb import events as ev
from cfepy.sb.core import BusCore
from cfepy.sb.routing import Destination, Route
from cfepy.status import CFE_SB_BAD_ARGUMENT, CFE_SB_BUF_ALOC_ERR, CFE_SB_BUFFER_INVALID, CFE_SB_MSG_TOO_BIG, CfeError

if TYPE_CHECKING:
    from cfepy.sb.message_buffer import MessageBuffer

BUFFER_BYTES = 64  # size of the descriptor in front of each message (CFE_SB_BufferD_t)
DESTINATION_BYTES = 32  # CFE_SB_DestinationD_t


@mypyc_attr(allow_interpreted_subclasses=True)
class BufferServices(BusCore):
    """The pool, and the functions for zero-copy messages; see `BusCore` for the arguments."""

    def __init__(
        self,
        kernel: Kernel,
        ports: Ports,
        config: PlatformConfig,
        costs: CpuCosts | None = None,
        sizes: ObjectSizes | None = None,
    ) -> None:
        super().__init__(kernel, ports, config, costs, sizes)
        self.pool_handle = 0
        self._zero_copy: dict[int, MessageBuffer] = {}
        self._last_number = 0
        self._held_bytes = 0  # by subscriptions and zero-copy buffers
        self._queued_bytes = 0  # by waiting messages, once per pipe: at least the memory they take
        self._known_bytes = -1  # queued bytes up to which the pool is known to suffice and the peaks to be valid

    def early_init(self) -> None:
        """Create the message pool, before any task exists (CFE_SB_EarlyInit, CFE_SB_InitBuffers).

        Raises:
            CfeError: if ES has no pool or no memory left.
        """
        self.routing.init()
        size = self.config.sb_buf_memory_bytes
        sizes = (*SB_MEM_BLOCK_SIZES, self.config.sb_max_msg_size + SB_LARGEST_BLOCK_MORE)
        try:
            self.pool_handle = self.ports.es.pool_create_ex_with_alignment(size, sizes, use_mutex=False, owner="CFE_SB")
        except CfeError as error:
            text = f"PoolCreate failed for SB Buffers, gave adr 0x0,size {size},stat={error.hex.lower()}"
            self.ports.syslog.write_to_sys_log(f"CFE_SB_InitBuffers: {text}")
            raise

    # -- zero copy -------------------------------------------------------------------------------------------------

    def allocate_message_buffer(self, size: int) -> MessageBuffer:
        """Return a zeroed buffer for a message to send with `transmit_buffer` (CFE_SB_AllocateMessageBuffer).

        The buffer belongs to the calling application until it is sent or released. If the application ends before, the
        bus releases it.

        Args:
            size: bytes, including the headers.

        Raises:
            CfeError: CFE_SB_MSG_TOO_BIG, CFE_SB_BUF_ALOC_ERR (the pool has no room, or the caller belongs to no
                application); NASA's function returns NULL.
        """
        owner = self.kernel.current.owner
        limit = self.config.sb_max_msg_size
        if not 0 <= size <= limit:
            text = f"Failed, requested size {size} larger than allowed {limit}"
            self.ports.syslog.write_to_sys_log(f"{getattr(owner, 'name', '')} CFE_SB_AllocateMessageBuffer: {text}")
            raise CfeError(CFE_SB_MSG_TOO_BIG, text)
        if owner is NOBODY:
            raise CfeError(CFE_SB_BUF_ALOC_ERR, "a buffer belongs to an application, and the caller does not")
        from cfepy.sb.message_buffer import MessageBuffer  # most applications send packets, and never load it

        buffer = MessageBuffer(size)
        buffer.allocated = buffer.reach = size
        buffer.app_id = getattr(owner, "app_id", 0)
        self._last_number = buffer.number = self._last_number + 1
        buffer.block = self.take_block(size + BUFFER_BYTES)
        self._zero_copy[buffer.number] = buffer
        self.note_growth()
        return buffer

    def release_message_buffer(self, buffer: MessageBuffer) -> None:
        """Release a buffer without sending it (CFE_SB_ReleaseMessageBuffer).

        Raises:
            CfeError: CFE_SB_BUFFER_INVALID if it is not from `allocate_message_buffer`, or was already sent or
                released.
        """
        self._check_buffer(buffer)
        self._forget_buffer(buffer)

    def transmit_buffer(self, buffer: MessageBuffer, is_origination: bool = True) -> None:
        """Send a buffer, in the size of its header (CFE_SB_TransmitBuffer); it no longer belongs to the caller
        afterwards.

        Args:
            buffer: a buffer from `allocate_message_buffer`, with MsgId and size filled in.
            is_origination: see `transmit_msg`.

        Raises:
            CfeError: CFE_SB_BUFFER_INVALID; or see `transmit_msg`, and then the caller keeps the buffer.
        """
        size = get_size(buffer) if len(buffer) > PRIMARY_HEADER_SIZE else 0
        self.check_header(buffer, size)
        self._check_buffer(buffer)
        if size > min(len(buffer), buffer.reach):
            text = f"Send Err:Bad input argument,Arg 0x0,App {self.caller_name()}"
            raise self.send_error(ev.SEND_BAD_ARG_EID, CFE_SB_BAD_ARGUMENT, text)
        self._forget_buffer(buffer)
        self.ports.sb.transmit_msg(bytes(buffer[:size]), is_origination)

    def time_stamp_msg(self, packet: bytearray) -> None:
        """Set the time of a telemetry packet to the spacecraft time (CFE_SB_TimeStampMsg).

        Raises:
            CfeError: CFE_MSG_WRONG_MSG_TYPE if the packet has no time.
        """
        set_msg_time(packet, self.ports.time.now())

    def release_buffers_of(self, app_id: int) -> None:
        """Release the buffers of an application that ends (CFE_SB_ZeroCopyReleaseAppId)."""
        for buffer in list(self._zero_copy.values()):
            if buffer.app_id == app_id:
                self._forget_buffer(buffer)

    def is_held(self, buffer: MessageBuffer) -> bool:
        """Return whether an application holds a buffer that was neither sent nor released."""
        return self._zero_copy.get(getattr(buffer, "number", 0)) is buffer

    def _check_buffer(self, buffer: MessageBuffer) -> None:
        if not self.is_held(buffer):
            raise CfeError(CFE_SB_BUFFER_INVALID, "not a buffer that an application holds")

    def _forget_buffer(self, buffer: MessageBuffer) -> None:
        del self._zero_copy[buffer.number]
        self.give_block(buffer.block, buffer.allocated + BUFFER_BYTES)

    # -- destinations ----------------------------------------------------------------------------------------------

    def remove_destination(self, route: Route, destination: Destination) -> None:
        """End a subscription (CFE_SB_RemoveDest)."""
        route.remove(destination)
        self.subscriptions -= 1
        self.give_block(destination.block, DESTINATION_BYTES)

    def hand_on(self, packet: bytes, destination: Destination) -> None:
        """Count a packet that has left its outlet."""
        self._queued_bytes -= len(packet) + BUFFER_BYTES
        destination.gets += 1

    # -- the pool --------------------------------------------------------------------------------------------------

    def take_block(self, size: int) -> Block | None:
        """Take memory from the pool for a subscription or a buffer; return None before the pool exists.

        Raises:
            CfeError: CFE_SB_BUF_ALOC_ERR if there is no room.
        """
        room = self.config.sb_buf_memory_bytes - size
        if self._most_bytes() > room and self.pool_use()[0] > room:
            raise CfeError(CFE_SB_BUF_ALOC_ERR, f"the message pool has no room for {size} bytes")
        block = self._block_of_pool(size)
        self._held_bytes += size
        self._known_bytes -= size
        return block

    def _block_of_pool(self, size: int) -> Block | None:
        if not self.pool_handle:
            return None
        try:
            return self.ports.es.get_pool_buf(self.pool_handle, size)
        except CfeError as error:
            raise CfeError(CFE_SB_BUF_ALOC_ERR, str(error)) from error

    def give_block(self, block: Block | None, size: int) -> None:
        """Return memory from `take_block` to the pool."""
        self._held_bytes -= size
        self._known_bytes += size
        if block is not None:
            self.ports.es.put_pool_buf(self.pool_handle, block)

    def _most_bytes(self) -> int:
        """Return an upper bound of the bytes in use, computed quickly."""
        return self._queued_bytes + self._held_bytes

    def pool_use(self, more: Packet | None = None) -> tuple[int, int]:
        """Return the (bytes, buffers) in use by waiting messages, zero-copy buffers and subscriptions.

        Args:
            more: a message that is about to be queued.
        """
        sizes = {id(item[0]): len(item[0]) for pipe in self.pipes for item in pipe.items}
        if more is not None:
            sizes[id(more)] = len(more)
        waiting = sum(sizes.values()) + BUFFER_BYTES * len(sizes)
        return waiting + self._held_bytes, len(sizes) + len(self._zero_copy)

    def note_peaks(self, more: Packet | None = None) -> tuple[int, int]:
        """Return `pool_use`, and record the peaks."""
        used, buffers = self.pool_use(more)
        self.peaks.memory = max(self.peaks.memory, used)
        self.peaks.buffers = max(self.peaks.buffers, buffers)
        return used, buffers

    def note_growth(self) -> None:
        """Record the peaks after an allocation, unless they cannot have changed."""
        if self._most_bytes() > self.peaks.memory:
            self.note_peaks()

    def has_room(self, packet: Packet) -> bool:
        """Return whether the pool has room for a message now; otherwise `transmit_msg` raises CFE_SB_BUF_ALOC_ERR."""
        return self._queued_bytes + len(packet) <= self._known_bytes or not self.pool_is_full(packet)

    def pool_is_full(self, packet: Packet) -> bool:
        """Return whether the pool has no room for a message, by an exact count; record new peaks.

        The count of `transmit_msg` includes a message once for each pipe, and the messages of deleted pipes. This call
        corrects it.
        """
        size, room = len(packet), self.config.sb_buf_memory_bytes
        if self.pool_use(packet)[0] > room:
            return True
        self.note_peaks(packet)
        self._queued_bytes = sum(len(item[0]) + BUFFER_BYTES for pipe in self.pipes for item in pipe.items)
        self._known_bytes = min(self._queued_bytes + size, room - self._held_bytes - BUFFER_BYTES)
        return False
