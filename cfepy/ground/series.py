"""Values over time: the messages of a run's ROS topics and its cFE packets, as numpy arrays and tables.

    recorder = SeriesRecorder(["/joint_states", "CFE_ES_HK_TLM"])  # an attachment; without names it records everything
    fly(RunPlan(("capture",), seconds=20), attachments=[recorder])  # or the replay of a journal
    joints = recorder.series("/joint_states")  # a `Series`; `bag_series(file)` has those of a bag
    times, positions = joints.to_numpy("position")  # seconds, and an array of shape (messages, 7)
    joints.to_pandas("position", "header.stamp")  # where pandas is installed
    recorder.found("/joint_states.position[0]")  # the series and the field of a word

Messages are stored undecoded, and decoded when values are requested. Recording does not change the run.
"""

from __future__ import annotations

import base64
import json
from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

from cfepy.attachment import Attachment
from cfepy.ground.dictionary import Dictionary, dictionary_of
from cfepy.ground.fields import MessageDecoder, array_of, columns_of, names_in, path_of, steps_of, unit_at, values_at
from cfepy.ground.on_demand import DecodingList
from cfepy.ground.topics import topics_of
from cfepy.ground.values import measured_fields, unknown_field
from cfepy.mission import Mission, PacketWatch, Seen, TopicMessage, TopicWatch, matches
from cfepy.msg import TLM_HEADER_SIZE, Command, Measurement, Telemetry, get_fcn_code, get_header_size, get_msg_time
from cfepy.reading.suggestions import expected
from cfepy.sb import SoftwareBus
from cfepy.status import CfeError, UsageError
from cfepy.units import NS_PER_S
from cfepy.writing.markup import headline, rows_of

if TYPE_CHECKING:
    from numpy.typing import NDArray

SHOWN_NAMES = 12
HEADER_BITS, TELEMETRY_BITS = 0x1800, 0x0800  # of a MsgId: command, secondary header
BYTES_OF_ONE = 8_192  # fewer messages that are larger than this are kept, if not all are


class Samples(NamedTuple):
    """A field over time: virtual times in s, of shape (n,), and values, of shape (n,), or (n, k) for arrays."""

    times: NDArray[Any]
    values: NDArray[Any]


