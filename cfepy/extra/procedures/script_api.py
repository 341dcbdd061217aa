"""The functions of `openc3.script` for procedures, by the documentation of OpenC3 COSMOS.

Each method of `ScriptApi` without an underscore is a function of the same name in procedures. docs/how_to/procedures.md
lists them; `refused.py` has the names of functions beyond them.
"""

from __future__ import annotations

import datetime
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from typing import Any

from cfepy.extra.procedures.answers import Answers
from cfepy.extra.procedures.limit_functions import LimitFunctions, functions_of
from cfepy.extra.procedures.packet_items import (
    CONVERTED,
    FORMATTED,
    RAW,
    VALUE_TYPES,
    WITH_UNITS,
    PacketDefinition,
    squeezed,
)
from cfepy.extra.procedures.procedure_errors import CheckError, UnsupportedError
from cfepy.extra.procedures.record_functions import RecordFunctions
from cfepy.extra.procedures.script_words import (
    command_words,
    comparison_words,
    holds,
    item_words,
    packet_words,
    value_of,
)
from cfepy.extra.procedures.station import Station, Waited
from cfepy.extra.procedures.target_packets import TargetPackets
from cfepy.status import UsageError

POLL_S = 0.25
EPOCH = 1_577_836_800.0
"""Wall time in s since 1970 of virtual time 0, as procedures see it: 2020-01-01, so runs are equal."""
_RECEIVED = ("RECEIVED_COUNT", "RECEIVED_TIMESECONDS", "RECEIVED_TIMEFORMATTED")
_PACKET_TIMES = ("PACKET_TIMESECONDS", "PACKET_TIMEFORMATTED", "PACKET_TIME")


