"""The combined packets: built from a copy table, filled from incoming telemetry, sent on request (hk_utils.c)."""

from __future__ import annotations

from cfepy.app import Cfe
from cfepy.es import PoolBlock
from cfepy.msg import TLM_HEADER_SIZE, init
from cfepy.status import CfeError

from . import events as ev
from .copy_table import CopyEntry, read_entries
from .packets import RUNTIME_TABLE_ENTRY


class CombinedPacket:
    """One output packet in a block of HK's memory pool, and which of its parts came in since it was sent last."""

    def __init__(self, msg_id: int, block: PoolBlock, entries: list[int]) -> None:
        self.msg_id = msg_id
        self.block = block
        self.entries = entries
        self.missing = set(entries)
        block.memory[:] = init(msg_id, len(block.memory))


class Combiner:
    """All combined packets of the copy table in use.

    Args:
        cfe: the app's handle.
        pipe: where the inputs shall arrive.
        pool: the memory pool that the packets live in.
        discard_incomplete: a packet that lacks data is not sent.
    """

    def __init__(self, cfe: Cfe, pipe: int, pool: int, discard_incomplete: bool) -> None:
        self._cfe = cfe
        self._pipe = pipe
        self._pool = pool
        self._discard_incomplete = discard_incomplete
        self._entries: list[CopyEntry] = []
        self._packets: dict[int, CombinedPacket] = {}
        self._inputs: dict[int, list[int]] = {}
        self._subscribed: set[int] = set()

    def use_table(self, table: memoryview) -> None:
        """Build the packets of a new copy table and subscribe to its inputs.

        Call `tear_down` for the old one before.
        """
        self._entries = read_entries(table)
        for index, entry in enumerate(self._entries):
            if not entry.is_used:
                continue
            self._inputs.setdefault(entry.input_mid, []).append(index)
            if entry.output_mid not in self._packets:
                self._build(entry.output_mid)
            if entry.input_mid not in self._subscribed:
                self._subscribe(entry.input_mid)

    def _build(self, msg_id: int) -> None:
        indices = [index for index, entry in enumerate(self._entries) if entry.output_mid == msg_id]
        size = max(TLM_HEADER_SIZE, *(self._entries[index].output_end for index in indices))
        try:
            block = self._cfe.es.get_pool_buf(self._pool, size)
        except CfeError as error:
            text = f"ES_GetPoolBuf for size {size} returned {error.hex}"
            self._cfe.evs.send_err(ev.MEM_POOL_MALLOC_FAILED_EID, f"HK Processing New Table: {text}")
            return
        self._packets[msg_id] = CombinedPacket(msg_id, block, indices)

    def _subscribe(self, msg_id: int) -> None:
        try:
            self._cfe.sb.subscribe(msg_id, self._pipe)
        except CfeError as error:
            text = f"SB_Subscribe for Mid 0x{msg_id:08X} returned {error.hex}"
            self._cfe.evs.send_err(ev.CANT_SUBSCRIBE_TO_SB_PKT_EID, f"HK Processing New Table:{text}")
            return
        self._subscribed.add(msg_id)

    def tear_down(self) -> None:
        """Give all packets back and end the subscriptions."""
        for packet in self._packets.values():
            try:
                self._cfe.es.put_pool_buf(self._pool, packet.block)
            except CfeError as error:
                text = f"pkt:0x{packet.block.offset:08X} ret {error.hex}, hdl 0x{self._pool:08x}"
                self._cfe.evs.send_err(ev.MEM_POOL_FREE_FAILED_EID, f"HK TearDown: ES_putPoolBuf Err {text}")
        for msg_id in sorted(self._subscribed):
            self._cfe.sb.unsubscribe(msg_id, self._pipe)
        self._packets, self._inputs, self._subscribed = {}, {}, set()

    def take_in(self, msg_id: int, packet: bytes) -> None:
        """Copy the parts of an input packet that the table uses. Entries that reach past its end are reported once."""
        too_short = 0
        for index in self._inputs.get(msg_id, ()):
            entry = self._entries[index]
            if len(packet) < entry.input_end:
                too_short += 1
                continue
            output = self._packets.get(entry.output_mid)
            if output is not None:
                output.block.memory[entry.output_offset : entry.output_end] = packet[
                    entry.input_offset : entry.input_end
                ]
                output.missing.discard(index)
        if too_short:
            text = f"MID:0x{msg_id:08X}, Length:{len(packet)}, Count:{too_short}"
            self._cfe.evs.send_err(
                ev.ACCESSING_PAST_PACKET_END_EID, f"HK table definition exceeds packet length. {text}"
            )

    def send(self, msg_id: int) -> tuple[int, int]:
        """Send a combined packet, unless it lacks data and such packets are discarded.

        Then wait for all of its data anew.

        Returns:
            How many packets were sent, and how many lacked data: (0, 0), (1, 0), (1, 1), or (0, 1) if discarded.
        """
        packet = self._packets.get(msg_id)
        if packet is None:
            text = f"Combined HK Packet 0x{msg_id:08X} is not found in current HK Copy Table"
            self._cfe.evs.send_info(ev.UNKNOWN_COMBINED_PACKET_EID, text)
            return 0, 0
        lacking = bool(packet.missing)
        if lacking:
            input_mid = self._entries[min(packet.missing)].input_mid
            text = f"Combined Packet 0x{msg_id:08X} missing data from Input Pkt 0x{input_mid:08X}"
            self._cfe.evs.send_dbg(ev.OUTPKT_MISSING_DATA_EID, text)
        packet.missing = set(packet.entries)
        if lacking and self._discard_incomplete:
            return 0, 1
        self._cfe.sb.transmit_msg(bytes(packet.block.memory))
        return 1, int(lacking)

    def fill_runtime_table(self, table: memoryview) -> None:
        """Write the state of every entry into the runtime table, for a dump."""
        for index, entry in enumerate(self._entries):
            packet = self._packets.get(entry.output_mid)
            at = index * RUNTIME_TABLE_ENTRY.size
            table[at : at + RUNTIME_TABLE_ENTRY.size] = RUNTIME_TABLE_ENTRY.pack(
                OutputPktAddr=packet.block.offset if packet else 0,
                InputMidSubscribed=int(entry.input_mid in self._subscribed),
                DataPresent=int(packet is not None and index not in packet.missing),
            )
