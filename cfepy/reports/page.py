"""A run as one HTML page that needs nothing else: no library, no request, no server.

`page.css` and `page.js` beside this module are put into it. The policy in its head lets nothing run but that script.
"""

from __future__ import annotations

import hashlib
import platform
from base64 import b64encode
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from cfepy import __version__, versions
from cfepy.mission.run_plan import Flown
from cfepy.reports import page_sections as parts
from cfepy.reports import page_verdicts as verdicts
from cfepy.reports.collector import Collector
from cfepy.reports.html_text import Numbers, Part, element, escaped, json_text, section

NO_ICON = "data:,"  # a browser would ask for one


@dataclass(frozen=True, slots=True)
class About:
    """What a page says of its run beside the results.

    Attributes:
        command: that does the run again.
        schedule: who went first, as `--schedule` takes it.
        source: what the page was made from: a journal, or a mission.
        warnings: what its reader should know.
    """

    command: str
    schedule: str
    source: str
    warnings: tuple[str, ...] = ()


def page_of(flown: Flown, collector: Collector, about: About) -> str:
    """The whole page.

    Args:
        flown: the run.
        collector: looked on at it.
        about: what else there is to say.
    """
    results = flown.results
    plain = results.to_dict()
    if flown.outcome is not None:
        plain["script"] = flown.outcome.to_dict()
    numbers = Numbers(plain)
    body = [
        _header(flown, numbers, about),
        _timeline(),
        verdicts.deadlines(results, numbers),
        verdicts.invariants(results, numbers),
        verdicts.faults(results, numbers),
        verdicts.marks(results, numbers, collector),
        verdicts.script(flown.outcome, numbers),
        parts.messages(results, numbers),
        parts.latencies(collector),
        parts.drops(collector),
        parts.applications(results, numbers),
        parts.pipes(results, numbers),
        parts.budget(results, numbers, collector),
        parts.events(results, numbers, collector),
        parts.console(collector),
        parts.others(numbers),
    ]
    data = element("script", json_text(plain), type="application/json", id="numbers")
    data += element("script", json_text(timeline_data(collector)), type="application/json", id="timeline-data")
    return _document(f"{results.mission}: cfepy run", _navigation(body) + element("main", "".join(body)) + data)


def _document(title: str, body: str) -> str:
    folder = Path(__file__).parent
    css, script = (folder / "page.css").read_text("utf-8"), (folder / "page.js").read_text("utf-8")
    allowed = b64encode(hashlib.sha256(script.encode()).digest()).decode()
    policy = f"default-src 'none'; img-src data:; style-src 'unsafe-inline'; script-src 'sha256-{allowed}'"
    head = "".join(
        (
            '<meta charset="utf-8">',
            f'<meta http-equiv="Content-Security-Policy" content="{policy}">',
            '<meta name="viewport" content="width=device-width, initial-scale=1">',
            '<meta name="color-scheme" content="light dark">',
            f'<link rel="icon" href="{NO_ICON}">',
            element("title", escaped(title)),
            element("style", css),
        )
    )
    return (
        f'<!DOCTYPE html>\n<html lang="en"><head>{head}</head>\n<body>{body}<script>{script}</script></body></html>\n'
    )


def _header(flown: Flown, numbers: Numbers, about: About) -> str:
    results = flown.results
    booted = "never" if results.booted_s is None else numbers.show("booted_s", f"{results.booted_s:.6f}") + " s"
    facts = {
        "Board": escaped(results.board),
        "Seed": numbers.show("seed", str(results.seed)),
        "Schedule": escaped(about.schedule),
        "Virtual time": f"{numbers.show('virtual_s', f'{results.virtual_s:,.3f}')} s",
        "OPERATIONAL at": booted,
        "Tasks": escaped(results.tasks),
        "Made from": escaped(about.source),
        "Versions": escaped(f"cfepy {__version__}, cFE {versions.CFE_VERSION}, Python {platform.python_version()}"),
        "Trace": element("code", escaped(results.trace)),
    }
    if results.wall_s:
        speed = f"{numbers.show('speed', f'{results.speed:,.1f}')} times real time"
        facts["Wall time"] = f"{numbers.show('wall_s', f'{results.wall_s:,.3f}')} s, {speed}"
    listed = "".join(element("div", element("dt", name) + element("dd", value)) for name, value in facts.items())
    command = element("dt", "The same run again") + element("dd", element("code", escaped(about.command)))
    warnings = "".join(element("p", escaped(text), class_="banner bad", role="note") for text in about.warnings)
    title = element("h1", escaped(results.mission)) + warnings + verdicts.problems(results)
    return element("header", title + element("dl", listed + element("div", command, class_="wide"), class_="facts"))


def _timeline() -> str:
    buttons = "".join(
        element("button", text, type="button", id=f"timeline-{name}", aria_label=label)
        for name, text, label in (
            ("in", "+", "Zoom in"),
            ("out", "&minus;", "Zoom out"),
            ("left", "&larr;", "Earlier"),
            ("right", "&rarr;", "Later"),
            ("all", "All", "Show the whole run"),
        )
    )
    shown = element("output", id="timeline-range", aria_live="polite")
    canvas = element(
        "canvas",
        "The tables below have these numbers as text.",
        id="timeline-canvas",
        tabindex="0",
        role="img",
        aria_label="Activity of applications and messages by virtual time",
    )
    tip = element("p", "", id="timeline-tip", class_="tip", aria_live="off")
    bar = element("p", buttons + shown, class_="tools")
    about = (
        "When applications ran and messages were sent; the darker, the more. Lines mark resets, faults and overruns. "
        "Zoom with the wheel, the buttons or + and &minus;, move by dragging or with the arrow keys. "
        "<code>cfepy trace --perfetto</code> has every single one."
    )
    return section("Timeline", "timeline", bar + element("div", canvas, class_="timeline") + tip, about)


def _navigation(body: list[str]) -> str:
    """Links to the parts that are there."""
    links = [element("a", escaped(part.heading), href=f"#{part.anchor}") for part in body if isinstance(part, Part)]
    return element("nav", "".join(links), aria_label="Parts of this page")


def timeline_data(collector: Collector) -> dict[str, Any]:
    """What the script draws: lanes of counts by time, run-length coded, and instants. Times in ns."""
    width_ns = collector.width_ns()
    lanes: list[dict[str, Any]] = []
    for name, app in collector.apps.items():
        lane = {"name": name, "kind": "app", "runs": app.runs.runs(width_ns), "busy": app.busy.runs(width_ns)}
        lanes.append(lane)
    for msg_id, topic in sorted(collector.topics.items(), key=lambda item: collector.names[item[0]]):
        lanes.append({"name": collector.names[msg_id], "kind": "topic", "runs": topic.sent.runs(width_ns), "busy": []})
    marks = [[mark.at_ns, mark.kind, mark.text] for mark in collector.marks]
    return {"end": collector.end_ns, "width": width_ns, "lanes": lanes, "marks": marks}
