"""The operations (deeds) of tasks on shared objects: locks, events, pipes, topics, parameters, counters.

Two runs are compared by their deeds. A deed is recognized in another run by its task, its verb, its object, and the
number of times that the task has done it before.
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
BINARY = "binary"  # the note of deeds with a semaphore that remembers one give


class Deed(NamedTuple):
    """An operation of a task on an object.

    Attributes:
        at_ns: virtual time.
        task: name of the task.
        app: name of its application.
        verb: HAS, SENDS and so on.
        thing: name of the object: `self.lock (bank.py:12)`, `/odom`, `pipe HK_PIPE`.
        place: the line of the mission's own code, `bank.py:14`; empty where it runs none.
        note: a detail: the depth of a pipe, the number of notified tasks, the owner of a pipe, the file of an access.
        ident: number of the object that was read or written; 0 if the object has only a name.
        key: the accessed attribute or item; ALL for all of a container.
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
        """Return True if two accesses are of the same variable, or one is of a whole container."""
        if self.ident or other.ident:
            return self.ident == other.ident and (self.key == other.key or ALL in (self.key, other.key))
        return self.thing == other.thing


class DeedKey(NamedTuple):
    """The key that a deed shares with its counterpart in another run; `number` counts deeds of the same kind from 0."""

    task: str
    verb: str
    thing: str
    note: str
    number: int


def keys_of(deeds: Iterable[Deed]) -> Iterator[DeedKey]:
    """Yield the key of each deed of a run."""
    seen: Counter[tuple[str, str, str, str]] = Counter()
    for deed in deeds:
        kind = (plain_name(deed.task), deed.verb, deed.thing, deed.note if deed.verb in (GETS, LOSES) else "")
        yield DeedKey(*kind, seen[kind])
        seen[kind] += 1
