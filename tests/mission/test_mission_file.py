"""The table of sections: a run's reading stops at the first mistake, and a check's reading continues."""

from __future__ import annotations

from pathlib import Path

import pytest

from cfepy.mission import MissionSpec, read_mission
from cfepy.mission.mission_file import DEMANDS, SECTIONS, MissionSections, read_mission_file
from cfepy.mission.record import RunRecord
from cfepy.reading.marked_yaml import Mistakes
from cfepy.status import UsageError
from rospy_shim.types.config import RosConfig

WRONG = """\
name: [a]
board: 3
bord: linux
limits: {sb_max_pipes: many, nodes: 0, os_max_tasks: 70}
nodes:
  A: {namespace: robot, args: x, keys: [-1]}
  B: {name: b}
topics:
  /a: {msg_id: 0x0901}
  b: {msg_id: 0x0902}
  /c: {msg_id: 0x0901}
params: {x: }
params_from: nothing.yaml
ordered_sets: maybe
cfe_version: 6.7
compiled: {omit_deprecated: 1, strip: true}
cpp_nodes: {profile: hard, arena_bytes: 3}
connection_delay: 20 parsecs
ros_bridge: {publish: {a: X, /b: {raw: true}, /c: Y}, subscribe: [d, /e], clock: 0, hear: []}
sweep: {rate: fast, topics: [a], points: 3}
launch: [nothing.launch, {args: {}}]
invariants: 3
"""


def read(folder: Path, text: str, mistakes: Mistakes) -> MissionSections:
    (folder / "mission.yaml").write_text(text, encoding="utf-8")
    return read_mission_file(folder / "mission.yaml", mistakes)


def test_check_reports_all_mistakes_and_keeps_valid_sections(tmp_path: Path) -> None:
    mistakes = Mistakes(keep=True)
    said = read(tmp_path, WRONG, mistakes)
    fields = "name board bord limits.sb_max_pipes limits.nodes nodes.A.namespace nodes.A.args nodes.A.keys[0] topics.b "
    fields += "topics./c params.x params_from ordered_sets cfe_version compiled.omit_deprecated compiled.strip "
    fields += "cpp_nodes.profile cpp_nodes.arena_bytes "
    fields += "connection_delay ros_bridge.publish.a ros_bridge.publish./b ros_bridge.subscribe[0] "
    fields += "ros_bridge.clock ros_bridge.hear "
    fields += "sweep.rate sweep.topics[0] sweep.points launch[0] launch[1]"
    assert [error.field for error in mistakes.errors] == fields.split()
    assert (said.name, said.board, said.ordered_sets, said.launch) == (None, None, False, ())
    assert (dict(said.limits.values), list(said.nodes), list(said.topics)) == (
        {"os_max_tasks": 70},
        ["B"],
        ["/a", "/c"],
    )
    assert (list(said.ros_bridge.publish), said.ros_bridge.subscribe) == (["/c"], ("/e",))
    assert list(said.demands) == ["invariants"]
    assert set(said.places) == set(SECTIONS) - {"results", "deadlines", "inversions"}


def test_run_ends_with_the_first_mistake_of_the_file(tmp_path: Path) -> None:
    lines = WRONG.splitlines()
    for first in (0, 2, 4, 7, 12, 14):
        text = "\n" * first + "\n".join(lines[first:])
        kept = Mistakes(keep=True)
        read(tmp_path, text, kept)
        with pytest.raises(UsageError) as caught:
            read(tmp_path, text, Mistakes())
        assert str(caught.value) == str(kept.errors[0])


def test_section_that_is_not_a_mapping_is_refused(tmp_path: Path) -> None:
    for text in ("[1]", "a: {", "nodes: 3", "topics: 3", "limits: 3", "launch: 3"):
        mistakes = Mistakes(keep=True)
        read(tmp_path, text, mistakes)
        assert len(mistakes.errors) == 1, text
    assert read(tmp_path, "", Mistakes()) == MissionSections()


def test_demands_are_kept_unparsed(tmp_path: Path) -> None:
    (tmp_path / "startup.scr").write_text("!", encoding="utf-8")
    text = "invariants: {a: 1}\nresults: {b: 2}\ndeadlines: {c: 3}\ninversions: 4\n"
    (tmp_path / "mission.yaml").write_text(text, encoding="utf-8")
    demands = read_mission(str(tmp_path)).demands
    assert {name: section.plain() for name, section in demands.items()} == dict(
        zip(DEMANDS, ({"a": 1}, {"b": 2}, {"c": 3}, 4), strict=True)
    )


def test_the_startup_script_is_read_once(tmp_path: Path) -> None:
    script = tmp_path / "startup.scr"
    script.write_text(
        "CFE_APP, a, Main, A, 50, 8192, 0, 0;\nCFE_APP, n, __main__, N, 50, 8192, 0, 0;!", encoding="utf-8"
    )
    spec = MissionSpec("m", tmp_path, script, None, "linux", RosConfig())
    assert [entry.name for entry in spec.entries] == ["A", "N"]
    script.unlink()
    assert spec.has_nodes
    assert spec.entries is spec.entries


def test_a_record_has_a_part_for_each_attachment() -> None:
    class Count(list[int]):
        """Counts the calls of an attachment."""

    record, other = RunRecord(), RunRecord()
    record.part(Count).append(1)
    assert (record.part(Count), other.part(Count)) == ([1], [])
    assert record.rows("faults") == []
    record.tables["faults"] = lambda: [{"name": "a"}]
    assert record.rows("faults") == [{"name": "a"}]
