"""The XTCE export, against a library independent of cfepy: it decodes real packets to the same values."""

from __future__ import annotations

import re
import warnings
from collections.abc import Iterator
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import pytest
from space_packet_parser.xtce.definitions import XtcePacketDefinition
from space_packet_parser.xtce.validation import validate_xtce

from cfepy.ground.dictionary import Dictionary, dictionary_of
from cfepy.ground.topics import Topic, topics_of
from cfepy.ground.values import flat, named_fields
from cfepy.ground.xtce import NAMESPACE, cells_with_padding, xtce_name, xtce_of
from cfepy.mission import UNIX_AT_CFE_EPOCH, Mission, read_mission
from cfepy.mission.packet_watch import PacketWatch, Seen
from cfepy.msg import Command, Layout, Measurement, MsgType, Telemetry, get_type, telemetry
from cfepy.writing.console import Console
from tests.mission.flights import write_mission

STARTUP = """
    CFE_APP, sample_app,    SAMPLE_APP_Main, SAMPLE_APP, 50, 16384, 0x0, 0;
    CFE_APP, hk,        HK_AppMain,      HK,         90, 16384, 0x0, 0;
    CFE_APP, talker.py, __main__,        TALKER,     60, 16384, 0x0, 0;
    !
"""
TALKER = """
    import rospy
    from geometry_msgs.msg import PoseStamped
    from sensor_msgs.msg import JointState
    from std_msgs.msg import Float32, Float64MultiArray, Header, String

    rospy.init_node("talker")
    messages = {
        "value": Float32(2.5),
        "text": String("from a node"),
        "numbers": Float64MultiArray(data=[1.0, 2.0]),
        "pose": PoseStamped(header=Header(frame_id="base")),
        "joints": JointState(name=["one", "two"], position=[1.0, 2.0]),
    }
    messages["pose"].pose.position.x = -1.5
    publishers = {}
    for name, message in messages.items():
        publishers[name] = rospy.Publisher(name, type(message), queue_size=1)
        rospy.Subscriber(name, type(message), lambda message: None)
    rate = rospy.Rate(10)
    while not rospy.is_shutdown():
        for name, message in messages.items():
            publishers[name].publish(message)
        rate.sleep()
"""


class Export:
    """A mission's XTCE, the library's reading of it, and packets from the mission's bus."""

    def __init__(self, folder: Path) -> None:
        spec = read_mission(write_mission(folder, STARTUP, talker=TALKER))
        self.dictionary = dictionary_of(spec)
        self.packets: dict[int, bytes] = {}
        self.events: list[bytes] = []
        with Mission(spec, console=Console(quiet=True), attachments=[PacketWatch(self._take)]) as mission:
            mission.run_for(2)
            for command in self.dictionary.commands.values():
                if command.name.endswith("_SEND_HK"):
                    mission.cfe.sb.transmit_msg(command.packet(), is_origination=False)
            mission.run_for(2)
            self.dictionary.learn(topics_of(mission))
        self.text = xtce_of(spec.name, self.dictionary)
        self.file = folder / "mission.xml"
        self.file.write_text(self.text, encoding="utf-8")
        self.definition = XtcePacketDefinition.from_xtce(self.file)

    def _take(self, seen: Seen) -> None:
        if get_type(seen.packet) == MsgType.TLM:
            self.packets[seen.msg_id] = seen.packet
            if seen.msg_id == 0x0808:
                self.events.append(seen.packet)

    def read(self, packet: bytes) -> dict[str, Any]:
        """Return the library's values of a packet. A packet that it does not read to its end is an error."""
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            return dict(self.definition.parse_bytes(packet))


@pytest.fixture(scope="module")
def export(tmp_path_factory: pytest.TempPathFactory) -> Export:
    return Export(tmp_path_factory.mktemp("xtce"))


