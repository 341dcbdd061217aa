"""The table of sections: a run raises all mistakes of the file together, and a check collects them."""

from __future__ import annotations

from pathlib import Path

import pytest

from cfepy.mission import MissionSpec, read_mission
from cfepy.mission.mission_file import DEMANDS, SECTIONS, MissionSections, read_mission_file
from cfepy.mission.record import RunRecord
from cfepy.monitors import read_demands
from cfepy.reading.mistakes import Mistakes
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
safe: perhaps
scheduling: unfair
memory: all
epoch: soon
compiled: {omit_deprecated: 1, strip: true}
cpp_nodes: {profile: hard, arena_bytes: 3}
connection_delay: 20 parsecs
ros_bridge: {publish: {a: X, /b: {raw: true}, /c: Y}, subscribe: [d, /e], clock: 0, hear: []}
sweep: {rate: fast, topics: [a], points: 3}
launch: [nothing.launch, {args: {}}]
dictionary: [nothing.xml, 3]
devices: {can0: {udp: 0, to: 1}, can1: {udp: 7, to: 1}, can2: {udp: 7, to: 1}, can3: 1}
invariants: 3
"""


def read(folder: Path, text: str, mistakes: Mistakes) -> MissionSections:
    (folder / "mission.yaml").write_text(text, encoding="utf-8")
    return read_mission_file(folder / "mission.yaml", mistakes)


def test_check_reports_all_mistakes_and_keeps_valid_sections(tmp_path: Path) -> None:
    mistakes = Mistakes()
    said = read(tmp_path, WRONG, mistakes)
    fields = "name board bord limits.sb_max_pipes limits.nodes nodes.A.namespace nodes.A.args nodes.A.keys[0] topics.b "
    fields += "topics./c params.x params_from ordered_sets cfe_version safe scheduling memory epoch "
    fields += "compiled.omit_deprecated compiled.strip "
    fields += "cpp_nodes.profile cpp_nodes.arena_bytes "
    fields += "connection_delay ros_bridge.publish.a ros_bridge.publish./b ros_bridge.subscribe[0] "
    fields += "ros_bridge.clock ros_bridge.hear "
    fields += "sweep.rate sweep.topics[0] sweep.points launch[0] launch[1] dictionary[0] dictionary[1] "
    fields += "devices.can0.udp devices.can2 devices.can3"
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


def test_run_raises_all_mistakes_of_the_file_by_line(tmp_path: Path) -> None:
    kept = Mistakes()
    read(tmp_path, WRONG, kept)
    (tmp_path / "startup.scr").write_text("!", encoding="utf-8")
    with pytest.raises(UsageError) as caught:
        read_mission(str(tmp_path))
    told = caught.value.each
    assert sorted(map(str, kept.errors)) == sorted(each.alone for each in told)
    assert [each.line for each in told] == sorted(each.line or 0 for each in told)
    lines = str(caught.value).splitlines()
    assert lines[0].startswith(f"{tmp_path / 'mission.yaml'}:1: name: must be text")
    assert lines[-1] == f"and {len(told) - 20} more"


def test_several_mistakes_of_one_entry_are_raised_together(tmp_path: Path) -> None:
    text = """\
nodes: {A: {keys: [{}, -1], compute: {f: x, g: y}}}
topics: {/a: {msg_id: big, rawe: true, raw: 3}}
params: {a: null, b: {c: null}}
params_from: [1]
deadlines: {apps: {B: {response: 2, periode: 3}}}
invariants: {x: {topic: a, holds: "1 +", after: soon}, y: {topic: /a, within: x, then: {topc: /a, holds: "mg"}}}
results: {/a: {compare: lst, ignore: [a b, c d]}}
"""
    mistakes = Mistakes()
    read_demands(read(tmp_path, text, mistakes).demands, mistakes)
    fields = "nodes.A.keys[0] nodes.A.keys[1] nodes.A.compute.f nodes.A.compute.g topics./a.rawe topics./a.raw "
    fields += "topics./a.msg_id params.a params.b.c params_from[0] "
    fields += "invariants.x.topic invariants.x.holds invariants.x.after "
    fields += "invariants.y.within invariants.y.then.topc invariants.y.then.holds "
    fields += "results./a.ignore[0] results./a.ignore[1] results./a.compare "
    fields += "deadlines.apps.B.periode deadlines.apps.B.response"
    assert [error.field for error in mistakes.errors] == fields.split()


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("connection_delay: 2024-01-01", "must be a time such as 0.5, 0.5 s or 20 ms, not the date 2024-01-01"),
        ("name: 2024-01-01 10:00:00", "must be text, not the date 2024-01-01 10:00:00; put it in quotes"),
        ("name: [2024-01-01, null, true]", "must be text, not [the date 2024-01-01, nothing, true]; put it in quotes"),
        ("name: !!binary QUJD", "must be text, not bytes; put it in quotes"),
        ("topics: {/a: {msg_id: 2024-01-01}}", "must be a number from 1 to 0x1FFF, not the date 2024-01-01"),
        ("ordered_sets:", "must be true or false, not nothing"),
    ],
)
def test_wrong_value_is_shown_as_in_yaml(tmp_path: Path, text: str, said: str) -> None:
    mistakes = Mistakes()
    read(tmp_path, text, mistakes)
    assert [error.text for error in mistakes.errors] == [said]


def test_section_that_is_not_a_mapping_is_refused(tmp_path: Path) -> None:
    for text in ("[1]", "a: {", "nodes: 3", "topics: 3", "limits: 3", "launch: 3"):
        mistakes = Mistakes()
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
