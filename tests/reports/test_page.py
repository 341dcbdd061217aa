"""The page of a run as text: every number is on it, and nothing that a node has said can be more than text."""

from __future__ import annotations

import json
import re
from html.parser import HTMLParser
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from cfepy.reports.collector import Collector
from cfepy.reports.html_text import escaped, json_text, numbers_in
from cfepy.reports.page import About, page_of
from tests.reports import looked_at
from tests.reports.conftest import Shown

VOID = {"meta", "link", "input"}


class Reader(HTMLParser):
    """What is on a page: its elements, its numbers, its JSON."""

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


def test_every_number_of_the_results_is_on_it(shown: Shown) -> None:
    wanted = dict(numbers_in(shown.flown.results.to_dict()))
    assert len(wanted) > 300
    assert Reader(shown.page).numbers == wanted


def test_the_numbers_are_there_for_programs_too(shown: Shown) -> None:
    assert Reader(shown.page).json["numbers"] == json.loads(json.dumps(shown.flown.results.to_dict()))


def test_a_script_and_its_numbers_are_on_it(tmp_path: Path) -> None:
    mission = looked_at.busy_mission(tmp_path)
    script = tmp_path / "noop.script"
    script.write_text("send CFE_ES_NOOP\nat 2 expect app SLOW RUNNING\n")
    collector = Collector()
    flown = looked_at.fly(mission, collector, script=str(script))
    assert flown.outcome is not None
    found = Reader(page_of(flown, collector, About("", "fifo", mission))).numbers
    wanted = dict(numbers_in({"script": flown.outcome.to_dict()}))
    assert wanted
    assert wanted.items() <= found.items()


def test_faults_and_invariants_are_on_it(tmp_path: Path) -> None:
    more = "invariants: {never hello: {topic: /chat, holds: msg.data != 'hello'}}\n"
    mission = looked_at.busy_mission(tmp_path, looked_at.DEADLINES + more)
    plan = tmp_path / "faults.yaml"
    plan.write_text("faults:\n  - {drop: /chat, number: 3}\n  - {drop: /nobody}\n")
    collector = Collector()
    flown = looked_at.fly(mission, collector, faults=str(plan))
    page = page_of(flown, collector, About("", "fifo", mission))
    assert Reader(page).numbers == dict(numbers_in(flown.results.to_dict()))
    assert 'data-path="faults.0.at_s.0"' in page
    assert 'data-path="invariants.0.violated"' in page
    assert {"fault", "invariant", "deadline"} <= {mark.kind for mark in collector.marks}


def test_it_is_well_formed_and_has_one_script_and_no_handlers(shown: Shown) -> None:
    reader = Reader(shown.page)
    assert reader.open == []
    assert reader.handlers == []
    assert reader.tags.count("script") == 3  # two of them are JSON
    assert "img" not in reader.tags
    assert reader.tags.count("h1") == 1
    assert reader.tags.count("caption") == reader.tags.count("table") > 5


def test_nothing_on_it_leads_elsewhere(shown: Shown) -> None:
    assert not re.search(r"https?:|//[a-z]", re.sub(r"<script.*?</script>", "", shown.page, flags=re.DOTALL))
    assert set(re.findall(r'(?:href|src)="([^#"]*)', shown.page)) <= {"data:,", ""}
    assert "default-src 'none'" in shown.page


def test_what_a_node_says_is_text(shown: Shown) -> None:
    assert any(looked_at.NASTY in line for line in shown.flown.mission.console.lines)
    assert escaped(looked_at.NASTY) in shown.page
    assert looked_at.NASTY not in shown.page
    assert "an error &lt;b&gt;of its own&lt;/b&gt;" in shown.page


def test_what_somebody_calls_things_is_text(tmp_path: Path) -> None:
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


def test_it_says_what_it_is_about(shown: Shown) -> None:
    for text in (shown.flown.trace, f"cfepy run --for 3 {shown.mission}", "rx64m", "Python 3.", "fifo"):
        assert escaped(text) in shown.page
    for problem in shown.flown.results.problems:
        assert escaped(problem) in shown.page


@pytest.mark.parametrize(
    "title",
    ["Timeline", "Deadlines", "Messages", "Latency", "Dropped messages", "Applications", "Pipes", "Board budget"],
)
def test_its_parts_can_be_found(shown: Shown, title: str) -> None:
    assert f">{title}</h2>" in shown.page
    assert f">{title}</a>" in shown.page


def test_the_same_run_gives_the_same_page(shown: Shown) -> None:
    collector = Collector()
    flown = looked_at.fly(shown.mission, collector)
    assert page_of(flown, collector, About(f"cfepy run --for 3 {shown.mission}", "fifo", shown.mission)) == shown.page