@pytest.mark.parametrize(
    ("zero_s", "epoch"), [(UNIX_AT_CFE_EPOCH, "1980-01-01T00:00:00"), (UNIX_AT_CFE_EPOCH - 37, "1979-12-31T23:59:23")]
)
def test_time_counts_from_the_zero_of_spacecraft_time(zero_s: int, epoch: str) -> None:
    root = ElementTree.fromstring(xtce_of("m", Dictionary(), zero_s))
    assert [each.text for each in root.iter(f"{{{NAMESPACE}}}Epoch")] == [epoch]


SERVICES = ("CFE_ES_HK_TLM", "CFE_EVS_HK_TLM", "CFE_SB_HK_TLM", "CFE_TBL_HK_TLM", "CFE_TIME_HK_TLM")


def assert_same(export: Export, packet: bytes) -> None:
    """Assert that every field, header included, equals our own decoding."""
    ours, theirs = export.dictionary.decode(packet), export.read(packet)
    assert theirs["PKT_APID"] == ours.msg_id & 0x7FF
    assert theirs["SRC_SEQ_CTR"] == ours.sequence
    assert theirs["PKT_LEN"] == len(packet) - 7
    assert theirs["TIME"] == ours.time_s
    names = {} if ours.layout is None else named_fields(ours.layout)
    fields = {
        f"{ours.name}_{xtce_name(path)}": names[path].text(value) if path in names and not names[path].flags else value
        for path, value in flat(ours.values).items()
    }
    assert fields
    assert {name: theirs[name] for name in fields} == fields
    assert {name for name in theirs if name.startswith(ours.name)} == set(fields)


@pytest.mark.parametrize("name", [*SERVICES, "SAMPLE_APP_HK_TLM"])
def test_housekeeping_of_a_running_mission_is_read_field_by_field(export: Export, name: str) -> None:
    assert_same(export, export.packets[export.dictionary.telemetry_of(name).msg_id])


def test_events_are_read_field_by_field(export: Export) -> None:
    assert len(export.events) > 20
    for packet in export.events:
        assert_same(export, packet)


def test_every_declared_packet_is_read_field_by_field(export: Export) -> None:
    """Also those that this mission did not send: with a different value in each byte."""
    for declared in export.dictionary.telemetry.values():
        if isinstance(declared, Telemetry) and declared.payload.fields:
            assert_same(export, bytes(telemetry(declared.msg_id, _filled(declared.payload))))


def _filled(layout: Layout) -> bytes:
    """Return a payload of different bytes; texts are texts, and bools are true."""
    payload = bytearray(number * 7 % 61 + 1 for number in range(layout.size))
    for cell in layout.cells():
        if cell.type.startswith("char"):
            payload[cell.offset : cell.offset + cell.size] = b"text"[: cell.size - 1].ljust(cell.size, b"\0")
        elif cell.type == "bool":
            payload[cell.offset] = 1
        elif cell.names is not None:  # a reader knows no others
            value = next(reversed(cell.names.values.values()))
            payload[cell.offset : cell.offset + cell.size] = value.to_bytes(cell.size, "little", signed=value < 0)
    return bytes(payload)


def test_ros_messages_are_decoded_as_far_as_xtce_can_describe_them(export: Export) -> None:
    values: dict[str, Any] = {}
    for topic in export.dictionary.telemetry.values():
        if isinstance(topic, Topic) and topic.msg_id in export.packets and topic.name != "/joints":
            values |= export.read(export.packets[topic.msg_id])
    assert values["value_data"] == 2.5
    assert values["text_data"] == "from a node"
    assert values["pose_header_frame_id"] == "base"
    assert values["pose_pose_position_x"] == -1.5
    assert values["numbers_layout_dim_count"] == 0
    assert len(values["numbers_rest"]) == 24  # data_offset, the count, two numbers


def test_fields_after_two_variable_texts_are_omitted(export: Export) -> None:
    packet = export.packets[export.dictionary.telemetry["/joints"].msg_id]
    with pytest.warns(UserWarning, match="Number of bits parsed"):
        values = export.definition.parse_bytes(packet)
    assert values["joints_name_count"] == 2
    assert not [name for name in values if name.startswith("joints_position")]


