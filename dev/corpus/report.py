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

This page lists {total} scenarios with public ROS 1 nodes in Python. The nodes run unmodified from their repositories.
Each node gets a stimulus from a second node. The scenario checks the published messages, the answers of services and
the printed lines of the node. All checks hold for the same nodes on rospy 1.15 with a ROS master. In virtual time on
cfepy, {passed} of {total} scenarios pass all checks. The wall time includes the start of the interpreter, on an x86-64
machine with two cores.

{driven} of the nodes get a generated stimulus (`dev/corpus/driving.py`): five messages on each subscribed topic, and a
call of each service. The messages, answers, printed lines, parameters and exit status of the node are compared with a
run on ROS that has the same stimulus. If two runs on ROS differ because of times, chance or the end of the recording,
counts are compared. {silent} of these nodes end on ROS before they register at the master, mostly because a parameter,
an argument or Python 2 is missing. They do the same on cfepy. To fly a scenario on both and show the differences, run
`python -m dev.corpus beside ID` on a computer with rospy and rosmaster.

`python -m dev.corpus report` writes this page. Nodes in C++ are in
[convertor.md](../../how_to/convertor.md#public-nodes).
To try it yourself:

```
python -m dev.corpus fetch ~/corpus
python -m dev.corpus run --sources ~/corpus --jobs 2
```

`fetch` downloads each repository at the commit below. No code of these repositories is part of cfepy. To run all
scenarios as tests, set {environment} to the folder and run `pytest tests/corpus`. The scenarios are in
`dev/corpus/scenarios.json`.

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
