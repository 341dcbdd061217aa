"""`Flight`: a mission under test. It goes on when the test says so, and remembers all that was sent.

    flight.run_until_operational()
    flight.send("SAMPLE_APP_NOOP")
    flight.expect_event("SAMPLE_APP", 2, within=1.0)

Times are virtual, in seconds. Expectations look every 10 ms of virtual time, and at everything since the test last did
something to the mission, so after one command several may stand in any order. `RosSide` finds mistakes of the test in
messages, parameters and service calls; `cfepy.mission.host_actions` then carries them out.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Mapping, Sequence
from contextlib import ExitStack
from dataclasses import replace
from types import TracebackType
from typing import TYPE_CHECKING, Any

from cfepy.attachment import Attachment
from cfepy.flight import expectations
from cfepy.flight.expectations import Check, Text, Wanted
from cfepy.flight.log import START, FlightLog, Packet
from cfepy.flight.message_library import filled, serialized
from cfepy.flight.run import ExpectationError, Run
from cfepy.ground import DecodedEvent, Topic, library_of, table_type, topics_of
from cfepy.mission import CALL, FILE, PACKET, PARAM, PUBLISH, HostCall, Mission, receivers
from cfepy.msg import get_msg_id
from cfepy.pilot import Flown, RunPlan, takeoff
from cfepy.reading.suggestions import did_you_mean
from cfepy.rtos import Policy, Stopwatch
from cfepy.script.conditions import seconds
from cfepy.status import UsageError
from cfepy.tbl import TableImage, build
from cfepy.units import NS_PER_MS, NS_PER_S

if TYPE_CHECKING:
    from rospy_shim.runtime import RosRuntime

__tracebackhide__ = True  # pytest shows the line of the test
MISSING = object()
LIKE_IT = 3  # names that are told in place of one that there is not
LOOK_NS = 10 * NS_PER_MS
WITHIN_S = 5.0
LONGEST_BOOT_S = 60.0
TABLE_FILE = "/ram/cfepy_test.tbl"
VALID = re.compile("validation succ|assumed valid")
"""What CFE_TBL says of an image that its owner took, and of one whose owner looks at none."""


class RosSide:
    """The ROS side of a mission, for its test.

    Args:
        mission: the mission, also after it was reset.
    """

    def __init__(self, mission: Mission) -> None:
        self._mission = mission

    def _started(self) -> RosRuntime:
        """The ROS side of the mission.

        Raises:
            ExpectationError: there is none before the first node.
        """
        ros: RosRuntime | None = self._mission.ros
        if ros is None:
            raise ExpectationError(
                "no ROS node has started yet; run the mission first, for instance with run_until_operational()"
            )
        return ros

    # -- topics --------------------------------------------------------------------------------------------------------

    def publish(self, name: str, message: Any, fields: Mapping[str, Any]) -> None:
        """Put a message on a topic; see `Flight.publish`."""
        topic = self._topic(name)
        route = self._mission.cfe.sb.routes.get(topic.msg_id)
        if route is None or not route.active:
            raise ExpectationError(f"{topic.name} has no subscriber at {seconds(self._mission.kernel.now)} s")
        self._mission.outside.act(PUBLISH, topic.name, self._payload(topic, message, fields))

    def _topic(self, name: str) -> Topic:
        self._started()
        known = {topic.name: topic for topic in topics_of(self._mission)}
        full = name if name.startswith("/") else f"/{name}"
        if full not in known:
            raise ExpectationError(f"unknown topic {full} (so far); {near(full, known)}")
        return known[full]

    def _payload(self, topic: Topic, message: Any, fields: Mapping[str, Any]) -> bytes:
        """The message as ROS serialises it.

        Raises:
            UsageError: it is of another type, or has no such field or value.
        """
        if message is None:
            if not topic.type:
                raise UsageError(f"the type of {topic.name} is unknown; give a message object")
            message = filled(library_of(topic), topic.type, fields)
        elif topic.type and getattr(message, "_type", None) != topic.type:
            kind = getattr(message, "_type", type(message).__name__)
            raise UsageError(f"{topic.name} has type {topic.type}, not {kind}")
        return serialized(message)

    # -- parameters ----------------------------------------------------------------------------------------------------

    def param(self, name: str, default: Any) -> Any:
        """A parameter's value now; see `Flight.param`."""
        tree = self._started().graph.params
        found = tree.find(name)
        if found is not tree.MISSING:
            return found
        if default is not MISSING:
            return default
        raise ExpectationError(f"unknown parameter {name}; {near(name, tree.names())}")

    def set_param(self, name: str, value: Any) -> None:
        """Set a parameter; see `Flight.set_param`."""
        self._started()
        self._mission.outside.act(PARAM, name, value)

    # -- services ------------------------------------------------------------------------------------------------------

    def call(self, name: str, request: Any, fields: Mapping[str, Any]) -> HostCall:
        """Begin to call a service; the mission has to run for the answer to come."""
        graph = self._started().graph
        services = graph.services
        full = name if name.startswith("/") else f"/{name}"
        if full not in services:
            raise ExpectationError(f"unknown service {full}; {near(full, sorted(services))}")
        if request is None:
            node, service_class = graph.caller(full)
            request = filled(node.library, service_class._request_class._type, fields)
        call: HostCall = self._mission.outside.act(CALL, full, serialized(request))
        return call


