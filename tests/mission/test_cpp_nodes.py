"""The section `cpp_nodes:` of a mission file, as far as it is readable without definitions of messages."""

from __future__ import annotations

from pathlib import Path

import pytest

from cfepy.extra.convert.build import library_folder
from cfepy.mission import ARENA_BYTES, CppNodesConfig, NodeGround, read_mission, read_sections
from cfepy.status import UsageError

SECTION = """cpp_nodes:
  profile: strict
  arena_bytes: 65536
  capacities:
    text: 20
    array: 30
    sensor_msgs/JointState: {name: 7, "name[]": 12}
    tf2_msgs/TFMessage:
      transforms: 4
"""


def read(folder: Path, text: str) -> CppNodesConfig:
    (folder / "mission.yaml").write_text(text, encoding="utf-8")
    return read_sections(str(folder / "mission.yaml")).cpp_nodes


def test_cpp_nodes_section_is_read(tmp_path: Path) -> None:
    said = read(tmp_path, SECTION)
    assert (said.profile, said.arena_bytes, said.text, said.array) == ("strict", 65536, 20, 30)
    assert said.capacities == {
        "sensor_msgs/JointState.name": 7,
        "sensor_msgs/JointState.name[]": 12,
        "tf2_msgs/TFMessage.transforms": 4,
    }
    assert said.places["tf2_msgs/TFMessage.transforms"].line == 9
    assert read(tmp_path, "cpp_nodes:\n") == read(tmp_path, "name: x\n") == CppNodesConfig()


@pytest.mark.parametrize(
    ("old", "new", "error"),
    [
        ("strict", "tight", "2: cpp_nodes.profile: unknown profile 'tight'; expected host, pool or strict"),
        ("65536", "0", "3: cpp_nodes.arena_bytes: must be a whole number of at least 4096, not 0"),
        ("65536", "8 GiB", "3: cpp_nodes.arena_bytes: must be a whole number"),
        ("text: 20", "text: true", "5: cpp_nodes.capacities.text: must be a whole number of at least 1, not true"),
        ("name: 7", "name: -7", "7: cpp_nodes.capacities.sensor_msgs/JointState.name: must be a whole"),
        (
            "name: 7",
            "name: 16777216",
            "7: cpp_nodes.capacities.sensor_msgs/JointState.name: must be at most ",
        ),
        ("sensor_msgs/J", "J", "7: cpp_nodes.capacities.JointState: is not a message type; write it with its package"),
        (
            "  capacities",
            "  capacity",
            "5: cpp_nodes.capacity: unknown field; did you mean capacities? (expected profile, arena_bytes, cap",
        ),
    ],
)
def test_errors_of_the_section_have_their_line(tmp_path: Path, old: str, new: str, error: str) -> None:
    with pytest.raises(UsageError) as caught:
        read(tmp_path, SECTION.replace(old, new))
    assert str(caught.value).startswith(f"{tmp_path}/mission.yaml:{error}")


def test_library_has_the_same_default_arena() -> None:
    assert f"#define ROSCFE_ARENA_BYTES {ARENA_BYTES}\n" in (library_folder() / "src/heap.cpp").read_text(
        encoding="utf-8"
    )


GROUND = """cpp_nodes:
  ground:
    /arm/talker: {msg_id: 0x0A10, performance_id: 40}
    /listener: {msg_id: 0x0A11}
"""


def test_ground_of_nodes_is_read(tmp_path: Path) -> None:
    said = read(tmp_path, GROUND)
    assert said.ground == {"/arm/talker": NodeGround(0x0A10, 40), "/listener": NodeGround(0x0A11)}


@pytest.mark.parametrize(
    ("old", "new", "error"),
    [
        ("0x0A11", "0x0A10", "4: cpp_nodes.ground./listener: the MsgId 0x0A10 is already used by /arm/talker; change"),
        (
            "0x0A11",
            "0x1A11",
            "4: cpp_nodes.ground./listener.msg_id: must be a MsgId of telemetry, from 0x0801 to 0x0FFF, not 0x1A11",
        ),
        (
            "0x0A11",
            "0x0700",
            "4: cpp_nodes.ground./listener.msg_id: must be a MsgId of telemetry, from 0x0801 to 0x0FFF, not 0x0700",
        ),
        ("msg_id: 0x0A11", "", "4: cpp_nodes.ground./listener: missing msg_id; add it, such as `msg_id: 0x0A10`"),
        ("/listener", "listener", "4: cpp_nodes.ground.listener: invalid node name 'listener'; write its full name"),
        (
            "performance_id: 40",
            "performance_id: 128",
            "3: cpp_nodes.ground./arm/talker.performance_id: must be at most",
        ),
        ("performance_id", "perf_id", "3: cpp_nodes.ground./arm/talker.perf_id: unknown field; "),
    ],
)
def test_mistakes_in_the_ground_of_nodes_are_named(tmp_path: Path, old: str, new: str, error: str) -> None:
    with pytest.raises(UsageError) as caught:
        read(tmp_path, GROUND.replace(old, new))
    assert error in str(caught.value)


def mission_with(folder: Path, text: str, lock: str = "") -> str:
    (folder / "startup.scr").write_text("!\n", encoding="utf-8")
    (folder / "mission.yaml").write_text(text, encoding="utf-8")
    if lock:
        (folder / "topics.lock").write_text(lock, encoding="utf-8")
    return str(folder)


def test_ground_of_a_node_takes_its_msg_id_from_topics_and_services(tmp_path: Path) -> None:
    spec = read_mission(mission_with(tmp_path, GROUND))
    assert spec.ros.locked_services == {"/arm/talker/ground": 0x0A10, "/listener/ground": 0x0A11}


@pytest.mark.parametrize(
    ("more", "lock", "error"),
    [
        (
            "topics:\n  /pulse: {msg_id: 0x0A10}\n",
            "",
            "mission.yaml: cpp_nodes.ground: the MsgId 0x0A10 of /arm/talker",
        ),
        (
            "",
            "topics:\n  /pulse: 0x0A11\n",
            "topics.lock: cpp_nodes.ground: the MsgId 0x0A11 of /listener belongs to /pu",
        ),
    ],
)
def test_ground_of_a_node_cannot_have_the_msg_id_of_a_topic(tmp_path: Path, more: str, lock: str, error: str) -> None:
    with pytest.raises(UsageError) as caught:
        read_mission(mission_with(tmp_path, GROUND + more, lock))
    assert error in str(caught.value)


def test_a_locked_msg_id_of_the_ground_gives_way_to_that_of_the_mission_file(tmp_path: Path) -> None:
    lock = "services:\n  /listener/ground: 0x0A50\n"
    assert read_mission(mission_with(tmp_path, GROUND, lock)).ros.locked_services["/listener/ground"] == 0x0A11
