"""A mission file's requirements for a run: one table reads them for a run and for a check."""

from __future__ import annotations

from pathlib import Path

import pytest

from cfepy.mission import MissionSpec, read_mission
from cfepy.monitors.deadline_monitor import DeadlineMonitor
from cfepy.monitors.invariant_watch import InvariantWatch
from cfepy.monitors.run_rules import Demands, demands_of, judges_of, read_demands
from cfepy.reading.mistakes import Mistakes
from cfepy.status import UsageError

GOOD = """\
invariants:
  a: {topic: /a, holds: "True"}
results: {/a: last, HK: output}
deadlines: {apps: {HK: {response: 2 ms}}, topics: {/a: {latency: 1 ms}}}
"""
WRONG = """\
invariants:
  a: {topic: /a}
  b: {topic: b, holds: "True"}
  c: {topic: /c, holds: "True"}
results: {/a: most, /b: last}
deadlines:
  apps: {HK: {response: 2}, SCH: {response: 1 ms}}
  topics: 3
  nodes: {}
"""


def mission(folder: Path, text: str) -> MissionSpec:
    (folder / "startup.scr").write_text("!", encoding="utf-8")
    (folder / "mission.yaml").write_text(text, encoding="utf-8")
    return read_mission(str(folder))


def test_demands_and_their_judges_are_read(tmp_path: Path) -> None:
    spec = mission(tmp_path, GOOD)
    demands = demands_of(spec)
    assert [each.name for each in demands.invariants] == ["a"]
    assert [(each.name, each.compare) for each in demands.results] == [("/a", "last"), ("HK", "output")]
    assert [each.app for each in demands.deadlines.apps] == ["HK"]
    assert [type(each) for each in judges_of(spec)] == [InvariantWatch, DeadlineMonitor]


def test_empty_mission_file_has_no_demands(tmp_path: Path) -> None:
    for text in ("", "results: {/a: last}", "invariants: {}\ndeadlines: {}\n"):
        spec = mission(tmp_path, text)
        assert judges_of(spec) == []
    assert demands_of(mission(tmp_path, "")) == Demands()


def test_check_reports_all_mistakes_and_keeps_valid_demands(tmp_path: Path) -> None:
    mistakes = Mistakes()
    demands = read_demands(mission(tmp_path, WRONG).demands, mistakes)
    fields = "invariants.a invariants.b.topic results./a deadlines.nodes deadlines.topics"
    assert [error.field for error in mistakes.errors] == [*fields.split(), "deadlines.apps.HK.response"]
    assert [each.name for each in demands.invariants] == ["c"]
    assert [each.name for each in demands.results] == ["/b"]
    assert [each.app for each in demands.deadlines.apps] == ["SCH"]


@pytest.mark.parametrize("section", ["invariants: {a: {topic: /a}}", "results: {/a: most}", "deadlines: {apps: 3}"])
def test_mistake_ends_a_run_before_it_boots(tmp_path: Path, section: str) -> None:
    spec = mission(tmp_path, section)
    with pytest.raises(UsageError) as caught:
        judges_of(spec)
    assert (Path(str(caught.value.file)).name, caught.value.line) == ("mission.yaml", 1)
