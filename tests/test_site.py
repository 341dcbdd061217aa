"""The documentation as a site: links fit the places of its pages, and mkdocs reports no problem."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

from dev.site import ROOT, linked, pages, slug


@pytest.mark.parametrize(
    ("source", "text", "on_the_site"),
    [
        ("docs/how_to/faults.md", "[a](../../README.md#set-up)", "[a](../project/README.md#set-up)"),
        ("docs/how_to/faults.md", "[a](replay.md) [b](#here)", "[a](replay.md) [b](#here)"),
        ("README.md", "[a](docs/how_to/faults.md)", "[a](../how_to/faults.md)"),
        ("README.md", "![a](docs/pictures/house.svg)", "![a](../pictures/house.svg)"),
        ("README.md", "[a](missions/capture/README.md)", "[a](../missions/capture/README.md)"),
        ("README.md", "[the licence](LICENSE), [a](https://ros.org)", "the licence, [a](https://ros.org)"),
        ("missions/capture/README.md", "[a](../../docs/how_to/replay.md#x)", "[a](../../how_to/replay.md#x)"),
        ("missions/capture/README.md", "```\n[a](startup.scr)\n```\n[a](startup.scr)", "```\n[a](startup.scr)\n```\na"),
    ],
)
def test_links_fit_the_place_of_a_page(source: str, text: str, on_the_site: str) -> None:
    assert linked(text, source) == on_the_site


def test_pages_are_files_and_anchors_githubs() -> None:
    assert [path for path in pages() if not (ROOT / path).is_file()] == []
    assert slug("Bags, topics & `rosbag`: 2 -- or 3?") == "bags-topics--rosbag-2----or-3"


@pytest.mark.slow
def test_site_is_built_without_a_warning(tmp_path: Path) -> None:
    command = [sys.executable, "-m", "mkdocs", "build", "--strict", "--site-dir", str(tmp_path)]
    environ = {**os.environ, "NO_MKDOCS_2_WARNING": "1"}
    built = subprocess.run(command, cwd=ROOT, env=environ, capture_output=True, text=True, check=False)
    assert built.returncode == 0, built.stderr
    missions, how_to = "missions/capture/index.html", "how_to/explore_schedules/index.html"
    for page in ("index.html", how_to, "project/index.html", missions):
        assert "cfepy" in (tmp_path / page).read_text(encoding="utf-8")
