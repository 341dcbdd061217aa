"""Commands and telemetry by name: what an app declares once, for its own dispatch and for every tool on the ground.

A service or an app has its declarations in one module, gathered in `COMMANDS` and `TELEMETRY`; an app offers these two
names next to its entry point, where tools find them.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from cfepy.msg.header import CMD_HEADER_SIZE, TLM_HEADER_SIZE
from cfepy.msg.layout import Layout, message_string_get
from cfepy.msg.secondary import command, telemetry
from cfepy.reading.texts import to_bytes

NO_PAYLOAD = Layout("no payload", [])


@dataclass(frozen=True, slots=True)
class Command:
    """A command, or a request without function codes such as the one for housekeeping.

    Args:
        name: as ground tools know it, NASA's without the ending: "CFE_ES_NOOP".
        msg_id: its MsgId.
        code: the function code; None for a message that has none.
        payload: layout of what follows the 8-byte header.
        text: what it does, for tools.
    """

    name: str
    msg_id: int
    code: int | None = None
    payload: Layout = NO_PAYLOAD
    text: str = ""

    @property
    def length(self) -> int:
        """Bytes of the whole packet."""
        return CMD_HEADER_SIZE + self.payload.size

    def packet(self, values: Mapping[str, Any] | None = None, /, **more: Any) -> bytes:
        """The command as bytes, checksum included; a field not given is zero.

        Raises:
            UsageError: an unknown field, or a value that does not fit.
        """
        return bytes(command(self.msg_id, self.code or 0, self.payload.pack(values, **more)))

    def read(self, packet: bytes | bytearray | memoryview) -> dict[str, Any]:
        """The payload's fields.

        Raises:
            CfeError: CFE_STATUS_WRONG_MSG_LENGTH when the packet is too short.
        """
        return self.payload.unpack(packet, CMD_HEADER_SIZE)

    def read_name(self, packet: bytes | bytearray | memoryview, field: str) -> str:
        """A name as a service takes it from the payload: into a C buffer of the field's size.

        A name that fills its field has no NUL, and loses its last character to the one of the buffer
        (CFE_SB_MessageStringGet).

        Raises:
            CfeError: CFE_STATUS_WRONG_MSG_LENGTH when the packet is too short.
        """
        return message_string_get(to_bytes(self.read(packet)[field]), self.payload.sizes[field])


@dataclass(frozen=True, slots=True)
class Telemetry:
    """A telemetry packet.

    Args:
        name: as ground tools know it, NASA's without the ending: "CFE_ES_HK_TLM".
        msg_id: its MsgId.
        payload: layout of what follows the 16-byte header.
        text: what it tells, for tools.
        first: of packets that share their MsgId, the value of the first byte of the payload, which tells them apart.
        variants: the other packets that have this MsgId.
    """

    name: str
    msg_id: int
    payload: Layout = NO_PAYLOAD
    text: str = ""
    first: int | None = None
    variants: tuple[Telemetry, ...] = ()

    @property
    def length(self) -> int:
        """Bytes of the whole packet."""
        return TLM_HEADER_SIZE + self.payload.size

    def packet(self, values: Mapping[str, Any] | None = None, /, **more: Any) -> bytes:
        """The packet as bytes, its time 0 until it is sent; a field not given is zero.

        Raises:
            UsageError: an unknown field, or a value that does not fit.
        """
        return bytes(telemetry(self.msg_id, self.payload.pack(values, **more)))

    def read(self, packet: bytes | bytearray | memoryview) -> dict[str, Any]:
        """The payload's fields.

        Raises:
            CfeError: CFE_STATUS_WRONG_MSG_LENGTH when the packet is too short.
        """
        return self.payload.unpack(packet, TLM_HEADER_SIZE)

    def variant_of(self, packet: bytes | bytearray | memoryview) -> Telemetry:
        """Which of the packets with this MsgId a packet is; this one when none fits."""
        first = packet[TLM_HEADER_SIZE] if len(packet) > TLM_HEADER_SIZE else None
        return next((each for each in self.variants if each.first == first), self)
