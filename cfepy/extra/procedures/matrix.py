"""The requirement matrix of a campaign as CSV, as an HTML page and as data for the next campaign's comparison."""

from __future__ import annotations

import csv
import io
import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from cfepy.extra.procedures.flying_suites import CampaignResult
from cfepy.extra.procedures.requirements import STATES, Requirement, Requirements
from cfepy.reading.input_files import read_limited
from cfepy.reading.input_limits import LINE_FILE_BYTES
from cfepy.status import UsageError
from cfepy.writing.markup import element, escaped

VERSION = 1
_STYLE = (
    "body{font:15px system-ui,sans-serif;margin:2em;max-width:70em}table{border-collapse:collapse}"
    "td,th{border:1px solid #bbb;padding:.3em .6em;text-align:left;vertical-align:top}"
    ".P,.PASS{background:#d8f0d8}.F,.FAIL{background:#f6d2d2}.U,.SKIP{background:#eee}.I,.A,.IA{background:#fdf0c8}"
)


def matrix_csv(requirements: Requirements) -> str:
    """Return the matrix as CSV: a row for each requirement and test that shows it."""
    output = io.StringIO()
    writer = csv.writer(output, lineterminator="\n")
    writer.writerow(["requirement", "text", "state", "test", "state of the test", "message"])
    for each in requirements.rows():
        rows = each.tests.items() or {"": ("", "")}.items()
        for test, (state, message) in rows:
            writer.writerow([each.name, each.text, STATES[each.state], test, STATES.get(state, ""), message])
    return output.getvalue()


def matrix_page(result: CampaignResult, title: str, changes: list[str] | None = None) -> str:
    """Return the matrix and the tests as one HTML page.

    Args:
        result: the campaign.
        title: its name.
        changes: lines about the comparison with an earlier campaign; None for no comparison.
    """
    rows = "".join(map(_row, result.requirements.rows()))
    head = "<tr><th>Requirement</th><th>Text</th><th>State</th><th>Tests</th></tr>"
    parts = [element("h1", escaped(title)), element("p", escaped(summary_line(result)))]
    if changes is not None:
        lines = "".join(element("li", escaped(each)) for each in changes) or element("li", "no change")
        parts += [element("h2", "Changes"), element("ul", lines)]
    parts += [element("h2", "Requirements"), element("table", head + rows)]
    tests = "".join(
        f'<tr class="{each.verdict}"><td>{escaped(each.full_name)}</td><td>{each.verdict}</td>'
        f"<td>{each.seconds:.3f}</td><td>{escaped(each.message)}</td></tr>"
        for each in result.tests
    )
    head = "<tr><th>Test</th><th>Verdict</th><th>Virtual time, s</th><th>Message</th></tr>"
    parts += [element("h2", "Tests"), element("table", head + tests)]
    begin = f'<!doctype html><html lang="en"><meta charset="utf-8"><title>{escaped(title)}</title>'
    return f"{begin}<style>{_STYLE}</style><body>{''.join(parts)}</body></html>\n"


def _row(each: Requirement) -> str:
    tests = "<br>".join(escaped(f"{test}: {STATES[state]}") for test, (state, _) in each.tests.items())
    cells = "".join(element("td", part) for part in (escaped(each.name), escaped(each.text), STATES[each.state], tests))
    return f'<tr class="{each.state}">{cells}</tr>'


def summary_line(result: CampaignResult) -> str:
    """Return the numbers of tests and requirements by their states."""
    verdicts = [each.verdict for each in result.tests]
    tests = ", ".join(f"{verdicts.count(each)} {name}" for each, name in _VERDICTS if verdicts.count(each))
    states = [each.state for each in result.requirements.rows()]
    found = ", ".join(f"{states.count(each)} {name}" for each, name in STATES.items() if states.count(each))
    return f"tests: {tests or 'none'}" + (f"; requirements: {found}" if states else "")


_VERDICTS = (("PASS", "passed"), ("FAIL", "failed"), ("SKIP", "skipped"))


def campaign_data(result: CampaignResult) -> dict[str, Any]:
    """Return a campaign as data for JSON."""
    return {
        "version": VERSION,
        "tests": [
            {
                "name": each.full_name,
                "verdict": each.verdict,
                "message": each.message,
                "place": each.place,
                "virtual_s": round(each.seconds, 9),
                "wall_s": round(each.wall, 3),
                "requirements": list(each.requirements),
                "output": each.output if each.verdict == "FAIL" else [],
                "events": each.events if each.verdict == "FAIL" else [],
            }
            for each in result.tests
        ],
        "requirements": {
            each.name: {
                "text": each.text,
                "state": each.state,
                "tests": {name: s for name, (s, _) in each.tests.items()},
            }
            for each in result.requirements.rows()
        },
    }


def changes_since(file: Path, now: Mapping[str, Any]) -> list[str]:
    """Return a line for each test and requirement whose state has changed since an earlier campaign.

    Args:
        file: JSON of the earlier campaign.
        now: data of this campaign.

    Raises:
        UsageError: if the file is not a campaign.
    """
    try:
        before = json.loads(read_limited(file, LINE_FILE_BYTES))
        old = {each["name"]: each["verdict"] for each in before["tests"]}
        states = {name: each["state"] for name, each in before["requirements"].items()}
    except (ValueError, KeyError, TypeError, AttributeError):
        raise UsageError("is not a campaign; give the file of an earlier --json", file=file) from None
    new = {each["name"]: each["verdict"] for each in now["tests"]}
    new_states = {name: each["state"] for name, each in now["requirements"].items()}
    lines = [f"{name}: {_change(old.get(name), new.get(name))}" for name in _all(old, new)]
    named = {key: STATES[value] for key, value in states.items()}, {key: STATES[v] for key, v in new_states.items()}
    lines += [f"requirement {name}: {_change(named[0].get(name), named[1].get(name))}" for name in _all(*named)]
    return lines


def _all(old: Mapping[str, str], new: Mapping[str, str]) -> list[str]:
    return [name for name in dict.fromkeys([*old, *new]) if old.get(name) != new.get(name)]


def _change(before: str | None, after: str | None) -> str:
    if before is None:
        return f"new, {after}"
    return f"{before} before, gone now" if after is None else f"{before} before, {after} now"
