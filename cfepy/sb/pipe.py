"""`Pipe`: a queue of packets that belongs to an application (CFE_SB_PipeD_t)."""

from __future__ import annotations

from cfepy import trace
from cfepy.interpreter.compiled import mypyc_attr
from cfepy.rtos import TIMEOUT, Kernel, Queue

NOBODY_HEARD = object()
"""In `Pipe.unheard`: a fault keeps the pipe full."""


@mypyc_attr(allow_interpreted_subclasses=True)
class Pipe(Queue):
    """The queue and its owner.

    `send_errors` counts what a message limit kept out, as NASA's SendErrors does; `overflows` what did not fit in. One
    that `keeps_newest` makes room for a message by dropping the oldest one, as the queue of a ROS subscriber does.
    Messages of the applications in `unheard` do not come in: its own, by an option of the pipe, and those of ROS nodes
    that are not connected with it yet; with NOBODY_HEARD among them, none of anybody. One that `is_called` has its
    reader come back without a message.

    Args:
        kernel: where its readers wait.
        depth: messages that fit in.
        name: unique on the bus.
        owner: the application, as found in `Task.owner`; None outside any.
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
        "receive_mark",
        "send_errors",
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
        self.send_errors = self.overflows = 0
        self.claim = 0
        self.identify(0)

    def call_reader(self) -> None:
        """Have the task that waits for a message, or is about to, come back without one."""
        if self.waits:
            self.kernel.wake_all(self.waits, TIMEOUT)
        else:
            self.is_called = True

    def ignore(self, sender: object) -> None:
        """Messages of this application do not come in from now on."""
        if sender not in self.unheard:
            self.unheard = (*self.unheard, sender)

    def heed(self, sender: object) -> None:
        """They come in again."""
        self.unheard = tuple(each for each in self.unheard if each is not sender)

    @property
    def is_filled(self) -> bool:
        """Whether it takes no message, not even for a reader that waits, and is nevertheless there."""
        return NOBODY_HEARD in self.unheard

    def identify(self, pipe_id: int) -> None:
        """Give the pipe the id under which its table keeps it."""
        self.pipe_id = pipe_id
        self.receive_mark = trace.mark(trace.RECEIVE, pipe_id)
        self.drop_mark = trace.mark(trace.DROP, pipe_id)

    @property
    def dropped(self) -> int:
        """Messages that did not come in."""
        return self.send_errors + self.overflows

    def is_closed(self) -> bool:
        """Whether the pipe was deleted: nothing fits in any more."""
        return self.depth == 0 and not self.is_filled
