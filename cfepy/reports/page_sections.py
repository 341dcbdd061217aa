"""The parts of a page that tell what there was: messages, applications, pipes, memory, events, the console.

Each is a table or two; `cfepy.reports.page` puts them together.
"""

from __future__ import annotations

from cfepy.mission.deadlines import time_text
from cfepy.mission.results import Results
from cfepy.reports.bins import Histogram
from cfepy.reports.collector import MOST, Collector
from cfepy.reports.html_text import Cell, Numbers, element, escaped, meter, section, table
from cfepy.rtos.units import NS_PER_S

SHARES = (0.5, 0.95, 0.99)
BAR_WIDTH, PICTURE_HEIGHT = 5, 24
STACK = "stack"
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
"""What becomes of a topic's messages, by the field of `TopicResult`."""


def messages(results: Results, numbers: Numbers) -> str:
    """Every MsgId: what was sent, and what became of it."""
    rows = []
    for index, topic in enumerate(results.topics):
        path = f"topics.{index}"
        name = escaped(topic.name) + element("span", escaped(topic.type), class_="type")
        msg_id = Cell(numbers.show(f"{path}.msg_id", f"0x{topic.msg_id:04X}"), topic.msg_id)
        rate = numbers.show(f"{path}.rate_hz", f"{topic.rate_hz:,.1f}")
        if topic.too_fast:
            rate += element("strong", " !", title="more than the board is made for")
        counts = [Cell(numbers.show(f"{path}.{each}"), getattr(topic, each)) for each in FATES]
        rows.append([name, msg_id, Cell(rate, topic.rate_hz), *counts])
    limit = ""
    if results.max_publish_hz:
        limit = f" The board is made for {numbers.show('max_publish_hz')} Hz of ROS messages a topic."
    about = f"What was sent over the Software Bus, and what became of it. Rates count from OPERATIONAL on.{limit}"
    heads = ("Name", "MsgId", "Hz", *FATES.values())
    rates = table("Messages by MsgId", heads, rows, range(1, len(heads)), class_="sortable")
    return section("Messages", "messages", rates, about)


def latencies(collector: Collector) -> str:
    """How long messages were under way."""
    rows = []
    for msg_id, topic in sorted(collector.topics.items()):
        latency = topic.latency
        if latency.count:
            times = [*latency.percentiles(SHARES), latency.most_ns]
            cells = [Cell(escaped(time_text(each)), each) for each in times]
            name = escaped(collector.names[msg_id])
            rows.append([name, Cell(f"{latency.count:,}", latency.count), *cells, _picture(latency)])
    heads = ("Name", "Received", "p50", "p95", "p99", "Longest", "From 0 ns on, doubling")
    about = (
        "Virtual time from the sending of a message until a receiver has it, which is when its callback begins. "
        "Percentiles are at most 1.6 % too low."
    )
    return section(
        "Latency", "latency", table("Latency by message", heads, rows, range(1, 6), class_="sortable"), about
    )


def _picture(latency: Histogram) -> str:
    """Bars, one for each doubling of the time; the first is 0 ns."""
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


def applications(results: Results, numbers: Numbers) -> str:
    """State, processor time and failures."""
    rows = []
    for index, app in enumerate(results.apps):
        path = f"apps.{index}"
        share = numbers.show(f"{path}.cpu_share", f"{app.cpu_share:.2%}")
        errors = numbers.show(f"own_errors.{app.name}") if app.name in results.own_errors else ""
        rows.append(
            [
                escaped(app.name),
                escaped(app.state),
                Cell(meter(app.cpu_share, share), app.cpu_share),
                Cell(numbers.show(f"{path}.restarts"), app.restarts),
                Cell(numbers.show(f"{path}.deaths"), app.deaths),
                errors,
                escaped(app.error or ""),
            ]
        )
    heads = ("Name", "State", "CPU", "Restarts", "Deaths", "Error events", "Died of")
    total = sum(app.cpu_share for app in results.apps)
    about = f"Processor time is virtual: what the board says that calls cost. All together they used {total:.2%} of it."
    inside = table("Applications", heads, rows, (2, 3, 4, 5), class_="sortable")
    return section("Applications", "applications", inside, about)