class ScriptApi:
    """The functions of a procedure that is connected to a station.

    Args:
        station: the connection.
        targets: packets by name.
        answers: answers to questions.
        write: prints a line of the procedure's output.
        line_delay: pause before each line in s.
    """

    def __init__(
        self,
        station: Station,
        targets: TargetPackets,
        answers: Answers,
        write: Callable[[str], object],
        line_delay: float = 0.0,
    ) -> None:
        self._station = station
        self._targets = targets
        self._answers = answers
        self._write = write
        self._stash: dict[str, Any] = {}
        self._line_delay = line_delay
        self._is_instrumented = True
        self._limits = LimitFunctions(station, targets)
        self._records = RecordFunctions(station, targets, EPOCH)
        self._state_of = self._limits._limits_state
        self._overrides: dict[tuple[str, str, str], Any] = {}
        self._subscriptions: list[tuple[dict[int, PacketDefinition], list[dict[str, Any]]]] = []

    # -- commands ------------------------------------------------------------------------------------------------------

    def cmd(self, *given: Any, **options: Any) -> list[Any]:
        """Send a command: `cmd("CFS CFE_ES_CMD_NOOP")`, or target, command and a dictionary of parameters."""
        return self._command(given)

    def cmd_no_range_check(self, *given: Any, **options: Any) -> list[Any]:
        """Send a command without a check of ranges."""
        return self._command(given, check_range=False)

    def cmd_no_hazardous_check(self, *given: Any, **options: Any) -> list[Any]:
        """Send a command that may be hazardous."""
        return self._command(given, check_hazard=False)

    def cmd_no_checks(self, *given: Any, **options: Any) -> list[Any]:
        """Send a command without a check of ranges and hazards."""
        return self._command(given, check_range=False, check_hazard=False)

    def cmd_raw(self, *given: Any, **options: Any) -> list[Any]:
        """Send a command whose values are not converted: numbers instead of names of states."""
        return self._command(given, is_raw=True)

    def cmd_raw_no_range_check(self, *given: Any, **options: Any) -> list[Any]:
        """Send a command with raw values and without a check of ranges."""
        return self._command(given, check_range=False, is_raw=True)

    def cmd_raw_no_hazardous_check(self, *given: Any, **options: Any) -> list[Any]:
        """Send a command with raw values that may be hazardous."""
        return self._command(given, check_hazard=False, is_raw=True)

    def cmd_raw_no_checks(self, *given: Any, **options: Any) -> list[Any]:
        """Send a command with raw values and without a check of ranges and hazards."""
        return self._command(given, check_range=False, check_hazard=False, is_raw=True)

    def build_cmd(self, *given: Any, **options: Any) -> dict[str, Any]:
        """Return a command without sending it."""
        target, name, values = command_words(given)
        packet = self._targets.command(target, name)
        return {"target_name": packet.target, "packet_name": packet.name, "buffer": packet.built(values)}

    build_command = build_cmd

    def _command(
        self, given: tuple[Any, ...], check_range: bool = True, check_hazard: bool = True, is_raw: bool = False
    ) -> list[Any]:
        target, name, values = command_words(given)
        packet = self._targets.command(target, name)
        hazard = packet.hazard(values) if check_hazard else None
        if hazard is not None and str(self._answers.answer(f"{packet.full_name} is hazardous: {hazard}")) != "Yes":
            raise UnsupportedError(f"{packet.full_name} is hazardous, and its answer is not Yes")
        self._station.send(packet.built(values, check_range, is_raw))
        shown = ", ".join(f"{key} {value!r}" for key, value in values.items())
        self._write(f'cmd("{packet.full_name}{" with " if shown else ""}{shown}")')
        return [packet.target, packet.name, values]

    def send_raw(self, interface: str, data: bytes) -> None:
        """Send bytes unchanged."""
        self._station.send(bytes(data), is_raw=True)

    def get_cmd_hazardous(self, *given: Any) -> bool:
        """Return whether a command is hazardous."""
        target, name, values = command_words(given)
        return self._targets.command(target, name).hazard(values) is not None

    # -- telemetry -----------------------------------------------------------------------------------------------------

    def tlm(self, *given: Any, type: str = CONVERTED, **options: Any) -> Any:
        """Return the newest value of an item, or None before its packet has arrived."""
        return self._value(item_words(given), type.upper())

    def tlm_raw(self, *given: Any, **options: Any) -> Any:
        """Return the newest value without conversion."""
        return self._value(item_words(given), RAW)

    def tlm_formatted(self, *given: Any, **options: Any) -> Any:
        """Return the newest value as text."""
        return self._value(item_words(given), FORMATTED)

    def tlm_with_units(self, *given: Any, **options: Any) -> Any:
        """Return the newest value as text, with its unit."""
        return self._value(item_words(given), WITH_UNITS)

    def _value(self, words: tuple[str, str, str], value_type: str) -> Any:
        if value_type not in VALUE_TYPES:
            raise UsageError(f"unknown type of value {value_type}; expected {', '.join(VALUE_TYPES)}")
        packet = self._targets.telemetry(words[0], words[1])
        name = words[2].upper()
        key = packet.target, packet.name, squeezed(name)
        if key in self._overrides:
            return self._overrides[key]
        newest = self._station.newest(packet.msg_id)
        if name in _RECEIVED:
            return None if newest is None else self._received(name, newest.number, newest.at)
        if name in _PACKET_TIMES:
            return None if newest is None else self._packet_time(name, newest.data)
        item = None if packet.read_all is not None else packet.item(name)
        if newest is None:
            return None
        if item is not None:
            return item.read(newest.data, value_type)
        assert packet.read_all is not None
        values = packet.read_all(newest.data)
        if squeezed(name) not in values:
            raise UsageError(f"{packet.full_name} has no item {name}; it has {', '.join(list(values)[:20])}")
        return values[squeezed(name)]

    def _received(self, name: str, count: int, at: float) -> Any:
        if name == "RECEIVED_COUNT":
            return count
        return _formatted(EPOCH + at) if name.endswith("FORMATTED") else EPOCH + at

    def _packet_time(self, name: str, data: bytes) -> Any:
        seconds = int.from_bytes(data[6:10], "big") + int.from_bytes(data[10:12], "big") / 65536
        return _formatted(EPOCH + seconds) if name.endswith("FORMATTED") else seconds

    def get_tlm_packet(self, *given: Any, type: str = CONVERTED, **options: Any) -> list[list[Any]]:
        """Return name, value and state of limits of all items of a packet's newest arrival."""
        packet = self._targets.telemetry(*packet_words(given))
        found = []
        for name in packet.items:
            value = self._value((packet.target, packet.name, name), type.upper())
            found.append([name, value, self._state_of(packet, name)])
        return found

    def get_packet(self, *given: Any) -> dict[str, Any]:
        """Return the newest packet as a dictionary with its values by name, or raise an error before it has arrived."""
        packet = self._targets.telemetry(*packet_words(given))
        newest = self._station.newest(packet.msg_id)
        if newest is None:
            raise RuntimeError(f"{packet.full_name} has not arrived")
        return self._as_dictionary(packet, newest.data, newest.number)

    def _as_dictionary(self, packet: PacketDefinition, data: bytes, count: int) -> dict[str, Any]:
        found: dict[str, Any] = {"target_name": packet.target, "packet_name": packet.name, "received_count": count}
        found["time"], found["buffer"] = int((EPOCH + self._station.now) * 1e9), data
        if packet.read_all is not None:
            return {**found, **packet.read_all(data)}
        return {**found, **{name: item.read(data) for name, item in packet.items.items()}}

    def get_tlm_values(self, items: list[str], **options: Any) -> list[list[Any]]:
        """Return value and state of limits of items written as "TARGET__PACKET__ITEM__CONVERTED"."""
        found = []
        for each in items:
            target, name, item, *kind = each.split("__")
            value = self._value((target, name, item), kind[0].upper() if kind else CONVERTED)
            found.append([value, self._state_of(self._targets.telemetry(target, name), item)])
        return found

    def subscribe_packets(self, packets: list[list[str]]) -> int:
        """Collect packets from now on; returns an id for `get_packets`."""
        wanted = {found.msg_id: found for found in (self._targets.telemetry(*each) for each in packets)}
        kept: list[dict[str, Any]] = []

        def keep(data: bytes) -> None:
            packet = wanted.get(data[0] << 8 | data[1])
            if packet is not None:
                kept.append(self._as_dictionary(packet, data, len(kept) + 1))

        self._station.listeners.append(keep)
        self._subscriptions.append((wanted, kept))
        return len(self._subscriptions) - 1

    def get_packets(self, id: int, block: Any = None, count: int = 1000, **options: Any) -> tuple[int, list[Any]]:
        """Return the packets collected since the last call."""
        kept = self._subscriptions[int(id)][1]
        found = kept[:count]
        del kept[:count]
        return id, found

    def set_tlm(self, *given: Any, type: str = CONVERTED, **options: Any) -> None:
        """Set an item of the newest packet, "TARGET PACKET ITEM = 5", until the next one arrives."""
        target, name, item, value = self._assigned(given)
        packet = self._targets.telemetry(target, name)
        newest = self._station.newest(packet.msg_id)
        data = bytearray(packet.size if newest is None else newest.data)
        packet.item(item).write(data, value)
        self._station.put_newest(packet.msg_id, bytes(data))

    def override_tlm(self, *given: Any, **options: Any) -> None:
        """Let an item have a value, until `normalize_tlm`."""
        target, name, item, value = self._assigned(given)
        self._overrides[self._override_key(target, name, item)] = value

    def normalize_tlm(self, *given: Any, **options: Any) -> None:
        """End `override_tlm` of an item."""
        target, name, item = item_words(given)
        self._overrides.pop(self._override_key(target, name, item), None)

    def get_overrides(self, **options: Any) -> list[dict[str, Any]]:
        """Return the overridden items with their values."""
        names = "target_name", "packet_name", "item_name", "value"
        found = (dict(zip(names, (*key, value), strict=True)) for key, value in self._overrides.items())
        return [{**each, "value_type": "ALL"} for each in found]

    def _override_key(self, target: str, name: str, item: str) -> tuple[str, str, str]:
        packet = self._targets.telemetry(target, name)
        return packet.target, packet.name, squeezed(item)

    def _assigned(self, given: tuple[Any, ...]) -> tuple[str, str, str, Any]:
        if len(given) == 4:
            return given[0], given[1], given[2], given[3]
        left, _, right = str(given[0]).partition("=")
        return *item_words((left,)), value_of(right.strip())

    def get_target_names(self) -> list[str]:
        """Return the names of targets."""
        return self._targets.names()

    get_target_list = get_target_names

    def get_all_tlm_names(self, target: str) -> list[str]:
        """Return the names of a target's telemetry packets."""
        return [each.name for each in self._targets.packets(target, False)]

    def get_all_cmd_names(self, target: str) -> list[str]:
        """Return the names of a target's commands."""
        return [each.name for each in self._targets.packets(target, True)]

    get_all_telemetry_names, get_all_command_names = get_all_tlm_names, get_all_cmd_names

    # -- time ----------------------------------------------------------------------------------------------------------

    def wait(self, *given: Any, **options: Any) -> Any:
        """Wait some seconds, or until a comparison is true; returns the time, or whether it is true."""
        if not given:
            self._answers.answer("wait() until the user continues")
            return 0.0
        if len(given) == 1 and not isinstance(given[0], str):
            start = self._station.now
            self._station.wait(max(float(given[0]), 0.0))
            return self._station.now - start
        passed, text = self._waited(given, CONVERTED)
        self._write(text)
        return passed

    def wait_check(self, *given: Any, type: str = CONVERTED, **options: Any) -> float:
        """Wait until a comparison is true, and fail if it is not in time."""
        start = self._station.now
        passed, text = self._waited(given, type.upper())
        self._judge(passed, text)
        return self._station.now - start

    def wait_check_raw(self, *given: Any, **options: Any) -> float:
        """As `wait_check`, for values without conversion."""
        return self.wait_check(*given, type=RAW)

    def wait_check_formatted(self, *given: Any, **options: Any) -> float:
        """As `wait_check`, for values as text."""
        return self.wait_check(*given, type=FORMATTED)

    def _waited(self, given: tuple[Any, ...], value_type: str) -> tuple[bool, str]:
        if isinstance(given[0], str) and len(given[0].split()) == 1 and len(given) >= 5:
            given = (" ".join(map(str, given[:4])), *given[4:])
        if len(given) < 2:
            raise UsageError("expected a comparison and a timeout in seconds")
        text, timeout, poll = given[0], float(given[1]), float(given[2]) if len(given) > 2 else POLL_S
        words = comparison_words(text)

        def fits() -> bool:
            return holds(self._value(words[:3], value_type), words.comparison)

        waited = self._station.until(fits, timeout, poll)
        value = self._value(words[:3], value_type)
        result = "success" if waited.passed else "failed"
        return waited.passed, f"CHECK: {text} {result} with value == {value!r}{_after(waited, poll)}"

    def wait_tolerance(self, *given: Any, **options: Any) -> bool:
        """Wait until a value is within a tolerance; returns whether it is."""
        passed, text = self._waited_tolerance(given)
        self._write(text)
        return passed

    def wait_check_tolerance(self, *given: Any, **options: Any) -> float:
        """Wait until a value is within a tolerance, and fail if it is not in time."""
        start = self._station.now
        self._judge(*self._waited_tolerance(given))
        return self._station.now - start

    def _waited_tolerance(self, given: tuple[Any, ...]) -> tuple[bool, str]:
        words, rest = _split_item(given)
        if len(rest) < 3:
            raise UsageError("expected an item, a value, a tolerance and a timeout in seconds")
        expected, tolerance, timeout = (float(each) for each in rest[:3])
        poll = float(rest[3]) if len(rest) > 3 else POLL_S

        def fits() -> bool:
            return _is_near(self._value(words, CONVERTED), expected, tolerance)

        waited = self._station.until(fits, timeout, poll)
        text = _near_text(words, self._value(words, CONVERTED), expected, tolerance, waited.passed)
        return waited.passed, f"{text}{_after(waited, poll)}"

    def wait_expression(
        self,
        expression: str,
        timeout: float,
        polling_rate: float = POLL_S,
        globals: Any = None,
        locals: Any = None,
    ) -> bool:
        """Wait until a Python expression is true; returns whether it is."""
        passed, text = self._waited_expression(expression, timeout, polling_rate, globals, locals)
        self._write(text)
        return passed

    def wait_check_expression(
        self,
        expression: str,
        timeout: float,
        polling_rate: float = POLL_S,
        globals: Any = None,
        locals: Any = None,
    ) -> float:
        """Wait until a Python expression is true, and fail if it is not in time."""
        start = self._station.now
        self._judge(*self._waited_expression(expression, timeout, polling_rate, globals, locals))
        return self._station.now - start

    def _waited_expression(
        self, expression: str, timeout: float, poll: float, names: Any, inner: Any
    ) -> tuple[bool, str]:
        code = compile(expression, "<expression>", "eval")
        scope = self._scope(names)
        waited = self._station.until(lambda: bool(eval(code, scope, inner)), float(timeout), float(poll))
        result = "TRUE" if waited.passed else "FALSE"
        return waited.passed, f"CHECK: {expression} is {result}{_after(waited, float(poll))}"

    def _scope(self, names: Any) -> dict[str, Any]:
        return self._functions() if names is None else names

    def wait_packet(self, target: str, name: str, count: int, timeout: float, polling_rate: float = POLL_S) -> bool:
        """Wait for a number of packets; returns whether they arrived."""
        passed, text = self._waited_packet(target, name, count, timeout, polling_rate)
        self._write(text)
        return passed

    def wait_check_packet(
        self, target: str, name: str, count: int, timeout: float, polling_rate: float = POLL_S
    ) -> float:
        """Wait for a number of packets, and fail if they do not arrive in time."""
        start = self._station.now
        self._judge(*self._waited_packet(target, name, count, timeout, polling_rate))
        return self._station.now - start

    def _waited_packet(self, target: str, name: str, count: int, timeout: float, poll: float) -> tuple[bool, str]:
        packet = self._targets.telemetry(target, name)
        first = self._records.get_tlm_cnt(target, name)
        waited = self._station.until(
            lambda: self._records.get_tlm_cnt(target, name) - first >= int(count), float(timeout), float(poll)
        )
        arrived = self._records.get_tlm_cnt(target, name) - first
        result = "success" if waited.passed else "failed"
        text = f"CHECK: {packet.full_name} {result}: {arrived} of {count} packets arrived in {waited.taken:.3f} seconds"
        return waited.passed, text

    # -- checks --------------------------------------------------------------------------------------------------------

    def check(self, *given: Any, type: str = CONVERTED, **options: Any) -> None:
        """Check a comparison of an item's newest value; without a comparison, only print the value."""
        if len(given) == 4:
            given = (" ".join(map(str, given)),)
        words = comparison_words(str(given[0]))
        value = self._value(words[:3], type.upper())
        if not words.comparison:
            self._write(f"CHECK: {given[0]} == {value!r}")
            return
        passed = holds(value, words.comparison)
        self._judge(passed, f"CHECK: {given[0]} {'success' if passed else 'failed'} with value == {value!r}")

    def check_raw(self, *given: Any, **options: Any) -> None:
        """As `check`, for a value without conversion."""
        self.check(*given, type=RAW)

    def check_formatted(self, *given: Any, **options: Any) -> None:
        """As `check`, for a value as text."""
        self.check(*given, type=FORMATTED)

    def check_with_units(self, *given: Any, **options: Any) -> None:
        """As `check`, for a value as text with its unit."""
        self.check(*given, type=WITH_UNITS)

    def check_tolerance(self, *given: Any, **options: Any) -> None:
        """Check that a value is within a tolerance."""
        words, rest = _split_item(given)
        if len(rest) < 2:
            raise UsageError("expected an item, a value and a tolerance")
        value, expected, tolerance = self._value(words, CONVERTED), float(rest[0]), float(rest[1])
        passed = _is_near(value, expected, tolerance)
        self._judge(passed, _near_text(words, value, expected, tolerance, passed))

    def check_expression(self, expression: str, globals: Any = None, locals: Any = None) -> None:
        """Check that a Python expression is true."""
        passed = bool(eval(expression, self._scope(globals), locals))
        self._judge(passed, f"CHECK: {expression} is {'TRUE' if passed else 'FALSE'}")

    def check_exception(self, name: str, *given: Any, **options: Any) -> None:
        """Check that a function of this list fails."""
        try:
            self._functions()[name](*given, **options)
        except Exception as error:
            self._write(f"CHECK: {name}({', '.join(map(repr, given))}) raised {type(error).__name__}: {error}")
            return
        raise CheckError(f"{name}({', '.join(map(repr, given))}) should have raised an exception but did not")

    def _judge(self, passed: bool, text: str) -> None:
        self._write(text)
        if not passed:
            raise CheckError(text)

    # -- questions -----------------------------------------------------------------------------------------------------

    def ask(self, question: str, *given: Any, **options: Any) -> Any:
        """Return the answer to a question, from the file of answers."""
        return self._answers.answer(question)

    def ask_string(self, question: str, *given: Any, **options: Any) -> str:
        """Return the answer as text."""
        return str(self._answers.answer(question))

    prompt = message_box = vertical_message_box = combo_box = ask

    # -- the runner ----------------------------------------------------------------------------------------------------

    def set_line_delay(self, seconds: float) -> None:
        """Set the pause before each line of a procedure, in virtual seconds."""
        self._line_delay = float(seconds)

    def get_line_delay(self) -> float:
        """Return the pause after each line."""
        return self._line_delay

    def step_mode(self) -> None:
        """Raise an UnsupportedError, because there is no user who could continue."""
        raise UnsupportedError("step_mode requires a user; use run_mode")

    def run_mode(self) -> None:
        """Run without a stop at each line, as always here."""

    def set_max_output(self, characters: int) -> None:
        """Accept a limit of the output, which has none here."""

    def enable_instrumentation(self) -> None:
        """Pause before each line again, as always outside of `disable_instrumentation`."""

    def disable_instrumentation(self) -> Any:
        """Return a context manager without pauses between lines."""
        return self._without_pauses()

    @contextmanager
    def _without_pauses(self) -> Iterator[None]:
        before, self._is_instrumented = self._is_instrumented, False
        try:
            yield
        finally:
            self._is_instrumented = before

    def _before_line(self) -> None:
        """Pause, as COSMOS does before each line that it runs."""
        if self._is_instrumented and self._line_delay > 0:
            self._station.wait(self._line_delay)

    def _sleep(self, seconds: float) -> None:
        self._station.wait(max(float(seconds), 0.0))

    def _time(self) -> float:
        return EPOCH + self._station.now

    def stash_set(self, key: str, value: Any, **options: Any) -> None:
        """Keep a value for the rest of the flight."""
        self._stash[key] = value

    def stash_get(self, key: str, **options: Any) -> Any:
        """Return a kept value, or None."""
        return self._stash.get(key)

    def stash_keys(self, **options: Any) -> list[str]:
        """Return the names of kept values."""
        return list(self._stash)

    def stash_all(self, **options: Any) -> Mapping[str, Any]:
        """Return all kept values."""
        return dict(self._stash)

    def stash_delete(self, key: str, **options: Any) -> None:
        """Remove a kept value."""
        self._stash.pop(key, None)

    def puts(self, *given: Any) -> None:
        """Print a line."""
        self._write(" ".join(map(str, given)))

    def _functions(self) -> dict[str, Any]:
        """Return all functions by name."""
        return functions_of(self, self._limits, self._records)


