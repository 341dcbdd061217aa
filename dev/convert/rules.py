"""The table of rules in docs/how_to/convertor.md: `python -m dev.convert.rules` rewrites it."""

from __future__ import annotations

import argparse

from cfepy.extra.convert import Profile
from cfepy.extra.convert.node_check import RULES
from dev.convert.survey import DOCUMENT, between

BEGIN, END = "<!-- rules: made by python -m dev.convert.rules -->", "<!-- end of rules -->"


def table() -> str:
    """Return the rules as a table."""
    lines = ["| rule | host | pool | strict | problem | what to do |", "|---|---|---|---|---|---|"]
    for rule in RULES.values():
        levels = " | ".join(str(rule.level(profile) or "") for profile in Profile)
        lines.append(f"| `{rule.id}` | {levels} | {rule.what} | {rule.remedy} |")
    return "\n".join(lines)


if __name__ == "__main__":
    argparse.ArgumentParser(prog="python -m dev.convert.rules", description=__doc__).parse_args()
    DOCUMENT.write_text(between(DOCUMENT.read_text(encoding="utf-8"), BEGIN, END, table()), encoding="utf-8")
