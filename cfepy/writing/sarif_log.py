"""Findings as SARIF 2.1.0, the format that code hosts and editors read: one run, with its rules and results.

Source: OASIS, Static Analysis Results Interchange Format (SARIF) Version 2.1.0.
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any, NamedTuple
from urllib.parse import quote

from cfepy.writing.ci_findings import ERROR, CiFinding, FindingPlace

VERSION = "2.1.0"
SCHEMA = "https://docs.oasis-open.org/sarif/sarif/v2.1.0/errata01/os/schemas/sarif-schema-2.1.0.json"
BASE = "BASE"


class SarifRule(NamedTuple):
    """A kind of findings.

    Attributes:
        id: as in `CiFinding.rule`.
        name: its name in some words.
        why: a sentence about it; empty if `name` is enough.
        remedy: a sentence with the remedy; empty if there is no general one.
        level: of its findings.
    """

    id: str
    name: str
    why: str = ""
    remedy: str = ""
    level: str = ERROR


def sarif_log(
    tool: str, version: str, rules: Sequence[SarifRule], findings: Sequence[CiFinding], base: Path
) -> dict[str, Any]:
    """Return a log of findings.

    Args:
        tool: name of the command.
        version: of cfepy.
        rules: the kinds of findings.
        findings: each of one of these kinds.
        base: paths below this folder are relative to it.

    Returns:
        Plain data for JSON.
    """
    index = {rule.id: at for at, rule in enumerate(rules)}
    run = {
        "tool": {"driver": {"name": tool, "version": version, "rules": [_rule(rule) for rule in rules]}},
        "columnKind": "unicodeCodePoints",
        "originalUriBaseIds": {BASE: {"uri": f"file://{quote(base.as_posix())}/"}},
        "results": [_result(each, index[each.rule], base) for each in findings],
    }
    return {"$schema": SCHEMA, "version": VERSION, "runs": [run]}


def _rule(rule: SarifRule) -> dict[str, Any]:
    full = {"fullDescription": {"text": f"{rule.name}: {rule.why}"}} if rule.why else {}
    return {
        "id": rule.id,
        "shortDescription": {"text": rule.name},
        **full,
        **({"help": {"text": rule.remedy}} if rule.remedy else {}),
        "defaultConfiguration": {"level": rule.level},
    }


def _result(finding: CiFinding, index: int, base: Path) -> dict[str, Any]:
    others = [{"id": at, **_location(place, base)} for at, place in enumerate(finding.places[1:], 1)]
    return {
        "ruleId": finding.rule,
        "ruleIndex": index,
        "level": finding.level,
        "message": {"text": finding.text},
        "locations": [_location(place, base) for place in finding.places[:1]],
        **({"relatedLocations": others} if others else {}),
    }


def _location(place: FindingPlace, base: Path) -> dict[str, Any]:
    location: dict[str, Any] = {"artifactLocation": _artifact(place.file, base)}
    if place.line:
        location["region"] = {"startLine": place.line} | ({"startColumn": place.column} if place.column else {})
    return {"physicalLocation": location}


def _artifact(file: Path, base: Path) -> dict[str, str]:
    if file.is_relative_to(base):
        return {"uri": quote(file.relative_to(base).as_posix()), "uriBaseId": BASE}
    path = quote(file.as_posix())
    return {"uri": f"file://{path}" if file.is_absolute() else path}
