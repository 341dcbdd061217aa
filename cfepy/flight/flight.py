"""`Flight`: a mission under test. It runs when the test calls for it, and records everything that is sent.

    flight.run_until_operational()
    flight.send("SAMPLE_APP_NOOP")
    flight.expect_event("SAMPLE_APP", 2, within=1.0)

Times are virtual, in seconds. Expectations check every 10 ms of virtual time, and look at everything since the test's
last action. So several expectations after one command can be in any order.
"""

from __future__ import annotations

import atexit
import re
from collections.abc import Callable, Mapping, Sequence
from contextlib import ExitStack
from dataclasses import replace
from types import TracebackType
from typing import Any
from weakref import WeakSet

from cfepy.attachment import Attachment
from cfepy.flight import expectations
from cfepy.flight.expectations import Check, Text, Wanted
from cfepy.flight.log import START, FlightLog, Packet
from cfepy.flight.run import ExpectationError, Run
from cfepy.ground import AbsentError, DecodedEvent, RosSide, table_type
from cfepy.mission import FILE, PACKET, receivers
from cfepy.msg import get_msg_id
from cfepy.pilot import Flown, RunPlan, takeoff
from cfepy.rtos import Policy, Stopwatch
from cfepy.tbl import TableImage, build
from cfepy.units import NS_PER_MS, NS_PER_S

__tracebackhide__ = True  # pytest then shows the line of the test
LOOK_NS = 10 * NS_PER_MS
WITHIN_S = 5.0
LONGEST_BOOT_S = 60.0
TABLE_FILE = "/ram/cfepy_test.tbl"
VALID = re.compile("validation succ|assumed valid")
"""The event texts of CFE_TBL for an image that its owner accepted, or whose owner does not validate."""