class Series:
    """The messages on a topic, or the packets of a name, in the order in which they were sent.

    Args:
        name: name of the topic, or name in the dictionary.
        type: type of the messages, such as "sensor_msgs/JointState"; "telemetry" or "command" for packets.
        read: decodes one.
        stamp: returns the on-board time at which it was sent, in ns; None if there is no such time.

    Attributes:
        most: maximum number of messages kept, fewer if they are large; None for all. Beyond it, every second one is
            dropped.
        every: one of this number of messages is kept.
        measured: the measurements of a packet, by the path of the field.
    """

    def __init__(self, name: str, type: str, read: Callable[[Any], Any], stamp: Callable[[Any], int | None]) -> None:
        self.name, self.type = name, type
        self.measured: Mapping[str, Measurement] = {}
        self.every = 1
        self.most: int | None = None
        self._added = self._bytes = 0
        self._read, self._stamp = read, stamp
        self._sent: list[Any] = []
        self._messages = DecodingList(self._sent, read)

    @classmethod
    def over(
        cls, name: str, type: str, read: Callable[[Any], Any], stamp: Callable[[Any], int | None], sent: list[Any]
    ) -> Series:
        """Return a series over a list of undecoded messages that others extend; see the class for the arguments."""
        made = cls(name, type, read, stamp)
        made._sent = sent
        made._messages = DecodingList(sent, read)
        return made

    def add(self, sent: TopicMessage | Seen | RecordedPacket) -> None:
        """Add a message."""
        self._added += 1
        if (self._added - 1) % self.every:
            return
        self._sent.append(sent)
        if self.most is not None:
            self._bytes += len(sent.data if isinstance(sent, TopicMessage) else sent.packet)
            if len(self._sent) > self.most or self._bytes > self.most * BYTES_OF_ONE:
                self._drop_half()

    def _drop_half(self) -> None:
        self.every *= 2
        self._bytes //= 2
        self._sent = self._sent[::2]
        self._messages = DecodingList(self._sent, self._read)

    @property
    def count(self) -> int:
        """Number of messages sent."""
        return len(self._sent) if self.every == 1 else self._added

    @property
    def sent(self) -> Sequence[Any]:
        """Undecoded messages: `TopicMessage` or `Seen`."""
        return self._sent

    def __len__(self) -> int:
        return len(self._sent)

    def __repr__(self) -> str:
        return f"<{self.name}: {len(self)} of {self.type}>"

    def _repr_html_(self) -> str:
        """Return the display in a notebook: each field with its first and last value."""
        if not self._sent:
            return headline(self.name, f"none of {self.type}")
        ends = [self._read(self._sent[0]), self._read(self._sent[-1])]
        columns = ((path, self.engineering(path, values)) for path, values in columns_of(ends))
        rows = [(path, self.unit(path), *map(str, values)) for path, values in columns]
        first, last = (f"at {self._sent[index].at_ns / NS_PER_S:.3f} s" for index in (0, -1))
        table = rows_of(("field", "unit", first, last), rows)
        count = f"{len(self):,} of {self.type}" if "/" in self.type else f"{len(self):,} packets of {self.type}"
        return f"<div>{headline(self.name, count)}{table}</div>"

    @property
    def messages(self) -> Sequence[Any]:
        """The messages as nodes receive them, packets as mappings of their fields. Each is decoded when it is read;
        that raises `UsageError` if its bytes are not a valid message.
        """
        return self._messages.present()

    @property
    def times_ns(self) -> NDArray[Any]:
        """Virtual times of sending in ns, as int64."""
        import numpy

        return numpy.array([sent.at_ns for sent in self._sent], numpy.int64)

    @property
    def times(self) -> NDArray[Any]:
        """Virtual times of sending in s, as float64."""
        return self.times_ns / NS_PER_S

    @property
    def stamps_ns(self) -> NDArray[Any]:
        """On-board times of sending, in ns, as int64: ROS time, or for telemetry packets the spacecraft time in the
        header. 0 if there is no such time, as in a command and before a bag's /clock.
        """
        import numpy

        return numpy.array([self._stamp(sent) or 0 for sent in self._sent], numpy.int64)

    def to_numpy(self, field: str) -> Samples:
        """Return a field over time.

        Numbers have the type that numpy gives them. Arrays of one length are rows. Times and durations are in s. Texts
        and arrays of different lengths are objects, and a number that a message has not is NaN.

        Args:
            field: its path, see `cfepy.ground.fields`.

        Raises:
            UsageError: if there is no such field, or it is a whole struct.
        """
        path, values = self._values(field)
        inner = next((names_in(value) for value in values if value is not None), ())
        if inner:
            names = ", ".join(f"{path}.{name}" if path else name for name in inner)
            raise UsageError(
                f"is not a single field; name one of its fields: {names}", file=self.name, field=path or None
            )
        return Samples(self.times, array_of(values))

    def columns(self, *fields: str) -> dict[str, NDArray[Any]]:
        """Return the fields as columns, each number, time and text in them by its path, such as "position[0]".

        Args:
            fields: their paths; all if empty.

        Raises:
            UsageError: if there is no such field.
        """
        found = [self._values(field) for field in fields or ("",)]
        return {name: column for path, values in found for name, column in columns_of(values, path)}

    def unit(self, field: str) -> str:
        """Return the unit of a field, defined by its message type or its measurement; "" if it is not known."""
        measurement = self.measurement(field)
        if measurement is not None:
            return measurement.unit
        return unit_at(self.messages[0], steps_of(field)) if len(self) else ""

    def to_pandas(self, *fields: str) -> Any:
        """Return a `pandas.DataFrame`: a row for each message, with its virtual time in s for an index, and a column
        for each of `columns(*fields)`.

        Raises:
            UsageError: if there is no such field, or pandas is not installed.
        """
        try:
            from pandas import DataFrame, Index
        except ImportError:
            raise UsageError("tables require the library pandas: pip install pandas") from None
        return DataFrame(self.columns(*fields), index=Index(self.times, name="time"))

    def measurement(self, field: str) -> Measurement | None:
        """Return the measurement of a field, or of the items of an array; None if it is not one."""
        if not self.measured:
            return None
        path = path_of(steps_of(field))
        return self.measured.get(path) or self.measured.get(f"{path}[0]")

    def engineering(self, path: str, column: NDArray[Any]) -> NDArray[Any]:
        """Return the engineering values of a field's raw numbers; the same numbers if the field is not calibrated.

        Args:
            path: path of the field.
            column: its raw numbers, of one dimension.
        """
        measurement = self.measurement(path)
        if measurement is None or not measurement.is_calibrated:
            return column
        import numpy

        return numpy.array([measurement.value(raw) for raw in column.tolist()])

    def _values(self, field: str) -> tuple[str, list[Any]]:
        """Return the path of a field in display form, and its value in each message."""
        messages = self.messages
        try:
            steps = steps_of(field)
            return path_of(steps), values_at(messages, steps) if steps else list(messages)
        except LookupError:
            raise self._missing(field) from None

    def _missing(self, field: str) -> UsageError:
        paths = [path for path, _ in columns_of(self.messages)]
        array, mark, _ = field.rpartition("[")
        items = {path[len(array) :].split("]")[0] for path in paths if mark and path.startswith(f"{array}[")}
        if not items:
            return unknown_field(self.name, paths, field)
        text = f"index out of range; the last item is {array}[{len(items) - 1}]"
        return UsageError(text, file=self.name, field=field)


