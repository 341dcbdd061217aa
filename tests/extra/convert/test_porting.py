"""docs/how_to/porting.md: one section per step, each with one command, and the commands do what the page describes."""

from __future__ import annotations

import re
import shlex
import shutil
from pathlib import Path

import pytest

from cfepy.cli.main import main
from tests.test_docs import FENCE

ROOT = Path(__file__).parents[3]
GUIDE = (ROOT / "docs/how_to/porting.md").read_text(encoding="utf-8")
SECTION = re.compile(r"^## (\d+)\. [^\n]+\n(.*?)(?=^## |\Z)", re.MULTILINE | re.DOTALL)
BY_HAND = "make "  # in a mission tree of cFS, which is not available here; dev.convert.mission_tree does it
CROSS = "aarch64-linux-gnu-g++"
SHOWN = {
    1: ("host: 2 nodes, 0 refused",),
    2: (
        "[/pump] [ INFO] [316533802.550",
        "]: pump on\n",
        "/level       116  10.1     0",
    ),  # then the costs of the calls
    3: ("2 nodes,",),
    5: ("* RESULT: SUCCESS", "* TESTS: 2"),
    6: ("host: 2 nodes, 0 refused",),
    7: ("0x0901  /level                   116        346        0                 10.1", "0x089C  HK_COMBINED_PKT1"),
    8: ("5 schedules, 0 failed",),
    9: ("the same run as tank.cfepy",),
    10: ("drops /pump #3",),
}


def commands() -> dict[int, list[str]]:
    """Return the commands of each section."""
    found: dict[int, list[str]] = {}
    for number, text in SECTION.findall(GUIDE):
        blocks = [block for block in FENCE.findall(text) if block.startswith("```sh\n")]
        found[int(number)] = [line for block in blocks for line in block.splitlines()[1:-1]]
    return found


def test_each_step_has_one_command() -> None:
    assert [number for number, lines in commands().items() if len(lines) != 1] == []
    by_hand = [number for number, (line,) in commands().items() if line.startswith(BY_HAND)]
    assert sorted([*SHOWN, *by_hand]) == list(range(1, 11))


@pytest.mark.slow
@pytest.mark.parametrize("number", SHOWN)
def test_command_of_a_step_prints_the_text_of_the_page(
    number: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    shutil.copytree(ROOT / "examples/tank", tmp_path / "examples/tank")
    monkeypatch.chdir(tmp_path)
    monkeypatch.delenv("ROS_PACKAGE_PATH", raising=False)
    for command in commands()[number][0].split(" && "):
        words = shlex.split(command)
        if words[0].startswith("CXX="):
            if shutil.which(CROSS) is None:
                pytest.skip(f"{CROSS} is not installed")
            monkeypatch.setenv(*words.pop(0).split("=", 1))
        assert main(words[1:]) == 0
    shown = "".join(capfd.readouterr())
    assert [text for text in SHOWN[number] if text not in shown] == []
