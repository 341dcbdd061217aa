"""The lines that install cfepy work in a fresh checkout, on each of three pages."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
from pathlib import Path

import pytest

from tests.docs.pages import ROOT, commands

PLACE = "<cfepy>"  # the page's placeholder for the checkout's folder
LEFT = shutil.ignore_patterns(
    *(".git", ".venv", ".hypothesis", "__pycache__", ".*_cache", "dist", "build", "*.egg-info", ".site", "tests")
)


def lines_of(page: str) -> list[str]:
    """Return the lines of a page that make an environment. .ci/run runs the tests in it with its own line."""
    return [line for line in commands(ROOT / page) if " -m venv " in line and "-m pytest" not in line]


PAGES = ("README.md", "docs/how_to/install.md", "docs/how_to/run_a_ros_node.md")
LINES = [line for page in PAGES for line in lines_of(page)]


def test_each_page_has_one_line() -> None:
    assert len(LINES) == 3
    assert len({re.sub(r".* install ", "", line) for line in LINES}) == 3


@pytest.mark.slow
@pytest.mark.parametrize("line", LINES)
def test_line_makes_an_environment_with_cfepy(line: str, tmp_path: Path) -> None:
    copy = tmp_path / "cfepy"
    shutil.copytree(ROOT, copy, ignore=LEFT)
    environment = {name: value for name, value in os.environ.items() if not name.startswith(("PYTHON", "VIRTUAL_"))}
    shell = f"{line.replace(PLACE, str(copy))} && .venv/bin/cfepy run capture --for 1 --no-console"
    done = subprocess.run(["bash", "-c", shell], cwd=copy, env=environment, capture_output=True, text=True)
    assert done.returncode == 0, f"{shell}\n{done.stdout}\n{done.stderr}"
    assert re.search(r"^trace: \w{32}$", done.stdout, re.MULTILINE)
