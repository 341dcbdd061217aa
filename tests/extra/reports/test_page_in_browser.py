"""The page of a run in a real browser: it loads without an error or a request, and its controls work."""

from __future__ import annotations

import json
import os
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from cfepy.cli.main import main
from cfepy.extra.reports.collector import Collector
from cfepy.extra.reports.html_text import numbers_in
from cfepy.extra.reports.page import About, page_of
from cfepy.extra.reports.page_story import PageStory, StoryRow
from cfepy.ground.series import SeriesRecorder
from dev.pages.browser import Browser, find_browser
from tests.extra.reports import looked_at
from tests.extra.reports.conftest import Shown
from tests.mission.flights import write_mission

NEEDS = "needs a browser: install the package chromium"
IS_REQUIRED = os.environ.get("CFEPY_BROWSER") == "required"  # .ci/run sets this if it has installed one
pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(find_browser() is None and not IS_REQUIRED, reason=NEEDS),
]


@pytest.fixture(scope="module")
def browser(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Browser]:
    assert find_browser() is not None, NEEDS
    with Browser(tmp_path_factory.mktemp("profile")) as found:
        found.resize(1280, 900)
        yield found


@pytest.fixture
def opened(browser: Browser, shown: Shown, tmp_path: Path) -> Browser:
    """The page of the common flight, freshly loaded."""
    page = tmp_path / "report.html"
    page.write_text(shown.page, encoding="utf-8")
    browser.errors.clear()
    browser.resize(1280, 900)
    browser.open(page)
    return browser


def shown_range(browser: Browser) -> tuple[int, int]:
    text = "JSON.stringify({...document.getElementById('timeline-range').dataset})"
    about: dict[str, Any] = json.loads(browser.evaluate(text))
    return int(about["from"]), int(about["to"])


def test_page_loads_without_an_error_or_a_request(opened: Browser) -> None:
    assert opened.evaluate("document.title") == opened.evaluate("document.querySelector('h1').innerText")
    assert opened.errors == []
    assert opened.requests == []


def test_browser_reports_errors_and_requests_of_a_page(browser: Browser, tmp_path: Path) -> None:
    """Or the test above could not fail."""
    page = tmp_path / "bad.html"
    page.write_text("<link rel=icon href='data:,'><img src='other.png'><script>nothing()</script>", encoding="utf-8")
    browser.errors.clear()
    browser.open(page)
    assert [url.rsplit("/", 1)[1] for url in browser.requests if not url.startswith("data:")] == ["other.png"]
    assert any("nothing is not defined" in error for error in browser.errors)


def test_page_shows_the_numbers_of_the_results(opened: Browser, shown: Shown) -> None:
    pairs = (
        "[...document.querySelectorAll('data')].map(each => [each.dataset.path, Number(each.value), each.innerText])"
    )
    found = {path: (value, text) for path, value, text in opened.evaluate(pairs)}
    wanted = dict(numbers_in(shown.flown.results.to_dict()))
    assert {path: value for path, (value, _) in found.items()} == wanted
    assert all(text.strip() for _, text in found.values()), "a number that nobody sees"


def test_output_of_a_node_executes_nothing(opened: Browser) -> None:
    assert opened.evaluate("document.title") != "owned"
    assert opened.evaluate("document.images.length") == 0
    assert "<img src=x" in opened.evaluate("document.getElementById('console').innerText")


def show_all(browser: Browser) -> None:
    browser.evaluate("document.getElementById('timeline-all').click()")


def test_page_opens_on_the_first_problem(opened: Browser) -> None:
    at = int(opened.evaluate("document.querySelector('.banner a[data-at]').dataset.at"))
    begin, end = shown_range(opened)
    show_all(opened)
    assert begin < at < end
    assert end - begin < shown_range(opened)[1] / 10


