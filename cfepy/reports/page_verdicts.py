"""The parts of a page that say how the run went: problems, deadlines, invariants, faults, resets, the script."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from cfepy.mission.deadlines import time_text
from cfepy.mission.results import Results
from cfepy.reports.collector import MOST_OF_A_KIND, Collector
from cfepy.reports.html_text import Cell, Numbers, element, escaped, section, table
from cfepy.rtos.units import NS_PER_S

NEVER = ("never", "never judged")


def problems(results: Results) -> str:
    """Whether the run went well, in a word and a list."""
    found = [*results.script_problems, *results.problems]
    if not found:
        return element("p", "No problems", class_="banner good")
    title = element("p", f"{len(found)} problem{'s' if len(found) > 1 else ''}")
    return element("div", title + element("ul", "".join(_items(found))), class_="banner bad", role="note")


def _items(texts: list[str]) -> Iterator[str]:
    return (element("li", escaped(text)) for text in texts)


def deadlines(results: Results, numbers: Numbers) -> str:
    """What the mission file asks for; nothing without it."""
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
    heads = ("Of", "What", "Limit", "Verdict", "Measured", "Missed", "Worst", "First at")
    return section("Deadlines", "deadlines", table("Deadlines of the mission file", heads, rows, (2, 4, 5, 6, 7)))


def faults(results: Results, numbers: Numbers) -> str:
    """What was to go wrong, and how often it did; nothing without faults."""
    rows = []
    for index, fault in enumerate(results.faults):
        path = f"faults.{index}"
        instants = [numbers.show(f"{path}.at_s.{number}", f"{at_s:.6f}") for number, at_s in enumerate(fault["at_s"])]
        when = ", ".join(instants) or escaped(fault["never"] or "")
        rows.append([escaped(fault["name"]), escaped(fault["what"]), numbers.show(f"{path}.times"), when])
    if not rows:
        return ""
    heads = ("Name", "What", "Times", "At, s, or why never")
    return section("Faults", "faults", table("Faults of the plan", heads, rows, (2,), class_="log"))


def invariants(results: Results, numbers: Numbers) -> str:
    """What had to hold of messages; nothing without invariants."""
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


def marks(results: Results, numbers: Numbers, collector: Collector) -> str:
    """Resets, faults, deadlines that were missed, invariants that did not hold."""
    rows: list[tuple[Cell, str, str]] = [
        (
            Cell(numbers.show(f"resets.{index}.at_s", f"{reset.at_s:.6f}"), reset.at_s),
            "reset",
            escaped(f"{reset.type}: {reset.reason}" + (" (a failure)" if reset.fault else "")),
        )
        for index, reset in enumerate(results.resets)
    ]
    for mark in collector.marks:
        if mark.kind != "reset":
            at = Cell(f"{mark.at_ns / NS_PER_S:.6f}", mark.at_ns / NS_PER_S)
            rows.append((at, escaped(mark.kind), escaped(mark.text)))
    if not rows:
        return ""
    rows.sort(key=lambda row: row[0].order or 0)
    inside = table("Resets, faults, overruns and notes", ("At, s", "What", "Text"), rows, (0,), class_="log")
    about = " ".join(
        f"The first {MOST_OF_A_KIND:,} of {count:,} of the kind {kind} are shown."
        for kind, count in collector.mark_counts.items()
        if count > MOST_OF_A_KIND
    )
    return section("What stands out", "marks", inside, about)


def script(outcome: Any, numbers: Numbers) -> str:
    """The steps of the mission's script; nothing without one."""
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
