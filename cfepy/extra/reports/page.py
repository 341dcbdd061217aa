"""A run as one self-contained HTML page: no library, no request, no server.

`page.css` and `page.js` next to this module are embedded in it. The policy in its head permits only that script. First
come the parts about the outcome of the run (problems, deadlines, invariants, faults, resets, the script). Then come the
parts about its components (messages, applications, pipes, memory, events, the console), each a table or two. The last
part shows every number of the results that has no other place.
"""

from __future__ import annotations

import hashlib
import platform
from base64 import b64encode
from dataclasses import dataclass
from pathlib import Path
from textwrap import shorten
from typing import Any

from cfepy import __version__
from cfepy.extra.reports.bins import Histogram
from cfepy.extra.reports.collector import MOST, MOST_OF_A_KIND, SWITCH, Collector, timeline_data
from cfepy.extra.reports.html_text import Numbers, PageSection, TableCell, json_text, meter, section, table
from cfepy.extra.reports.page_story import (
    MOST_SWITCHES,
    STORY,
    STORY_SPAN_NS,
    PageStory,
    instant,
    opened_range,
    problems_of_page,
    story_section,
)
from cfepy.extra.reports.page_values import limits_section, value_data, values_section
from cfepy.ground import SeriesSet, graph_svg
from cfepy.pilot import Flown, Results, RunProblem
from cfepy.units import NS_PER_S, instant_text, time_text
from cfepy.writing.markup import element, escaped

NO_ICON = "data:,"  # a browser would request one
NEVER = ("never", "never judged")
SHARES = (0.5, 0.95, 0.99)
BAR_WIDTH, PICTURE_HEIGHT = 5, 24
STACK = "stack"
MOST_OF_TITLE = 100  # characters
FATES = {
    "sent": "Sent",
    "delivered": "Delivered",
    "waiting": "Waiting",
    "dropped": "Dropped",
    "dropped_limit": "by limit",
    "dropped_pipe_full": "pipe full",
    "dropped_segment": "segment lost",
    "no_subscriber": "no subscriber",
    "held_back": "held back",
}
"""The fates of a topic's messages, by the field of `TopicResult`."""


@dataclass(frozen=True, slots=True)
class About:
    """Information about a run besides the results.

    Attributes:
        command: the command that repeats the run.
        schedule: the schedule of the run, as `--schedule` takes it.
        source: the source of the page: a journal, or a mission.
        warnings: warnings for the reader.
        story: the story of a failure that the schedule shows and fifo does not, or None.
        journal: name of the journal; empty for a run that was flown.
    """

    command: str
    schedule: str
    source: str
    warnings: tuple[str, ...] = ()
    story: PageStory | None = None
    journal: str = ""


def page_of(flown: Flown, collector: Collector, about: About, recorded: SeriesSet | None = None) -> str:
    """Return the whole page.

    Args:
        flown: the run.
        collector: the collector that watched it.
        about: further information.
        recorded: values over time, for fields that a reader selects; None leaves them out.
    """
    values = None if recorded is None else value_data(recorded)
    results = flown.results
    plain = results.to_dict()
    if flown.outcome is not None:
        plain["script"] = flown.outcome.to_dict()
    numbers = Numbers(plain)
    body = [
        _header(flown, numbers, about, collector),
        "" if about.story is None else story_section(about.story),
        _timeline(),
        "" if values is None or recorded is None else values_section(values, recorded),
        _deadlines(results, numbers),
        _invariants(results, numbers),
        "" if recorded is None else limits_section(recorded),
        _faults(results, numbers),
        _marks(results, numbers, collector),
        _script(flown.outcome, numbers),
        _messages(results, numbers),
        _latencies(collector),
        _drops(collector),
        _applications(results, numbers),
        _pipes(results, numbers),
        _graph(collector),
        _budget(results, numbers, collector),
        _events(results, numbers, collector),
        _console(collector),
        _others(numbers),
    ]
    data = element("script", json_text(plain), type="application/json", id="numbers")
    timeline = timeline_data(collector) | {"open": opened_range(flown, collector)}
    data += element("script", json_text(timeline), type="application/json", id="timeline-data")
    drawable = [] if values is None else values.plain
    data += element("script", json_text(drawable), type="application/json", id="values-data")
    return _document(_title(flown, collector, about), _navigation(body) + element("main", "".join(body)) + data)


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