def test_the_timeline_zooms_and_moves(opened: Browser) -> None:
    show_all(opened)
    begin, end = shown_range(opened)
    assert begin == 0
    assert end >= 3_000_000_000
    pixels = "document.getElementById('timeline-canvas').toDataURL()"
    before = opened.evaluate(pixels)
    opened.evaluate("document.getElementById('timeline-in').click()")
    first = shown_range(opened)
    assert first[1] - first[0] == pytest.approx((end - begin) / 2, rel=0.01)
    assert opened.evaluate(pixels) != before
    opened.evaluate("document.getElementById('timeline-right').click()")
    assert shown_range(opened)[0] > first[0]
    opened.evaluate("document.getElementById('timeline-all').click()")
    assert shown_range(opened) == (begin, end)
    assert opened.evaluate(pixels) == before


def test_timeline_zooms_at_the_mouse(opened: Browser) -> None:
    opened.evaluate("document.getElementById('timeline-canvas').scrollIntoView({behavior: 'instant'})")
    show_all(opened)
    place = "(r => [r.left, r.top, r.width])(document.getElementById('timeline-canvas').getBoundingClientRect())"
    left, top, width = opened.evaluate(place)
    begin, end = shown_range(opened)
    opened.wheel(int(left + width - 20), int(top + 80), -100)
    turned = "new Promise(done => requestAnimationFrame(() => setTimeout(done, 50)))"
    opened.evaluate(turned)
    now = shown_range(opened)
    assert now[1] - now[0] < end - begin
    assert now[0] - begin > end - now[1], "what is under the mouse stays where it is"


def test_timeline_shows_drawn_pixels(opened: Browser) -> None:
    show_all(opened)
    colors = """(() => {
        const canvas = document.getElementById('timeline-canvas');
        const data = canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height).data;
        const seen = new Set();
        for (let at = 0; at < data.length; at += 4) seen.add(data[at] << 16 | data[at + 1] << 8 | data[at + 2]);
        return seen.size;
    })()"""
    assert opened.evaluate(colors) > 20


def test_keys_work_on_the_timeline(opened: Browser) -> None:
    show_all(opened)
    begin, end = shown_range(opened)
    press = "document.getElementById('timeline-canvas').dispatchEvent(new KeyboardEvent('keydown', {key: '+'}))"
    opened.evaluate(press)
    assert shown_range(opened)[1] - shown_range(opened)[0] < end - begin


def test_fields_that_change_are_drawn_at_first(opened: Browser) -> None:
    assert not opened.evaluate("document.getElementById('values-canvas').hidden")
    checked = "[...document.querySelectorAll('.fields input:checked')].length"
    assert opened.evaluate(checked) == opened.evaluate("chosen.size") > 0
    assert opened.evaluate("[...chosen].every(group => group.lines.some(line => line.data !== undefined))")


def test_chosen_field_is_drawn(opened: Browser, shown: Shown) -> None:
    show_all(opened)
    is_hidden = "document.getElementById('values-canvas').hidden"
    opened.evaluate("document.querySelectorAll('.fields input:checked').forEach(box => box.click())")
    assert opened.evaluate(is_hidden)
    name = "CFE_EVS_LONG_EVENT_MSG"
    opened.evaluate(f"""(() => {{
        const parts = [...document.querySelectorAll('.fields details')];
        const part = parts.find(part => part.textContent.startsWith('{name}'));
        part.open = true;
        part.querySelector('input').click();
    }})()""")
    assert not opened.evaluate(is_hidden)
    drawn = """(() => {
        const canvas = document.getElementById('values-canvas'), seen = new Set();
        const data = canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height).data;
        for (let at = 0; at < data.length; at += 4) seen.add(data[at] << 16 | data[at + 1] << 8 | data[at + 2]);
        return seen.size;
    })()"""
    assert opened.evaluate(drawn) > 10
    found = f"""(group => [group.lines.map(line => line.name), linesOf(group).map(line => [...line.values]),
        [...group.times]])(groups.find(group => group.series.name === '{name}'))"""
    names, values, times = opened.evaluate(found)
    series = shown.recorder.series(name)
    assert names == [f"PacketID.{each}" for each in ("EventID", "EventType", "SpacecraftID", "ProcessorID")]
    assert values == [series.to_numpy(each).values.tolist() for each in names]
    assert times == [round(each / 1000) * 1000 for each in series.times_ns.tolist()]


