"""Hypothesis strategies for flight software: ROS messages, packets, tables, schedules, faults.

    @given(message=messages("std_msgs/String"), schedule=schedules())
    def test_it(mission, message, schedule): ...

A ROS message is made from plain data, so that it shrinks field by field; big types get short arrays, to keep examples
small. Packets and table rows come from the declarations of the dictionary. Schedules and faults are texts and plain
dictionaries, which are readable in a failing example.
"""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator, Mapping, Sequence
from functools import cache
from typing import TYPE_CHECKING, Any

from hypothesis import strategies as st

from cfepy.flight import SECONDS, array_of, build, library_near, library_of_class
from cfepy.ground import Dictionary, Topic, dictionary_of, table_type
from cfepy.mission import read_mission
from cfepy.msg import CMD_HEADER_SIZE, HIGHEST_VALID_MSG_ID, Cell, Command, Layout, Telemetry, command, telemetry
from cfepy.reading.suggestions import expected
from cfepy.schedules import Schedule
from cfepy.status import UsageError, together

if TYPE_CHECKING:
    from rospy_shim.types.msgs import Library

__all__ = ["fault_plans", "messages", "packets", "schedules", "tables"]

OCTETS = ("uint8", "char")  # arrays of these are bytes
SIGNED_BITS = {"int8": 8, "int16": 16, "int32": 32, "int64": 64, "byte": 8}
LONGEST_TEXT = 12
LIGHT, HEAVY = 16, 64  # weights of a type from which on its arrays are shorter
LONGEST_PAYLOAD = 64
MOST_ROWS = 4  # maximum number of rows that are not all zero; more would only make examples longer
COMMAND_BIT = 0x1000
HAS_TIME_OR_CODE = 0x0800
TELEMETRY_IDS, COMMAND_IDS = (0x0801, 0x0FFF), (0x1801, 0x1FFF)
SIZE_BYTES = slice(4, 6)
CODE_BYTE = 6
UNKNOWN_CODE = 0x7F
MissionName = str | os.PathLike[str] | None
Fields = Mapping[str, st.SearchStrategy[Any]]
DECISIONS = 500  # number of decisions among which schedules deviate
HUNDREDTHS = 100  # times of faults are multiples of 10 ms
MOST_COUNT = 20


class MessageValues:
    """Plain values of the types of a library: dictionaries, lists, numbers, texts, bytes for `uint8[]`.

    Args:
        library: library with the types.
    """

    def __init__(self, library: Library) -> None:
        self._library = library
        self._weights: dict[str, int] = {}
        self._strategies: dict[str, st.SearchStrategy[Any]] = {}

    def of(self, field_type: str) -> st.SearchStrategy[Any]:
        """Return a strategy for values of a type, such as "float64", "uint8[]", "time" or "geometry_msgs/Point[3]".

        Raises:
            UsageError: if there is no such type.
        """
        found = self._strategies.get(field_type)
        if found is None:
            found = self._strategies[field_type] = self._make(field_type)
        return found

    def fields(self, full_name: str) -> dict[str, st.SearchStrategy[Any]]:
        """Return a strategy for each field of a message type; see `of` for the errors."""
        kind = self._library.message_class(full_name)
        return {name: self.of(slot) for name, slot in zip(kind.__slots__, kind._slot_types, strict=True)}

    def _make(self, field_type: str) -> st.SearchStrategy[Any]:
        if field_type.endswith("]"):
            base, size = array_of(field_type)
            limits: dict[str, Any] = (
                {"min_size": size, "max_size": size} if size is not None else {"max_size": self._most(base)}
            )
            return st.binary(**limits) if base in OCTETS else st.lists(self.of(base), **limits)
        if field_type in SECONDS:
            low, high = SECONDS[field_type]
            return st.fixed_dictionaries({"secs": st.integers(low, high), "nsecs": st.integers(0, 999_999_999)})
        return st.fixed_dictionaries(self.fields(field_type)) if "/" in field_type else _number_or_text(field_type)

    def _most(self, base: str) -> int:
        """Return the number of items of an array without fixed length."""
        weight = self._weight(base)
        return 4 if weight <= LIGHT else 2 if weight <= HEAVY else 1

    def _weight(self, field_type: str) -> int:
        """Return the approximate number of numbers and texts in a value of a type."""
        if field_type.endswith("]"):
            base, size = array_of(field_type)
            return 1 if base in OCTETS else (size or self._most(base)) * self._weight(base)
        if "/" not in field_type:
            return 1
        if field_type not in self._weights:
            slots = self._library.message_class(field_type)._slot_types
            self._weights[field_type] = sum(map(self._weight, slots))
        return self._weights[field_type]


