"""The display of the library's objects in a notebook."""

from __future__ import annotations

import re
from html.parser import HTMLParser
from pathlib import Path

import pytest

import cfepy
from cfepy.writing import markup
from dev.pages import notebook

FAILS = """
import rospy

rospy.init_node("fails")
print("<b>about to fail</b>")
raise ValueError("<i>no wheels</i>")
"""


class Balanced(HTMLParser):
    """Keeps the elements that are open, and counts those that there were."""

    def __init__(self, page: str) -> None:
        super().__init__()
        self.open: list[str] = []
        self.seen: list[str] = []
        self.feed(page)
        self.close()

    def handle_starttag(self, tag: str, attrs: object) -> None:
        self.open.append(tag)
        self.seen.append(tag)

    def handle_endtag(self, tag: str) -> None:
        assert self.open.pop() == tag


def words(page: str) -> list[str]:
    """Return the visible text, one piece at a time."""
    html = Balanced(page)
    assert html.open == []
    return [text for text in re.split(r"<[^>]*>", page) if text]


def test_a_run() -> None:
    run = cfepy.run("capture", seconds=1, seed=3, tasks="greenlet")
    shown = words(run._repr_html_())
    assert shown[:2] == ["capture", ": " + shown[1][2:]]
    assert shown[1].startswith(": 1.000 virtual s, seed 3, board linux, greenlet tasks, ")
    assert shown[2] == f"trace {run.trace}"
    sent, dropped = sum(row.sent for row in run.topics), sum(row.dropped for row in run.topics)
    assert shown[3].startswith("Messages: ")
    assert shown[3].endswith(f" topics and packets, {sent:,} sent, {dropped:,} dropped")
    busiest = max(run.topics, key=lambda row: row.sent)
    assert shown[12:14] == [f"0x{busiest.msg_id:04X}", busiest.name]
    assert "Applications: 7 RUNNING" in shown
    assert any(text.startswith("Console: the last 30 of ") for text in shown)


def test_failed_run_shows_its_failure_first(tmp_path: Path) -> None:
    (tmp_path / "fails.py").write_text(FAILS, encoding="utf-8")
    run = cfepy.run(tmp_path / "fails.py", seconds=1, tasks="greenlet")
    page = run._repr_html_()
    shown = words(page)
    assert shown[2 : 2 + len(run.problems)] == [markup.escaped(each) for each in run.problems]
    assert "&lt;i&gt;no wheels" in page
    assert "&lt;b&gt;about to fail" in page
    assert not {"i"} & set(Balanced(page).seen)


def test_a_flight() -> None:
    with cfepy.boot("lab", tasks="greenlet") as flight:
        assert "flies" in words(flight._repr_html_())[1]
        flight.run_for(1)
        shown = words(flight._repr_html_())
        assert shown[1] == ": 1.000 virtual s, seed 0, board linux, greenlet tasks, flies"
        assert not [text for text in shown if text.startswith("trace ")]
        series = words(flight.topic("CFE_EVS_LONG_EVENT_MSG")._repr_html_())
        assert series[:2] == ["CFE_EVS_LONG_EVENT_MSG", f": {len(flight.events)} packets of telemetry"]
        assert series[2:6] == ["field", "unit", f"at {flight.events[0].at_ns / 1e9:.3f} s", series[5]]
        assert "PacketID.AppName" in series


@pytest.mark.slow
def test_an_exploration() -> None:
    mission = Path(__file__).parents[1] / "quality/missions/lost_update"
    found = cfepy.explore(mission, seeds=3, seconds=1, jobs=1, shrink=20)
    shown = words(found._repr_html_())
    assert shown[:2] == [str(mission), f": 3 schedules, {found.failed} failed"]
    (failure,) = found.failures
    assert [markup.escaped(failure.title), markup.escaped(failure.command)] == [shown[2], shown[5]]
    assert shown[4] == f": {failure.about}"
    assert f"the shortest is {failure.schedule}" in failure.about
    assert words(failure._repr_html_()) == shown[2:]
    assert "PREEMPTED" in failure._repr_html_()


@pytest.mark.slow
def test_exploration_can_end_when_schedules_bring_nothing_new() -> None:
    mission = Path(__file__).parents[1] / "quality/missions/lost_update"
    found = cfepy.explore(mission, seeds="auto", seconds=1, jobs=1, shrink=0)
    switches = found.to_dict()["breadth"]["switches"]
    assert found.schedules == switches["schedules"] >= switches["last_new"] + 50


def test_long_tables_are_folded() -> None:
    rows = [(f"topic {number}", number) for number in range(markup.MOST + 5)]
    page = markup.rows_of(("name", "sent"), rows)
    shown = words(page)
    few = markup.FEW
    assert shown[2 : 2 + 2 * few : 2] == [name for name, _ in rows[:few]]
    assert shown[2 + 2 * few] == f"{markup.MOST - few} more, 5 left out"
    assert Balanced(page).seen.count("tr") == markup.MOST + 2
    assert 'text-align: right">99<' in page
    assert markup.rows_of(("name",), []) == markup.folded("nothing", "") == ""


@pytest.mark.parametrize("text", ["<script>", "a & b", '"', "\x00\x1b", "\ud800"])
def test_nothing_of_a_mission_is_html(text: str) -> None:
    for shown in (markup.headline(text, text), markup.trouble(text), markup.code(text), markup.lines_of([text])):
        shown.encode()
        assert text not in words(shown) or text == markup.escaped(text)


@pytest.mark.slow
def test_notebook_of_the_documentation_is_up_to_date(tmp_path: Path) -> None:
    pytest.importorskip("nbclient")
    nbformat = pytest.importorskip("nbformat")
    committed = nbformat.read(notebook.FILE, as_version=4)
    executed = notebook.executed(str(tmp_path))
    assert notebook.texts(executed) == notebook.texts(committed), "python -m dev.pages.notebook"
    kinds = [set(output.get("data", ())) for cell in executed.cells for output in cell.get("outputs", ())]
    assert sum("image/png" in kind for kind in kinds) == 1
    assert sum("text/html" in kind for kind in kinds) >= 3
