"""The page of a run as text: it has every number, and output of nodes is only ever shown as text."""

from __future__ import annotations

import json
import re
from html.parser import HTMLParser
from pathlib import Path
from shutil import copytree, rmtree

import pytest
from hypothesis import given
from hypothesis import strategies as st

from cfepy.cli.main import main
from cfepy.extra.reports.collector import Collector
from cfepy.extra.reports.html_text import json_text, meter, numbers_in
from cfepy.extra.reports.page import About, page_of
from cfepy.ground.series import SeriesRecorder
from cfepy.pilot import RunPlan, pilot
from cfepy.rtos import NotingPolicy
from cfepy.schedules import Move, Schedule
from cfepy.writing.markup import escaped
from tests.extra.reports import looked_at
from tests.extra.reports.conftest import Shown
from tests.mission.flights import write_mission

VOID = {"meta", "link", "input"}


class Reader(HTMLParser):
    """Content of a page: its elements, its numbers, its JSON."""

    def __init__(self, page: str) -> None:
        super().__init__()
        self.tags: list[str] = []
        self.open: list[str] = []
        self.numbers: dict[str, float] = {}
        self.json: dict[str, object] = {}
        self.handlers: list[str] = []
        self._json_id: str | None = None
        self.feed(page)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        about = dict(attrs)
        self.tags.append(tag)
        self.handlers += [name for name in about if name.startswith("on")]
        if tag not in VOID:
            self.open.append(tag)
        if tag == "data":
            self.numbers[about["data-path"] or ""] = json.loads(about["value"] or "")
        if about.get("type") == "application/json":
            self._json_id = about["id"]

    def handle_endtag(self, tag: str) -> None:
        assert self.open.pop() == tag

    def handle_data(self, data: str) -> None:
        if self._json_id is not None:
            self.json[self._json_id] = json.loads(data)
            self._json_id = None


def test_page_has_every_number_of_the_results(shown: Shown) -> None:
    wanted = dict(numbers_in(shown.flown.results.to_dict()))
    assert len(wanted) > 300
    assert Reader(shown.page).numbers == wanted


def test_page_has_the_numbers_as_json(shown: Shown) -> None:
    assert Reader(shown.page).json["numbers"] == json.loads(json.dumps(shown.flown.results.to_dict()))


def test_page_has_a_script_and_its_numbers(tmp_path: Path) -> None:
    mission = looked_at.busy_mission(tmp_path)
    script = tmp_path / "noop.script"
    script.write_text("send CFE_ES_NOOP\nat 2 expect app SLOW RUNNING\n", encoding="utf-8")
    collector = Collector()
    flown = looked_at.fly(mission, collector, script=str(script))
    assert flown.outcome is not None
    found = Reader(page_of(flown, collector, About("", "fifo", mission))).numbers
    wanted = dict(numbers_in({"script": flown.outcome.to_dict()}))
    assert wanted
    assert wanted.items() <= found.items()


def test_page_has_faults_and_invariants(tmp_path: Path) -> None:
    more = "invariants: {never hello: {topic: /chat, holds: msg.data != 'hello'}}\n"
    mission = looked_at.busy_mission(tmp_path, looked_at.DEADLINES + more)
    plan = tmp_path / "faults.yaml"
    plan.write_text("faults:\n  - {drop: /chat, number: 3}\n  - {drop: /nobody}\n", encoding="utf-8")
    collector = Collector()
    flown = looked_at.fly(mission, collector, faults=str(plan))
    page = page_of(flown, collector, About("", "fifo", mission))
    assert Reader(page).numbers == dict(numbers_in(flown.results.to_dict()))
    assert 'data-path="faults.0.at_s.0"' in page
    assert 'data-path="invariants.0.violated"' in page
    assert {"fault", "invariant", "deadline"} <= {mark.kind for mark in collector.marks}


def test_page_is_well_formed_and_has_one_script_and_no_handlers(shown: Shown) -> None:
    reader = Reader(shown.page)
    assert reader.open == []
    assert reader.handlers == []
    assert reader.tags.count("script") == 4  # three of them are JSON
    assert "img" not in reader.tags
    assert reader.tags.count("h1") == 1
    assert reader.tags.count("caption") == reader.tags.count("table") > 5


def test_page_has_no_external_links(shown: Shown) -> None:
    assert not re.search(r"https?:|//[a-z]", re.sub(r"<script.*?</script>", "", shown.page, flags=re.DOTALL))
    assert set(re.findall(r'(?:href|src)="([^#"]*)', shown.page)) <= {"data:,", ""}
    assert "default-src 'none'" in shown.page