def _number_or_text(field_type: str) -> st.SearchStrategy[Any]:
    if field_type == "bool":
        return st.booleans()
    if field_type == "string":
        return st.text(st.characters(exclude_categories=["Cs"]), max_size=LONGEST_TEXT)
    if field_type.startswith("float"):
        return st.floats(width=32 if field_type == "float32" else 64)
    if field_type in SIGNED_BITS:
        bits = SIGNED_BITS[field_type]
        return st.integers(-(2 ** (bits - 1)), 2 ** (bits - 1) - 1)
    return st.integers(0, 2 ** (8 if field_type == "char" else int(field_type[4:])) - 1)


def messages(
    kind: str | type, *, near: str | os.PathLike[str] | None = None, **fields: st.SearchStrategy[Any]
) -> st.SearchStrategy[Any]:
    """Return a strategy for messages of a ROS type, with all its values.

    Args:
        kind: a type such as "std_msgs/String", or a message class, ROS's own or cfepy's.
        near: a file or folder of the package that the type is from, such as `__file__`; ROS's common packages and those
            near the working directory and on ROS_PACKAGE_PATH are always known.
        fields: strategies for single fields, such as `data=st.floats(0, 1)`.

    Raises:
        UsageError: if there is no such type or field.

    >>> messages("std_msgs/Bool", data=st.just(True)).example().data  # doctest: +SKIP
    True
    """
    name = kind if isinstance(kind, str) else str(getattr(kind, "_type", kind))
    library = library_near(near) if isinstance(kind, str) else library_of_class(kind)
    known = MessageValues(library).fields(name)
    _check_fields(fields, known, name)
    built = st.fixed_dictionaries({**known, **fields}).map(lambda values: build(library, name, values))
    return built if isinstance(kind, str) else built.map(lambda message: _as_class(kind, message))


def _as_class(kind: type, message: Any) -> Any:
    """Return the message as one of `kind`, a class of the same type created elsewhere."""
    return message if type(message) is kind else kind().deserialize(message.__pack__())


def cell_values(cell: Cell) -> st.SearchStrategy[Any]:
    """Return a strategy for all values of one field of a struct; text without the NUL that would end it."""
    if cell.type.startswith("char"):
        printable = st.characters(min_codepoint=32, max_codepoint=126)
        return st.text(printable, max_size=max(0, cell.size - 1))
    if cell.type == "bool":
        return st.booleans()
    bits = 8 * cell.size
    if cell.type.startswith("f"):
        return st.floats(width=32 if bits == 32 else 64)
    signed = cell.type.startswith("i")
    return st.integers(-(2 ** (bits - 1)), 2 ** (bits - 1) - 1) if signed else st.integers(0, 2**bits - 1)


def fields_of(layout: Layout, given: Fields, owner: str) -> st.SearchStrategy[dict[str, Any]]:
    """Return a strategy for values of a struct by path: {"PacketID.AppName": "HK", "Counts[0]": 1}.

    Args:
        layout: the struct.
        given: strategies instead of those of the type, by path.
        owner: owner of the fields, for the error.

    Raises:
        UsageError: if there is no such field.
    """
    cells = {cell.path: cell_values(cell) for cell in layout.cells()}
    _check_fields(given, cells, owner)
    return st.fixed_dictionaries({**cells, **given})


def _check_fields(given: Iterable[str], known: Iterable[str], owner: str) -> None:
    names = list(known)
    unknown = [name for name in given if name not in names]
    if unknown:
        hints = [(name, expected(name, names)) for name in unknown]
        raise together([UsageError(f"unknown field of {owner}; {hint}", field=name) for name, hint in hints])


