"""`Pipe`: a queue of packets that belongs to an application (CFE_SB_PipeD_t)."""

from __future__ import annotations

from collections.abc import Callable

from cfepy import trace
from cfepy.interpreter.compiled import mypyc_attr
from cfepy.rtos import TIMEOUT, Kernel, Queue

NOBODY_HEARD = object()
"""Marks in `Pipe.unheard` that a fault keeps the pipe full."""


@mypyc_attr(allow_interpreted_subclasses=True)
class Pipe(Queue):
    """The queue of a pipe, with its owner.

    `send_errors` counts messages refused by a message limit, like NASA's SendErrors, and `overflows` those that did not
    fit. A pipe that `keeps_newest` drops its oldest message to make room, as the queue of a ROS subscriber does.
    Messages of the applications in `unheard` are refused: of its own application by a pipe option, and of ROS nodes not
    connected yet. If `spill` returns True for the size of the next packet, it has made room with `set_aside`, and none
    is dropped. If NOBODY_HEARD is in it, all messages are refused. If `is_called`, the reader returns without a
    message.

    Args:
        kernel: the kernel of its readers.
        depth: maximum number of messages.
        name: unique on the bus.
        owner: the application, as in `Task.owner`; None outside any.
    """

    __slots__ = (
        "app_id",
        "app_name",
        "claim",
        "drop_mark",
        "is_called",
        "keeps_newest",
        "opts",
        "overflows",
        "owner",
        "pipe_id",
        "queue_id",
        "receive_mark",
        "send_errors",
        "spill",
        "unheard",
    )

    def __init__(self, kernel: Kernel, depth: int, name: str, owner: object) -> None:
        super().__init__(kernel, depth, name)
        self.waits.what = f"a message on pipe {name}"
        self.owner = owner
        self.app_id: int = getattr(owner, "app_id", 0)
        self.app_name: str = getattr(owner, "name", "host")
        self.opts = 0
        self.unheard: tuple[object, ...] = ()
        self.keeps_newest = self.is_called = False
        self.spill: Callable[[int], bool] | None = None
        self.send_errors = self.overflows = 0
        self.claim = 0
        self.queue_id = 0
        self.identify(0)

    def call_reader(self) -> None:
        """Make the task that waits for a message, or is about to, return without one."""
        if self.waits:
            self.kernel.wake_all(self.waits, TIMEOUT)
        else:
            self.is_called = True

    def ignore(self, sender: object) -> None:
        """Refuse messages of an application from now on."""
        if sender not in self.unheard:
            self.unheard = (*self.unheard, sender)

    def heed(self, sender: object) -> None:
        """Accept messages of an application again."""
        self.unheard = tuple(each for each in self.unheard if each is not sender)

    @property
    def is_filled(self) -> bool:
        """Whether the pipe exists but accepts no message, not even for a waiting reader."""
        return NOBODY_HEARD in self.unheard

    def identify(self, pipe_id: int) -> None:
        """Give the pipe the id of its table."""
        self.pipe_id = pipe_id
        self.receive_mark = trace.mark(trace.RECEIVE, pipe_id)
        self.drop_mark = trace.mark(trace.DROP, pipe_id)

    @property
    def dropped(self) -> int:
        """The number of messages that were refused."""
        return self.send_errors + self.overflows

    def is_closed(self) -> bool:
        """Return whether the pipe was deleted and has no room any more."""
        return self.depth == 0 and not self.is_filled
