"""The source of `cfepy topic` and `cfepy service`: a bag, or a mission that is flown for them in virtual time."""

from __future__ import annotations

import argparse
from collections.abc import Callable, Generator, Iterator, Sequence
from contextlib import ExitStack
from types import TracebackType
from typing import NamedTuple

from cfepy.cli.options import refuse_run_options
from cfepy.cli.user_notes import tell
from cfepy.cli.viewed_runs import flight_plan
from cfepy.ground import BagReader, header_of, is_bag
from cfepy.mission import Mission, MissionSpec, TopicMessage, TopicWatch
from cfepy.pilot import LiveRun, RunPlan, never_happened, takeoff
from cfepy.units import NS_PER_MS, NS_PER_S
from cfepy.writing.console import Console

PIECE_NS = 100 * NS_PER_MS


class SeenTopic(NamedTuple):
    """What there is on a topic; nodes by name."""

    name: str
    type: str
    publishers: tuple[str, ...]
    subscribers: tuple[str, ...]


class BagSource:
    """A recorded run; use as a context manager.

    Args:
        file: the bag.
        seconds: how much of it; None is all.
    """

    def __init__(self, file: str, seconds: float | None) -> None:
        self._bag = BagReader(file)
        self._end_ns = None if seconds is None else round(seconds * NS_PER_S)

    def messages(self, patterns: Sequence[str] = ()) -> Generator[TopicMessage, None, None]:
        """The messages by time, as far as the command line wants them."""
        for message in self._bag.messages(patterns):
            if self._end_ns is not None and message.at_ns > self._end_ns:
                return
            yield message

    def topics(self) -> list[SeenTopic]:
        """The topics, by name; a bag knows no subscribers."""
        publishers: dict[tuple[str, str], dict[str, None]] = {}
        for each in self._bag.connections:
            names = publishers.setdefault((each.topic, each.datatype), {})
            header = header_of(each)
            if "callerid" in header:
                names[header["callerid"]] = None
        return [SeenTopic(*key, tuple(names), ()) for key, names in sorted(publishers.items())]

    def addresses(self) -> dict[str, str]:
        """The URIs of nodes by name; a bag knows none."""
        return {}

    def __enter__(self) -> BagSource:
        self._bag.__enter__()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, where: TracebackType | None
    ) -> None:
        self._bag.__exit__(kind, error, where)


class FlightSource:
    """A mission that is flown; use as a context manager.

    Args:
        plan: the run.
        spec: the mission, when it is not that of the plan as it is.
        console: takes the mission's lines; None takes them away.
    """

    def __init__(self, plan: RunPlan, spec: MissionSpec | None = None, console: Console | None = None) -> None:
        self._plan = plan
        self._spec = spec
        self._console = console
        self._flight = ExitStack()
        self._run: LiveRun | None = None

    @property
    def mission(self) -> Mission:
        """The mission, as far as it has flown."""
        assert self._run is not None
        return self._run.mission

    def messages(self, patterns: Sequence[str] = ()) -> Generator[TopicMessage, None, None]:
        """Fly, and give the messages as they come; see `TopicWatch` for the patterns."""
        seen: list[TopicMessage] = []
        for _ in self._pieces([TopicWatch(seen.append, patterns)]):
            yield from seen
            seen.clear()

    def _pieces(self, watches: Sequence[TopicWatch] = ()) -> Iterator[None]:
        """Fly piece by piece."""
        flight = takeoff(self._plan, spec=self._spec, attachments=watches, console=self._console)
        self._run = run = self._flight.enter_context(flight)
        tell(run.notes)
        while run.course.goes_on:
            run.run_until(run.mission.kernel.now + PIECE_NS)
            yield

    def fly(self, is_enough: Callable[[], bool] = lambda: False) -> Mission:
        """Fly without looking at messages, until there is enough; the mission, as it is at the end."""
        for _ in self._pieces():
            if is_enough():
                break
        return self.mission

    def topics(self) -> list[SeenTopic]:
        """The topics that there are when it has flown, by name."""
        found = [] if self.mission.ros is None else self.mission.ros.topics()
        return [SeenTopic(row.name, row.type, row.publishers, row.subscribers) for row in found]

    def addresses(self) -> dict[str, str]:
        """The URIs of the nodes that there are when it has flown, by name."""
        nodes = {} if self.mission.ros is None else self.mission.ros.graph.nodes
        return {name: node.client.get_node_uri() or "" for name, node in nodes.items()}

    def __enter__(self) -> FlightSource:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, where: TracebackType | None
    ) -> None:
        if self._run is None:
            return
        problems = [*self._run.problems(), *never_happened(self.mission)]
        self._flight.__exit__(kind, error, where)
        tell(problems)


Source = BagSource | FlightSource


def source_of(arguments: argparse.Namespace) -> Source:
    """What the command line names: a bag or a mission."""
    if is_bag(arguments.source):
        refuse_run_options(
            arguments, f"only valid for a mission, and {arguments.source} is a bag; leave it out", but=["seconds"]
        )
        return BagSource(arguments.source, arguments.seconds)
    return FlightSource(flight_plan(arguments))