def packed(layout: Layout, values: Mapping[str, Any]) -> bytes:
    """Return the bytes of a struct from values by path; missing ones are zero."""
    data = bytearray(layout.size)
    for cell in layout.cells():
        if cell.path in values:
            one = Layout(cell.path, [("value", cell.type)]).pack(value=values[cell.path])
            data[cell.offset : cell.offset + cell.size] = one
    return bytes(data)


def packets(
    name: str | int | Command | Telemetry | None = None,
    *,
    mission: MissionName = None,
    malformed: bool = False,
    fields: Fields | None = None,
) -> st.SearchStrategy[bytes]:
    """Return a strategy for CCSDS packets as on the Software Bus.

    Args:
        name: a command or telemetry packet of the dictionary, such as "SAMPLE_APP_DISPLAY_PARAM", with valid fields; a
            declaration itself; a MsgId, with any payload; None for any MsgId.
        mission: mission with the dictionary; None for the applications included in cfepy.
        malformed: whether the packet has a mistake that its receiver must find, because the bus accepts it: it is too
            short or too long, or has an unknown function code.
        fields: strategies for single fields, by path.

    Raises:
        UsageError: if there is no such packet, field or mission.
    """
    good = _packets(name, mission, fields or {})
    return good.flatmap(_with_mistake) if malformed else good


def _packets(
    name: str | int | Command | Telemetry | None, mission: MissionName, fields: Fields
) -> st.SearchStrategy[bytes]:
    if name is None:
        return (st.integers(*TELEMETRY_IDS) | st.integers(*COMMAND_IDS)).flatmap(_any_payload)
    if isinstance(name, int):
        if not 0 < name <= HIGHEST_VALID_MSG_ID or not name & HAS_TIME_OR_CODE:
            raise UsageError(f"invalid MsgId 0x{name:04X}; expected 0x0801 to 0x0FFF or 0x1801 to 0x1FFF")
        return _any_payload(name)
    entry = name if isinstance(name, Command | Telemetry) else _entry(name, mission)
    values = fields_of(entry.payload, fields, entry.name)
    if isinstance(entry, Command):
        return values.map(lambda each: bytes(command(entry.msg_id, entry.code or 0, packed(entry.payload, each))))
    return values.map(lambda each: bytes(telemetry(entry.msg_id, packed(entry.payload, each))))


def _entry(name: str, mission: MissionName) -> Command | Telemetry:
    known = dictionary_of(None if mission is None else read_mission(os.fspath(mission)))
    if name in known.telemetry:
        entry = known.telemetry[name]
        if isinstance(entry, Topic):
            raise UsageError(f"{name} is a ROS topic; use messages(TYPE) for its messages")
        return entry
    return _command(known, name)


def _command(known: Dictionary, name: str) -> Command:
    try:
        return known.command(name)
    except UsageError as error:
        raise UsageError(error.text.replace("command", "command or telemetry packet", 1)) from None


def _any_payload(msg_id: int) -> st.SearchStrategy[bytes]:
    payload = st.binary(max_size=LONGEST_PAYLOAD)
    if msg_id & COMMAND_BIT:
        return st.builds(lambda code, data: bytes(command(msg_id, code, data)), st.integers(0, 127), payload)
    return payload.map(lambda data: bytes(telemetry(msg_id, data)))


def _with_mistake(packet: bytes) -> st.SearchStrategy[bytes]:
    """Return a strategy for mistakes of a packet, the shortest one first."""
    mistakes = [
        st.integers(CMD_HEADER_SIZE - 1, len(packet) - 1).map(lambda size: _resized(packet[:size])),
        st.binary(min_size=1, max_size=LONGEST_PAYLOAD).map(lambda more: _resized(packet + more)),
    ]
    if packet[0] & COMMAND_BIT >> 8:
        mistakes.append(st.just(packet[:CODE_BYTE] + bytes([UNKNOWN_CODE]) + packet[CODE_BYTE + 1 :]))
    return st.one_of(mistakes)


def _resized(packet: bytes) -> bytes:
    """Return the packet with the correct length in its header."""
    return packet[: SIZE_BYTES.start] + (len(packet) - 7).to_bytes(2, "big") + packet[SIZE_BYTES.stop :]