def _header(flown: Flown, numbers: Numbers, about: About, collector: Collector) -> str:
    results = flown.results
    booted = "never" if results.booted_s is None else numbers.show("booted_s", f"{results.booted_s:.6f}") + " s"
    facts = {
        "Mission": escaped(results.mission),
        "Board": escaped(results.board),
        "Seed": numbers.show("seed", str(results.seed)),
        "Schedule": escaped(about.schedule),
        "Virtual time": f"{numbers.show('virtual_s', f'{results.virtual_s:,.3f}')} s",
        "OPERATIONAL at": booted,
        "Tasks": escaped(str(results.task_kind)),
        "Source": escaped(about.source),
        "Versions": escaped(f"cfepy {__version__}, Python {platform.python_version()}"),
        "Trace": element("code", escaped(results.trace)),
    }
    if results.wall_s:
        speed = f"{numbers.show('speed', f'{results.speed:,.1f}')} times real time"
        facts["Wall time"] = f"{numbers.show('wall_s', f'{results.wall_s:,.3f}')} s, {speed}"
    listed = "".join(element("div", element("dt", name) + element("dd", value)) for name, value in facts.items())
    command = element("dt", "Command to repeat the run") + element("dd", element("code", escaped(about.command)))
    warnings = "".join(element("p", escaped(text), class_="banner bad", role="note") for text in about.warnings)
    title = element("h1", escaped(_title(flown, collector, about))) + warnings
    title += _problems(flown, collector, about.story)
    title += _silent(results)
    return element("header", title + element("dl", listed + element("div", command, class_="wide"), class_="facts"))


def _title(flown: Flown, collector: Collector, about: About) -> str:
    """Return the title: the journal, or the mission, and the outcome of the run."""
    results = flown.results
    name = about.journal or results.mission
    found = list(problems_of_page(flown, collector))
    if not found:
        return f"{name}: no problems in {results.virtual_s:,.6g} s"
    text = shorten(found[0].text.splitlines()[0], MOST_OF_TITLE, placeholder="...")
    return f"{name}: {text}" + (f", and {len(found) - 1} more" if len(found) > 1 else "")


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
        "The times at which applications ran and messages were sent. Darker areas have more of them. Lines mark "
        "resets, faults, overruns and switches of the schedule. To zoom, use the wheel, the buttons, or + and "
        "&minus;. To move, drag or use the arrow keys. <code>cfepy trace --perfetto</code> exports all of them."
    )
    return section("Timeline", "timeline", bar + element("div", canvas, class_="timeline") + tip, about)


def _navigation(body: list[str]) -> str:
    """Return links to the existing parts."""
    links = [
        element("a", escaped(part.heading), href=f"#{part.anchor}") for part in body if isinstance(part, PageSection)
    ]
    return element("nav", "".join(links), aria_label="Parts of this page")


def _problems(flown: Flown, collector: Collector, story: PageStory | None) -> str:
    """Show the number of problems and a list of them; the time of each problem links to the timeline."""
    found = list(problems_of_page(flown, collector))
    if not found:
        return element("p", "No problems", class_="banner good")
    title = element("p", f"{len(found)} problem{'s' if len(found) > 1 else ''}")
    items = element("ul", "".join(_item(problem) for problem in found))
    if story is not None:
        cause = f": {escaped(story.cause)}" if story.cause else ""
        items += element("p", element("a", "What happened", href=f"#{STORY}") + cause)
    switches = [RunProblem(mark.text, mark.at_ns) for mark in collector.marks if mark.kind == SWITCH]
    if switches:
        one = len(switches) == 1
        items += element("p", f"The schedule made {'one switch' if one else f'{len(switches)} switches'} in this run:")
        items += element("ul", "".join(_item(each, SWITCH) for each in switches[:MOST_SWITCHES]))
    return element("div", title + items, class_="banner bad", role="note")