def _after(waited: Waited, poll: float) -> str:
    """Return how long a wait took, and when it missed a true condition."""
    text = f" after waiting {waited.taken:.3f} seconds"
    if waited.missed is None:
        return text
    at, lasted = waited.missed
    when = "before this wait began" if at < waited.start else f"between two looks that are {poll:g} s apart"
    return f"{text}; it was true at {at:.3f} s for {lasted:.6f} s, {when}"


def _split_item(given: tuple[Any, ...]) -> tuple[tuple[str, str, str], tuple[Any, ...]]:
    if isinstance(given[0], str) and len(given[0].split()) == 3:
        return item_words(given[:1]), given[1:]
    return item_words(given[:3]), given[3:]


def _is_near(value: Any, expected: float, tolerance: float) -> bool:
    return isinstance(value, int | float) and abs(value - expected) <= abs(tolerance)


def _near_text(words: tuple[str, str, str], value: Any, expected: float, tolerance: float, passed: bool) -> str:
    result = "success" if passed else "failed"
    return f"CHECK: {' '.join(words)} {result}: {value!r}, expected {expected:g} with tolerance {tolerance:g}"


def _formatted(seconds: float) -> str:
    return datetime.datetime.fromtimestamp(seconds, datetime.UTC).strftime("%Y/%m/%d %H:%M:%S.%f")[:-3]
