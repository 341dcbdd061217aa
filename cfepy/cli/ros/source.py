"""The source of `cfepy rostopic` and `cfepy rosservice`: a bag, a mission that is flown for them in virtual time, or a
running flight."""

from __future__ import annotations

import argparse
from collections.abc import Callable, Generator, Iterator, Sequence
from contextlib import ExitStack
from types import TracebackType
from typing import NamedTuple

from cfepy.cli.flying_progress import FlyingProgress
from cfepy.cli.options import refuse_run_options
from cfepy.cli.user_notes import tell, tell_briefly
from cfepy.cli.viewed_runs import flight_plan
from cfepy.ground import BagReader, header_of, is_bag
from cfepy.io import LiveFlight, live_flight, live_name
from cfepy.mission import Mission, MissionSpec, TopicMessage, TopicWatch
from cfepy.pilot import LiveRun, RunPlan, never_happened, takeoff
from cfepy.units import NS_PER_MS, NS_PER_S
from cfepy.writing.console import Console

PIECE_NS = 100 * NS_PER_MS


class SeenTopic(NamedTuple):
    """The state of a topic; nodes by name."""

    name: str
    type: str
    publishers: tuple[str, ...]
    subscribers: tuple[str, ...]


class BagSource:
    """A recorded run; use as a context manager.

    Args:
        file: the bag.
        seconds: length to read, in s; None is all.
    """

    def __init__(self, file: str, seconds: float | None) -> None:
        self._bag = BagReader(file)
        self._end_ns = None if seconds is None else round(seconds * NS_PER_S)

    def messages(self, patterns: Sequence[str] = ()) -> Generator[TopicMessage, None, None]:
        """Yield the messages by time, up to the end that the command line sets."""
        for message in self._bag.messages(patterns):
            if self._end_ns is not None and message.at_ns > self._end_ns:
                return
            yield message

    def topics(self) -> list[SeenTopic]:
        """Return the topics, by name; a bag knows no subscribers."""
        publishers: dict[tuple[str, str], dict[str, None]] = {}
        for each in self._bag.connections:
            names = publishers.setdefault((each.topic, each.datatype), {})
            header = header_of(each)
            if "callerid" in header:
                names[header["callerid"]] = None
        return [SeenTopic(*key, tuple(names), ()) for key, names in sorted(publishers.items())]

    def addresses(self) -> dict[str, str]:
        """Return the URIs of nodes by name; a bag has none."""
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
        spec: the mission, if it differs from the mission of the plan.
        console: receives the mission's lines; None discards them.
    """

    def __init__(self, plan: RunPlan, spec: MissionSpec | None = None, console: Console | None = None) -> None:
        self._plan = plan
        self._spec = spec
        self._console = console
        self._host = FlyingProgress()
        self._flight = ExitStack()
        self._run: LiveRun | None = None

    @property
    def mission(self) -> Mission:
        """The mission, in its present state."""
        assert self._run is not None
        return self._run.mission

    def messages(self, patterns: Sequence[str] = ()) -> Generator[TopicMessage, None, None]:
        """Fly the mission, and yield the messages as they arrive; see `TopicWatch` for the patterns."""
        seen: list[TopicMessage] = []
        for _ in self._pieces([TopicWatch(seen.append, patterns)]):
            if seen:
                self._host.progress.clear()
            yield from seen
            seen.clear()

    def _pieces(self, watches: Sequence[TopicWatch] = ()) -> Iterator[None]:
        """Fly the mission in short steps."""
        flight = takeoff(self._plan, spec=self._spec, attachments=watches, console=self._console, host=self._host)
        self._run = run = self._flight.enter_context(flight)
        tell_briefly(run.notes)
        while run.course.goes_on:
            run.run_until(run.mission.kernel.now + PIECE_NS)
            yield

    def fly(self, is_enough: Callable[[], bool] = lambda: False) -> Mission:
        """Fly without looking at messages until `is_enough` or to the end. Returns the mission in its final state."""
        for _ in self._pieces():
            if is_enough():
                break
        return self.mission

    def topics(self) -> list[SeenTopic]:
        """Return the topics that exist after the flight, by name."""
        found = [] if self.mission.ros is None else self.mission.ros.topics()
        return [SeenTopic(row.name, row.type, row.publishers, row.subscribers) for row in found]

    def addresses(self) -> dict[str, str]:
        """Return the URIs of the nodes that exist after the flight, by name."""
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


class LiveSource:
    """A running flight; use as a context manager.

    Args:
        flight: the connection with it.
        seconds: wall time to listen, in s; None until Ctrl-C.
    """

    def __init__(self, flight: LiveFlight, seconds: float | None) -> None:
        self._flight = flight
        self._seconds = seconds
        self._topics: list[SeenTopic] = []

    def messages(self, patterns: Sequence[str] = ()) -> Generator[TopicMessage, None, None]:
        """Yield the messages from now on, until the flight or the time ends, or Ctrl-C."""
        self.topics()
        self._flight.listen(patterns)
        for message in self._flight.messages(self._seconds):
            if isinstance(message, TopicMessage):
                yield message

    def topics(self) -> list[SeenTopic]:
        """Return the topics that exist now, by name; after the end of the flight, those before."""
        try:
            self._topics = [SeenTopic(*row) for row in sorted(self._flight.topics())]
        except OSError:  # the flight has ended
            pass
        return self._topics

    def addresses(self) -> dict[str, str]:
        """Return the URIs of the nodes that exist now, by name."""
        return self._flight.nodes()

    def __enter__(self) -> LiveSource:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, where: TracebackType | None
    ) -> None:
        self._flight.close()
        if self._flight.lost:
            tell([f"{self._flight.lost} messages were lost, because they were not read in time"])


Source = BagSource | FlightSource | LiveSource


def source_of(arguments: argparse.Namespace) -> Source:
    """Make the source that the command line names: a bag, a mission or a running flight."""
    name = live_name(arguments.source)
    if name is not None:
        refuse_run_options(arguments, "only valid for a mission to be run; leave it out", but=["seconds"])
        return LiveSource(live_flight(name), arguments.seconds)
    if is_bag(arguments.source):
        refuse_run_options(
            arguments, f"only valid for a mission, and {arguments.source} is a bag; leave it out", but=["seconds"]
        )
        return BagSource(arguments.source, arguments.seconds)
    return FlightSource(flight_plan(arguments))