def near(name: str, known: Iterable[str]) -> str:
    """What there is instead of a name: those that are like it, or all."""
    names = list(known)
    return did_you_mean(name, names, f"there are {', '.join(names) or 'none'}", most=LIKE_IT)


class Flight(Run):
    """A mission under test; the fixture `mission` makes it, and closes it.

    Args:
        plan: what is flown.
        policy: decides which task goes first, in place of the plan's schedule.
        attachments: what else watches the run or changes it.
        again: the command that does it again when the program has had a hand in it.

    Attributes:
        touched: whether the program has had a hand in it, other than to let it run.
        closed: whether all its tasks have ended.
    """

    def __init__(
        self,
        plan: RunPlan,
        *,
        policy: Policy | None = None,
        attachments: Sequence[Attachment] = (),
        again: Callable[[], str] | None = None,
    ) -> None:
        spec = plan.spec()
        log = FlightLog(spec)
        with ExitStack() as flight:
            self._live = flight.enter_context(takeoff(plan, spec=spec, attachments=[log, *attachments], policy=policy))
            super().__init__(plan, self._live.mission, log)
            self._flight = flight.pop_all()
        self.touched = self.closed = False
        self._again = again
        self._wall_ns = 0
        self._here = START
        self._ros = RosSide(self.mission)

    # -- time ----------------------------------------------------------------------------------------------------------

    def run_for(self, seconds: float) -> None:
        """Let the mission run for some virtual seconds more."""
        self._run_until_ns(self.mission.kernel.now + round(seconds * NS_PER_S))

    def run_until(self, time: float) -> None:
        """Let it run until a virtual time in s since the boot; nothing when that is over."""
        self._run_until_ns(round(time * NS_PER_S))

    def run_until_operational(self, within: float = LONGEST_BOOT_S) -> None:
        """Let it run until the startup script is done and cFE is OPERATIONAL, or was once.

        Raises:
            ExpectationError: it is not after so many virtual seconds.
        """
        mission = self.mission
        operational = Wanted(
            "the mission to be OPERATIONAL",
            lambda: mission.processor.booted is not None or None,
            lambda: f"applications {', '.join(app.name for app in mission.cfe.es.apps) or 'none'}",
        )
        self._await(operational, within)

    def mark(self) -> None:
        """Let the expectations that follow look only at what is still to come."""
        self._here = self.log.here()

    def _run_until_ns(self, until_ns: int) -> None:
        if self.closed:
            raise ExpectationError(
                "the flight is over, because its results were read or it was closed; start another flight"
            )
        if until_ns > self.mission.kernel.now:
            watch = Stopwatch()
            self.mission.run_until(until_ns)
            self._wall_ns += watch.elapsed_ns()

    # -- doing ---------------------------------------------------------------------------------------------------------

    def send(self, command: str | bytes, values: Mapping[str, Any] | None = None, /, **fields: Any) -> None:
        """Put a command on the Software Bus at once.

        Args:
            command: its name in the mission's dictionary, such as "CFE_ES_NOOP"; or the bytes of any packet, which
                needs no subscriber.
            values, fields: of its fields; those that are not given are zero.

        Raises:
            UsageError: there is no such command or field.
            CfeError: the bus refuses the packet, as when the length in its header is not its own.
            ExpectationError: a command that was given by name has no subscriber.
        """
        packet = command if isinstance(command, bytes | bytearray) else self._packet(command, values, fields)
        bus = self.mission.cfe.sb
        if isinstance(command, str) and not receivers(bus, get_msg_id(packet)):
            raise self._failure(f"a subscriber of {command}", "none, so the command cannot be sent")
        self._act()
        self.mission.outside.act(PACKET, bytes(packet))

    def _packet(self, name: str, values: Mapping[str, Any] | None, fields: Mapping[str, Any]) -> bytes:
        return self.dictionary.command(name).packet({**(values or {}), **fields})

    def publish(self, topic: str, message: Any = None, /, **fields: Any) -> None:
        """Put a message on a ROS topic at once.

        Args:
            topic: its name.
            message: of the topic's type: one of ROS's own classes, or of `flight.message_class`.
            fields: of a message of the topic's type, instead; dictionaries stand for nested messages.

        Raises:
            UsageError: it is of another type, or has no such field or value.
            ExpectationError: there is no such topic yet, or it has no subscriber.
        """
        self._act()
        self._checked(lambda: self._ros.publish(topic, message, fields))

    def call_service(self, name: str, request: Any = None, /, *, within: float = WITHIN_S, **fields: Any) -> Any:
        """Call a ROS service, and let the mission run until the answer is there.

        Args:
            name: of the service.
            request: a message of its request's type.
            within: virtual seconds in which the answer has to come.
            fields: of a request, instead.

        Returns:
            The response.

        Raises:
            ExpectationError: no node offers it, it failed, or did not answer in time.
        """
        self._act()
        call = self._checked(lambda: self._ros.call(name, request, fields))
        answered = Wanted(f"the answer of {name}", lambda: call.over or None, lambda: "it has not answered")
        self._await(answered, within)
        if call.error is not None:
            raise self._failure(f"{name} to answer", str(call.error))
        return call.response

    def param(self, name: str, default: Any = MISSING) -> Any:
        """A ROS parameter's value now.

        Args:
            name: its full name.
            default: the value of one that is not there.

        Raises:
            ExpectationError: there is none, and no default.
        """
        return self._checked(lambda: self._ros.param(name, default))

    def set_param(self, name: str, value: Any) -> None:
        """Set a ROS parameter."""
        self._act()
        self._checked(lambda: self._ros.set_param(name, value))

    def load_table(self, name: str, rows: Any, *, wake: str | None = None, within: float = WITHIN_S) -> None:
        """Load a table, validate it and activate it, as the ground does.

        Args:
            name: full name, such as "HK.CopyTable".
            rows: as `cfepy.tbl.TableType.pack` takes them, or the table's bytes.
            wake: a command that lets the table's owner look after its tables, such as "SAMPLE_APP_SEND_HK", for an
                application that does so only when it is asked for housekeeping.
            within: virtual seconds for each of the three steps.

        Raises:
            UsageError: there is no such table, or rows that are none of its.
            ExpectationError: cFE or the table's owner refuses it.
        """
        kind = table_type(name, self.plan.words[0])
        data = bytes(rows) if isinstance(rows, bytes | bytearray) else kind.pack(rows)
        image = build(TableImage(kind.name, data, kind.description))
        self.mission.outside.act(FILE, TABLE_FILE, image)
        self.send("CFE_TBL_LOAD", LoadFilename=TABLE_FILE)
        self.expect_event("CFE_TBL", text="Successful load", within=within)
        self.send("CFE_TBL_VALIDATE", ActiveTableFlag=0, TableName=kind.name)
        self._await_owner(VALID, wake, within)
        self.send("CFE_TBL_ACTIVATE", TableName=kind.name)
        self._await_owner("Update", wake, within)

    def _await_owner(self, text: Text, wake: str | None, within: float) -> None:
        """Wait for an event of CFE_TBL about what a table's owner does in CFE_TBL_Manage."""
        wanted = expectations.event(self.log, self._here, "CFE_TBL", None, text, None)
        first = self._here.events
        if wake is not None:
            self._run_until_ns(self.mission.kernel.now + LOOK_NS)  # CFE_TBL has to have got its command before
            self.send(wake)

        def instead() -> str:
            is_idle = wake is None and not any(event.app == "CFE_TBL" for event in self.log.events[first:])
            hint = "; its owner has not called CFE_TBL_Manage: wake= names the command that lets it" if is_idle else ""
            return wanted.instead() + hint

        self._await(replace(wanted, instead=instead), within)

    def _act(self) -> None:
        """The test does something: from here on, expectations look."""
        self.touched = True
        self.mark()

    def _checked(self, act: Callable[[], Any]) -> Any:
        """Do something; what cannot be gets the text of a failure."""
        try:
            return act()
        except ExpectationError as error:
            raise self._failure(None, str(error)) from None

    # -- expecting -----------------------------------------------------------------------------------------------------

    def expect_event(
        self,
        app: str | None = None,
        event_id: int | None = None,
        text: Text | None = None,
        *,
        type: str | None = None,
        within: float = WITHIN_S,
    ) -> DecodedEvent:
        """Wait for an event.

        Args:
            app: cFE name of its sender; None for any.
            event_id: its id; None for any.
            text: a part of its text, or a compiled regular expression.
            type: "DEBUG", "INFORMATION", "ERROR" or "CRITICAL".
            within: virtual seconds from now.

        Returns:
            The event: `at_ns`, `app`, `event_id`, `type_name`, `text`.

        Raises:
            ExpectationError: it did not come.
        """
        event: DecodedEvent = self._await(expectations.event(self.log, self._here, app, event_id, text, type), within)
        return event

    def expect_no_event(
        self,
        app: str | None = None,
        event_id: int | None = None,
        text: Text | None = None,
        *,
        type: str | None = None,
        within: float = WITHIN_S,
    ) -> None:
        """Let the mission run for `within` virtual seconds; arguments and errors as `expect_event`, the other way."""
        self._refuse(expectations.event(self.log, self._here, app, event_id, text, type), within)

    def expect_message(
        self, topic: str, check: Check | None = None, /, *, within: float = WITHIN_S, **fields: Any
    ) -> Any:
        """Wait for a message on a ROS topic.

        Args:
            topic: its name.
            check: tells whether a message is the one.
            within: virtual seconds from now.
            fields: values that it has to have, or functions that accept them.

        Returns:
            The message.

        Raises:
            ExpectationError: it did not come.
        """
        return self._await(expectations.message(self.log, self._here, topic, check, fields), within)

    def expect_no_message(
        self, topic: str, check: Check | None = None, /, *, within: float = WITHIN_S, **fields: Any
    ) -> None:
        """Let the mission run for `within` virtual seconds; arguments and errors as `expect_message`, the other way."""
        self._refuse(expectations.message(self.log, self._here, topic, check, fields), within)

    def expect_telemetry(
        self,
        name: str,
        check: Check | None = None,
        values: Mapping[str, Any] | None = None,
        /,
        *,
        within: float = WITHIN_S,
        **fields: Any,
    ) -> Packet:
        """Wait for a telemetry packet.

        Args:
            name: in the mission's dictionary, such as "SAMPLE_APP_HK_TLM", or a MsgId such as "0x0883".
            check: tells whether a packet is the one.
            values, fields: values that its fields have to have, by path, or functions that accept them.
            within: virtual seconds from now.

        Returns:
            The packet.

        Raises:
            UsageError: there is no such packet.
            ExpectationError: it did not come.
        """
        wanted = {**(values or {}), **fields}
        entry = self.dictionary.telemetry_of(name)
        packet: Packet = self._await(
            expectations.telemetry(self.log, self._here, entry.name, entry.msg_id, check, wanted), within
        )
        return packet

    def expect_console(self, text: Text, *, within: float = WITHIN_S) -> str:
        """Wait for a line of the console that contains a text or matches a regular expression; the line."""
        line: str = self._await(expectations.line(self.log.lines, self._here, text), within)
        return line

    def expect(self, check: Callable[[], Any], what: str | None = None, *, within: float = WITHIN_S) -> Any:
        """Wait until a function returns something that is true; what it returned.

        Args:
            check: the function.
            what: what it stands for, in the text of the failure.
            within: virtual seconds from now.

        Raises:
            ExpectationError: it never did.
        """
        return self._await(expectations.condition(check, what), within)

    def _await(self, wanted: Wanted, within: float) -> Any:
        deadline_ns = self.mission.kernel.now + round(within * NS_PER_S)
        while True:
            found = wanted.find()
            now_ns = self.mission.kernel.now
            if found is not None:
                return found
            if now_ns >= deadline_ns or self.mission.over:
                raise self._failure(f"{wanted.text} within {within:g} s, until {self.now:.3f}", wanted.instead())
            self._run_until_ns(min(now_ns + LOOK_NS, deadline_ns))

    def _refuse(self, unwanted: Wanted, within: float) -> None:
        deadline_ns = self.mission.kernel.now + round(within * NS_PER_S)
        while (found := unwanted.find()) is None and self.mission.kernel.now < deadline_ns and not self.mission.over:
            self._run_until_ns(min(self.mission.kernel.now + LOOK_NS, deadline_ns))
        if found is not None:
            raise self._failure(f"no {unwanted.text} within {within:g} s", " ".join(str(found).split()))

    # -- the end -------------------------------------------------------------------------------------------------------

    def flown(self) -> Flown:
        """How the run ended, which it does now."""
        if self._flown is None:
            self._live.end(self._wall_ns)
            self.close()
            self._flown = self._live.flown()
        return self._flown

    def close(self) -> None:
        """End every task; what was taken down stays readable."""
        if not self.closed:
            self.mission.kernel.check_caller()
            self.closed = True
            self._flight.__exit__(None, None, None)

    def command(self) -> str:
        """The command that does the same run again: `cfepy run`, or the test when it has had a hand in it."""
        return self._again() if self.touched and self._again is not None else super().command()

    def __enter__(self) -> Flight:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, where: TracebackType | None
    ) -> None:
        self.close()
