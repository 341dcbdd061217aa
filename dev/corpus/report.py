"""docs/reference/generated/compatibility.md, the page about the public nodes that run."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from dev.corpus.scenarios import Corpus
from dev.corpus.sources import ENVIRONMENT
from dev.corpus.verdict import Verdict

DRIVE = "drive()"  # the stimulus of an unknown node
PAGE = Path(__file__).parents[2] / "docs" / "reference" / "generated" / "compatibility.md"
_HEAD = """# Compatibility

{total} scenarios with public ROS 1 nodes in Python, run unmodified from their repositories: the node gets a stimulus
from a second node, and what it publishes, answers and prints is checked. All checks hold for the same nodes on rospy
1.15 with a ROS master. In virtual time on cfepy, {passed} of {total} meet all of theirs. The wall time is that of the
whole process, start of the interpreter included, on an x86-64 machine with two cores.

{driven} of them are nodes that were driven without being read (`dev/corpus/driving.py`): each topic that the node
subscribes to gets five messages, each service a call, and all that it publishes, answers, prints, sets and ends with is
held against a run on ROS with the same stimulus. Where two runs on ROS differ, by times, chance or the end of the
recording, counts are compared. {silent} of these nodes end on ROS before they are on the graph, mostly for want of a
parameter, an argument or Python 2, and do the same here. `python -m dev.corpus beside ID`, on a computer with rospy
and rosmaster, flies a scenario on both and shows what is not alike.

This page is made by `python -m dev.corpus report`. Nodes in C++ are in
[convertor.md](../../how_to/convertor.md#public-nodes).
To try it yourself:

```
python -m dev.corpus fetch ~/corpus
python -m dev.corpus run --sources ~/corpus --jobs 2
```

`fetch` gets each repository at the commit below; nothing of it is part of cfepy. With the folder in
{environment}, `pytest tests/corpus` runs them all as tests. The scenarios are in `dev/corpus/scenarios.json`.

| scenario | node | commit | verdict | wall time | reason |
|---|---|---|---|---|---|
"""


def page(corpus: Corpus, verdicts: Sequence[Verdict]) -> str:
    """Return the page's text."""
    passed = sum(verdict.passed for verdict in verdicts)
    driven = [scenario for scenario in corpus.scenarios.values() if scenario.stimulus == DRIVE]
    silent = sum(
        "R['kinds']=={}" in each.expect and not any("services" in text for text in each.expect) for each in driven
    )
    head = _HEAD.format(total=len(verdicts), passed=passed, driven=len(driven), silent=silent, environment=ENVIRONMENT)
    return head + "".join(_row(corpus, verdict) for verdict in verdicts)


def write_page(corpus: Corpus, verdicts: Sequence[Verdict]) -> None:
    """Write the page."""
    PAGE.write_text(page(corpus, verdicts), encoding="utf-8")


def _row(corpus: Corpus, verdict: Verdict) -> str:
    node = corpus.scenarios[verdict.id].node
    commit = corpus.commits[node.repo]
    link = f"[{node.repo}: {node.path}](https://github.com/{node.repo}/blob/{commit}/{node.path})"
    reason = verdict.reason.replace("|", "\\|")
    said = "runs" if verdict.passed else "does not"
    return f"| {verdict.id} | {link} | {commit[:8]} | {said} | {verdict.wall_s:.1f} s | {reason} |\n"