def test_fields_are_found_by_words(opened: Browser) -> None:
    rows = "[...document.querySelectorAll('.fields label')]"
    visible = f"{rows}.filter(row => row.offsetHeight).map(row => row.textContent)"
    opened.evaluate("""(field => { field.value = 'long_event packetid'; field.dispatchEvent(new Event('input')); })(
        document.getElementById('values-filter'))""")
    assert opened.evaluate(visible) == ["PacketID[4]"]


def test_the_time_of_a_problem_leads_to_the_timeline(opened: Browser, shown: Shown) -> None:
    link = "document.querySelector('.banner a[data-at]')"
    at = int(opened.evaluate(f"{link}.dataset.at"))
    assert at in {round((each.first_at_s or 0) * 1e9) for each in shown.flown.results.deadlines} | set(
        shown.collector.first_errors.values()
    )
    opened.evaluate(f"{link}.click()")
    begin, end = shown_range(opened)
    assert begin <= at <= end
    assert end - begin < shown.collector.end_ns / 10
    assert opened.evaluate("document.location.hash") == "#timeline"


def test_problem_links_to_its_story_and_the_story_to_the_timeline(
    browser: Browser, shown: Shown, tmp_path: Path
) -> None:
    rows = [StoryRow(1_000_000_000, 0, "a.py:1: go()"), StoryRow(1_000_000_001, 0, "=== PREEMPTED by B ===", True)]
    story = PageStory(
        "B got in", ("A", "B"), [*rows, StoryRow(1_000_000_001, 1, "has lock"), StoryRow(None, None, "x 4")], ""
    )
    page = tmp_path / "story.html"
    page.write_text(
        page_of(shown.flown, shown.collector, About("", "at:1=1", shown.mission, (), story)), encoding="utf-8"
    )
    browser.errors.clear()
    browser.open(page)
    assert browser.errors == []
    browser.evaluate("document.querySelector('.banner a[href=\"#story\"]').click()")
    assert browser.evaluate("document.location.hash") == "#story"
    cells = "[...document.querySelectorAll('.story tbody tr')].map(row => [...row.cells].map(each => each.innerText))"
    assert browser.evaluate(cells)[1:] == [
        ["1.000000", "=== PREEMPTED by B ===", ""],
        ["1.000000", "", "has lock"],
        ["", "x 4", ""],
    ]
    browser.evaluate("document.querySelector('.story a[data-at]').click()")
    begin, end = shown_range(browser)
    assert begin <= 1_000_000_000 <= end


RACE = "moves:ODOMETER.left_tic@670/on_ticks.publish/4=ODOMETER.right_ti"


def test_race_of_a_journal_is_shown_exactly_and_fits_the_window(browser: Browser, tmp_path: Path) -> None:
    mission = str(Path(__file__).parents[2] / "quality" / "missions" / "lost_update")
    journal, page = tmp_path / "race.cfepy", tmp_path / "race.html"
    main(["run", mission, "--for", "1.3", "--quiet", "--schedule", RACE, "--record", str(journal)])
    assert main(["report", str(journal), "-o", str(page)]) == 0
    browser.resize(1280, 900)
    browser.errors.clear()
    browser.open(page)
    assert browser.errors == []
    begin, end = shown_range(browser)
    assert begin <= 670_012_000 < 670_014_000 <= end, "the switch, and the callbacks around it"
    assert end - begin <= 40_000
    spans = "shownExactly(40).flatMap(range => range.lanes[lanes.findIndex(lane => lane.name === 'ODOMETER')])"
    found = browser.evaluate(f"{spans}.filter(([begin]) => begin >= view.from && begin <= view.to)")
    assert found
    assert all(begin <= first <= last <= end for first, last in found)
    overflow = "[...document.querySelectorAll('#story .scroll')].map(box => box.scrollWidth - box.clientWidth)"
    for width in (1280, 500):
        browser.resize(width, 900)
        assert browser.evaluate(overflow) == [0]
    acts = "[...document.querySelectorAll('.story .act')].map(act => getComputedStyle(act, '::before').content)"
    assert browser.evaluate(f"{acts}.some(text => text.includes('ODOMETER.right_ti.2'))"), "a narrow window names tasks"