def test_the_document_is_valid_xtce(export: Export) -> None:
    result = validate_xtce(export.file, level="all", raise_on_error=False)
    assert result.valid, [str(error) for error in result.errors[:5]]


def test_names_are_unique_and_allowed(export: Export) -> None:
    root = ElementTree.fromstring(export.text)
    for kind in ("Parameter", "SequenceContainer", "MetaCommand"):
        names = [each.attrib["name"] for each in root.iter(f"{{{NAMESPACE}}}{kind}")]
        assert len(set(names)) == len(names)
        assert not [name for name in names if re.search(r"[./:\[\]\s]", name)]


def test_names_that_collide_after_conversion_stay_distinct() -> None:
    found = Dictionary()
    found.add([Telemetry("APP_TLM", 0x0890, Layout("L", [("A", "u8[2]"), ("A_1", "u8")]))])
    root = ElementTree.fromstring(xtce_of("m", found))
    names = [each.attrib["name"] for each in root.iter(f"{{{NAMESPACE}}}Parameter")]
    assert names[-3:] == ["APP_TLM_A_0", "APP_TLM_A_1", "APP_TLM_A_1_"]


def read_with(packets: list[Telemetry | Topic], folder: Path, packet: bytes) -> dict[str, Any]:
    """Return the library's values of a packet from the document of a few declarations."""
    found = Dictionary()
    found.add(packets)
    (folder / "few.xml").write_text(xtce_of("few", found), encoding="utf-8")
    return dict(XtcePacketDefinition.from_xtce(folder / "few.xml").parse_bytes(packet))


def test_a_topic_of_whole_packets_is_bytes(tmp_path: Path) -> None:
    """HK's combined packets are an example, because a table defines their fields."""
    topic = Topic("/cfe/hk/combined_pkt1", 0x089C, "std_msgs/UInt8MultiArray", raw=True)
    values = read_with([topic], tmp_path, bytes(telemetry(0x089C, b"any bytes")))
    assert values["cfe_hk_combined_pkt1_data"] == b"any bytes"


def test_topic_with_a_command_id_is_not_telemetry(tmp_path: Path) -> None:
    """Its APID is a telemetry packet's, so the two could not be distinguished."""
    declared = Telemetry("APP_TLM", 0x0890, Layout("L", [("A", "u8")]))
    topics = [Topic("/goal", 0x1890, "std_msgs/Int32"), Topic("/plain", 0x0090, "std_msgs/Int32")]
    assert read_with([declared, *topics], tmp_path, bytes(telemetry(0x0890, b"\x07")))["APP_TLM_A"] == 7


def test_padding_fills_every_gap() -> None:
    layout = Layout("L", [("A", "u8"), ("B", "u32"), ("C", "u16")])
    found = list(cells_with_padding(layout))
    assert [(cell.type, cell.offset, cell.size) for cell in found] == [
        ("u8", 0, 1), ("padding", 1, 3), ("u32", 4, 4), ("u16", 8, 2), ("padding", 10, 2),
    ]  # fmt: skip
    assert sum(cell.size for cell in found) == layout.size


# -- commands ----------------------------------------------------------------------------------------------------------


def entries_of(export: Export, command: Command) -> Iterator[ElementTree.Element]:
    root = ElementTree.fromstring(export.text)
    meta = next(
        each for each in root.iter(f"{{{NAMESPACE}}}MetaCommand") if each.attrib["name"] == xtce_name(command.name)
    )
    container = meta.find(f"{{{NAMESPACE}}}CommandContainer/{{{NAMESPACE}}}EntryList")
    assert container is not None
    yield from container


