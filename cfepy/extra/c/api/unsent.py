"""cfepy_unsent and related functions: messages of compiled ROS nodes without a subscriber, for traces and viewers.

These messages go to the trace, bags and viewers. The interface library finds these functions by weak symbols, so a
flight computer never calls them. A call takes no virtual time, and its memory is outside of the arena, so no address
that a program sees depends on it.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Protocol

if TYPE_CHECKING:
    from cfepy.extra.c.calls import Declarations
    from cfepy.extra.c.runtime import CRuntime

SMALLEST = 256
"""Bytes that an application gets at first."""


class PublicationWatch(Protocol):
    """Observes the messages that compiled ROS nodes publish."""

    def unsent(self, app: str, msg_id: int, message: bytes) -> None:
        """Take a published message that reaches no subscriber."""

    def latches(self, app: str, msg_id: int) -> None:
        """Record that an application has a latching publisher of the topic."""


def declare(api: Declarations, c: CRuntime) -> None:
    watch = c.publication_watch
    if watch is None:
        return
    rooms: dict[str, bytearray] = {}  # by application; each fills one at a time
    memory = c.memory

    def app() -> str:
        return str(getattr(c.kernel.current.owner, "name", ""))

    def room(size: int) -> int:
        found = rooms.get(app())
        if found is None or len(found) < size:
            found = rooms[app()] = bytearray(max(SMALLEST, 2 * size))
        return int(memory.address_of(found))

    def unsent(msg_id: int, at: int, size: int) -> None:
        watch.unsent(app(), msg_id, memory.peek(at, size))

    def latches(msg_id: int) -> None:
        watch.latches(app(), msg_id)

    api.add("cfepy_unsent_room", "Q", room)
    api.add("cfepy_unsent", "HPQ", unsent)
    api.add("cfepy_latches", "H", latches)
