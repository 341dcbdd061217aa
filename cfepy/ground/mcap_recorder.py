"""Recording a run into an MCAP file, for Foxglove and other tools: its ROS topics, cFE packets and events.

Recording observes the bus, like recording a bag, so it does not change the run. Packets are JSON with a schema
(`cfepy.ground.json_packets`), and events are also written as `foxglove.Log`.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING

from cfepy.ground.bag import BagRecorder, RunRecorder, storage
from cfepy.ground.dictionary import Dictionary, dictionary_of
from cfepy.ground.events import EVENT_IDS, DecodedEvent
from cfepy.ground.json_packets import EVENTS, PACKETS, event_json, log_schema, packet_json, packet_schema
from cfepy.ground.mcap_writer import McapWriter, mcap_library
from cfepy.mission import Mission, Seen, TopicMessage, matches
from cfepy.msg import Command, Telemetry, get_header_version
from cfepy.status import CfeError, UsageError
from cfepy.units import NS_PER_S

if TYPE_CHECKING:
    from rosbag_storage import RecordedChannel

SUFFIX = ".mcap"
FLUSH_NS = NS_PER_S  # in virtual time: maximum loss if a run is killed, apart from data not on the disk yet


class McapRecorder(RunRecorder):
    """Records a run into an MCAP file.

    Args:
        file: the file; it is overwritten.
        patterns: names of topics and channels, such as "/odom" or "/cfe/*"; all if empty.
        command: command that repeats the run, stored in the file.

    Raises:
        UsageError: if the file cannot be written, or the library mcap is not installed.

    Attributes:
        count: number of messages, packets and events so far.
    """

    def __init__(self, file: str, patterns: Sequence[str] = (), command: str = "") -> None:
        mcap_library()  # before an existing file is overwritten
        super().__init__(self._take_topic, file, patterns)
        self._channels: dict[object, int] = {}
        self._dictionary = Dictionary()
        self._flushed_ns = 0
        self._writer = McapWriter(self._file)
        if command:
            self._writer.metadata("cfepy", {"command": command})

    def _finish(self) -> None:
        self._writer.finish()

    def begin(self, mission: Mission) -> None:
        super().begin(mission)
        self._dictionary = dictionary_of(mission.spec)

    def _is_wanted(self, msg_id: int) -> bool:
        return True

    def take_packet(self, seen: Seen) -> None:
        super().take_packet(seen)
        declared = None if get_header_version(seen.packet) else self._dictionary.declared_as(seen.packet)
        if declared is None and self._topic(seen.msg_id) is not None:
            return  # the message of a ROS topic, which was already recorded
        stamp_ns = self._stamp(seen.at_ns)
        if stamp_ns is None:
            return  # as for topics, there is no time yet
        self._take_cfe(seen, declared, stamp_ns)
        if seen.msg_id in EVENT_IDS and matches(EVENTS, self._patterns):
            self._take_event(seen, stamp_ns)

    def _take_cfe(self, seen: Seen, declared: Command | Telemetry | None, stamp_ns: int) -> None:
        name = f"{PACKETS}{f'0x{seen.msg_id:04X}' if declared is None else declared.name}"
        if not matches(name, self._patterns):
            return
        decoded = self._dictionary.decode(seen.packet)

        def channel() -> RecordedChannel:
            about = {"msg_id": f"0x{seen.msg_id:04X}"}
            return _json_channel(name, name[1:].replace("/", "."), packet_schema(name, declared), about)

        self._write(name, channel, seen.at_ns, stamp_ns, packet_json(seen, decoded), decoded.sequence)

    def _take_event(self, seen: Seen, stamp_ns: int) -> None:
        try:
            event = DecodedEvent.of(seen)
        except (CfeError, UsageError):
            return  # an application has sent something else with this MsgId, which the packet's own channel shows
        data = event_json(event, stamp_ns)
        self._write(EVENTS, lambda: _json_channel(EVENTS, "foxglove.Log", log_schema(), {}), seen.at_ns, stamp_ns, data)

    def _take_topic(self, message: TopicMessage) -> None:
        if message.stamp_ns is None:
            return  # rosbag, too, starts once there is a time
        header = message.header
        key = (message.topic, header.get("callerid", ""), header["md5sum"])

        def channel() -> RecordedChannel:
            found: RecordedChannel = storage().channel_of_connection(storage().Connection(0, message.topic, header))
            return found

        self._write(key, channel, message.at_ns, message.stamp_ns, message.data)

    def _write(
        self,
        key: object,
        channel: Callable[[], RecordedChannel],
        at_ns: int,
        stamp_ns: int,
        data: bytes,
        sequence: int = 0,
    ) -> None:
        if self._failed is not None:
            return
        try:
            if key not in self._channels:
                self._channels[key] = self._writer.channel(channel())
            self.count += 1
            self._writer.write(self._channels[key], stamp_ns, data, sequence=sequence)
            if at_ns - self._flushed_ns >= FLUSH_NS:
                self._flushed_ns = at_ns
                self._writer.flush()
        except OSError as error:
            self._failed = error


def _json_channel(name: str, title: str, schema: bytes, about: dict[str, str]) -> RecordedChannel:
    library = storage()
    channel: RecordedChannel = library.RecordedChannel(
        0, name, "json", library.McapSchema(title, "jsonschema", schema), about
    )
    return channel


def recorder_of(file: str, patterns: Sequence[str] = (), command: str = "") -> RunRecorder:
    """Return the recorder of a run: for an MCAP file if the file name ends with .mcap, otherwise for a bag.

    Args:
        file: the file; it is overwritten.
        patterns: names of topics; all if empty.
        command: command that repeats the run, stored in an MCAP file.

    Raises:
        UsageError: if the file cannot be written, or the library mcap is not installed.
    """
    if file.endswith(SUFFIX):
        return McapRecorder(file, patterns, command)
    return BagRecorder(file, patterns)
