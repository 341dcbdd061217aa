"""Parameters in cFE tables: their state after resets, the ground's view and loads, and too many of them."""

from __future__ import annotations

from pathlib import Path

import pytest

from cfepy.ground.cfe_files.table_file import take_apart
from cfepy.mission.packet_watch import PacketWatch, Seen
from cfepy.msg import command
from cfepy.tbl import TableHandle
from rospy_shim.parameters.app import ParameterImages
from rospy_shim.parameters.rows import ParametersFull
from rospy_shim.parameters.table import HK_TLM, NOOP, RESET_COUNTERS, SEND_HK, TABLES
from tests.rospy_shim.parameters.flights import (
    POWERON_RESET,
    PROCESSOR_RESET,
    dump,
    events,
    fly,
    load,
    printed,
    reset,
    rows_of,
)

COUNTING = """
    import rospy
    rospy.init_node("n")
    print(sorted(rospy.get_param("/").items()))
    rospy.set_param("~count", rospy.get_param("~count", 0) + 1)
    rospy.set_param("/all", {"i": 1, "f": 1.0, "b": True, "s": "1", "l": [1, 2.5, "x", {"y": []}], "e": {}})
    rospy.spin()
    """


@pytest.mark.parametrize("tasks", ["thread", "greenlet"])
def test_parameters_survive_a_processor_reset_but_no_power_on_reset(tmp_path: Path, tasks: str) -> None:
    everything = {"b": True, "e": {}, "f": 1.0, "i": 1, "l": [1, 2.5, "x", {"y": []}], "s": "1"}
    with fly(tmp_path, COUNTING, tasks=tasks) as mission:
        mission.run_for(2)
        reset(mission, PROCESSOR_RESET)
        assert mission.ros.graph.params.find("/all") == everything
        assert [type(value) for value in mission.ros.graph.params.find("/all/l")] == [int, float, str, dict]
        assert mission.ros.graph.params.find("/n/count") == 2
        reset(mission, POWERON_RESET)
        assert mission.ros.graph.params.find("/n/count") == 1
        boots = printed(mission)
    assert boots[0] == boots[2] == "[]"
    assert "'n', {'count': 1}" in boots[1]


def test_parameter_set_by_a_node_overrides_the_mission_file_after_a_reset(tmp_path: Path) -> None:
    node = """
        import rospy
        rospy.init_node("n")
        print([rospy.get_param(name, None) for name in ("/rate", "/gone", "~mode", "~left")])
        rospy.set_param("/rate", 20)
        rospy.set_param("~mode", "fast")
        if rospy.has_param("/gone"):
            rospy.delete_param("/gone")
        rospy.spin()
        """
    with fly(tmp_path, node, params={"rate": 10, "gone": 1}, private={"mode": "slow", "left": [1]}) as mission:
        mission.run_for(2)
        reset(mission, PROCESSOR_RESET)
        reset(mission, POWERON_RESET)
        boots = printed(mission)
    assert boots == ["[10, 1, 'slow', [1]]", "[20, None, 'fast', [1]]", "[10, 1, 'slow', [1]]"]


def test_parameter_set_right_before_a_node_dies_is_kept(tmp_path: Path) -> None:
    node = """
        import rospy
        rospy.init_node("n")
        rospy.sleep(0.1)
        rospy.set_param("/deaths", rospy.get_param("/deaths", 0) + 1)
        raise RuntimeError("no more")
        """
    with fly(tmp_path, node) as mission:
        mission.run_for(2)
        mission.cfe.psp.restart(1)
        mission.run_for(2)
        assert mission.ros.graph.params.find("/deaths") == 2


