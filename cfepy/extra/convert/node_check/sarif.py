"""Findings as SARIF 2.1.0, the format that code hosts and editors read: one run, with its rules and results.

Source: OASIS, Static Analysis Results Interchange Format (SARIF) Version 2.1.0.
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any
from urllib.parse import quote

from cfepy.extra.convert.message_headers import Profile
from cfepy.extra.convert.node_check.findings import CheckReport, RuleFinding
from cfepy.extra.convert.node_check.rules import RULES, CheckRule

VERSION = "2.1.0"
SCHEMA = "https://docs.oasis-open.org/sarif/sarif/v2.1.0/errata01/os/schemas/sarif-schema-2.1.0.json"


def sarif_of(reports: Sequence[CheckReport], profile: Profile, version: str, base: Path) -> dict[str, Any]:
    """Return a log of findings.

    Args:
        reports: of the programs.
        profile: the profile of the check.
        version: of cfepy.
        base: paths below this folder are relative to it.

    Returns:
        Plain data for JSON.
    """
    rules = [rule for rule in RULES.values() if rule.level(profile) is not None]
    index = {rule.id: at for at, rule in enumerate(rules)}
    findings = dict.fromkeys(finding for report in reports for finding in report.findings)
    run = {
        "tool": {
            "driver": {
                "name": "cfepy convert check",
                "version": version,
                "rules": [_rule(rule, profile) for rule in rules],
            }
        },
        "columnKind": "unicodeCodePoints",
        "originalUriBaseIds": {"BASE": {"uri": f"file://{quote(str(base))}/"}},
        "results": [_result(each, index[each.rule], profile, base) for each in sorted(findings)],
    }
    return {"$schema": SCHEMA, "version": VERSION, "runs": [run]}


def _rule(rule: CheckRule, profile: Profile) -> dict[str, Any]:
    return {
        "id": rule.id,
        "shortDescription": {"text": rule.what},
        "fullDescription": {"text": f"{rule.what}: {rule.why}"},
        "help": {"text": rule.remedy},
        "defaultConfiguration": {"level": str(rule.level(profile))},
    }


def _result(finding: RuleFinding, index: int, profile: Profile, base: Path) -> dict[str, Any]:
    place = finding.place
    location: dict[str, Any] = {"artifactLocation": _artifact(place.file, base)}
    if place.line:
        location["region"] = {"startLine": place.line} | ({"startColumn": place.column} if place.column else {})
    return {
        "ruleId": finding.rule,
        "ruleIndex": index,
        "level": str(RULES[finding.rule].level(profile)),
        "message": {"text": finding.message or RULES[finding.rule].what},
        "locations": [{"physicalLocation": location}],
    }


def _artifact(file: Path, base: Path) -> dict[str, str]:
    if file.is_relative_to(base):
        return {"uri": quote(str(file.relative_to(base))), "uriBaseId": "BASE"}
    return {"uri": f"file://{quote(str(file))}" if file.is_absolute() else quote(str(file))}
