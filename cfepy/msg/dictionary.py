"""Commands and telemetry by name: declarations that an app makes once, for its own dispatch and for all ground tools.

A service or an app has its declarations in one module, collected in `COMMANDS` and `TELEMETRY`. An app offers these two
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
        name: its name in ground tools, NASA's name without the suffix: "CFE_ES_NOOP".
        msg_id: its MsgId.
        code: the function code; None for a message without one.
        payload: layout of the payload after the 8-byte header.
        text: description for tools.
    """

    name: str
    msg_id: int
    code: int | None = None
    payload: Layout = NO_PAYLOAD
    text: str = ""

    @property
    def length(self) -> int:
        """The bytes of the whole packet."""
        return CMD_HEADER_SIZE + self.payload.size

    def packet(self, values: Mapping[str, Any] | None = None, /, **more: Any) -> bytes:
        """Return the command as bytes, with its checksum; missing fields are zero.

        Raises:
            UsageError: for an unknown field or a value that does not fit.
        """
        return bytes(command(self.msg_id, self.code or 0, self.payload.pack(values, **more)))

    def read(self, packet: bytes | bytearray | memoryview) -> dict[str, Any]:
        """Return the payload's fields.

        Raises:
            CfeError: CFE_STATUS_WRONG_MSG_LENGTH if the packet is too short.
        """
        return self.payload.unpack(packet, CMD_HEADER_SIZE)

    def read_name(self, packet: bytes | bytearray | memoryview, field: str) -> str:
        """Return a name as a service reads it from the payload, into a C buffer of the field's size.

        A name that fills its field has no NUL, and loses its last character to the NUL of the buffer
        (CFE_SB_MessageStringGet).

        Raises:
            CfeError: CFE_STATUS_WRONG_MSG_LENGTH if the packet is too short.
        """
        return message_string_get(to_bytes(self.read(packet)[field]), self.payload.sizes[field])


@dataclass(frozen=True, slots=True)
class Telemetry:
    """A telemetry packet.

    Args:
        name: its name in ground tools, NASA's name without the suffix: "CFE_ES_HK_TLM".
        msg_id: its MsgId.
        payload: layout of the payload after the header.
        text: description for tools.
        first: value of the first payload byte, which distinguishes packets that share their MsgId.
        variants: the other packets that have this MsgId.
        header_size: bytes of the header: 16, or 12 for an application that was built for cFE 6.
    """

    name: str
    msg_id: int
    payload: Layout = NO_PAYLOAD
    text: str = ""
    first: int | None = None
    variants: tuple[Telemetry, ...] = ()
    header_size: int = TLM_HEADER_SIZE

    @property
    def length(self) -> int:
        """The bytes of the whole packet."""
        return self.header_size + self.payload.size

    def packet(self, values: Mapping[str, Any] | None = None, /, **more: Any) -> bytes:
        """Return the packet as bytes; its time is 0 until it is sent, and missing fields are zero.

        Raises:
            UsageError: for an unknown field or a value that does not fit.
        """
        return bytes(telemetry(self.msg_id, self.payload.pack(values, **more), self.header_size))

    def read(self, packet: bytes | bytearray | memoryview) -> dict[str, Any]:
        """Return the payload's fields.

        Raises:
            CfeError: CFE_STATUS_WRONG_MSG_LENGTH if the packet is too short.
        """
        return self.payload.unpack(packet, self.header_size)

    def variant_of(self, packet: bytes | bytearray | memoryview) -> Telemetry:
        """Return which of the telemetry packets with this MsgId a packet is, or this one if none matches."""
        first = packet[self.header_size] if len(packet) > self.header_size else None
        return next((each for each in self.variants if each.first == first), self)
