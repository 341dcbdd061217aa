"""Run scenarios in parallel, each in its own process. Its time includes the start of the process."""

from __future__ import annotations

import json
import subprocess
import sys
import tempfile
import time
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import asdict
from pathlib import Path

from dev.corpus.flight import Flight
from dev.corpus.scenarios import Scenario, read_corpus
from dev.corpus.sources import Sources
from dev.corpus.verdict import Outcome, Verdict, judge

LONGEST_S = 120


def run_all(scenarios: Sequence[Scenario], sources: Sources, jobs: int, tasks: str) -> dict[str, Verdict]:
    """Run scenarios, `jobs` at a time. Returns verdicts by name."""
    with ThreadPoolExecutor(jobs) as pool:
        verdicts = pool.map(lambda scenario: _run_apart(scenario, sources, tasks), scenarios)
        return {verdict.id: verdict for verdict in verdicts}


def _run_apart(scenario: Scenario, sources: Sources, tasks: str) -> Verdict:
    command = [sys.executable, "-m", "dev.corpus.pool", scenario.id, str(sources.root), tasks]
    begun = time.perf_counter()
    try:
        done = subprocess.run(command, capture_output=True, text=True, timeout=LONGEST_S, check=False)
    except subprocess.TimeoutExpired:
        return Verdict(scenario.id, f"takes longer than {LONGEST_S} s", LONGEST_S)
    wall_s = time.perf_counter() - begun
    if done.returncode:
        return Verdict(scenario.id, f"cfepy failed: {done.stderr.strip().splitlines()[-1]}", wall_s)
    verdict = judge(scenario, Outcome(**json.loads(done.stdout.splitlines()[-1])))
    return Verdict(verdict.id, verdict.reason, wall_s)


def main(name: str, sources: str, tasks: str) -> None:
    """Run one scenario in this process. The last line of the output is its result."""
    scenario = read_corpus().scenarios[name]
    with tempfile.TemporaryDirectory() as folder:
        print(json.dumps(asdict(Flight(scenario, Sources(Path(sources)), Path(folder), tasks).run())))


if __name__ == "__main__":
    main(*sys.argv[1:])
