"""The workflow of docs/how_to/ci.md is the file of the example, and its steps work the first time and later."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest
import yaml

from cfepy.extra.exploration.results_file import keep_failure
from cfepy.reading.resources import import_path
from cfepy.schedules import Schedule

ROOT = Path(__file__).parents[2]
PROBE = ROOT / "examples" / "probe"
WORKFLOW = PROBE / ".github" / "workflows" / "cfepy.yml"
OURS = ROOT / ".github" / "workflows" / "ci.yml"
EARLIER = ("explore", "mission", "--for", "1", "--seeds", "1", "--quiet", "--results")
KEPT = {"restore": "actions/cache/restore", "save": "actions/cache/save", "artifact": "actions/upload-artifact"}


def job_of(file: Path, name: str) -> dict[str, Any]:
    """Return a job of a workflow."""
    found: dict[str, Any] = yaml.safe_load(file.read_text(encoding="utf-8"))["jobs"][name]
    return found


def test_the_page_shows_the_workflow_of_the_example() -> None:
    page = (ROOT / "docs" / "how_to" / "ci.md").read_text(encoding="utf-8")
    assert f"```yaml\n{WORKFLOW.read_text(encoding='utf-8')}```\n" in page


def test_workflow_keeps_the_files_that_steps_write() -> None:
    steps = job_of(WORKFLOW, "cfepy")["steps"]
    paths = {
        kind: [step["with"]["path"] for step in steps if step.get("uses", "").startswith(action)]
        for kind, action in KEPT.items()
    }
    assert paths == {"restore": ["explored"], "save": ["explored"], "artifact": ["found"]}
    for step in steps:
        if step.get("uses", "").startswith((KEPT["save"], KEPT["artifact"])):
            assert step["if"] == "always()"


def test_own_workflow_runs_the_required_checks() -> None:
    assert "bash .ci/run" in [step.get("run") for step in job_of(OURS, "all")["steps"]]
    assert {name.partition("-")[0] for name in job_of(OURS, "systems")["strategy"]["matrix"]["system"]} == {
        *("ubuntu", "macos", "windows")
    }


@pytest.mark.slow
def test_steps_work_with_and_without_results_of_an_earlier_run(tmp_path: Path) -> None:
    package = tmp_path / "probe"
    shutil.copytree(PROBE, package)
    job = job_of(WORKFLOW, "cfepy")
    tools = tmp_path / "bin"
    tools.mkdir()
    for name, module in (("cfepy", "cfepy"), ("python", "")):  # as in an environment with cfepy
        words = f"-m {module}" if module else ""
        (tools / name).write_text(f'#!/bin/sh\nexec "{sys.executable}" {words} "$@"\n', encoding="utf-8")
        (tools / name).chmod(0o755)
    environment = {**os.environ, **{name: str(value) for name, value in job["env"].items()}}
    environment |= {"BUDGET": "3", "PATH": f"{tools}:{os.environ['PATH']}", "PYTHONPATH": import_path()}
    environment |= {"GITHUB_RUN_ID": "77", "GITHUB_RUN_ATTEMPT": "1", "GITHUB_RUN_NUMBER": "5"}
    results = package / "explored" / "76-1.results"
    for is_later in (False, True):
        if is_later:
            assert list(results.parent.iterdir()) == []
            subprocess.run([tools / "cfepy", *EARLIER, results], cwd=package, env=environment, check=True)
            keep_failure(results, "gone", "a failure that was mended", Schedule("random", 3))
        for step in job["steps"]:
            if "run" in step and not step["run"].startswith("pip install"):
                command = ["bash", "-e", "-o", "pipefail", "-c", step["run"]]
                done = subprocess.run(
                    command, cwd=package, env=environment, capture_output=True, text=True, check=False
                )
                assert done.returncode == 0, f"{step['run']}\n{done.stdout}\n{done.stderr}"
    assert list(results.parent.iterdir()) == [results]
    found = {path.name for path in (package / "found").iterdir()}
    assert found >= {"tests.xml", "schedules.json", "earlier-76-1.json"}