def _silent(results: Results) -> str:
    """List the checks of the mission file without data, the topics that connect to nothing, and the traps."""
    texts = (*results.never_judged, *results.loose_ends, *results.traps)
    items = "".join(element("li", escaped(text)) for text in texts)
    return element("ul", items, class_="silent") if items else ""


def _item(problem: RunProblem, kind: str = "") -> str:
    """Show a problem, with a link to its place in the timeline."""
    if problem.at_ns is None:
        return element("li", escaped(problem.text), class_=kind or None)
    span_ns = STORY_SPAN_NS if kind == SWITCH else None
    link = instant(problem.at_ns, instant_text(problem.at_ns), span_ns)
    return element("li", f"{link}: {escaped(problem.text)}", class_=kind or None)


def _deadlines(results: Results, numbers: Numbers) -> str:
    """Show the deadlines of the mission file; empty without deadlines."""
    rows = []
    for index, each in enumerate(results.deadlines):
        path = f"deadlines.{index}"
        jitter = ""
        if each.kind == "period":
            jitter = " &plusmn; " + numbers.show(f"{path}.jitter_s", time_text(round(each.jitter_s * NS_PER_S)))
        worst = "" if each.worst_s is None else time_text(round(each.worst_s * NS_PER_S))
        first = "" if each.first_at_s is None else f"{each.first_at_s:.6f} s"
        verdict = "missed" if each.overruns else "kept" if each.checked else "never measured"
        rows.append(
            [
                escaped(each.owner),
                escaped(each.kind.replace("_", " ")),
                numbers.show(f"{path}.limit_s", time_text(round(each.limit_s * NS_PER_S))) + jitter,
                element("span", verdict, class_=f"verdict {verdict.split()[0]}"),
                numbers.show(f"{path}.checked"),
                numbers.show(f"{path}.overruns"),
                numbers.show(f"{path}.worst_s", worst),
                numbers.show(f"{path}.first_at_s", first),
            ]
        )
    if not rows:
        return ""
    heads = ("Subject", "Kind", "Limit", "Verdict", "Measured", "Missed", "Worst", "First at")
    return section("Deadlines", "deadlines", table("Deadlines of the mission file", heads, rows, (2, 4, 5, 6, 7)))


def _faults(results: Results, numbers: Numbers) -> str:
    """Show the faults of the plan, and how often each happened; empty without faults."""
    rows = []
    for index, fault in enumerate(results.faults):
        path = f"faults.{index}"
        instants = [numbers.show(f"{path}.at_s.{number}", f"{at_s:.6f}") for number, at_s in enumerate(fault["at_s"])]
        when = ", ".join(instants) or escaped(fault["never"] or "")
        rows.append([escaped(fault["name"]), escaped(fault["what"]), numbers.show(f"{path}.times"), when])
    if not rows:
        return ""
    heads = ("Name", "Fault", "Times", "At, s, or the reason why not")
    return section("Faults", "faults", table("Faults of the plan", heads, rows, (2,), class_="log"))


def _invariants(results: Results, numbers: Numbers) -> str:
    """Show the invariants of messages; empty without invariants."""
    rows = []
    for index, each in enumerate(results.invariants):
        path = f"invariants.{index}"
        mark, word = ("missed", "violated") if each.violated else ("kept", "held") if each.judged else NEVER
        first = ""
        if each.first_at_s is not None:
            first = numbers.show(f"{path}.first_at_s", f"{each.first_at_s:.6f}") + f" s: {escaped(each.first)}"
        rows.append(
            [
                escaped(each.name) + element("span", escaped(each.place), class_="type"),
                element("span", word, class_=f"verdict {mark}"),
                numbers.show(f"{path}.judged"),
                numbers.show(f"{path}.violated"),
                first,
            ]
        )
    if not rows:
        return ""
    heads = ("Invariant", "Verdict", "Judged", "Violated", "First")
    return section("Invariants", "invariants", table("Invariants", heads, rows, (2, 3), class_="log"))