class SeriesSet:
    """Series by name.

    Args:
        most: maximum number of messages kept for each, evenly spread over the run; None for all.
    """

    def __init__(self, most: int | None = None) -> None:
        self._most = most
        self._series: dict[str, Series] = {}
        self._silent: list[str] = []  # names of existing topics without any recorded message
        self._decoder = MessageDecoder()

    @property
    def names(self) -> list[str]:
        """Names of the topics and packets that were sent, sorted."""
        return sorted(self._series)

    def get(self, name: str) -> Series | None:
        """Return the series of a topic or a packet; None when nothing was sent under this name."""
        return self._series.get(name)

    def series(self, name: str) -> Series:
        """Return the series of a topic or a packet.

        Raises:
            UsageError: if nothing was sent under this name; the text has the existing names.
        """
        if name in self._series:
            return self._series[name]
        raise self._unknown(name)

    def found(self, word: str) -> tuple[Series, str]:
        """Return the series and the path of the field for a word; the path is empty for the whole message.

        Args:
            word: such as "/odom.pose.pose.position.x", "/odom/pose/pose/position/x", "CFE_ES_HK_TLM.PerfState",
                "CFE_ES.HK_TLM.PerfState" or "0x0800.PerfState".

        Raises:
            UsageError: if nothing was sent that matches.
        """
        for name, field in meanings(word):
            if name in self._series:
                return self._series[name], field
        raise self._unknown(word)

    def matching(self, word: str) -> list[tuple[Series, str]]:
        """Return the result of `found` for a word, or all topics that match a pattern such as "/arm/*".

        Raises:
            UsageError: if nothing was sent that matches.
        """
        if not word.startswith("/") or "*" not in word:
            return [self.found(word)]
        names = [name for name in self.names if matches(name, [word])]
        if not names:
            raise self._unknown(word)
        return [(self._series[name], "") for name in names]

    def _unknown(self, word: str) -> UsageError:
        names = [name for name, _ in meanings(word)]
        if any(name in self._silent for name in names):
            return UsageError("no message was sent there", file=word)
        known = sorted({*self._series, *self._silent})
        if not known:
            return UsageError("no message was sent there or on any other topic", file=word)
        hint = expected(names[0], known, subject="known are", last="and", likeness=0.5)
        return UsageError(f"unknown topic or packet; {hint}", file=word)

    def add(self, series: Series) -> None:
        """Add a series, replacing one with its name."""
        self._series[series.name] = series

    def take_message(self, message: TopicMessage) -> None:
        """Add a message of a topic."""
        series = self._series.get(message.topic)
        if series is None:
            series = Series(message.topic, message.header["type"], self._decoder.decode, lambda sent: sent.stamp_ns)
            series.most = self._most
            self._series[message.topic] = series
        series.add(message)


