"""Routes of the Software Bus: which pipes a MsgId goes to, and what became of each message (cfe_sb_priv.c, cfe_sbr)."""

from __future__ import annotations

from cfepy import trace
from cfepy.rtos import Kernel, Queue

COMMAND = 0x1000  # bits of a MsgId: the packet type, and whether a secondary header follows
SECONDARY = 0x0800
GLOBAL = 1  # scope of a subscription: other processors are told of it
LOCAL = 0


class Pipe(Queue):
    """A queue of packets that belongs to an application (CFE_SB_PipeD_t)."""

    __slots__ = ("app_id", "app_name", "claim", "drop_mark", "opts", "owner", "pipe_id", "receive_mark", "send_errors")

    def __init__(self, kernel: Kernel, depth: int, name: str, owner: object) -> None:
        super().__init__(kernel, depth, name)
        self.waits.what = f"a message on pipe {name}"
        self.owner = owner
        self.app_id: int = getattr(owner, "app_id", 0)
        self.app_name: str = getattr(owner, "name", "host")
        self.opts = 0
        self.send_errors = 0
        self.claim = 0
        self.identify(0)

    def identify(self, pipe_id: int) -> None:
        """Give the pipe the id under which its table keeps it."""
        self.pipe_id = pipe_id
        self.receive_mark = trace.mark(trace.RECEIVE, pipe_id)
        self.drop_mark = trace.mark(trace.DROP, pipe_id)


class Destination:
    """One pipe on a route (CFE_SB_DestinationD_t); `puts - gets` is NASA's BuffCount."""

    __slots__ = ("active", "gets", "limit", "limit_drops", "overflow_drops", "pipe", "puts", "scope")

    def __init__(self, pipe: Pipe, limit: int, scope: int) -> None:
        self.pipe = pipe
        self.limit = limit
        self.scope = scope
        self.active = True
        self.puts = self.gets = 0
        self.limit_drops = self.overflow_drops = 0


class Route:
    """All destinations of one MsgId, the newest subscriber first; it stays when the last one leaves.

    `active` is replaced and never changed: a transmission that is under way goes on with the tuple it began with.
    """

    __slots__ = ("active", "destinations", "gone", "is_telemetry", "msg_id", "relayed", "sequence")

    def __init__(self, msg_id: int) -> None:
        self.msg_id = msg_id
        self.is_telemetry = msg_id & (COMMAND | SECONDARY) == SECONDARY
        self.sequence = 0  # messages that were given a sequence count here
        self.relayed = 0  # messages that came with their own
        self.destinations: list[Destination] = []
        self.active: tuple[Destination, ...] = ()
        self.gone: list[Destination] = []  # of subscriptions that ended, for the totals

    @property
    def sent(self) -> int:
        """Messages transmitted on this route."""
        return self.sequence + self.relayed

    def find(self, pipe: Pipe) -> Destination | None:
        """The destination that a pipe is, or None."""
        for destination in self.destinations:
            if destination.pipe is pipe:
                return destination
        return None

    def add(self, destination: Destination) -> None:
        """Put a destination in front: the newest subscriber gets a message first."""
        self.destinations.insert(0, destination)
        self.refresh()

    def remove(self, destination: Destination) -> None:
        """Take a destination off."""
        self.destinations.remove(destination)
        self.gone.append(destination)
        self.refresh()

    def refresh(self) -> None:
        """Make `active` new after a change."""
        self.active = tuple(destination for destination in self.destinations if destination.active)

    def totals(self) -> tuple[int, int, int]:
        """(delivered, dropped for a message limit, dropped for a full pipe) over all destinations there ever were."""
        everyone = [*self.destinations, *self.gone]
        return (
            sum(each.gets for each in everyone),
            sum(each.limit_drops for each in everyone),
            sum(each.overflow_drops for each in everyone),
        )
