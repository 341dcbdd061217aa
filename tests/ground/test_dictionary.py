"""The dictionary of a mission: declarations, found by name and by packet, without starting an app."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest

from cfepy.ground.dictionary import Dictionary, declared, dictionary_of, table_types
from cfepy.ground.survey import surveyed_topics
from cfepy.ground.topics import Topic, topic_id, topics_of
from cfepy.ground.values import flat, packet_of
from cfepy.mission import Mission, read_mission
from cfepy.mission.packet_watch import PacketWatch, Seen
from cfepy.msg import Command, Layout, Telemetry, command, telemetry
from cfepy.status import UsageError
from cfepy.writing.console import Console
from tests.mission.flights import write_mission

APP = """
    from cfepy.msg import Command, Layout, Telemetry

    SET = Command("OWN_SET", 0x1890, 2, Layout("Set", [("Value", "u16")]), "Sets it.")
    HK_TLM = Telemetry("OWN_HK_TLM", 0x0890, Layout("Hk", [("Count", "u32")]), "Counts.")
    COMMANDS = (SET,)
    TELEMETRY = (HK_TLM,)

    def Main(cfe):
        while cfe.es.run_loop(1):
            cfe.os.task_delay(100)
"""
TALKER = """
    import rospy
    from std_msgs.msg import UInt32

    rospy.init_node("talker")
    publisher = rospy.Publisher("count", UInt32, queue_size=1)
    rospy.Subscriber("count", UInt32, lambda message: None)
    rate = rospy.Rate(10)
    while not rospy.is_shutdown():
        publisher.publish(7)
        rate.sleep()
"""
NODES = """
    CFE_APP, own,       Main,     OWN,    50, 8192, 0, 0;
    CFE_APP, talker.py, __main__, TALKER, 60, 8192, 0, 0;
    !
"""
SET = Command("APP_SET", 0x1882, 3, Layout("Set", [("Value", "u16")]))
HK = Telemetry("APP_HK_TLM", 0x0883, Layout("Hk", [("Count", "u32")]))
TABLES = """
    from cfepy.msg import Layout
    from cfepy.tbl import TableType

    TABLES = (TableType("{name}", Layout("Row", [("X", "u8")]), rows={rows}),)


    def Main(cfe):
        raise AssertionError("a tool starts no app")
