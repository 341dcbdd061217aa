"""LINK, the link to the ground that stays when CI_LAB, TO_LAB or SCH_LAB end; the twin of link_app.c.

It puts datagrams of its port on the bus, and sends packets of the bus to the ground. It also calls the CDS for the
ground, and passes datagrams on to CI_LAB. A mission has this file in its folder, as `link.py`.
"""

from __future__ import annotations

import struct

from cfepy.app import Cfe
from cfepy.osal import OS_CHECK, OS_SocketDomain_INET, OS_SocketType_DATAGRAM
from cfepy.status import CFE_SUCCESS, CfeError

UP_PORT, DOWN_PORT, CI_PORT = 5200, 5201, 1234
DEPTH = 50
PERIOD_MS = 20
SLOTS = 4
SHOWN = 200
REQUEST_MID, REPLY_MID = 0x18E5, 0x08E5
WATCHED = (0x800, 0x801, 0x803, 0x804, 0x805, 0x806, 0x808, 0x809, 0x80A, 0x80B, 0x80C,
           0x80D, 0x80E, 0x810, 0x880, 0x881, 0x883, 0x884, REPLY_MID)  # fmt: skip
REQUEST = struct.Struct("<cBHB")
"""Behind the header of a command: a letter, the slot of a block, its size, the byte to fill it with; then its name."""


class Link:
    """The socket, the pipe and the blocks of the CDS."""

    def __init__(self, cfe: Cfe) -> None:
        self._cfe = cfe
        self._blocks, self._sizes = [0] * SLOTS, [0] * SLOTS
        self._is_new = [False] * SLOTS
        cfe.evs.register()
        self._pipe = cfe.sb.create_pipe(DEPTH, "LINK_PIPE")
        for msg_id in WATCHED:
            cfe.sb.subscribe_ex(msg_id, self._pipe, msg_limit=DEPTH)
        self._socket = cfe.os.socket_open(OS_SocketDomain_INET, OS_SocketType_DATAGRAM)
        here = cfe.os.socket_addr_init(OS_SocketDomain_INET)
        cfe.os.socket_addr_set_port(here, UP_PORT)
        cfe.os.socket_bind(self._socket, here)

    def run(self) -> None:
        """Hand over until the end."""
        while self._cfe.es.run_loop():
            self._cfe.os.task_delay(PERIOD_MS)
            while (found := self._cfe.os.socket_recv_from(self._socket, 2048, OS_CHECK)) is not None:
                self._take(found[0])
            while (packet := self._cfe.sb.receive_buffer(self._pipe, 0)) is not None:
                self._send_to(DOWN_PORT, packet)

    def _send_to(self, port: int, data: bytes) -> None:
        target = self._cfe.os.socket_addr_init(OS_SocketDomain_INET)
        self._cfe.os.socket_addr_from_string(target, "127.0.0.1")
        self._cfe.os.socket_addr_set_port(target, port)
        self._cfe.os.socket_send_to(self._socket, data, target)

    def _take(self, data: bytes) -> None:
        if int.from_bytes(data[:2], "big") != REQUEST_MID:
            try:
                self._cfe.sb.transmit_msg(data, is_origination=False)
            except CfeError:
                pass  # an event has told it
        elif data[8:9] == b"U":
            self._send_to(CI_PORT, data[9:])
        else:
            self._answer(data)

    def _answer(self, data: bytes) -> None:
        letter, slot, size, byte = REQUEST.unpack_from(data, 8)
        name = data[13:].partition(b"\0")[0].decode()
        status, content = 0, b""
        try:
            status, content = self._do(letter, slot % SLOTS, size, byte, name)
        except CfeError as error:
            status = error.status
        packet = self._cfe.msg.init(REPLY_MID, 20 + len(content))
        packet[16:] = struct.pack("<i", status) + content
        self._cfe.sb.transmit_msg(packet)

    def _do(self, letter: bytes, slot: int, size: int, byte: int, name: str) -> tuple[int, bytes]:
        es = self._cfe.es
        if letter == b"R":
            self._blocks[slot], self._is_new[slot] = 0, False
            block = es.register_cds(size, name)
            self._blocks[slot], self._sizes[slot], self._is_new[slot] = block, size, block.status == CFE_SUCCESS
            return block.status, b""
        if letter == b"C":
            self._is_new[slot] = False
            es.copy_to_cds(self._blocks[slot], bytes([byte]) * self._sizes[slot])
            return CFE_SUCCESS, b""
        if self._is_new[slot]:
            return -1, b""
        return CFE_SUCCESS, bytes(es.restore_from_cds(self._blocks[slot]))[:SHOWN].ljust(SHOWN, b"\0")


def LINK_Main(cfe: Cfe) -> None:
    """The entry point that the startup script names."""
    Link(cfe).run()
    cfe.es.exit_app()