def meanings(word: str) -> Iterator[tuple[str, str]]:
    """Return the possible (name, path of a field) of a word, the one with the longest name first."""
    if word.startswith("/"):
        head, dot, rest = word.partition(".")
        yield from ((name, (head.removeprefix(name) + dot + rest).strip("/.")) for name in candidates(head))
        return
    parts = word.split(".")
    for count in range(len(parts), 0, -1):
        yield "_".join(parts[:count]), ".".join(parts[count:])


def candidates(name: str) -> list[str]:
    """Return the possible topics in a name: itself, or the part before a field, as in /odom/pose/pose/position/x."""
    parts = name.split("[")[0].strip("/").split("/")
    return ["/" + "/".join(parts[:count]) for count in range(len(parts), 0, -1)]


def bag_series(file: str, words: Sequence[str] = (), seconds: float | None = None) -> SeriesSet:
    """Return the series of a bag, or of an MCAP file, which may also have cFE packets.

    Args:
        file: the bag.
        words: selection, as for `SeriesRecorder`; everything if empty.
        seconds: duration to read, from its first message on a topic on; None for all.

    Raises:
        UsageError: if there is no such bag, it is damaged, or a word matches nothing in it.
    """
    from cfepy.ground.bag import BagReader

    packets = [word for word in words if not word.startswith("/")]
    topics = _topics_of(words)
    found = SeriesSet()
    start_ns: int | None = None
    with BagReader(file) as bag:
        found._silent = [connection.topic for connection in bag.connections]
        for message in bag.messages(topics) if topics or not words else ():
            if seconds is not None and message.at_ns > seconds * NS_PER_S:
                break
            found.take_message(message)
        start_ns = bag.start_ns
    if packets or not words:
        _take_packets(found, file, packets, start_ns, seconds)
    return found


class RecordedPacket(NamedTuple):
    """A packet of an MCAP file: virtual time since the file's first message on a topic, and its contents."""

    at_ns: int
    packet: bytes
    values: dict[str, Any]
    stamp_ns: int | None


def _take_packets(
    found: SeriesSet, file: str, words: Sequence[str], start_ns: int | None, seconds: float | None
) -> None:
    from cfepy.ground.json_packets import PACKETS
    from cfepy.ground.recording import packets_of

    wanted = {name for word in words for name, _ in meanings(word)}
    there: set[str] = set()
    for message in packets_of(file):
        name = message.channel.topic.removeprefix(PACKETS)
        there.add(name)
        if words and name not in wanted:
            continue
        start_ns = message.time if start_ns is None else start_ns
        if seconds is not None and message.time - start_ns > seconds * NS_PER_S:
            continue
        packet = _recorded_packet(message.data, message.time - start_ns, file)
        series = found.get(name)
        if series is None:
            kind = "command" if packet.stamp_ns is None else "telemetry"
            series = Series(name, kind, lambda sent: sent.values, lambda sent: sent.stamp_ns)
            found.add(series)
        series.add(packet)
    if words and not there:
        raise UsageError(f"{words[0]} is not a topic name, which begins with /; this file has only topics", file=file)
    found._silent += sorted(there)


def _recorded_packet(data: bytes, at_ns: int, file: str) -> RecordedPacket:
    try:
        values = json.loads(data)
        header, packet = values["_header"], base64.b64decode(values["_packet"])
        fields = {name: value for name, value in values.items() if name not in ("_header", "_packet")}
        if "problem" in header:
            fields = {"data": packet[get_header_size(packet) :]}
        stamp_ns = round(header["time_s"] * NS_PER_S) if "time_s" in header else None
    except (ValueError, LookupError, TypeError, CfeError) as error:
        raise UsageError(f"has a packet that cannot be read: {error}", file=file) from None
    return RecordedPacket(at_ns, packet, fields, stamp_ns)


def _topics_of(words: Sequence[str]) -> list[str]:
    return [name for word in words if word.startswith("/") for name in candidates(word.partition(".")[0])]