"""


@pytest.fixture
def mission(tmp_path: Path) -> str:
    yaml = "topics:\n  /count: {msg_id: 0x0950}\n"
    return write_mission(tmp_path, NODES, own=APP, talker=TALKER, mission_yaml=yaml)


def test_dictionary_has_services_and_apps_of_the_mission(mission: str) -> None:
    found = dictionary_of(read_mission(mission))
    assert {"CFE_ES_NOOP", "CFE_EVS_NOOP", "CFE_SB_NOOP", "CFE_TBL_NOOP", "CFE_TIME_NOOP", "OWN_SET"} <= set(
        found.commands
    )
    assert {"CFE_ES_HK_TLM", "CFE_EVS_LONG_EVENT_MSG", "OWN_HK_TLM", "/count"} <= set(found.telemetry)
    assert "SAMPLE_APP_NOOP" not in found.commands
    assert found.problems == []


def test_dictionary_without_a_mission_has_all_shipped_declarations() -> None:
    found = dictionary_of(None)
    assert {"CFE_ES_NOOP", "SAMPLE_APP_NOOP", "TO_LAB_OUTPUT_ENABLE"} <= set(found.commands)
    assert found.problems == []


def test_names_and_ids_are_unique() -> None:
    found = dictionary_of(None)
    codes = [(each.msg_id, each.code) for each in found.commands.values()]
    ids = [each.msg_id for each in found.telemetry.values()]
    assert len(set(codes)) == len(codes)
    assert len(set(ids)) == len(ids)


def test_app_without_declarations_is_not_executed(tmp_path: Path) -> None:
    startup = "CFE_APP, own, Main, OWN, 50, 8192, 0, 0;\n!\n"
    source = "raise RuntimeError('executed')\ndef Main(cfe):\n    pass\n"
    assert dictionary_of(read_mission(write_mission(tmp_path, startup, own=source))).problems == []


def test_number_named_like_a_declaration_declares_nothing(tmp_path: Path) -> None:
    startup = "CFE_APP, own, Main, OWN, 50, 8192, 0, 0;\n!\n"
    source = "COMMANDS = 6\ndef Main(cfe):\n    pass\n"
    assert dictionary_of(read_mission(write_mission(tmp_path, startup, own=source))).problems == []


def test_app_that_fails_is_a_problem_named_in_errors_about_unknown_names(tmp_path: Path) -> None:
    startup = "CFE_APP, own, Main, OWN, 50, 8192, 0, 0;\n!\n"
    source = "COMMANDS = (undefined,)\ndef Main(cfe):\n    pass\n"
    found = dictionary_of(read_mission(write_mission(tmp_path, startup, own=source)))
    assert found.problems == [f"{tmp_path / 'own.py'} could not be read: NameError: name 'undefined' is not defined"]
    with pytest.raises(UsageError, match=r"unknown command OWN_SET; .*own\.py could not be read"):
        found.command("OWN_SET")


def test_modules_of_a_mission_are_removed_from_the_process(mission: str) -> None:
    import sys

    before = set(sys.modules)
    dictionary_of(read_mission(mission))
    assert not [name for name in set(sys.modules) - before if name.startswith("cfepy_app_")]


@pytest.fixture
def small() -> Dictionary:
    found = Dictionary()
    found.add([SET, HK])
    return found


@pytest.mark.parametrize("name", ["APP_SETT", "app_sett", "APP_ST"])
def test_unknown_name_suggests_similar_names(small: Dictionary, name: str) -> None:
    with pytest.raises(UsageError) as error:
        small.command(name)
    assert str(error.value) == f"unknown command {name}; did you mean APP_SET?"


def test_names_and_fields_may_be_in_small_letters(small: Dictionary) -> None:
    assert small.command("app_set") is SET
    assert small.telemetry_of("app_hk_tlm") is HK
    for path in SET.payload.cells():
        assert packet_of(SET, [f"{path.path.lower()}=1"]) == packet_of(SET, [f"{path.path}=1"])


def test_telemetry_by_pattern(small: Dictionary) -> None:
    assert small.telemetry_like("APP_*") == small.telemetry_like("app_hk_tlm") == [HK.msg_id]
    with pytest.raises(UsageError, match="unknown telemetry packet NO_"):
        small.telemetry_like("NO_*")


def test_telemetry_by_name_and_by_number(small: Dictionary) -> None:
    assert small.telemetry_of("APP_HK_TLM") is small.telemetry_of("0x883") is small.telemetry_of("2179") is HK
    assert small.telemetry_of("0x0999").name == "0x0999"
    with pytest.raises(UsageError, match="unknown telemetry packet APP_HK; did you mean APP_HK_TLM"):
        small.telemetry_of("APP_HK")


def test_packets_are_decoded_by_their_headers(small: Dictionary) -> None:
    decoded = small.decode(SET.packet(Value=5))
    assert (decoded.name, decoded.values, decoded.time_s, decoded.problem) == ("APP_SET", {"Value": 5}, None, "")
    packet = telemetry(0x0883, HK.payload.pack(Count=9))
    packet[6:12] = bytes([0, 0, 0, 2, 0x80, 0])
    decoded = small.decode(bytes(packet))
    assert (decoded.name, decoded.values, decoded.time_s) == ("APP_HK_TLM", {"Count": 9}, 2.5)


def test_undecodable_packets_have_a_reason(small: Dictionary) -> None:
    assert small.decode(bytes(command(0x1882, 4)))[0] == "0x1882/4"
    assert small.decode(bytes(command(0x1882, 4))).problem == "its layout is not known"
    short = small.decode(bytes(telemetry(0x0883, b"x")))
    assert (short.name, short.values) == ("APP_HK_TLM", {})
    assert "requires 4 bytes" in short.problem
    assert small.decode(bytes(telemetry(0x0883))[:9]).problem == "9 bytes are too few for a header of 16"


def test_topics_are_decoded_when_their_type_is_known(mission: str) -> None:
    spec = read_mission(mission)
    found, seen = dictionary_of(spec), list[Seen]()
    watch = PacketWatch(seen.append, lambda each: each == 0x0950)
    with Mission(spec, console=Console(quiet=True), attachments=[watch]) as flight:
        flight.run_for(2)
        assert found.decode(seen[0].packet).problem == "the message type is unknown"
        found.learn(topics_of(flight))
    decoded = found.decode(seen[0].packet)
    assert (decoded.name, decoded.values, seen[0].sender) == ("/count", {"data": 7}, "TALKER")
    assert found.telemetry["/count"].text == "ROS topic, std_msgs/UInt32"


def test_a_survey_finds_types_and_ids(mission: str, tmp_path: Path) -> None:
    spec = read_mission(mission)
    found = {topic.name: topic for topic in surveyed_topics(spec)}
    assert (found["/count"].msg_id, found["/count"].type) == (0x0950, "std_msgs/UInt32")
    assert topic_id(spec, "/count") == 0x0950
    assert topic_id(spec, "/rosout") == found["/rosout"].msg_id


def test_incomplete_message_of_a_topic_is_refused() -> None:
    topic = Topic("/count", 0x0950, "std_msgs/UInt32")
    packet = telemetry(0x0950, bytes([1, 0, 0, 0]))
    assert topic.read(bytes(packet)) == {"data": 1}
    with pytest.raises(UsageError, match="invalid std_msgs/UInt32"):
        topic.read(bytes(telemetry(0x0950, b"x")))
    packet[2] = 0x40  # the first of several
    with pytest.raises(UsageError, match="one segment"):
        topic.read(bytes(packet))
    assert Topic("/raw", 0x0951, "std_msgs/UInt8MultiArray", raw=True).read(b"packet") == {"data": b"packet"}


@pytest.mark.parametrize("declared", dictionary_of(None).commands.values(), ids=lambda each: each.name)
def test_every_command_can_be_written_as_text(declared: Command) -> None:
    payload = bytes(number % 61 + 33 for number in range(declared.payload.size))
    values = declared.payload.unpack(payload)
    words = [f"{path}={value}" for path, value in flat(values).items()]
    assert packet_of(declared, words) == declared.packet(values)


def test_packet_of_another_version_is_not_decoded() -> None:
    dictionary = dictionary_of(None)
    for head, size in ((0xE8, 16), (0x78, 8)):
        decoded = dictionary.decode(bytes([head, 0]) + bytes(size))
        assert decoded.values == {}
        assert "its header has the version" in decoded.problem


def test_shipped_apps_declare_their_tables() -> None:
    problems: list[str] = []
    known = table_types(None, problems)
    assert problems == []
    assert {"SAMPLE_APP.ExampleTable", "SCH.SCHED_DEF", "SCH.MSG_DEFS", "SCH_LAB.ScheduleTable"} <= set(known)
    assert all(kind.file.startswith("/cf/") and kind.file.endswith(".tbl") for kind in known.values() if kind.file)


def test_own_apps_of_a_mission_have_precedence(tmp_path: Path) -> None:
    mission = write_mission(
        tmp_path,
        "CFE_APP, own, Main, OWN, 50, 8192, 0, 0;\nCFE_APP, other, Main, OTHER, 50, 8192, 0, 0;\n!\n",
        own=TABLES.format(name="OWN.Table", rows=2),
        other=TABLES.format(name="SAMPLE_APP.ExampleTable", rows=7),
    )
    known = table_types(mission, [])
    assert known["OWN.Table"].rows == 2
    assert known["SAMPLE_APP.ExampleTable"].rows == 7


def test_each_file_is_executed_once_and_its_modules_removed(tmp_path: Path) -> None:
    entries = "".join(f"CFE_APP, own, Main, OWN{number}, 50, 8192, 0, 0;\n" for number in range(3))
    mission = write_mission(tmp_path, entries + "!\n", own=TABLES.format(name="OWN.Table", rows=2))
    before = set(sys.modules)
    found = declared(read_mission(mission), ("TABLES",), [])
    assert [kind.name for kind in found] == ["OWN.Table"]
    assert not {name for name in set(sys.modules) - before if name.startswith("cfepy_app_")}


def test_broken_apps_are_reported_and_others_found(tmp_path: Path) -> None:
    mission = write_mission(
        tmp_path,
        "CFE_APP, bad, Main, BAD, 50, 8192, 0, 0;\nCFE_APP, ends, Main, ENDS, 50, 8192, 0, 0;\n"
        "CFE_APP, own, Main, OWN, 50, 8192, 0, 0;\nCFE_APP, gone, Main, GONE, 50, 8192, 0, 0;\n!\n",
        bad="TABLES = 1 / 0\n",
        ends="import sys\nTABLES = ()\nsys.exit(3)\n",
        own=TABLES.format(name="OWN.Table", rows=2),
    )
    problems: list[str] = []
    found = declared(read_mission(mission), ("TABLES",), problems)
    assert [kind.name for kind in found] == ["OWN.Table"]
    assert [problem.rpartition("/")[2] for problem in problems] == [
        "bad.py could not be read: ZeroDivisionError: division by zero",
        "ends.py could not be read: SystemExit: 3",
    ]


def test_nodes_and_apps_without_declarations_are_not_executed(tmp_path: Path) -> None:
    mission = write_mission(
        tmp_path,
        "CFE_APP, node.py, __main__, NODE, 50, 8192, 0, 0;\nCFE_APP, plain, Main, PLAIN, 50, 8192, 0, 0;\n!\n",
        node="TABLES = 1 / 0\n",
        plain="raise AssertionError('executed')\n",
    )
    problems: list[str] = []
    tables = declared(read_mission(mission), ("TABLES",), problems)
    assert {table.name.partition(".")[0] for table in tables} == {"ROS"}  # which comes with every node
    assert problems == []
