"""`MessageBuffer`: a message that an application fills in place (zero copy)."""

from __future__ import annotations

from cfepy.ports import Block


class MessageBuffer(bytearray):
    """A message that is filled in place and then sent or released (CFE_SB_Buffer_t).

    `app_id` is the application that loses it when it ends. `block` is its memory in the pool, and `allocated` the size
    of it. `reach` is the longest message that can be sent from it; compiled code can send the memory behind it.
    `number` distinguishes it from others with the same content.
    """

    __slots__ = ("allocated", "app_id", "block", "number", "reach")

    allocated: int
    app_id: int
    block: Block | None
    number: int
    reach: int