DIES = """
    def DIES_Main(cfe):
        cfe.es.run_loop()
        raise ValueError("a_word_that_has_no_blank_at_which_a_line_could_end_" * 4)
"""


def test_tables_fit_a_window_of_1280_pixels(browser: Browser, tmp_path: Path) -> None:
    mission = write_mission(tmp_path, "CFE_APP, dies, DIES_Main, DIES, 50, 8192, 0, 1;\n!\n", dies=DIES)
    collector, page = Collector(), tmp_path / "wide.html"
    flown = looked_at.fly(mission, collector, seconds=1)
    page.write_text(page_of(flown, collector, About("", "fifo", mission)), encoding="utf-8")
    browser.resize(1280, 900)
    browser.open(page)
    wide = "[...document.querySelectorAll('.scroll')].filter(box => box.scrollWidth > box.clientWidth)"
    assert browser.evaluate(f"{wide}.map(box => box.ariaLabel)") == []


def test_events_are_filtered(opened: Browser, shown: Shown) -> None:
    visible = "[...document.querySelectorAll('#events-table tbody tr')].filter(row => row.offsetHeight).length"
    count = len(shown.collector.events)
    assert opened.evaluate(visible) == count
    opened.evaluate("""(field => { field.value = 'ERROR of its own'; field.dispatchEvent(new Event('input')); })(
        document.getElementById('events-filter'))""")
    assert opened.evaluate(visible) == 1
    assert opened.evaluate("document.getElementById('events-count').value") == f"1 of {count}"


def test_tables_sort_by_number(opened: Browser) -> None:
    column = "[...document.querySelectorAll('#messages tbody tr')].map(row => Number(row.cells[3].dataset.order))"
    opened.evaluate("document.querySelectorAll('#messages thead button')[3].click()")
    sent = opened.evaluate(column)
    assert sent == sorted(sent, reverse=True)
    opened.evaluate("document.querySelectorAll('#messages thead button')[3].click()")
    assert opened.evaluate(column) == sorted(sent)


@pytest.mark.parametrize("width", [390, 768, 1280])
@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_page_fits_its_window_and_has_enough_contrast(opened: Browser, width: int, scheme: str) -> None:
    opened.prefer(scheme)
    opened.resize(width, 900)
    assert opened.evaluate("document.documentElement.scrollWidth <= innerWidth")
    contrast = """(() => {
        const light = color => {
            const [r, g, b] = color.match(/[\\d.]+/g).map(Number).map(each => each / 255)
                .map(each => each <= 0.03928 ? each / 12.92 : ((each + 0.055) / 1.055) ** 2.4);
            return 0.2126 * r + 0.7152 * g + 0.0722 * b;
        };
        const ground = element => {
            for (let at = element; at; at = at.parentElement) {
                const color = getComputedStyle(at).backgroundColor;
                if (!/, 0\\)$/.test(color)) return color;
            }
        };
        let least = 21;
        for (const element of document.querySelectorAll('h1, h2, p, a, dt, dd, th, td, td *, button, output, li')) {
            if (!element.innerText || !element.offsetHeight) continue;
            const pair = [light(getComputedStyle(element).color), light(ground(element))].sort((a, b) => b - a);
            least = Math.min(least, (pair[0] + 0.05) / (pair[1] + 0.05));
        }
        return least;
    })()"""
    assert opened.evaluate(contrast) >= 4.5  # WCAG AA
    opened.prefer("light")


def test_a_minute_of_capture_is_small_and_quick(browser: Browser, tmp_path: Path) -> None:
    collector, recorder = Collector(), SeriesRecorder(most=10_000)
    flown = looked_at.fly("capture", collector, recorder, seconds=60)
    assert sum(topic.sent for topic in flown.results.topics) > 60_000
    page = tmp_path / "capture.html"
    page.write_text(page_of(flown, collector, About("", "fifo", "capture"), recorder), encoding="utf-8")
    assert page.stat().st_size < 5_000_000
    browser.errors.clear()
    assert browser.open(page) < 2
    assert browser.errors == []