def _marks(results: Results, numbers: Numbers, collector: Collector) -> str:
    """Show resets, faults, missed deadlines and violated invariants."""
    rows: list[tuple[TableCell, str, str]] = [
        (
            TableCell(numbers.show(f"resets.{index}.at_s", f"{reset.at_s:.6f}"), reset.at_s),
            "reset",
            escaped(f"{reset.type}: {reset.reason}" + (" (a failure)" if reset.fault else "")),
        )
        for index, reset in enumerate(results.resets)
    ]
    for mark in collector.marks:
        if mark.kind != "reset":
            span_ns = STORY_SPAN_NS if mark.kind == SWITCH else None
            at = TableCell(instant(mark.at_ns, f"{mark.at_ns / NS_PER_S:.6f}", span_ns), mark.at_ns / NS_PER_S)
            rows.append((at, escaped(mark.kind), escaped(mark.text)))
    if not rows:
        return ""
    rows.sort(key=lambda row: row[0].order or 0)
    inside = table("Resets, faults, overruns and notes", ("At, s", "Kind", "Text"), rows, (0,), class_="log")
    about = " ".join(
        f"The first {MOST_OF_A_KIND:,} of {count:,} entries of the kind {kind} are shown."
        for kind, count in collector.mark_counts.items()
        if count > MOST_OF_A_KIND
    )
    return section("Notable events", "marks", inside, about)


def _script(outcome: Any, numbers: Numbers) -> str:
    """Show the steps of the mission's script; empty without one."""
    if outcome is None:
        return ""
    rows = []
    for index, step in enumerate(outcome.verdicts):
        path = f"script.steps.{index}"
        word = "ok" if step.ok else "FAILED"
        rows.append(
            [
                numbers.show(f"{path}.line"),
                element("span", word, class_=f"verdict {'kept' if step.ok else 'missed'}"),
                numbers.show(f"{path}.at_s", f"{step.at_s:.6f}"),
                escaped(step.step),
                escaped(step.detail),
            ]
        )
    heads = ("Line", "Verdict", "At, s", "Step", "Detail")
    return section("Script", "script", table(f"Steps of {outcome.file}", heads, rows, (0, 2), class_="log"))


def _messages(results: Results, numbers: Numbers) -> str:
    """Show the numbers of sent, delivered and lost messages of every MsgId."""
    rows = []
    for index, topic in enumerate(results.topics):
        path = f"topics.{index}"
        name = escaped(topic.name) + element("span", escaped(topic.type), class_="type")
        msg_id = TableCell(numbers.show(f"{path}.msg_id", f"0x{topic.msg_id:04X}"), topic.msg_id)
        rate = numbers.show(f"{path}.rate_hz", f"{topic.rate_hz:,.1f}")
        if topic.too_fast:
            rate += element("strong", " !", title="more than the board can carry")
        counts = [TableCell(numbers.show(f"{path}.{each}"), getattr(topic, each)) for each in FATES]
        rows.append([name, msg_id, TableCell(rate, topic.rate_hz), *counts])
    limit = ""
    if results.max_publish_hz:
        limit = f" The board carries at most {numbers.show('max_publish_hz')} Hz of ROS messages per topic."
    about = (
        f"The messages sent over the Software Bus, and their delivery. Rates are measured from OPERATIONAL on.{limit}"
    )
    heads = ("Name", "MsgId", "Hz", *FATES.values())
    rates = table("Messages by MsgId", heads, rows, range(1, len(heads)), class_="sortable")
    return section("Messages", "messages", rates, about)