class Flight(Run):
    """A mission under test; the fixture `mission` makes it, and closes it.

    Args:
        plan: the plan of the run.
        policy: decides which task runs next, instead of the plan's schedule.
        attachments: further objects that observe or modify the run.
        again: returns the command that repeats the run if the program has acted on it.

    Attributes:
        touched: whether the program has acted on it, other than to let it run.
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
        self._ros = RosSide(self.mission, self.mission.outside.act)
        _OPEN.add(self)

    # -- time ----------------------------------------------------------------------------------------------------------

    def run_for(self, seconds: float) -> None:
        """Run the mission for a number of virtual seconds."""
        self._run_until_ns(self.mission.kernel.now + round(seconds * NS_PER_S))

    def run_until(self, time: float) -> None:
        """Run the mission until a virtual time in s since the boot; do nothing if that has passed."""
        self._run_until_ns(round(time * NS_PER_S))

    def run_until_operational(self, within: float = LONGEST_BOOT_S) -> None:
        """Run the mission until the startup script is done and cFE is OPERATIONAL, or was once.

        Raises:
            ExpectationError: if this takes more than `within` virtual seconds.
        """
        mission = self.mission
        operational = Wanted(
            "the mission to be OPERATIONAL",
            lambda: mission.processor.booted is not None or None,
            lambda: f"applications {', '.join(app.name for app in mission.cfe.es.apps) or 'none'}",
        )
        self._await(operational, within)

    def mark(self) -> None:
        """Make the following expectations look only at input from now on."""
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
            command: its name in the mission's dictionary, such as "CFE_ES_NOOP"; or the bytes of any packet, which need
                not have a subscriber.
            values, fields: values of its fields; missing ones are zero.

        Raises:
            UsageError: if the command or field does not exist.
            CfeError: if the bus refuses the packet, for example for a wrong length in its header.
            ExpectationError: if a command given by name has no subscriber.
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
        """Publish a message on a ROS topic at once.

        Args:
            topic: its name.
            message: a message of the topic's type, of ROS's own classes or of `flight.message_class`.
            fields: fields of a message of the topic's type, as an alternative; dictionaries are nested messages.

        Raises:
            UsageError: if it has another type, or no such field or value.
            ExpectationError: if the topic does not exist yet, or has no subscriber.
        """
        self._act()
        self._checked(lambda: self._ros.publish(topic, message, fields))

    def call_service(self, name: str, request: Any = None, /, *, within: float = WITHIN_S, **fields: Any) -> Any:
        """Call a ROS service, and run the mission until the response arrives.

        Args:
            name: name of the service.
            request: a message of its request type.
            within: time limit of the response in virtual seconds.
            fields: fields of a request, as an alternative.

        Returns:
            The response.

        Raises:
            ExpectationError: if no node offers it, it failed, or there was no response in time.
        """
        self._act()
        call = self._checked(lambda: self._ros.call(name, request, fields))
        answered = Wanted(f"the answer of {name}", lambda: call.over or None, lambda: "it has not answered")
        self._await(answered, within)
        if call.error is not None:
            raise self._failure(f"{name} to answer", str(call.error))
        return call.response

    def param(self, name: str, default: Any = RosSide.MISSING) -> Any:
        """Return the present value of a ROS parameter.

        Args:
            name: its full name.
            default: the result if the parameter does not exist.

        Raises:
            ExpectationError: if it does not exist and there is no default.
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
            rows: see `cfepy.tbl.TableType.pack`, or the table's bytes.
            wake: a command that makes the table's owner manage its tables, such as "SAMPLE_APP_SEND_HK", for an
                application that does so only at a housekeeping request.
            within: virtual seconds for each of the three steps.

        Raises:
            UsageError: if the table does not exist, or the rows do not fit it.
            ExpectationError: if cFE or the table's owner refuses it.
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
        """Wait for an event of CFE_TBL about the owner's work in CFE_TBL_Manage."""
        wanted = expectations.event(self.log, self._here, "CFE_TBL", None, text, None)
        first = self._here.events
        if wake is not None:
            self._run_until_ns(self.mission.kernel.now + LOOK_NS)  # CFE_TBL must have received its command before
            self.send(wake)

        def instead() -> str:
            is_idle = wake is None and not any(event.app == "CFE_TBL" for event in self.log.events[first:])
            hint = "; its owner has not called CFE_TBL_Manage: wake= names the command that lets it" if is_idle else ""
            return wanted.instead() + hint

        self._await(replace(wanted, instead=instead), within)

    def _act(self) -> None:
        """Mark an action of the test: expectations look at input from here on."""
        self.touched = True
        self.mark()

    def _checked(self, act: Callable[[], Any]) -> Any:
        """Perform an action; give an error the text of a failure."""
        try:
            return act()
        except (AbsentError, ExpectationError) as error:
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
            ExpectationError: if the event did not occur.
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
        """Run the mission for `within` virtual seconds, and fail if the event occurs; see `expect_event` for the
        arguments.
        """
        self._refuse(expectations.event(self.log, self._here, app, event_id, text, type), within)

    def expect_message(
        self, topic: str, check: Check | None = None, /, *, within: float = WITHIN_S, **fields: Any
    ) -> Any:
        """Wait for a message on a ROS topic.

        Args:
            topic: its name.
            check: returns whether a message matches.
            within: virtual seconds from now.
            fields: required values of its fields, or functions that accept them.

        Returns:
            The message.

        Raises:
            ExpectationError: if no such message arrived.
        """
        return self._await(expectations.message(self.log, self._here, topic, check, fields), within)

    def expect_no_message(
        self, topic: str, check: Check | None = None, /, *, within: float = WITHIN_S, **fields: Any
    ) -> None:
        """Run the mission for `within` virtual seconds, and fail if the message arrives; see `expect_message` for the
        arguments.
        """
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
            name: name in the mission's dictionary, such as "SAMPLE_APP_HK_TLM", or a MsgId such as "0x0883".
            check: returns whether a packet matches.
            values, fields: required values of its fields by path, or functions that accept them.
            within: virtual seconds from now.

        Returns:
            The packet.

        Raises:
            UsageError: if the packet is unknown.
            ExpectationError: if no such packet was sent.
        """
        wanted = {**(values or {}), **fields}
        entry = self.dictionary.telemetry_of(name)
        packet: Packet = self._await(
            expectations.telemetry(self.log, self._here, entry.name, entry.msg_id, check, wanted), within
        )
        return packet

    def expect_console(self, text: Text, *, within: float = WITHIN_S) -> str:
        """Wait for a line of the console that contains a text or matches a regular expression; return the line."""
        line: str = self._await(expectations.line(self.log.lines, self._here, text), within)
        return line

    def expect(self, check: Callable[[], Any], what: str | None = None, *, within: float = WITHIN_S) -> Any:
        """Wait until a function returns a true value; return that value.

        Args:
            check: the function.
            what: its description in the text of the failure.
            within: virtual seconds from now.

        Raises:
            ExpectationError: if it never did.
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
        """End the run now, and return its end state."""
        if self._flown is None:
            self._live.end(self._wall_ns)
            self.close()
            self._flown = self._live.flown()
        return self._flown

    def close(self) -> None:
        """End every task; the recorded data stay readable."""
        if not self.closed:
            self.mission.kernel.check_caller()
            self.closed = True
            _OPEN.discard(self)
            self._flight.__exit__(None, None, None)

    def command(self) -> str:
        """Return the command that repeats the run: `cfepy run`, or the test if it has acted on the mission."""
        return self._again() if self.touched and self._again is not None else super().command()

    def __enter__(self) -> Flight:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, where: TracebackType | None
    ) -> None:
        self.close()


_OPEN: WeakSet[Flight] = WeakSet()


@atexit.register
def _close_all() -> None:
    """Close flights that the program left open, as long as Python can still switch between tasks."""
    for flight in list(_OPEN):
        flight.close()
