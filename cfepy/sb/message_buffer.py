"""`MessageBuffer`: a message that an application fills in place (zero copy)."""

from __future__ import annotations

from cfepy.ports import Block


class MessageBuffer(bytearray):
    """A message that is filled in place and then sent or released (CFE_SB_Buffer_t).

    `app_id` is the application that it goes back from when that ends, `block` its memory in the pool, `allocated` how
    many bytes that has, `number` what tells it from others of the same content.
    """

    __slots__ = ("allocated", "app_id", "block", "number")

    allocated: int
    app_id: int
    block: Block | None
    number: int
