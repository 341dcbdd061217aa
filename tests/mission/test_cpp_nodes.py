"""The section `cpp_nodes:` of a mission file, as far as it is readable without definitions of messages."""

from __future__ import annotations

from pathlib import Path

import pytest

from cfepy.extra.convert.build import library_folder
from cfepy.mission import ARENA_BYTES, CppNodesConfig, read_sections
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
            "5: cpp_nodes.capacity: unknown field; did you mean capacities? (expected profile, arena_bytes or cap",
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
