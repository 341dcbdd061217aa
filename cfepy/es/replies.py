"""How Executive Services answer a command: a counter goes up and an event goes out."""

from __future__ import annotations

from collections.abc import Callable

from cfepy.es import events as ev
from cfepy.msg import Command
from cfepy.ports import Ports

Handlers = tuple[tuple[Command, Callable[[bytes], object]], ...]
"""What a group of commands offers the dispatcher."""


class Replies:
    """The command counters, and the events of command handlers.

    Args:
        ports: for the events.
    """

    def __init__(self, ports: Ports) -> None:
        self._ports = ports
        self.command_counter = 0
        self.error_counter = 0

    def accept(self, event_id: int, text: str, kind: int = ev.INFORMATION) -> None:
        """The command was carried out."""
        self.command_counter += 1
        self.send(event_id, text, kind)

    def reject(self, event_id: int, text: str) -> None:
        """The command was refused, or failed."""
        self.error_counter += 1
        self.send(event_id, text, ev.ERROR)

    def send(self, event_id: int, text: str, kind: int = ev.INFORMATION) -> None:
        """Say something, and count nothing."""
        self._ports.evs.send_event(event_id, kind, text)
