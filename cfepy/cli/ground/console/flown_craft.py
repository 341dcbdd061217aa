"""The craft of a console that flies a mission: in virtual time, or in real time with its ports open."""

from __future__ import annotations

import contextlib
from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import Any

from cfepy.cli.display import SilentDisplay
from cfepy.cli.flight_add_ons import FlightAddOns
from cfepy.cli.ground.console.saved import SavedScript
from cfepy.cli.options import LONGEST_S
from cfepy.cli.watched_host import Interrupts, WatchedHost
from cfepy.ground import Dictionary
from cfepy.journal import JournalRecorder
from cfepy.mission import PACKET, Mission, MissionSpec, PacketWatch, Seen
from cfepy.pilot import Course, Flown, LiveRun, RunPlan, takeoff
from cfepy.script import Collected, RosAction, Scene, StandingScript

MOST_PACKETS = 50_000
"""How many recent packets an expectation can look at."""


class CraftScene(Scene):
    """A scene of a mission in this process. Packets and actions are outside events, so that a journal records them."""

    def __init__(self, mission: Mission, dictionary: Dictionary, packets: Collected, saved: SavedScript) -> None:
        super().__init__(mission, dictionary, packets)
        self._saved = saved

    def transmit(self, packet: bytes) -> None:
        outside = self.mission.outside
        self._saved.sent(packet, max(0, outside.until_ns))
        outside.act(PACKET, packet)

    def perform(self, action: RosAction) -> str:
        self._saved.acted(action, max(0, self.mission.outside.until_ns))
        return super().perform(action)

    def act(self, name: str, *values: Any) -> Any:
        return self.mission.outside.act(name, *values)


class StandingCourse(Course):
    """The course of a run that continues until its user ends it."""

    script: StandingScript

    def next_stop(self) -> int:
        return min(self.until_ns, self.script.advance())


class News(SilentDisplay):
    """Keeps packets and console lines in the order in which they arrive, until they are taken."""

    def __init__(self) -> None:
        self._news: list[Seen | str] = []

    def line(self, text: str) -> None:
        self._news.append(text)

    tell = line

    def packet(self, seen: Seen) -> None:
        """Keep a packet that was sent."""
        self._news.append(seen)

    def take(self) -> list[Seen | str]:
        """Return all packets and lines since the last call."""
        news, self._news = self._news, []
        return news


class FlownCraft:
    """A mission that is flown for a console; use as a context manager.

    Args:
        plan: the run; without a length, it goes on until the session ends.
        spec: the mission.
        dictionary: the dictionary of the mission.
        saved: receives the packets that are sent.
        interrupts: reports whether Ctrl-C was pressed.
        realtime: as for `WatchedHost`.
        ports: as for `WatchedHost`.
        add_ons: as for `WatchedHost`.
        journal: records the run, if it is not None.
        note: receives messages for the user.

    Attributes:
        name: see `Craft`.
        flows: see `Craft`.
        script: see `Craft`.
    """

    def __init__(
        self,
        plan: RunPlan,
        spec: MissionSpec,
        dictionary: Dictionary,
        saved: SavedScript,
        interrupts: Interrupts,
        *,
        realtime: float | None = None,
        ports: Mapping[int, int] | None = None,
        add_ons: FlightAddOns | None = None,
        journal: JournalRecorder | None = None,
        note: Callable[[str], object] = print,
    ) -> None:
        self.name = spec.name
        self.flows = realtime is not None
        self.script: StandingScript
        self._plan = replace(plan, seconds=LONGEST_S if plan.seconds is None else plan.seconds, script=None)
        self._spec = spec
        self._dictionary = dictionary
        self._saved = saved
        self._attachments = [] if add_ons is None else add_ons.attachments
        self._journal = journal
        self._packets = Collected(MOST_PACKETS)
        self._news = News()
        self._interrupts = interrupts
        self._host = WatchedHost(
            interrupts,
            lambda seconds: self._news,
            realtime=realtime,
            ports=ports,
            add_ons=add_ons,
            pause=(lambda: None) if journal is None else journal.mark,
            note=note,
        )
        self._open = contextlib.ExitStack()
        self._run: LiveRun

    def __enter__(self) -> FlownCraft:
        journal = self._journal
        with self._open as opening:
            opening.enter_context(self._host)
            observers = [PacketWatch(self._sent, unsent=True), *self._attachments]
            flight = takeoff(
                self._plan,
                spec=self._spec,
                attachments=observers if journal is None else [*observers, journal],
                console=self._host.console,
                policy=None if journal is None else journal.policy,
                make_course=StandingCourse,
                host=self._host,
            )
            self._run = opening.enter_context(flight)
            scene = CraftScene(self._run.mission, self._dictionary, self._packets, self._saved)
            course = self._run.course
            assert isinstance(course, StandingCourse)
            self.script = course.script = StandingScript(scene, self._spec)
            self._open = opening.pop_all()
        return self

    def __exit__(self, *error: Any) -> None:
        self._open.__exit__(*error)

    def _sent(self, seen: Seen) -> None:
        self._news.packet(seen)
        self._packets.append(seen)

    @property
    def stands_ns(self) -> int:
        return max(0, self._run.mission.outside.until_ns)

    @property
    def is_asked(self) -> bool:
        return self._interrupts.asked

    @property
    def is_over(self) -> bool:
        return not self._run.course.goes_on

    def step(self, until_ns: int) -> bool:
        return self._run.step(until_ns)

    def stand(self) -> None:
        if not self.is_over:
            self._host.stand()

    def next_event(self) -> int | None:
        return self._run.mission.kernel.next_event()

    def pace(self, factor: float | None) -> None:
        self._host.pace(factor)

    def news(self) -> list[Seen | str]:
        news = self._news.take()
        if news:
            self.script.scene.learn_topics()
        return news

    def land(self) -> Flown:
        """End the run, and close the mission."""
        self._run.end(self._host.wall_ns())
        self._open.close()
        flown = self._run.flown()
        if self._journal is not None:
            self._journal.end(flown)
        return flown
