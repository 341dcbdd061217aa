"""What tasks do to things that they share: locks, events, pipes, topics, parameters, counters.

Two runs are compared by their deeds. A deed is known again in another run by its task, what it does to which thing, and
how often the task has done that before.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator
from typing import NamedTuple

from cfepy.schedules import plain_name

WANTS, HAS, RELEASES = "wants", "has", "releases"
SETS, CLEARS, NOTIFIES, AWAITS, WAKES, GIVES_UP = (
    "sets",
    "clears",
    "notifies",
    "waits for",
    "is woken by",
    "gives up waiting for",
)
GIVES, TAKES = "gives", "takes"
SENDS, GETS, LOSES, SUBSCRIBES = "sends", "gets", "loses", "subscribes to"
DELETES, RECEIVES = "deletes", "receives from"
READS, WRITES = "reads", "writes"
GIVES_WAY = "gives way to"
ALL = "*"


class Deed(NamedTuple):
    """What a task did to a thing.

    Attributes:
        at_ns: virtual time.
        task: its name.
        app: that of its application.
        verb: HAS, SENDS and so on.
        thing: `self.lock (bank.py:12)`, `/odom`, `pipe HK_PIPE`.
        place: the line of the mission's own code, `bank.py:14`; empty where it runs none.
        note: more of it: the depth of a pipe, how many tasks were notified, in whose pipe, the file of an access.
        ident: number of the object that was read or written, 0 where the thing has its name alone.
        key: of what was accessed in it, an attribute or an item; ALL for all of a container.
    """

    at_ns: int
    task: str
    app: str
    verb: str
    thing: str
    place: str
    note: str = ""
    ident: int = 0
    key: str = ""

    def is_of_same(self, other: Deed) -> bool:
        """Whether two accesses are of the same variable, or one is of all of a container."""
        if self.ident or other.ident:
            return self.ident == other.ident and (self.key == other.key or ALL in (self.key, other.key))
        return self.thing == other.thing


class DeedKey(NamedTuple):
    """What a deed has in common with that of another run; `number` counts those of the same kind from 0."""

    task: str
    verb: str
    thing: str
    note: str
    number: int


def keys_of(deeds: Iterable[Deed]) -> Iterator[DeedKey]:
    """The key of each deed of a run."""
    seen: Counter[tuple[str, str, str, str]] = Counter()
    for deed in deeds:
        kind = (plain_name(deed.task), deed.verb, deed.thing, deed.note if deed.verb in (GETS, LOSES) else "")
        yield DeedKey(*kind, seen[kind])
        seen[kind] += 1