def test_output_of_a_node_is_escaped(shown: Shown) -> None:
    assert any(looked_at.NASTY in line for line in shown.flown.mission.console.lines)
    assert escaped(looked_at.NASTY) in shown.page
    assert looked_at.NASTY not in shown.page
    assert "an error &lt;b&gt;of its own&lt;/b&gt;" in shown.page


def test_names_of_mission_and_source_are_escaped(tmp_path: Path) -> None:
    """The mission's name and its source can hold anything as well."""
    mission = looked_at.busy_mission(tmp_path, looked_at.DEADLINES + f"name: {json.dumps(looked_at.NASTY)}\n")
    collector = Collector()
    flown = looked_at.fly(mission, collector, seconds=1)
    page = page_of(flown, collector, About(looked_at.NASTY, looked_at.NASTY, looked_at.NASTY, (looked_at.NASTY,)))
    reader = Reader(page)
    assert looked_at.NASTY not in page
    assert reader.open == []
    assert "img" not in reader.tags


@given(st.text())
def test_any_text_stays_text(text: str) -> None:
    for form in (escaped(text), json_text({"text": text})):
        assert "<" not in form
        assert ">" not in form
        assert not re.search(r"[\x00-\x08\x0b\x0c\x0e-\x1f\x7f]", form)
    assert json.loads(json_text({"text": text})) == {"text": text}


def test_page_has_trace_command_board_and_problems(shown: Shown) -> None:
    for text in (shown.flown.trace, f"cfepy run --for 3 {shown.mission}", "rx64m", "Python 3.", "fifo"):
        assert escaped(text) in shown.page
    for problem in shown.flown.results.problems:
        assert escaped(problem) in shown.page


@pytest.mark.parametrize(
    "title",
    ["Timeline", "Deadlines", "Messages", "Latency", "Dropped messages", "Applications", "Pipes", "Board budget"],
)
def test_page_has_a_link_to_each_section(shown: Shown, title: str) -> None:
    assert f">{title}</h2>" in shown.page
    assert f">{title}</a>" in shown.page


def test_equal_runs_give_equal_pages(shown: Shown) -> None:
    collector, recorder = Collector(), SeriesRecorder()
    flown = looked_at.fly(shown.mission, collector, recorder)
    about = About(f"cfepy run --for 3 {shown.mission}", "fifo", shown.mission)
    assert page_of(flown, collector, about, recorder) == shown.page


def items(page: str) -> list[str]:
    """Return the lines of the problem box, as text."""
    box = page.partition('class="banner')[2].partition("</div>")[0]
    return [re.sub("<[^>]*>", "", item) for item in re.findall("<li.*?</li>", box)]


def test_each_problem_has_its_time(shown: Shown) -> None:
    texts = items(shown.page)
    assert [text.partition(" s: ")[2] for text in texts] == [escaped(each) for each in shown.flown.results.problems]
    first = {each.owner: each.first_at_s for each in shown.flown.results.deadlines if each.overruns}
    assert any(text.startswith(f"{at_s:.6f} s: {owner} missed") for owner, at_s in first.items() for text in texts)
    event = next(event for event in shown.collector.events if event.type_name == "ERROR" and event.app == "SLOW")
    assert f"{event.at_ns / 1e9:.6f} s: SLOW sent 1 ERROR or CRITICAL event" in texts


DIES = """\
def main(cfe):
    cfe.es.wait_for_startup_sync(1000)
    cfe.os.task_delay(300)
    raise ValueError("boom")
"""
EXITS = """\
def main(cfe):
    cfe.es.wait_for_startup_sync(1000)
    cfe.os.task_delay(200)
    cfe.es.exit_app(3)
"""


def test_deaths_bad_ends_and_failed_steps_have_their_times(tmp_path: Path) -> None:
    startup = "CFE_APP, dies, main, DIES, 50, 16384, 0x0, 0;\nCFE_APP, exits, main, EXITS, 50, 16384, 0x0, 0;\n!\n"
    mission = write_mission(tmp_path, startup, dies=DIES, exits=EXITS)
    script = tmp_path / "script.txt"
    script.write_text("expect event DIES 1 within 1\n", encoding="utf-8")
    collector = Collector()
    flown = looked_at.fly(mission, collector, seconds=2, script=str(script))
    booted_s = flown.results.booted_s
    assert booted_s is not None
    texts = items(page_of(flown, collector, About("", "fifo", mission)))
    assert len(texts) == 3
    assert re.match(rf"{booted_s + 0.3:.2f}\d+ s: DIES died: ValueError: boom", texts[0])
    assert re.match(rf"{booted_s + 0.2:.2f}\d+ s: EXITS ended with CFE_ES_RunStatus_APP_ERROR", texts[1])
    assert re.match(r"1\.\d+ s: step .*script\.txt:1 failed: expect event DIES 1", texts[2])