def _latencies(collector: Collector) -> str:
    """Show the latencies of messages."""
    rows = []
    for msg_id, topic in sorted(collector.topics.items()):
        latency = topic.latency
        if latency.count:
            times = [*latency.percentiles(SHARES), latency.most_ns]
            cells = [TableCell(escaped(time_text(each)), each) for each in times]
            name = escaped(collector.names[msg_id])
            rows.append([name, TableCell(f"{latency.count:,}", latency.count), *cells, _picture(latency)])
    heads = ("Name", "Received", "p50", "p95", "p99", "Longest", "Distribution, doubling from 0 ns")
    about = (
        "Virtual time from the sending of a message until its receiver takes it, or until its callback begins. "
        "Percentiles are at most 1.6 % too low."
    )
    return section(
        "Latency", "latency", table("Latency by message", heads, rows, range(1, 6), class_="sortable"), about
    )


def _picture(latency: Histogram) -> str:
    """Draw bars, one for each doubling of the time; the first is 0 ns."""
    octaves = latency.octaves()
    largest = max(octaves.values())
    bars = []
    for bits in range(max(octaves) + 1):
        count = octaves.get(bits, 0)
        height = max(1, round(count / largest * PICTURE_HEIGHT)) if count else 0
        limits = "0 ns" if bits == 0 else f"{time_text(1 << bits - 1)} to {time_text((1 << bits) - 1)}"
        title = element("title", escaped(f"{limits}: {count:,}"))
        place = {"x": bits * BAR_WIDTH, "y": PICTURE_HEIGHT - height, "width": BAR_WIDTH - 1, "height": height}
        bars.append(element("rect", title, **place))
    width = (max(octaves) + 1) * BAR_WIDTH
    box = f"0 0 {width} {PICTURE_HEIGHT}"
    return element(
        "svg", "".join(bars), class_="histogram", viewBox=box, width=width, height=PICTURE_HEIGHT, aria_hidden="true"
    )


def _applications(results: Results, numbers: Numbers) -> str:
    """Show state, processor time and failures of applications."""
    rows = []
    for index, app in enumerate(results.apps):
        path = f"apps.{index}"
        share = numbers.show(f"{path}.cpu_share", app.cpu_text)
        errors = numbers.show(f"own_errors.{app.name}") if app.name in results.own_errors else ""
        rows.append(
            [
                escaped(app.name),
                escaped(app.state),
                TableCell(meter(app.cpu_share, share), app.cpu_share),
                TableCell(numbers.show(f"{path}.restarts"), app.restarts),
                TableCell(numbers.show(f"{path}.deaths"), app.deaths),
                errors,
                escaped(app.error or ""),
            ]
        )
    heads = ("Name", "State", "CPU", "Restarts", "Deaths", "Error events", "Cause of death")
    total = sum(app.cpu_share for app in results.apps)
    about = (
        f"Processor time is virtual: the board profile defines the cost of calls. All applications used {total:.2%}."
    )
    inside = table("Applications", heads, rows, (2, 3, 4, 5), class_="sortable log")
    return section("Applications", "applications", inside, about)


def _pipes(results: Results, numbers: Numbers) -> str:
    """Show the peak use of pipes."""
    rows = []
    for index, pipe in enumerate(results.pipes):
        path = f"pipes.{index}"
        share = pipe.peak / pipe.depth if pipe.depth else 1.0
        rows.append(
            [
                escaped(pipe.name),
                escaped(pipe.app),
                TableCell(meter(share, numbers.show(f"{path}.peak"), pipe.dropped > 0), pipe.peak),
                TableCell(numbers.show(f"{path}.depth"), pipe.depth),
                TableCell(f"{share:.0%}", share),
                TableCell(numbers.show(f"{path}.dropped"), pipe.dropped),
            ]
        )
    heads = ("Pipe", "Application", "Peak", "Depth", "Share", "Dropped")
    return section("Pipes", "pipes", table("Pipes", heads, rows, (2, 3, 4, 5), class_="sortable"))


def _graph(collector: Collector) -> str:
    """Draw senders, messages and receivers."""
    about = (
        "Senders are on the left, receivers and their pipes on the right. An application may be on both sides. "
        "<code>cfepy graph</code> shows the same graph as text."
    )
    drawing = graph_svg(collector.graph.of_interest(), is_document=False)
    return section("Graph", "graph", element("div", drawing, class_="drawing"), about)


