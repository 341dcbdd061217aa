"""The strategies: their values are valid, or invalid in the requested way, and small if they fail."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
from hypothesis import HealthCheck, find, given, settings
from hypothesis import strategies as st

from cfepy.faults import FaultPlan
from cfepy.flight.message_library import library_near
from cfepy.ground.dictionary import dictionary_of, table_type
from cfepy.mission import read_mission
from cfepy.msg import get_msg_id, get_size
from cfepy.schedules.schedule import Schedule
from cfepy.status import UsageError
from cfepy.testing.strategies import fault_plans, messages, packets, schedules, tables
from rospy_shim.types.msgs import message_class

PROBE = Path(__file__).parents[2] / "examples/probe"
COPY_TABLE = table_type("CopyTable", None)
LAB = dictionary_of(read_mission("lab"))
quick = settings(max_examples=25, suppress_health_check=[HealthCheck.too_slow])


@quick
@given(message=messages("nav_msgs/Odometry"))
def test_messages_can_be_sent(message: Any) -> None:
    kind = message_class("nav_msgs/Odometry")
    assert message._md5sum == kind._md5sum
    assert kind.__unpack__(message.__pack__()).__pack__() == message.__pack__()


@quick
@given(message=messages("probe_msgs/Count", near=PROBE / "mission", number=st.just(3)))
def test_messages_of_an_own_package(message: Any) -> None:
    assert (message._type, message.number) == ("probe_msgs/Count", 3)


@quick
@given(message=messages(message_class("std_msgs/Header")))
def test_messages_of_a_class(message: Any) -> None:
    assert type(message) is message_class("std_msgs/Header")


@quick
@given(message=messages(library_near(PROBE / "mission").message_class("probe_msgs/Count")))
def test_messages_of_a_class_of_an_own_package(message: Any) -> None:
    assert 0 <= message.number < 2**32


@quick
@given(pose=messages("geometry_msgs/Pose", position=messages("geometry_msgs/Point", x=st.just(1.0))))
def test_nested_messages_can_be_given(pose: Any) -> None:
    assert pose.position.x == 1.0
    assert len(pose.__pack__()) == 56


@pytest.mark.slow
def test_messages_shrink() -> None:
    found = find(messages("sensor_msgs/JointState"), lambda message: len(message.position) > 1)
    assert found.position == [0.0, 0.0]
    assert (found.name, found.header.frame_id, found.header.stamp.secs) == ([], "", 0)


def test_unknown_message_types_are_refused() -> None:
    with pytest.raises(UsageError, match="no_msgs/Nothing"):
        messages("no_msgs/Nothing")
    with pytest.raises(UsageError, match="date: unknown field of std_msgs/String; did you mean data"):
        messages("std_msgs/String", date=st.text())
    with pytest.raises(UsageError, match="not a ROS message class"):
        messages(int)


@quick
@given(packet=packets("SAMPLE_APP_DISPLAY_PARAM", fields={"ValI16": st.just(-1)}))
def test_packets_by_name(packet: bytes) -> None:
    declared = LAB.commands["SAMPLE_APP_DISPLAY_PARAM"]
    assert (get_msg_id(packet), get_size(packet), len(packet)) == (declared.msg_id, declared.length, declared.length)
    assert declared.read(packet)["ValI16"] == -1
    assert declared.packet(declared.read(packet)) == packet


@quick
@given(packet=packets("HEATER_HK_TLM", mission=str(PROBE / "mission")))
def test_telemetry_of_a_mission(packet: bytes) -> None:
    assert get_msg_id(packet) == 0x08A0


@quick
@given(packet=packets() | packets(0x1882))
def test_packets_of_any_kind(packet: bytes) -> None:
    assert get_size(packet) == len(packet)


@quick
@given(packet=packets("SAMPLE_APP_DISPLAY_PARAM", malformed=True))
def test_malformed_packets_have_a_mistake(packet: bytes) -> None:
    declared = LAB.commands["SAMPLE_APP_DISPLAY_PARAM"]
    assert get_msg_id(packet) == declared.msg_id
    assert get_size(packet) == len(packet)
    assert len(packet) != declared.length or packet[6] == 0x7F


def test_unknown_packets_are_refused() -> None:
    with pytest.raises(
        UsageError, match="unknown command or telemetry packet SAMPLE_APP_NOP; did you mean SAMPLE_APP_NOOP"
    ):
        packets("SAMPLE_APP_NOP")
    with pytest.raises(UsageError, match="invalid MsgId 0x1001"):
        packets(0x1001)
    with pytest.raises(UsageError, match="Val: unknown field of SAMPLE_APP_DISPLAY_PARAM; did you mean ValU32"):
        packets("SAMPLE_APP_DISPLAY_PARAM", fields={"Val": st.just(1)})


@quick
@given(rows=tables("HK.CopyTable", fields={"NumBytes": st.integers(1, 4)}))
def test_tables_match_their_definition(rows: list[dict[str, Any]]) -> None:
    kind = COPY_TABLE
    assert kind.unpack(kind.pack(rows))[: len(rows)] == rows
    assert all(1 <= row["NumBytes"] <= 4 for row in rows)


def test_unknown_tables_are_refused() -> None:
    with pytest.raises(UsageError, match=r"unknown table 'HK\.Copy'; did you mean HK\.CopyTable"):
        tables("HK.Copy")


@quick
@given(schedule=schedules())
def test_schedules_are_valid(schedule: str) -> None:
    assert Schedule.parse(schedule).text() == schedule


def test_schedules_shrink_to_the_deviations_that_matter() -> None:
    found = find(schedules(), lambda schedule: any(at >= 42 for at, _ in Schedule.parse(schedule).deviations))
    assert found == "at:42=1"


@quick
@given(faults=fault_plans(messages=["/odom"], apps=["ARM"]))
def test_fault_plans_are_valid(faults: dict[str, Any]) -> None:
    assert len(FaultPlan.from_dict(faults).faults) == len(faults["faults"])


def test_fault_plans_shrink() -> None:
    assert find(fault_plans(messages=["/odom"]), lambda faults: bool(faults["faults"])) == {
        "faults": [{"drop": "/odom", "number": 1}]
    }


@pytest.mark.slow
def test_fault_plans_of_a_mission_target_its_applications() -> None:
    faults = find(fault_plans(PROBE / "mission"), lambda faults: any("crash" in each for each in faults["faults"]))
    assert faults["faults"][0]["crash"] in ("HEATER", "COUNTER")
    with pytest.raises(UsageError, match="missing target of faults"):
        fault_plans()
