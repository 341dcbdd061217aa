"""Where `cfepy topic` and `cfepy service` look: a bag, or a mission that is flown for it in virtual time."""

from __future__ import annotations

import argparse
import importlib
import sys
from collections.abc import Callable, Generator, Iterator, Sequence
from pathlib import Path
from types import TracebackType
from typing import TYPE_CHECKING, NamedTuple

from cfepy.cli.failures import booting
from cfepy.cli.run import script_of
from cfepy.console import Console
from cfepy.mission import Mission, MissionSpec, read_mission
from cfepy.mission.bag import BagReader, is_bag
from cfepy.mission.results import deaths
from cfepy.mission.single_node import spec_of_script
from cfepy.mission.topic_watch import Message, TopicWatch
from cfepy.rtos.units import NS_PER_MS, NS_PER_S

if TYPE_CHECKING:
    from cfepy.mission.script import ScriptRun

FLIGHT_S = 10.0
PIECE_NS = 100 * NS_PER_MS


class TopicRow(NamedTuple):
    """What there is on a topic; nodes by name."""

    name: str
    type: str
    publishers: tuple[str, ...]
    subscribers: tuple[str, ...]


def spec_for(arguments: argparse.Namespace) -> MissionSpec:
    """The mission that a command line means: a node's script, or what `read_mission` takes.

    Raises:
        UsageError: it is none of them.
    """
    path = Path(arguments.source)
    if path.is_file() and importlib.import_module("rospy_shim.roslaunch.scripts").is_python(path):
        return spec_of_script(path.resolve(), [])
    return read_mission(arguments.source, dict(arguments.launch_args))


class BagSource:
    """A recorded run; use as a context manager.

    Args:
        file: the bag.
        seconds: how much of it; None is all.
    """

    def __init__(self, file: str, seconds: float | None) -> None:
        self._bag = BagReader(file)
        self._end_ns = None if seconds is None else round(seconds * NS_PER_S)

    def messages(self, patterns: Sequence[str] = ()) -> Generator[Message, None, None]:
        """The messages by time, as far as the command line wants them."""
        for message in self._bag.messages(patterns):
            if self._end_ns is not None and message.at_ns > self._end_ns:
                return
            yield message

    def rows(self) -> list[TopicRow]:
        """The topics, by name; a bag knows no subscribers."""
        publishers: dict[tuple[str, str], dict[str, None]] = {}
        for each in self._bag.connections:
            names = publishers.setdefault((each.topic, each.datatype), {})
            if "callerid" in each.header:
                names[each.header["callerid"].decode()] = None
        return [TopicRow(*key, tuple(names), ()) for key, names in sorted(publishers.items())]

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
        spec: the mission.
        arguments: of the command line: seconds, script and so on.
        console: takes the mission's lines; None takes them away.

    Attributes:
        mission: while it is flown.
    """

    def __init__(self, spec: MissionSpec, arguments: argparse.Namespace, console: Console | None = None) -> None:
        self._spec = spec
        self._arguments = arguments
        self._console = console if console is not None else Console(quiet=True)
        self.mission: Mission

    def messages(self, patterns: Sequence[str] = ()) -> Generator[Message, None, None]:
        """Fly, and give the messages as they come; see `TopicWatch` for the patterns."""
        seen: list[Message] = []
        for _ in self._pieces(seen, patterns):
            yield from seen
            seen.clear()

    def _pieces(self, seen: list[Message] | None, patterns: Sequence[str] = ()) -> Iterator[None]:
        """Fly piece by piece; messages go into `seen`, if anybody wants them."""
        arguments = self._arguments
        script = script_of(arguments, self._spec)
        watch = None if seen is None else TopicWatch(seen.append, patterns)
        with booting(self._spec.script):
            self.mission = mission = Mission(
                self._spec,
                seed=arguments.seed,
                board=arguments.board,
                console=self._console,
                attachments=[each for each in (script, watch) if each is not None],
            )
            until_ns = self._end_ns(script)
            while mission.kernel.now < until_ns and not mission.over and not self._is_done(script):
                stop_ns = min(until_ns, mission.kernel.now + PIECE_NS)
                mission.run_until(stop_ns if script is None else min(stop_ns, script.advance()))
                yield

    def _end_ns(self, script: ScriptRun | None) -> int:
        longest_s = FLIGHT_S if script is None else script.script.longest_ns / NS_PER_S
        return round((self._arguments.seconds or longest_s) * NS_PER_S)

    def _is_done(self, script: ScriptRun | None) -> bool:
        return script is not None and (script.stopped or (script.finished and self._arguments.seconds is None))

    def fly(self, is_enough: Callable[[], bool] = lambda: False) -> Mission:
        """Fly without looking at messages, until there is enough; the mission, as it is at the end."""
        for _ in self._pieces(None):
            if is_enough():
                break
        return self.mission

    def rows(self) -> list[TopicRow]:
        """The topics that there are when it has flown, by name."""
        found = [] if self.mission.ros is None else self.mission.ros.topics()
        return [TopicRow(row.name, row.type, row.publishers, row.subscribers) for row in found]

    def addresses(self) -> dict[str, str]:
        """The URIs of the nodes that there are when it has flown, by name."""
        nodes = {} if self.mission.ros is None else self.mission.ros.graph.nodes
        return {name: node.client.get_node_uri() for name, node in nodes.items()}

    def __enter__(self) -> FlightSource:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, where: TracebackType | None
    ) -> None:
        if not hasattr(self, "mission"):
            return
        problems = deaths(self.mission)
        self.mission.close()
        sys.stdout.flush()
        for problem in problems:
            print(f"cfepy: {problem}", file=sys.stderr)


Source = BagSource | FlightSource


def source_of(arguments: argparse.Namespace) -> Source:
    """What the command line names: a bag or a mission."""
    if is_bag(arguments.source):
        return BagSource(arguments.source, arguments.seconds)
    return FlightSource(spec_for(arguments), arguments)