def tables(
    name: str, *, mission: MissionName = None, fields: Fields | None = None
) -> st.SearchStrategy[list[dict[str, Any]]]:
    """Return a strategy for contents of a table: its rows with their fields, as for `Flight.load_table`.

    Args:
        name: full name, such as "HK.CopyTable", or the table's own name if no other one has it.
        mission: mission whose applications declare it; those included in cfepy are always known.
        fields: strategies for single fields, by path within a row.

    Raises:
        UsageError: if there is no such table, field or mission.
    """
    kind = table_type(name, None if mission is None else os.fspath(mission))
    row = fields_of(kind.row, fields or {}, kind.name).map(lambda values: kind.row.unpack(packed(kind.row, values)))
    if kind.rows == 1:
        return st.lists(row, min_size=1, max_size=1)
    return st.lists(row, max_size=min(kind.rows, MOST_ROWS))


def schedules(decisions: int = DECISIONS, *, most: int = 3, candidates: int = 3) -> st.SearchStrategy[str]:
    """Return a strategy for schedules with a few deviations from fifo, as for `mission(schedule=...)`: "at:42=1".

    The schedules shrink to the fewest deviations, and then to the earliest ones.

    Args:
        decisions: approximate number of decisions in a run; later ones are as with fifo.
        most: maximum number of deviations.
        candidates: maximum number of tasks to choose from; if there are fewer, the last one is used.
    """
    deviations = st.dictionaries(st.integers(0, decisions - 1), st.integers(1, candidates - 1), max_size=most)
    return deviations.map(lambda chosen: Schedule().at(chosen).text() if chosen else Schedule().text())


def fault_plans(
    mission: str | os.PathLike[str] | None = None,
    *,
    messages: Sequence[str] = (),
    apps: Sequence[str] = (),
    most: int = 3,
    until: float = 10.0,
) -> st.SearchStrategy[dict[str, Any]]:
    """Return a strategy for faults, as for `mission(faults=...)`: {"faults": [{"drop": "/odom", "number": 1}]}.

    They shrink to the fewest faults, and these to the first message or the earliest time.

    Args:
        mission: mission whose messages and applications are targets if none are given. It is flown once to find them.
        messages: topics, and packets by their names in the dictionary.
        apps: cFE names.
        most: maximum number of faults.
        until: virtual time in s until which they happen.

    Raises:
        UsageError: if there is no target.
    """
    if mission is None and not messages and not apps:
        raise UsageError("missing target of faults; give a mission, messages or apps")

    def made() -> st.SearchStrategy[dict[str, Any]]:
        names, own = tuple(messages), tuple(apps)
        if mission is not None and not (names or own):
            names, own = _found_in(os.fspath(mission))
        faults = st.lists(st.one_of(*_faults(names, own, until)), max_size=most)
        return faults.map(lambda chosen: {"faults": chosen})

    return st.deferred(made)


def _faults(messages: Sequence[str], apps: Sequence[str], until: float) -> Iterator[st.SearchStrategy[dict[str, Any]]]:
    """Yield a strategy for each kind of fault."""
    when = st.integers(0, round(until * HUNDREDTHS)).map(lambda hundredths: hundredths / HUNDREDTHS)
    number = st.integers(1, MOST_COUNT)
    if messages:
        name = st.sampled_from(list(messages))
        for kind in ("drop", "duplicate", "corrupt"):
            yield st.fixed_dictionaries({kind: name, "number": number})
        delay = st.integers(1, HUNDREDTHS).map(lambda hundredths: hundredths / HUNDREDTHS)
        yield st.fixed_dictionaries({"delay": name, "number": number, "by": delay})
        yield st.fixed_dictionaries({"reorder": name, "number": number})
    if apps:
        name = st.sampled_from(list(apps))
        for kind in ("restart", "crash"):
            yield st.fixed_dictionaries({kind: name, "at": when})
        yield st.fixed_dictionaries(
            {"hang": name, "at": when, "for": st.integers(1, 10).map(lambda tenths: tenths / 10)}
        )


@cache
def _found_in(mission: str) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """Return the messages with a receiver in a mission, and its own applications."""
    from cfepy.faults import targets_of

    targets = targets_of(read_mission(mission))
    return tuple(name for name, _ in targets.messages), targets.apps
