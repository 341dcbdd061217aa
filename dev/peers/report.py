"""Report results of test files: one line each, and docs/reference/generated/peer_tests.md."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from dev.peers.flight import Verdict
from dev.peers.peers import Peers

PAGE = Path(__file__).parents[2] / "docs" / "reference" / "generated" / "peer_tests.md"
_HEAD = """# Tests of ROS packages

{total} public test files of ROS 1's own packages, Python files and launch files for rostest, run unmodified from their
repositories. How many of their tests pass on ROS was counted with rospy 1.15 and a ROS master; {known} files have been
run there. Of these {good} pass on cfepy as they do on ROS, but for at most one test in twenty and for those that look
into what cfepy does otherwise, which the last column names. Tests that fail on ROS fail there for reasons of their own,
such as a library that was not installed; so more tests can pass here than there.

This page is made by `python -m dev.peers report`. To try it yourself:

```
python -m dev.peers fetch ~/peers
python -m dev.peers run --sources ~/peers --jobs 2
```

`fetch` gets each repository at its commit; nothing of it is part of cfepy. With the folder in CFEPY_PEERS_SOURCES,
`pytest tests/peers` runs them all as tests. The list is `dev/peers/peers.json`. A file that brings the library it
tests along is run with that library, in the place of cfepy's; the others test cfepy's own.

| file | repository | tests | pass on ROS | pass on cfepy | verdict | what does not, and why |
|---|---|---|---|---|---|---|
"""

_LEFT_OUT = """
## What is left out

| files | why |
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