def test_the_switches_of_a_schedule_are_marked(tmp_path: Path) -> None:
    """These are the switches of an `at:` schedule, the form of a shrunk one. Marking them changes nothing."""
    mission = str(Path(__file__).parents[2] / "quality" / "missions" / "lost_update")
    noting = NotingPolicy(Schedule.parse("random:0").policy())
    before = pilot.fly(RunPlan((mission,), seconds=1.3), policy=noting)
    plan = RunPlan((mission,), seconds=1.3, schedule=Schedule().at(noting.deviations))
    collector, inner = Collector(), plan.schedule.policy()
    assert inner is not None
    flown = pilot.fly(plan, attachments=[collector], policy=collector.policy(inner))
    assert flown.results.trace == before.results.trace
    switches = [mark for mark in collector.marks if mark.kind == "switch"]
    assert [mark.at_ns for mark in switches] == [moment.now for moment in noting.moments]
    for mark, moment in zip(switches, noting.moments, strict=True):
        assert Move.parse(mark.text.partition("(move ")[2][:-1]).chosen in moment.chosen
        assert f"{moment.instead_of} is preempted by {moment.chosen}" in mark.text or not moment.preemption
    assert any("odometer.py:" in mark.text for mark in switches)
    page = page_of(flown, collector, About("", plan.schedule.text(), mission))
    assert f"The schedule made {len(switches)} switches in this run:" in page
    assert any("is preempted by" in text for text in items(page))


@pytest.mark.slow
def test_failure_is_shown_as_a_story_with_its_switch(tmp_path: Path) -> None:
    """The run has a shrunk schedule. The problem links to the story, and the switch is marked."""
    mission, page = str(Path(__file__).parents[2] / "quality" / "missions" / "lock_order"), tmp_path / "report.html"
    words = ["report", mission, "--for", "1.3", "--tasks", "greenlet", "-o", str(page)]
    assert main([*words, "--schedule", "moves:MAPPER.scan@660/on_scan.__enter__/2=MAPPER.odom"]) == 0
    text = page.read_text(encoding="utf-8")
    assert '<a href="#story">What happened</a>: MAPPER.scan.1 holds self.map_lock (mapper.py:11) and waits' in text
    assert '<strong class="switch">=== PREEMPTED by MAPPER.odom.2 ===</strong>' in text
    assert main([*words, "--schedule", "moves:MAPPER.scan@660/on_scan.__enter__=MAPPER.odom"]) == 0  # does not fail
    assert "What happened" not in page.read_text(encoding="utf-8")


@pytest.mark.slow
def test_page_of_a_journal_has_the_story_and_a_title(tmp_path: Path) -> None:
    """The files of the mission come from the journal: the mission's own folder is gone."""
    mission, journal, page = tmp_path / "bug", tmp_path / "race.cfepy", tmp_path / "report.html"
    copytree(Path(__file__).parents[2] / "quality" / "missions" / "lost_update", mission)
    moves = "moves:ODOMETER.left_tic@670/on_ticks.publish/4=ODOMETER.right_ti"
    main(["run", str(mission), "--for", "1.3", "--quiet", "--schedule", moves, "--record", str(journal)])
    rmtree(mission)
    assert main(["report", str(journal), "-o", str(page)]) == 0
    text = page.read_text(encoding="utf-8")
    assert "<h1>race.cfepy: WHEELS ended with exit status 1 (node /wheels): the wheels made " in text
    assert '<a href="#story">What happened</a>: an update of Odometer.travelled is lost' in text
    assert 'data-task="ODOMETER.right_ti.2">writes Odometer.travelled</span>' in text


def test_title_has_the_mission_and_the_first_problem(shown: Shown) -> None:
    first, *others = shown.flown.problems
    text = escaped(first.text.splitlines()[0])
    assert f"<h1>{shown.flown.results.mission}: {text[:40]}" in shown.page
    assert f", and {len(others)} more</h1>" in shown.page


def test_share_without_a_limit_has_no_colour() -> None:
    assert 'class="meter raised"' in meter(0.9, "")
    assert 'class="meter"' in meter(0.9, "", has_limit=False)
