"""`Run`: the data of a mission that flies or has flown: messages, packets, events, console, numbers.

    run.topic("/joint_states").to_numpy("position")
    run.trace, run.speed, run.topics, run.apps, run.events, run.console

It finds the data of a `FlightLog` by name, and creates the errors of failed expectations.
"""

from __future__ import annotations

import os
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

from cfepy.es import STATE_NAMES
from cfepy.flight.log import FlightLog, Packet
from cfepy.flight.message_library import library_near
from cfepy.flight.notebook import Picture, page_of_run, picture
from cfepy.ground import DecodedEvent, Dictionary, Series, SeriesSet
from cfepy.mission import Mission, endless_waits
from cfepy.monitors import Heard
from cfepy.pilot import (
    AppResult,
    Failure,
    Flown,
    Results,
    RunPlan,
    RunProblem,
    TopicResult,
    failures_of,
    mark,
    problems_of,
)
from cfepy.reading.suggestions import did_you_mean, listed
from cfepy.units import NS_PER_S
from cfepy.writing.escapes import visible

__tracebackhide__ = True  # pytest then shows the line of the test
LAST_LINES = 10  # of the console, in the text of a failure


class ExpectationError(AssertionError):
    """Exception for an expectation of a test that failed: an item was missing, or one occurred that must not.

    The text has the expectation and its time limit, the nearest other input, and the command that repeats the run.
    Control characters of messages and events are escaped.
    """

    def __str__(self) -> str:
        return visible(super().__str__())


@dataclass(frozen=True, slots=True)
class App:
    """An application: its state ("RUNNING", "GONE", ...), its numbers of restarts and deaths, its last error."""

    name: str
    state: str
    restarts: int
    deaths: int
    error: BaseException | None