def pipes(results: Results, numbers: Numbers) -> str:
    """How full they ever were."""
    rows = []
    for index, pipe in enumerate(results.pipes):
        path = f"pipes.{index}"
        share = pipe.peak / pipe.depth if pipe.depth else 1.0
        rows.append(
            [
                escaped(pipe.name),
                escaped(pipe.app),
                Cell(meter(share, numbers.show(f"{path}.peak"), pipe.dropped > 0), pipe.peak),
                Cell(numbers.show(f"{path}.depth"), pipe.depth),
                Cell(f"{share:.0%}", share),
                Cell(numbers.show(f"{path}.dropped"), pipe.dropped),
            ]
        )
    heads = ("Pipe", "Application", "Most that waited", "Room for", "Share", "Did not get in")
    return section("Pipes", "pipes", table("Pipes", heads, rows, (2, 3, 4, 5), class_="sortable"))


def drops(collector: Collector) -> str:
    """Where messages were lost; nothing when none was."""
    rows = [
        [escaped(collector.names[drop.msg_id]), escaped(drop.pipe), escaped(drop.why), Cell(f"{count:,}", count)]
        for drop, count in sorted(collector.drops.items(), key=lambda item: -item[1])
    ]
    if not rows:
        return ""
    heads = ("Message", "Pipe", "Why", "Times")
    return section("Dropped messages", "drops", table("Dropped messages", heads, rows, (3,), class_="sortable"))


def budget(results: Results, numbers: Numbers, collector: Collector) -> str:
    """The board's RAM by owner, and how much of it is stacks."""
    memory = results.memory
    stacks = {owner: size for (owner, kind), size in collector.memory.items() if kind == STACK}
    rows = []
    for owner, size in memory.by_owner.items():
        share = size / (memory.limit or max(memory.used, 1))
        stack = stacks.get(owner, 0)
        booked = Cell(meter(share, numbers.show(f"memory.by_owner.{owner}"), memory.limit is not None), size)
        rows.append([escaped(owner), booked, Cell(f"{stack:,}", stack), Cell(f"{share:.1%}", share)])
    whole = "of the board" if memory.limit else "of what is used"
    parts = table("RAM by owner", ("Owner", "Bytes", "of them stacks", whole), rows, (1, 2, 3), class_="sortable")
    used, peak = numbers.show("memory.used"), numbers.show("memory.peak")
    if memory.limit:
        of = f"{meter(memory.peak / memory.limit, '')} at most {peak} of {numbers.show('memory.limit')} bytes"
    else:
        of = f"At most {peak} bytes, on a board without a limit"
    about = f"{of}; {used} at the end, {sum(stacks.values()):,} of them stacks."
    return section("Board budget", "budget", parts, about)


def events(results: Results, numbers: Numbers, collector: Collector) -> str:
    """What applications reported; with a filter."""
    counts = ", ".join(f"{numbers.show(f'events.{name}')} {name}" for name in results.events)
    rows = [
        [
            Cell(f"{event.at_ns / NS_PER_S:.6f}", event.at_ns),
            element("span", escaped(event.type), class_=f"severity {escaped(event.type.lower())}"),
            escaped(event.app),
            str(event.number),
            escaped(event.text),
        ]
        for event in collector.events
    ]
    heads = ("At, s", "Type", "Application", "Id", "Text")
    inside = _filter("events", "Show events with") + table(
        "Events", heads, rows, (0, 3), class_="log", id="events-table"
    )
    about = f"{counts}. {kept(len(collector.events), collector.event_count)}"
    return section("Events", "events", inside, about)


def console(collector: Collector) -> str:
    """What was printed; with a filter."""
    rows = [[f"{line.at_ns / NS_PER_S:.6f}", escaped(line.text)] for line in collector.lines]
    inside = _filter("console", "Show lines with")
    inside += table("Console", ("At, s", "Line"), rows, (0,), class_="log console", id="console-table")
    return section("Console", "console", inside, kept(len(collector.lines), collector.line_count))


def kept(shown: int, count: int) -> str:
    """What is said where not all can be shown."""
    return "" if count <= shown else f"The first {MOST:,} of {count:,} are shown."


def _filter(name: str, label: str) -> str:
    field = element("input", type="search", id=f"{name}-filter", data_table=f"{name}-table", autocomplete="off")
    field = field.removesuffix("</input>")
    count = element("output", id=f"{name}-count", for_=f"{name}-filter", aria_live="polite")
    return element("p", element("label", escaped(label), for_=f"{name}-filter") + field + count, class_="filter")


def others(numbers: Numbers) -> str:
    """Every number that has no place of its own, so that none is missing."""
    rows = [[escaped(path), shown] for path, shown in numbers.rest()]
    if not rows:
        return ""
    return section("Other numbers", "others", table("Other numbers", ("What", "Value"), rows, (1,)))
