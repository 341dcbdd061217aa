"""The result of each node (results.tsv), and the counts in convertor.md. explained.tsv explains the differences."""

from __future__ import annotations

import csv
import json
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path
from typing import Any, NamedTuple

from dev.convert.stimulus.comparing import Likeness
from dev.convert.survey import DOCUMENT, between

RESULTS = Path(__file__).with_name("results.tsv")
EXPLAINED = Path(__file__).with_name("explained.tsv")
BEGIN, END = "<!-- stimulus: made by python -m dev.convert.stimulus --report -->", "<!-- end of stimulus -->"
ALL = "*"
"""Stands for each part of a node."""


class Row(NamedTuple):
    """Result of a node.

    Attributes:
        node: OWNER/NAME/file.
        verdict: a key of `VERDICTS`.
        messages: number of messages that it published with roscpp.
        lines: number of lines that it printed there.
        answers: number of answers that it gave.
        why: why it is not equal, or the parts that may vary.
    """

    node: str
    verdict: str
    messages: int
    lines: int
    answers: int
    why: str


VERDICTS = {
    "equal": "the messages, answers, printed lines, names in the graph and exit are equal",
    "explained": "differs for a reason that is listed in explained.tsv",
    "different": "differs without a known reason",
    "refused": "compiles, but a rule of the check refuses it",
    "not on cfepy": "converts, but does not fly",
    "not with roscpp": "cannot be built with Debian's roscpp",
    "not run": "was not tried",
}


def explained() -> dict[tuple[str, str], str]:
    """Why a part of a node differs."""
    with EXPLAINED.open(encoding="utf-8") as stream:
        return {(row["node"], row["part"]): row["why"] for row in csv.DictReader(stream, delimiter="\t")}


def rows(results: Iterable[Mapping[str, Any]], known: Mapping[tuple[str, str], str]) -> Iterator[Row]:
    """Yield the results of nodes.

    Args:
        results: results of `dev.convert.stimulus`.
        known: explanations from `explained`.
    """
    for each in sorted(results, key=lambda result: result["node"].lower()):
        node, parts = each["node"], each.get("parts", [])
        seen = {kind: sum(part["seen"] for part in parts if part["name"].startswith(kind)) for kind in _KINDS}
        verdict, why = _verdict(node, each, known)
        yield Row(node, verdict, seen["topic "], seen["log"], seen["answer "], why)


_KINDS = ("topic ", "log", "answer ")


def _verdict(node: str, result: Mapping[str, Any], known: Mapping[tuple[str, str], str]) -> tuple[str, str]:
    parts = result.get("parts", [])
    of_all = known.get((node, ALL))
    if result["verdict"] in ("not run", "refused"):
        return result["verdict"], result.get("why", "")
    if result["verdict"] == "not built":
        return "not with roscpp", of_all or result["why"]
    if not parts:
        return "not on cfepy", of_all or result["why"]
    differ = [part["name"] for part in parts if part["likeness"] == Likeness.DIFFERENT]
    if not differ:
        varies = [part["name"] for part in parts if part["likeness"] == Likeness.VARIES]
        return "equal", f"two runs of roscpp differ in a part of: {', '.join(varies)}" if varies else ""
    reasons = {name: known.get((node, name), of_all) for name in differ}
    unknown = [name for name, why in reasons.items() if not why]
    if unknown:
        return "different", ", ".join(unknown)
    return "explained", "; ".join(dict.fromkeys(why for why in reasons.values() if why))


def write(results: Iterable[Mapping[str, Any]]) -> list[Row]:
    """Write results.tsv and the counts in docs/how_to/convertor.md."""
    made = list(rows(results, explained()))
    with RESULTS.open("w", encoding="utf-8", newline="") as stream:
        writer = csv.writer(stream, delimiter="\t", lineterminator="\n")
        writer.writerow(Row._fields)
        writer.writerows(made)
    text = DOCUMENT.read_text(encoding="utf-8")
    DOCUMENT.write_text(between(text, BEGIN, END, table(made)), encoding="utf-8")
    return made


def table(made: list[Row]) -> str:
    """Return the counts as a part of docs/how_to/convertor.md."""
    counts = Counter(row.verdict for row in made)
    there = [row for row in made if row.verdict in ("equal", "explained", "different")]
    lines = [
        f"The comparison covers {len(made)} nodes that compile for the host:",
        "",
        "| verdict | nodes | meaning |",
        "|---|---|---|",
    ]
    lines += [f"| {name} | {counts[name]} | {what} |" for name, what in VERDICTS.items() if counts[name]]
    messages, printed = sum(each.messages for each in there), sum(each.lines for each in there)
    sums = (messages, printed, sum(each.answers for each in there))
    seen = "published {:,} messages, printed {:,} lines and gave {:,} answers".format(*sums)
    lines += ["", f"The {len(there)} nodes that ran on both sides {seen} with roscpp."]
    return "\n".join(lines)


def read(file: Path, verdicts: Iterable[Mapping[str, Any]]) -> list[dict[str, Any]]:
    """Return the results in a file of `--json`.

    Args:
        file: that one.
        verdicts: of `dev.convert.survey`: nodes that convert should be in it.
    """
    found: dict[str, dict[str, Any]] = json.loads(file.read_text(encoding="utf-8"))
    results = []
    for each in verdicts:
        node, rules = f"{each['repository']}/{each['file']}", each["refused"]["host"]
        if not rules:
            results.append(found.get(node, {"node": node, "verdict": "not run"}))
        elif node in found:
            flew = "; flown without the check it was equal" if found[node]["verdict"] == "equal" else ""
            results.append({"node": node, "verdict": "refused", "why": f"{', '.join(rules)}{flew}"})
    return results
