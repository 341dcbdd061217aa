"""Findings of the check of nodes in C++ as SARIF: its rules, and the message of each finding."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

from cfepy.extra.convert.message_headers import Profile
from cfepy.extra.convert.node_check.findings import CheckReport, RuleFinding
from cfepy.extra.convert.node_check.rules import RULES, CheckRule
from cfepy.writing.ci_findings import CiFinding, FindingPlace
from cfepy.writing.sarif_log import SarifRule, sarif_log


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
    rules = [_rule(rule, profile) for rule in RULES.values() if rule.level(profile) is not None]
    found = sorted(dict.fromkeys(finding for report in reports for finding in report.findings))
    return sarif_log("cfepy convert check", version, rules, [_finding(each, profile) for each in found], base)


def _rule(rule: CheckRule, profile: Profile) -> SarifRule:
    return SarifRule(rule.id, rule.what, rule.why, rule.remedy, str(rule.level(profile)))


def _finding(found: RuleFinding, profile: Profile) -> CiFinding:
    rule = RULES[found.rule]
    return CiFinding(found.rule, found.message or rule.what, (FindingPlace(*found.place),), str(rule.level(profile)))