def test_command_built_from_the_document_equals_ours(export: Export) -> None:
    """A ground system would send it, with a different byte in every argument; it may leave the checksum zero."""
    for command in export.dictionary.commands.values():
        payload = _filled(command.payload)
        cells = {xtce_name(cell.path): cell for cell in command.payload.cells()}
        packet = b""
        for entry in entries_of(export, command):
            if "argumentRef" in entry.attrib:
                cell = cells[entry.attrib["argumentRef"]]
                packet += payload[cell.offset : cell.offset + cell.size]
            else:
                packet += bytes.fromhex(entry.attrib["binaryValue"])
        ours = bytearray(command.packet(command.payload.unpack(payload)))
        ours[7] = 0
        assert packet == bytes(ours), command.name


TEMPERATURE = Measurement("u16", "degC", polynomial=(-40.0, 0.1), yellow=(0, 50), red=(-20, 60))
VOLTAGE = Measurement("i8", "V", points=((0, 0.0), (50, 20.0), (100, 30.0)), red=(22, None))
RATE = Measurement("f32", "rad/s", yellow=(None, 2.5))
COUNT = Measurement("u32", "1", red=(0, 7))
MEASURED = [("Temp", TEMPERATURE), ("Volts", (VOLTAGE, 2)), ("Rate", RATE), ("Count", COUNT)]


def test_measurements_have_units_calibrators_and_alarms(tmp_path: Path) -> None:
    packet = Telemetry("T_HK_TLM", 0x08F0, Layout("Hk", MEASURED))
    dictionary = Dictionary()
    set_limit = Command("T_SET_LIMIT", 0x18F0, 1, Layout("Set", [("Temp", TEMPERATURE)]))  # XTCE has no alarm for it
    dictionary.add([packet, set_limit])
    text, file = xtce_of("t", dictionary), tmp_path / "t.xml"
    file.write_text(text, encoding="utf-8")
    result = validate_xtce(file, level="all", raise_on_error=False)
    assert result.valid, [str(error) for error in result.errors[:5]]
    raw = {"Temp": 930, "Volts": [25, 75], "Rate": 0.25, "Count": 9}
    found = XtcePacketDefinition.from_xtce(file).parse_bytes(packet.packet(raw))
    values = {name.removeprefix("T_HK_TLM_"): value for name, value in found.items() if name.startswith("T_HK")}
    assert values == {"Temp": pytest.approx(53.0), "Volts_0": 10.0, "Volts_1": 25.0, "Rate": 0.25, "Count": 9}
    assert found["T_HK_TLM_Temp"].raw_value == 930
    root = ElementTree.fromstring(text)
    kinds = {each.get("name"): each for each in root.iter() if each.tag.endswith("ParameterType")}

    def of(name: str) -> ElementTree.Element:
        parameters = root.iter(f"{{{NAMESPACE}}}Parameter")
        return kinds[next(each.attrib["parameterTypeRef"] for each in parameters if each.get("name") == name)]

    def limits(name: str) -> dict[str, dict[str, str]]:
        ranges = of(name).find(f"{{{NAMESPACE}}}DefaultAlarm/{{{NAMESPACE}}}StaticAlarmRanges")
        return {} if ranges is None else {each.tag.rpartition("}")[2]: each.attrib for each in ranges}

    assert limits("T_HK_TLM_Temp") == {
        "WarningRange": {"minInclusive": "0.0", "maxInclusive": "50.0"},
        "CriticalRange": {"minInclusive": "-20.0", "maxInclusive": "60.0"},
    }
    assert limits("T_HK_TLM_Volts_1") == {"CriticalRange": {"minInclusive": "22.0"}}
    assert limits("T_HK_TLM_Rate") == {"WarningRange": {"maxInclusive": "2.5"}}
    assert of("T_HK_TLM_Count").tag.endswith("IntegerParameterType")
    assert [unit.text for unit in of("T_HK_TLM_Temp").iter(f"{{{NAMESPACE}}}Unit")] == ["degC"]
    assert of("T_HK_TLM_Volts_0") is of("T_HK_TLM_Volts_1")
