"""Missions that fly together with another one, as processors on one network: `--with MISSION`.

Each is a simulated computer with its own kernel. The missions advance in turn, by one link delay at a time. Datagrams
to a port without a socket in the sending mission are collected meanwhile. They arrive at the ports of the other
missions at the next such instant, through the same entry point as input from real sockets. No datagram can arrive
earlier, so the order of the missions does not matter: the run is a function of the missions and the seed. A journal of
the first mission has its input, and is replayed without the others.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from cfepy.mission import Mission
from cfepy.osal import Datagram, Place
from cfepy.pilot.problems import BESIDE
from cfepy.units import NS_PER_MS, NS_PER_S

LOOPBACK = "127.0.0.1"
LINK_NS = NS_PER_MS
"""The maximum delay of a datagram in virtual ns; it arrives at a multiple of this time."""

_LATER = re.compile(r"(?P<mission>.+)@(?P<seconds>\d+(\.\d+)?)")


def boot_of(text: str) -> tuple[str, int]:
    """Return a mission and the virtual time in ns at which it boots: "pair/client.scr@0.35"."""
    found = _LATER.fullmatch(text)
    return (text, 0) if found is None else (found["mission"], round(float(found["seconds"]) * NS_PER_S))


@dataclass(eq=False)
class Companion:
    """A mission that flies together with others.

    Attributes:
        name: its name, as the user has written it.
        mission: the mission.
        begins_ns: virtual time of the first mission at which this one starts, in ns.
        run_until: runs it to a virtual time of its own, in ns.
        problems: returns its problems, one per line.
        sent, taken, lost: numbers of datagrams that it sent to the others, that arrived, and that found no room or
            socket.
    """

    name: str
    mission: Mission
    begins_ns: int
    run_until: Callable[[int], object]
    problems: Callable[[], list[str]]
    sent: int = 0
    taken: int = 0
    lost: int = 0

    def row(self) -> dict[str, Any]:
        """Return its row of the report."""
        mission = self.mission
        return {
            "mission": self.name,
            "booted_s": None if mission.booted is None else (mission.booted + self.begins_ns) / NS_PER_S,
            "sent": self.sent,
            "taken": self.taken,
            "lost": self.lost,
            "resets": len(mission.record.resets),
            "died": "; ".join(mission.record.deaths()),
            "problems": self.problems(),
            "trace": mission.trace.digest(),
        }


class Company:
    """The missions that fly together, and the network between them.

    Args:
        members: the missions; the caller flies the first one.
    """

    def __init__(self, members: list[Companion]) -> None:
        self._members = members
        self._under_way: list[tuple[Companion, Datagram]] = []
        self._due_ns = 0
        for each in members:
            each.mission.network.outlets.append(self._outlet(each))
        members[0].mission.record.tables[BESIDE] = lambda: [each.row() for each in members[1:]]

    def advance(self) -> int:
        """Bring all missions to the time of the first one; return the virtual time in ns until which it may
        continue.
        """
        now_ns = self._members[0].mission.kernel.now
        if now_ns >= self._due_ns:
            for each in self._members[1:]:
                if now_ns > each.begins_ns:
                    each.run_until(now_ns - each.begins_ns)
            self._deliver(now_ns)
            self._due_ns = now_ns - now_ns % LINK_NS + LINK_NS
        return self._due_ns

    def _outlet(self, sender: Companion) -> Callable[[Datagram], object]:
        def leave(datagram: Datagram) -> None:
            if datagram.target.is_here and not datagram.target.is_ip6:
                self._under_way.append((sender, datagram))

        return leave

    def _deliver(self, now_ns: int) -> None:
        under_way, self._under_way = self._under_way, []
        under_way.sort(key=lambda each: self._members.index(each[0]))
        for sender, datagram in under_way:
            receiver = self._receiver(sender, datagram.target)
            if receiver is None:
                continue  # a port of no mission, such as the ground's
            sender.sent += 1
            source = Place(LOOPBACK, datagram.source.port)
            if receiver.mission.outside.datagram(datagram.target.port, source, datagram.data):
                receiver.taken += 1
            else:
                receiver.lost += 1

    def _receiver(self, sender: Companion, target: Place) -> Companion | None:
        for each in self._members:
            if each is not sender and each.mission.network.datagrams.find(target.reached()) is not None:
                return each
        return None