def test_reset_before_the_tables_are_loaded_does_not_block_them(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Table Services begin to restore images that the CDS does not have yet, and keep those loads in progress."""
    register, resets = ParameterImages._register, []

    def reset_after(images: ParameterImages, number: int) -> TableHandle | None:
        handle = register(images, number)
        if number == 2 and not resets:
            resets.append(number)
            mission.cfe.psp.restart(PROCESSOR_RESET)
            mission.cfe.os.task_delay(1)
        return handle

    monkeypatch.setattr(ParameterImages, "_register", reset_after)
    with fly(tmp_path, COUNTING) as mission:
        mission.run_for(2)
        assert len(mission.record.resets) == 1
        assert mission.ros.graph.params.find("/n/count") == 1
        assert any("Table Load Aborted for 'ROS.Params03'" in line for line in mission.console.lines)
        assert [text.split(".")[0] for text in events(mission)] == ["1: ROS Initialized"]
        reset(mission, PROCESSOR_RESET)
        assert mission.ros.graph.params.find("/n/count") == 2


def test_bytes_stay_bytes_after_a_reset(tmp_path: Path) -> None:
    node = """
        import rospy
        rospy.init_node("n")
        print(type(rospy.get_param("/raw", None)).__name__)
        import xmlrpc.client
        rospy.set_param("/raw", xmlrpc.client.Binary(bytes(range(256))))
        """
    with fly(tmp_path, node) as mission:
        mission.run_for(2)
        reset(mission, PROCESSOR_RESET)
        assert mission.ros.graph.params.find("/raw") == bytes(range(256))
        assert printed(mission) == ["NoneType", "Binary"]


def test_dates_match_xmlrpc_and_survive_a_reset(tmp_path: Path) -> None:
    node = """
        import datetime, rospy, xmlrpc.client
        rospy.init_node("n")
        if not rospy.has_param("/when"):
            known = datetime.datetime(2026, 11, 21, 18, 50)
            rospy.set_param("/when", [known, xmlrpc.client.DateTime("20260102T03:04:05")])
        found = rospy.get_param("/when")
        print([each.value for each in found], isinstance(found[0], xmlrpc.client.DateTime))
        print(rospy.get_master().getParam("/when")[2] == found)
        try:
            rospy.set_param("/day", datetime.date(2026, 11, 21))
        except TypeError as error:
            print(error)
        rospy.spin()
    """
    with fly(tmp_path, node) as mission:
        mission.run_for(2)
        reset(mission, PROCESSOR_RESET)
        shown = ["['20261121T18:50:00', '20260102T03:04:05'] True", "True"]
        refused = "cannot marshal <class 'datetime.date'> objects"
        assert printed(mission) == [*shown, refused] * 2
        row = ("/when", '[{"!!timestamp": "20261121T18:50:00"}, {"!!timestamp": "20260102T03:04:05"}]')
        assert row in rows_of(mission)


def test_ground_reads_the_rows_of_a_dump(tmp_path: Path) -> None:
    node = """
        import rospy
        rospy.init_node("n")
        rospy.set_param("/robot", {"rate": 10, "gain": 0.5, "name": "arm", "label": "10", "axes": ["x", "y"]})
        rospy.spin()
        """
    with fly(tmp_path, node) as mission:
        mission.run_for(2)
        file = take_apart(dump(mission, 0), {table.name: table for table in TABLES}.get, "dump")
    assert file.table.table_name == "ROS.Params01"
    assert [row for row in file.rows() or [] if row["Name"]] == [
        {"Name": "/robot/rate", "Value": "10"},
        {"Name": "/robot/gain", "Value": "0.5"},
        {"Name": "/robot/name", "Value": "arm"},
        {"Name": "/robot/label", "Value": '"10"'},
        {"Name": "/robot/axes", "Value": '["x", "y"]'},
    ]


WATCHING = """
    import rospy
    rospy.init_node("n")
    rospy.set_param("/mode", "start")
    rate, last = rospy.Rate(10), None
    while not rospy.is_shutdown():
        if rospy.get_param("/") != last:
            last = rospy.get_param("/")
            print(last)
        rate.sleep()
    """


def test_table_from_the_ground_changes_parameters_of_nodes(tmp_path: Path) -> None:
    with fly(tmp_path, WATCHING) as mission:
        mission.run_for(2)
        load(mission, 0, {"/mode": "safe", "/arm/gain": "2.5", "/arm/on": "true"})
        assert printed(mission)[-1] == "{'mode': 'safe', 'arm': {'gain': 2.5, 'on': True}}"
        assert events(mission)[-1].endswith("ROS: parameters loaded, there are 3")
        reset(mission, PROCESSOR_RESET)
        assert mission.ros.graph.params.find("/arm") == {"gain": 2.5, "on": True}


@pytest.mark.parametrize(
    ("values", "said"),
    [
        ({"mode": "safe"}, "Params01, row 0: invalid name 'mode'; expected a full name such as /robot/rate"),
        ({"/good": "1", "/mode": "[1, 2"}, "Params01, row 1: invalid JSON '[1, 2'"),
        ({"/when": '{"!!timestamp": "noon"}'}, "Params01, row 0: invalid date and time 'noon'"),
        ({"/mode": "5000000000"}, "Params01, row 0: 5000000000 has more than 32 bits"),
    ],
)
def test_invalid_table_is_refused(tmp_path: Path, values: dict[str, str], said: str) -> None:
    with fly(tmp_path, WATCHING) as mission:
        mission.run_for(2)
        load(mission, 0, values)
        assert printed(mission) == ["{'mode': 'start'}"]
        assert any(said in text for text in events(mission)), events(mission)


def test_long_text_is_stored_and_too_long_text_is_refused(tmp_path: Path) -> None:
    node = """
        import rospy
        rospy.init_node("n")
        rospy.set_param("/small", 1)
        rospy.set_param("/robot_description", '<robot name="r2">\\n' * 5600)
        try:
            rospy.set_param("/another", "x" * 100000)
        except rospy.ROSException as error:
            print(error)
        print(rospy.has_param("/another"), len(rospy.get_param("/robot_description")))
        rospy.set_param("/robot_description", "none")
        rospy.set_param("/another", "x" * 100000)
        """
    with fly(tmp_path, node) as mission:
        mission.run_for(2)
        error, kept = printed(mission)
        assert error == "the parameter tables are full: /another needs 1250 rows of 2032, 560 are free"
        assert kept == "False 100800"
        reset(mission, PROCESSOR_RESET)
        assert len(mission.ros.graph.params.find("/another")) == 100000


def test_changed_parameters_alone_are_written(tmp_path: Path) -> None:
    node = """
        import rospy
        rospy.init_node("n")
        rospy.set_param("/a", {"x": 1, "y": 2, "z": 3})
        rospy.set_param("/a", {"x": 1, "y": 5})
        rospy.set_param("/a/z/deep", True)
        rospy.delete_param("/a/z/deep")
        rospy.set_param("/b", 1)
        rospy.set_param("/b/c", 2)
        """
    with fly(tmp_path, node) as mission:
        mission.run_for(2)
        assert rows_of(mission) == [("/a/x", "1"), ("/a/y", "5"), ("/a/z", "{}"), ("/b/c", "2")]


def test_restarted_application_has_its_parameters(tmp_path: Path) -> None:
    with fly(tmp_path, WATCHING) as mission:
        mission.run_for(2)
        mission.cfe.es.restart_app(mission.cfe.es.app_named("ROS").app_id)
        mission.run_for(2)
        mission.ros.graph.params.set("/meanwhile", True)
        mission.run_for(5)
        assert "found in the CDS" in events(mission)[-1]
        mission.ros.graph.params.set("/mode", "later")
        mission.run_for(1)
        assert rows_of(mission) == [("/mode", "later"), ("/meanwhile", "true")]


def test_parameters_work_after_the_application_is_deleted(tmp_path: Path) -> None:
    """Then there are no tables that could be full."""
    with fly(tmp_path, WATCHING, board="rx64m") as mission:
        mission.run_for(2)
        params = mission.ros.graph.params
        with pytest.raises(ParametersFull):
            params.set("/long", "x" * 5000)
        mission.cfe.es.delete_app(mission.cfe.es.app_named("ROS").app_id)
        mission.run_for(6)
        params.set("/long", "x" * 5000)
        assert params.find("/long") == "x" * 5000


def test_board_without_memory_keeps_parameters_until_the_reset(tmp_path: Path) -> None:
    with fly(tmp_path, COUNTING, limits={"tbl_max_num_tables": 1, "tbl_max_critical_tables": 1}) as mission:
        mission.run_for(2)
        assert mission.ros.graph.params.find("/n/count") == 1
        assert rows_of(mission) != []
    with fly(tmp_path, COUNTING, limits={"es_max_applications": 6}) as mission:
        mission.run_for(2)
        assert mission.ros.graph.params.find("/n/count") == 1
        assert any("parameters do not outlive a reset" in line for line in mission.console.lines)


def test_small_board_has_one_table(tmp_path: Path) -> None:
    with fly(tmp_path, COUNTING, board="rx64m") as mission:
        mission.run_for(2)
        assert events(mission)[0].endswith("1 tables (new), 0 parameters")
        reset(mission, PROCESSOR_RESET)
        assert mission.ros.graph.params.find("/n/count") == 2
        assert mission.memory.by_owner()["ROS"] > 4000  # its stack; tables are in the pool of CFE_TBL


def test_commands_and_housekeeping_of_the_application(tmp_path: Path) -> None:
    seen: list[Seen] = []
    watch = PacketWatch(seen.append, lambda msg_id: msg_id == HK_TLM.msg_id)
    with fly(tmp_path, COUNTING, attachments=[watch]) as mission:
        mission.run_for(2)
        for packet in (NOOP.packet(), command(NOOP.msg_id, 99), command(NOOP.msg_id, 0, b"long"), SEND_HK.packet()):
            mission.cfe.sb.transmit_msg(packet, is_origination=False)
        mission.run_for(0.1)
        noop, code, length = events(mission)[-3:]
        assert noop.endswith("ROS: No-op command")
        assert code.endswith("ROS: invalid command code: ID = 0x18FD, CC = 99")
        assert "ROS: Invalid msg length" in length
        (housekeeping,) = [HK_TLM.read(packet) for _, packet, _ in seen]
        assert housekeeping == {
            "CommandCounter": 1,
            "CommandErrorCounter": 2,
            "Tables": 16,
            "Parameters": 7,
            "RowsUsed": 7,
            "RowsFree": 2025,
        }
        mission.cfe.sb.transmit_msg(RESET_COUNTERS.packet(), is_origination=False)
        mission.cfe.sb.transmit_msg(SEND_HK.packet(), is_origination=False)
        mission.run_for(0.1)
        assert HK_TLM.read(seen[-1].packet)["CommandErrorCounter"] == 0
