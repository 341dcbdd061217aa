"""Dispatch of command packets to handlers: message id, function code and length are checked, in this order.

Every service and app dispatches in this way, and sends its own event if a check fails. So the table calls the handler
or reports the failed check, and sends no event itself.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

from cfepy.msg.dictionary import Command
from cfepy.msg.header import PRIMARY_HEADER_SIZE, Packet, get_msg_id
from cfepy.status import CFE_MSG_BAD_ARGUMENT, CfeError

Handler = Callable[[bytes], object]

DONE = 0
BAD_MSG_ID = 1
BAD_CODE = 2
BAD_LENGTH = 3


class Dispatch(NamedTuple):
    """The result of a dispatch, with all data for an event text.

    `outcome` is DONE, BAD_MSG_ID, BAD_CODE or BAD_LENGTH. `length` and `expected` are bytes of the whole packet
    (`expected` is 0 if unknown). `fcn_code` is 0 for telemetry. `result` is the handler's result.
    """

    outcome: int
    msg_id: int
    fcn_code: int
    length: int
    expected: int
    result: object = None

    def length_text(self) -> str:
        """Return the event text of a core service for a packet of the wrong length (TBL has its own text)."""
        sizes = f"Len = {self.length}, Expected = {self.expected}"
        return f"Invalid msg length: ID = 0x{self.msg_id:X},  CC = {self.fcn_code}, {sizes}"


class CommandTable:
    """Handlers by message id and function code.

    A handler gets the whole packet as bytes. Pass the handlers of declared commands to the constructor, or add them
    with `handle`, `add` and `add_message`. Then call `dispatch`.

    Args:
        handlers: declared commands, each with its handler.
    """

    __slots__ = ("_commands", "_messages")

    def __init__(self, *handlers: tuple[Command, Handler]) -> None:
        self._commands: dict[int, dict[int, tuple[int, Handler]]] = {}
        self._messages: dict[int, tuple[int, Handler]] = {}
        for command, handler in handlers:
            self.handle(command, handler)

    def handle(self, command: Command, handler: Handler, *, any_length: bool = False) -> None:
        """Handle a declared command.

        Args:
            command: the command; its MsgId, function code and length are used.
            handler: called with the packet.
            any_length: accept packets of any length, for handlers that check it themselves.

        Raises:
            CfeError: CFE_MSG_BAD_ARGUMENT if it already has a handler.
        """
        length = 0 if any_length else command.length
        if command.code is None:
            self.add_message(command.msg_id, length, handler)
        else:
            self.add(command.msg_id, command.code, length, handler)

    def add(self, msg_id: int, fcn_code: int, length: int, handler: Handler) -> None:
        """Handle one function code of a command message.

        Args:
            msg_id: the message id.
            fcn_code: 0..127.
            length: bytes of the whole packet, including the header.
            handler: called with the packet.

        Raises:
            CfeError: CFE_MSG_BAD_ARGUMENT if the same command, or a plain message of that id, already has a handler.
        """
        if msg_id in self._messages or fcn_code in self._commands.get(msg_id, ()):
            raise CfeError(CFE_MSG_BAD_ARGUMENT, f"command 0x{msg_id:04X}/{fcn_code} already has a handler")
        self._commands.setdefault(msg_id, {})[fcn_code] = (length, handler)

    def add_message(self, msg_id: int, length: int, handler: Handler) -> None:
        """Handle a message without function codes, such as a housekeeping request or telemetry of another app.

        Args:
            msg_id: the message id.
            length: bytes of the whole packet, or 0 to take any.
            handler: called with the packet.

        Raises:
            CfeError: CFE_MSG_BAD_ARGUMENT if the id has a handler already.
        """
        if msg_id in self._messages or msg_id in self._commands:
            raise CfeError(CFE_MSG_BAD_ARGUMENT, f"message 0x{msg_id:04X} already has a handler")
        self._messages[msg_id] = (length, handler)

    def dispatch(self, packet: bytes) -> Dispatch:
        """Check a packet and call its handler."""
        msg_id, length = get_msg_id(packet), len(packet)
        codes = self._commands.get(msg_id)
        fcn_code = _fcn_code(packet)
        if codes is not None:
            entry = codes.get(fcn_code)
            if entry is None:
                return Dispatch(BAD_CODE, msg_id, fcn_code, length, 0)
        else:
            entry = self._messages.get(msg_id)
            if entry is None:
                return Dispatch(BAD_MSG_ID, msg_id, fcn_code, length, 0)
        expected, handler = entry
        if expected not in (0, length):
            return Dispatch(BAD_LENGTH, msg_id, fcn_code, length, expected)
        return Dispatch(DONE, msg_id, fcn_code, length, expected, handler(packet))


def _fcn_code(packet: Packet) -> int:
    """Return the function code, or 0 without one, as CFE_MSG_GetFcnCode leaves it."""
    return packet[6] & 0x7F if len(packet) > PRIMARY_HEADER_SIZE and packet[0] & 0x18 == 0x18 else 0
