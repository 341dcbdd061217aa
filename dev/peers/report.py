"""Report results of test files: one line each, and docs/reference/generated/peer_tests.md."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from dev.peers.flight import Verdict
from dev.peers.peers import Peers

PAGE = Path(__file__).parents[2] / "docs" / "reference" / "generated" / "peer_tests.md"
_HEAD = """# Tests of ROS packages

This page lists {total} public test files of the packages of ROS 1: Python files, and launch files for rostest. They run
unmodified from their repositories. {known} files were also run on ROS, with rospy 1.15 and a ROS master, to count the
tests that pass there. {good} of these files are "ok": on cfepy, at most one test in twenty of those that pass on ROS
fails. Tests of details in which cfepy differs from ROS do not count; the last column names them. Some tests fail on ROS
for other reasons, such as a library that was not installed, so more tests can pass on cfepy than on ROS.

`python -m dev.peers report` writes this page. To try it yourself:

```
python -m dev.peers fetch ~/peers
python -m dev.peers run --sources ~/peers --jobs 2
```

`fetch` downloads each repository at its commit. No code of these repositories is part of cfepy. To run all files as
tests, set CFEPY_PEERS_SOURCES to the folder and run `pytest tests/peers`. The list is `dev/peers/peers.json`. A file
whose repository has the tested library runs with that library. The other files test cfepy's own libraries.

| file | repository | tests | pass on ROS | pass on cfepy | verdict | failed tests, and reasons |
|---|---|---|---|---|---|---|
"""

_LEFT_OUT = """
## Excluded files

| files | reason |
|---|---|
"""


def row(verdict: Verdict) -> str:
    """Return a line of text."""
    peer = verdict.peer
    counts = f"{_or_unknown(peer.passed):>3} on ROS {verdict.passed:3} here"
    return f"{'ok  ' if verdict.good else 'FAIL'} {counts} {verdict.wall_s:5.1f} s  {peer.name}  {_reason(verdict)}"


def page(peers: Peers, verdicts: Sequence[Verdict]) -> str:
    """Return the page's text."""
    known = [verdict for verdict in verdicts if verdict.peer.passed is not None]
    good = sum(verdict.good for verdict in known)
    head = _HEAD.format(total=len(verdicts), known=len(known), good=good)
    rows = "".join(_table_row(peers, verdict) for verdict in verdicts)
    return f"{head}{rows}{_LEFT_OUT}" + "".join(f"| {what} | {why} |\n" for what, why in peers.left_out)


def write_page(peers: Peers, verdicts: Sequence[Verdict]) -> None:
    """Write the page."""
    PAGE.write_text(page(peers, verdicts), encoding="utf-8")


def _table_row(peers: Peers, verdict: Verdict) -> str:
    peer = verdict.peer
    commit = peers.commits[peer.repo]
    link = f"[{peer.path}](https://github.com/{peer.repo}/blob/{commit}/{peer.path})"
    reason = _reason(verdict).replace("|", "\\|")
    counts = f"{_or_unknown(peer.tests)} | {_or_unknown(peer.passed)} | {verdict.passed}"
    return f"| {link} | {peer.repo} {commit[:8]} | {counts} | {'ok' if verdict.good else 'not yet'} | {reason} |\n"


def _or_unknown(count: int | None) -> str:
    return "?" if count is None else str(count)


def _reason(verdict: Verdict) -> str:
    """Return the failed tests, with their reasons where known, and further remarks."""
    peer = verdict.peer
    names = [f"{name}: {peer.aside[name]}" if name in peer.aside else name for name in verdict.failing]
    return "; ".join(filter(None, [verdict.reason, *names, peer.note]))