class SeriesRecorder(SeriesSet, Attachment):
    """Records the messages of a run.

    Args:
        words: selection: topics, patterns such as "/arm/*", packets of the mission's dictionary and MsgIds, optionally
            with fields (`SeriesSet.found`). Without any, all topics and all declared telemetry.
        most: as for `SeriesSet`.

    Raises:
        UsageError: when the mission is created, if it has no such packet.
    """

    def __init__(self, words: Sequence[str] = (), most: int | None = None) -> None:
        super().__init__(most)
        topics = _topics_of(words)
        self._packets = [word for word in words if not word.startswith("/")]
        self._wants_all = not words
        self._names: dict[int, dict[int | None, str]] = {}
        self._dictionary = Dictionary()
        self._mission: Mission
        self._is_over = False
        self._watches: list[TopicWatch | PacketWatch] = []
        self._all_topics = TopicWatch(self._take_in_time)
        if topics:
            self._watches.append(TopicWatch(self._take_in_time, topics))
        if self._packets:
            self._watches.append(PacketWatch(self._take_packet, self._names.__contains__))

    def bus(self, base: type[SoftwareBus]) -> type[SoftwareBus]:
        if self._wants_all:  # one check of each packet, instead of one for topics and one for packets
            return PacketWatch(self._take_any, _is_telemetry).bus(self._all_topics.hearing(base))
        for each in self._watches:
            base = each.bus(base)
        return base

    def begin(self, mission: Mission) -> None:
        self._mission = mission
        for each in (*self._watches, self._all_topics):
            each.begin(mission)
        if not self._packets and not self._wants_all:
            return
        self._dictionary = dictionary_of(mission.spec)
        for word in self._packets:
            self._want(self._declared(word))
        if self._wants_all:
            for packet in self._dictionary.telemetry.values():
                if isinstance(packet, Telemetry):
                    self._want(packet)

    def conclude(self) -> None:
        """Stop recording: the shutdown of the nodes is not part of the run's time."""
        self._is_over = True
        self._silent = [topic.name for topic in topics_of(self._mission)]
        self._silent += (name for names in self._names.values() for name in names.values())

    def _declared(self, word: str) -> Any:
        known = {**self._dictionary.telemetry, **self._dictionary.commands}
        names = [name for name, _ in meanings(word)]
        found = next((known[name] for name in names if name in known), None)
        return self._dictionary.telemetry_of(word.partition(".")[0]) if found is None else found

    def _want(self, packet: Any) -> None:
        code = packet.code if isinstance(packet, Command) else None
        self._names.setdefault(packet.msg_id, {})[code] = packet.name

    def _take_any(self, seen: Seen) -> None:
        if seen.msg_id in self._names:
            self._take_packet(seen)
        self._all_topics.take_packet(seen)

    def _take_in_time(self, message: TopicMessage) -> None:
        if not self._is_over:
            self.take_message(message)

    def _take_packet(self, seen: Seen) -> None:
        names = self._names[seen.msg_id]
        is_command = get_header_size(seen.packet) != TLM_HEADER_SIZE
        name = names.get(None) or names.get(get_fcn_code(seen.packet) if is_command else None)
        if name is None or self._is_over:
            return
        series = self._series.get(name)
        if series is None:
            series = self._series[name] = packet_series(name, is_command, self._dictionary)
            series.most = self._most
        series.add(seen)


def _is_telemetry(msg_id: int) -> bool:
    return msg_id & HEADER_BITS == TELEMETRY_BITS


def packet_series(name: str, is_command: bool, dictionary: Dictionary, sent: list[Seen] | None = None) -> Series:
    """Return a series of packets.

    Args:
        name: name in the dictionary.
        is_command: whether they are commands, which have no time in their header.
        dictionary: decodes them.
        sent: the packets, to which others add; None for an empty series of its own.
    """
    kind, stamp = ("command", _no_stamp) if is_command else ("telemetry", _spacecraft_time)
    series = Series.over(
        name, kind, lambda seen: dictionary.fields_of(seen.packet), stamp, [] if sent is None else sent
    )
    packet = dictionary.telemetry.get(name)
    if isinstance(packet, Telemetry) and not packet.variants:
        series.measured = measured_fields(packet.payload)
    return series


def _spacecraft_time(seen: Seen) -> int:
    seconds, subseconds = get_msg_time(seen.packet)
    return seconds * NS_PER_S + (subseconds * NS_PER_S >> 32)


def _no_stamp(seen: Seen) -> None:
    """Return None: a command has no time in its header."""