class Run:
    """The data of a mission that flies or has flown. A notebook shows it as tables.

    While the run flies, its numbers are those so far. `trace`, `speed` and `results` are about the whole run, and end
    it.

    Args:
        plan: plan of the run.
        mission: the mission.
        log: the log attached to it.
        flown: its end state; None while it flies.

    Attributes:
        plan, mission, log: as given.
    """

    def __init__(self, plan: RunPlan, mission: Mission, log: FlightLog, flown: Flown | None = None) -> None:
        self.plan = plan
        self.mission = mission
        self.log = log
        self._flown = flown

    @property
    def dictionary(self) -> Dictionary:
        """The mission's packets by name."""
        return self.log.dictionary

    @property
    def now(self) -> float:
        """Virtual time in s since the boot; after the end, the end of the run without the nodes' shutdown."""
        return self.mission.kernel.now / NS_PER_S if self._flown is None else self._flown.results.virtual_s

    @property
    def trace(self) -> str:
        """The digest of the run, 32 hexadecimal digits, equal for equal runs. Reading it ends the run."""
        return self.results.trace

    @property
    def speed(self) -> float:
        """Virtual time divided by wall time. Reading it ends the run."""
        return self.results.speed

    @property
    def topics(self) -> list[TopicResult]:
        """The delivery counts of each topic and packet, a row for each MsgId."""
        return self._numbers.topics

    @property
    def apps(self) -> list[AppResult]:
        """A row for each application: state, share of the CPU, restarts, deaths, error."""
        return self._numbers.apps

    @property
    def _numbers(self) -> Results:
        """The numbers of the whole run, or so far."""
        return self._flown.results if self._flown is not None else Results.of(self.mission, mark(self.mission, 0), "")

    @property
    def console(self) -> list[str]:
        """All lines of the console: system log, events on the port, output and logs of nodes."""
        return self.log.lines

    @property
    def events(self) -> list[DecodedEvent]:
        """All events."""
        return self.log.events

    @property
    def series(self) -> SeriesSet:
        """Values over time of everything sent so far; `Run.topic` returns one of them."""
        return self.log.series()

    def topic(self, name: str) -> Series:
        """Return the messages on a ROS topic, or the packets of a cFE packet type, with their values over time.

        Args:
            name: name of the topic, or of the packet in the mission's dictionary, such as "CFE_ES_HK_TLM".

        Returns:
            The messages: `to_numpy(field)` returns times in s and values, `to_pandas()` a table.

        Raises:
            UsageError: if nothing was sent under this name.
        """
        found = self.log.series_of(name)
        return self.series.series(name) if found is None else found

    def plot(self, name: str, *fields: str, file: str | os.PathLike[str] | None = None) -> Picture:
        """Return a picture of values over time, one axes below the other.

        Args:
            name: name of a topic or a packet.
            fields: their paths, such as "position" or "pose.position.x"; empty for all.
            file: file to write, as PNG, SVG or PDF by its suffix; None writes none.

        Raises:
            UsageError: if nothing was sent under this name, the field does not exist, matplotlib is not installed, or
                the file cannot be written.
        """
        words = [f"{name}.{field}" for field in fields] or [name]
        return picture(self.series, words, self.mission.spec.name, file)

    def __repr__(self) -> str:
        state = "flies" if self._flown is None else f"{self._flown.results.speed:.1f} x real time, trace {self.trace}"
        return f"<{self.mission.spec.name}: {self.now:.3f} virtual s, seed {self.plan.seed}, {state}>"

    def _repr_html_(self) -> str:
        """Return the HTML for a notebook."""
        notes = () if self._flown is None else self._flown.notes
        return page_of_run(self._numbers, self.problems, notes, self.events, self.console)

    def messages(self, topic: str) -> Sequence[Any]:
        """Return all messages on a ROS topic so far, including those without a subscriber. Each is decoded when it is
        read, so `messages(topic)[-1]` takes the same time in a long run.
        """
        series = self.log.topics.get(topic)
        return [] if series is None else series.messages

    def history(self, topic: str) -> Sequence[Heard]:
        """Return the messages on a ROS topic: `msg` is the message, `sender` its sender, `t` its time in virtual s."""
        return self.log.heard(topic)

    def telemetry(self, name: str) -> Packet:
        """Return the last packet of a kind.

        Raises:
            UsageError: if the packet is not in the dictionary.
            ExpectationError: if none was sent.
        """
        found = self.log.packets.get(self.dictionary.telemetry_of(name).msg_id)
        if not found:
            names = self.log.telemetry_names()
            instead = f"only {listed(names, 'and')}" if names else "no telemetry"
            raise self._failure(f"telemetry {self.dictionary.telemetry_of(name).name} until now", instead)
        return self.log.packet(found[-1])

    def packets(self, name: str) -> Sequence[Packet]:
        """Return all packets of a kind so far, by the name of the telemetry or its MsgId, including those without a
        subscriber. Each is decoded when it is read.

        Raises:
            UsageError: if the packet is not in the dictionary.
        """
        return self.log.read(self.dictionary.telemetry_of(name).msg_id)

    def stdout(self, node: str) -> list[str]:
        """Return the lines that a node has printed and logged, without the node's name in front.

        Raises:
            ExpectationError: if there is and was no such node.
        """
        name = node.lstrip("/")
        found = [line.removeprefix(f"[{name}] ") for line in self.log.lines if line.startswith(f"[{name}] ")]
        ros = self.mission.ros
        known = [] if ros is None else [*ros.graph.nodes, *(f"/{end.name}" for end in ros.ended.values())]
        if not found and f"/{name}" not in known:
            near = did_you_mean(f"/{name}", known, before="; ")
            raise self._failure(
                f"a node {node}", f"{listed(dict.fromkeys(known), 'and')}{near}" if known else "no node"
            )
        return found

    def app(self, name: str) -> App:
        """Return an application, by its cFE name.

        Raises:
            ExpectationError: if there is and was no such application.
        """
        es = self.mission.cfe.es
        history = es.history.get(name)
        if history is None:
            near = did_you_mean(name, es.history, before="; ")
            raise self._failure(f"an application {name}", f"{listed(es.history, 'and')}{near}")
        state = next((STATE_NAMES[app.state] for app in es.apps if app.name == name), "GONE")
        return App(name, state, history.restarts, history.deaths, history.last_error)

    @property
    def deaths(self) -> list[str]:
        """A line for each application that has died of an exception."""
        return self.mission.record.deaths()

    @property
    def problems(self) -> list[str]:
        """A line for each problem so far, as in a run's report; a run without problems went well."""
        if self._flown is not None:
            return self._flown.results.problems
        return [problem.text for problem in self._problems]

    @property
    def failures(self) -> list[Failure]:
        """The failures behind the problems so far, by time, as `cfepy explore` counts them."""
        return failures_of(self._problems if self._flown is None else self._flown.problems)

    @property
    def _problems(self) -> list[RunProblem]:
        return problems_of(self.mission, endless_waits(self.mission))

    def message_class(self, kind: str) -> Any:
        """Return the class of a ROS message type, such as "std_msgs/Float64". The mission's own packages are searched
        too.

        Raises:
            UsageError: if the type is unknown.
        """
        return library_near(self.mission.spec.folder).message_class(kind)

    # -- the end -------------------------------------------------------------------------------------------------------

    @property
    def results(self) -> Results:
        """The numbers of the whole run (`cfepy.pilot.Results`). Reading them ends the run: the nodes shut down."""
        return self.flown().results

    @property
    def notes(self) -> tuple[str, ...]:
        """Notes for the user, such as a fault that never happened. Reading them ends the run."""
        return self.flown().notes

    def flown(self) -> Flown:
        """Return the end state."""
        assert self._flown is not None
        return self._flown

    # -- failures ------------------------------------------------------------------------------------------------------

    def _failure(self, expected: str | None, instead: str) -> ExpectationError:
        first = instead if expected is None else f"expected {expected}\ninstead: {instead}"
        return ExpectationError("\n".join([first, *self.state_lines(), f"to reproduce: {self.command()}"]))

    def state_lines(self) -> list[str]:
        """Return the problems and the end of the console, as failures show them."""
        lines = [f"  {line}" for line in self.log.lines[-LAST_LINES:]]
        problems = [f"problem: {each}" for each in self.problems]
        return [*problems, f"console until {self.now:.3f}:", *lines]

    def command(self) -> str:
        """Return the command that repeats the run."""
        return replace(self.plan, seconds=self.now).command_line()
