"""What a test can look back at while a mission flies and afterwards: console, events, messages, numbers."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

from cfepy.es.records import STATE_NAMES
from cfepy.explore.console_errors import TracebackReader
from cfepy.mission.dictionary import Dictionary, dictionary_of
from cfepy.mission.message_watch import Heard
from cfepy.mission.mission import Mission
from cfepy.mission.results import Results, deaths, mark
from cfepy.mission.run_plan import RunPlan
from cfepy.mission.script_packets import Event
from cfepy.rtos.units import NS_PER_S
from cfepy.testing.errors import ExpectationError
from cfepy.testing.flight_log import FlightLog, Packet
from cfepy.testing.message_library import library_near

__tracebackhide__ = True  # pytest shows the line of the test

LAST_LINES = 10  # of the console, in the text of a failure


@dataclass(frozen=True, slots=True)
class App:
    """An application: its state ("RUNNING", "GONE", ...), how often it was restarted and died, its last error."""

    name: str
    state: str
    restarts: int
    deaths: int
    error: BaseException | None


class FlightRecord:
    """A mission that flies or has flown, to be looked at.

    Args:
        plan: what is flown.
        mission: the mission.
        log: attached to it.
        again: the command that does it again when the test has had a hand in it.

    Attributes:
        plan, mission, log: as given.
        touched: whether the test has had a hand in it, other than to let it run.
        closed: whether all its tasks have ended.
    """

    def __init__(self, plan: RunPlan, mission: Mission, log: FlightLog, again: Callable[[], str] | None) -> None:
        self.plan, self.mission, self.log = plan, mission, log
        self.touched = self.closed = False
        self._again = again
        self._results: Results | None = None

    @cached_property
    def dictionary(self) -> Dictionary:
        """Its packets by name; made when it is first asked for, since the applications' code is read for it."""
        return dictionary_of(self.mission.spec)

    @property
    def now(self) -> float:
        """Virtual time in s since the boot; when the results are there, that of the end without the nodes' shutdown."""
        return self.mission.kernel.now / NS_PER_S if self._results is None else self._results.virtual_s

    @property
    def console(self) -> list[str]:
        """All lines of the console: system log, events on the port, what nodes print and log."""
        return self.log.lines

    @property
    def events(self) -> list[Event]:
        """All events."""
        return self.log.events

    def messages(self, topic: str) -> list[Any]:
        """All messages on a ROS topic, whether or not anybody subscribed."""
        return [each.msg for each in self.history(topic)]

    def history(self, topic: str) -> list[Heard]:
        """The messages on a ROS topic with who sent them (`sender`) and when (`t`, virtual s); `msg` is the message."""
        return self.log.messages.get(topic, [])

    def telemetry(self, name: str) -> Packet:
        """The last packet of a kind.

        Raises:
            UsageError: there is no such packet in the dictionary.
            ExpectationError: none was sent.
        """
        found = self.packets(name)
        if not found:
            names = self.log.telemetry_names()
            instead = f"only {', '.join(names)}" if names else "no telemetry"
            raise self._failure(f"telemetry {self.dictionary.telemetry_of(name).name} until now", instead)
        return found[-1]

    def packets(self, name: str) -> list[Packet]:
        """All packets of a kind, by the name of the telemetry or its MsgId, whether or not anybody subscribed.

        Raises:
            UsageError: there is no such packet in the dictionary.
        """
        msg_id = self.dictionary.telemetry_of(name).msg_id
        return [self.log.packet(seen) for seen in self.log.packets.get(msg_id, ())]

    def stdout(self, node: str) -> list[str]:
        """The lines that a node has printed and logged, by the node's name, without the name in front.

        Raises:
            ExpectationError: there is no such node, and was none.
        """
        name = node.lstrip("/")
        found = [line.removeprefix(f"[{name}] ") for line in self.log.lines if line.startswith(f"[{name}] ")]
        ros = self.mission.ros
        known = [] if ros is None else [*ros.graph.nodes, *(f"/{end.name}" for end in ros.ended.values())]
        if not found and f"/{name}" not in known:
            raise self._failure(f"a node {node}", ", ".join(dict.fromkeys(known)) or "no node")
        return found

    def app(self, name: str) -> App:
        """An application, by its cFE name.

        Raises:
            ExpectationError: there is none, and was none.
        """
        es = self.mission.cfe.es
        history = es.history.get(name)
        if history is None:
            raise self._failure(f"an application {name}", ", ".join(es.history))
        state = next((STATE_NAMES[app.state] for app in es.apps if app.name == name), "GONE")
        return App(name, state, history.restarts, history.deaths, history.last_error)

    @property
    def deaths(self) -> list[str]:
        """A line for each application that has died of an exception."""
        return deaths(self.mission)

    @property
    def problems(self) -> list[str]:
        """A line for all that is wrong until now: what a run's report tells, exceptions in nodes, deadlocks.

        An exception that ends only a thread, or that rospy catches behind a callback, is not in a run's report.
        """
        if self._results is not None:
            return [*self._results.problems, *self._raised()]
        circles = [", ".join(map(str, circle)) for circle in self.mission.kernel.deadlocked()]
        return [*Results.of(self.mission, mark(self.mission, 0), "").problems, *self._raised(), *circles]

    def _raised(self) -> list[str]:
        """The exceptions whose tracebacks nodes have printed."""
        reader = TracebackReader()
        for line in self.log.lines:
            reader.take(line, 0)
        return list(dict.fromkeys(failure.title for failure in reader.found))

    def message_class(self, kind: str) -> Any:
        """The class of a ROS message type, such as "std_msgs/Float64", also of the mission's own packages.

        Raises:
            UsageError: there is no such type.
        """
        return library_near(self.mission.spec.folder).message_class(kind)

    # -- the end -------------------------------------------------------------------------------------------------------

    @property
    def results(self) -> Results:
        """The numbers of the run (`cfepy.mission.results.Results`). Asking for them ends it: the nodes shut down."""
        if self._results is None:
            at = mark(self.mission, 0)
            self.mission.conclude()
            self.mission.shut_down_nodes()
            digest = self.mission.finish()
            self.close()
            self._results = Results.of(self.mission, at, digest)
        return self._results

    def close(self) -> None:
        """End every task; what was taken down stays readable."""
        if not self.closed:
            self.closed = True
            self.mission.close()

    # -- failures ------------------------------------------------------------------------------------------------------

    def _failure(self, expected: str | None, instead: str) -> ExpectationError:
        first = instead if expected is None else f"expected {expected}\ninstead: {instead}"
        return ExpectationError("\n".join([first, *self.state_lines(), f"the same again: {self.command()}"]))

    def state_lines(self) -> list[str]:
        """What is wrong, and the end of the console, as failures have it."""
        lines = [f"  {line}" for line in self.log.lines[-LAST_LINES:]]
        problems = [f"problem: {each}" for each in self.problems]
        return [*problems, f"console until {self.now:.3f}:", *lines]

    def command(self) -> str:
        """The command that does the same run again: `cfepy run`, or the test when it has had a hand in it."""
        if self.touched and self._again is not None:
            return self._again()
        return replace(self.plan, seconds=self.now).command_line()