def _drops(collector: Collector) -> str:
    """Show the places of message loss; empty if no message was lost."""
    rows = [
        [escaped(collector.names[drop.msg_id]), escaped(drop.pipe), escaped(drop.why), TableCell(f"{count:,}", count)]
        for drop, count in sorted(collector.drops.items(), key=lambda item: -item[1])
    ]
    if not rows:
        return ""
    heads = ("Message", "Pipe", "Reason", "Times")
    return section("Dropped messages", "drops", table("Dropped messages", heads, rows, (3,), class_="sortable"))


def _budget(results: Results, numbers: Numbers, collector: Collector) -> str:
    """Show the board's RAM by owner, and the share of stacks."""
    memory = results.memory
    stacks = {owner: size for (owner, kind), size in collector.memory.items() if kind == STACK}
    rows = []
    for owner, size in memory.by_owner.items():
        share = size / (memory.limit or max(memory.used, 1))
        stack = stacks.get(owner, 0)
        bar = meter(share, numbers.show(f"memory.by_owner.{owner}"), has_limit=memory.limit is not None)
        booked = TableCell(bar, size)
        rows.append([escaped(owner), booked, TableCell(f"{stack:,}", stack), TableCell(f"{share:.1%}", share)])
    whole = "Share of the board" if memory.limit else "Share of the used bytes"
    parts = table("RAM by owner", ("Owner", "Bytes", "Bytes of stacks", whole), rows, (1, 2, 3), class_="sortable")
    used, peak = numbers.show("memory.used"), numbers.show("memory.peak")
    if memory.limit:
        of = f"{meter(memory.peak / memory.limit, '')} at most {peak} of {numbers.show('memory.limit')} bytes"
    else:
        of = f"At most {peak} bytes, on a board without a limit"
    about = f"{of}; {used} bytes at the end, including {sum(stacks.values()):,} bytes of stacks."
    return section("Board budget", "budget", parts, about)


def _events(results: Results, numbers: Numbers, collector: Collector) -> str:
    """Show the events of applications, with a filter."""
    counts = ", ".join(f"{numbers.show(f'events.{name}')} {name}" for name in results.events)
    rows = [
        [
            TableCell(f"{event.at_ns / NS_PER_S:.6f}", event.at_ns),
            element("span", escaped(event.type_name), class_=f"severity {escaped(event.type_name.lower())}"),
            escaped(event.app),
            str(event.event_id),
            escaped(event.text),
        ]
        for event in collector.events
    ]
    heads = ("At, s", "Type", "Application", "Id", "Text")
    inside = _filter("events", "Show events that contain") + table(
        "Events", heads, rows, (0, 3), class_="log", id="events-table"
    )
    about = f"{counts}. {_kept(len(collector.events), collector.event_count)}"
    return section("Events", "events", inside, about)


def _console(collector: Collector) -> str:
    """Show the console, with a filter."""
    rows = [[f"{line.at_ns / NS_PER_S:.6f}", escaped(line.text)] for line in collector.lines]
    inside = _filter("console", "Show lines that contain")
    inside += table("Console", ("At, s", "Line"), rows, (0,), class_="log console", id="console-table")
    return section("Console", "console", inside, _kept(len(collector.lines), collector.line_count))


def _kept(shown: int, count: int) -> str:
    """Return a note if not all rows are shown."""
    return "" if count <= shown else f"The first {MOST:,} of {count:,} rows are shown."


def _filter(name: str, label: str) -> str:
    field = element("input", type="search", id=f"{name}-filter", data_table=f"{name}-table", autocomplete="off")
    field = field.removesuffix("</input>")
    count = element("output", id=f"{name}-count", for_=f"{name}-filter", aria_live="polite")
    return element("p", element("label", escaped(label), for_=f"{name}-filter") + field + count, class_="filter")


def _others(numbers: Numbers) -> str:
    """Show every number that has no place of its own, so that none is missing."""
    rows = [[escaped(path), shown] for path, shown in numbers.rest()]
    if not rows:
        return ""
    return section("Other numbers", "others", table("Other numbers", ("Name", "Value"), rows, (1,)))
