"""docs/how_to/porting.md: one section per step, each with one command, and the commands do what the page describes."""

from __future__ import annotations

import re
import shlex
import shutil
import subprocess
from pathlib import Path

import pytest

from cfepy.cli.main import main
from cfepy.extra.c import headers_folder
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


EM_ARM = 40
ARM = "arm-linux-gnueabihf-g++"
STAND_IN_TREE = """cmake_minimum_required(VERSION 3.16)
project(tree C)
add_compile_options(-std=c99 -pedantic -Wstrict-prototypes)
add_library(core_api INTERFACE)
target_include_directories(core_api INTERFACE {headers})
function(add_cfe_app NAME)
    add_library(${{NAME}} MODULE ${{ARGN}})
    set_target_properties(${{NAME}} PROPERTIES PREFIX "")
endfunction()
add_subdirectory(ros_nodes/gauge)
add_subdirectory(ros_nodes/pump)
"""
"""What a mission tree of cFS does with applications, as far as roscfe.cmake uses it."""


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


@pytest.mark.slow
def test_toolchain_file_of_the_page_builds_the_nodes_for_arm(tmp_path: Path) -> None:
    missing = next((each for each in (ARM, "cmake", "make") if shutil.which(each) is None), None)
    if missing is not None:
        pytest.skip(f"{missing} is not installed")
    toolchain = next(block for block in FENCE.findall(GUIDE) if block.startswith("```cmake\n"))
    file = tmp_path / "toolchain-arm-linux.cmake"
    file.write_text("\n".join(toolchain.splitlines()[1:-1]) + "\n", encoding="utf-8")
    launch = str(ROOT / "examples/tank/launch/tank.launch")
    assert main(["convert", launch, "-o", str(tmp_path / "ros_nodes"), "--no-check"]) == 0
    text = STAND_IN_TREE.format(headers=headers_folder())
    (tmp_path / "CMakeLists.txt").write_text(text, encoding="utf-8")
    made = tmp_path / "build"
    for command in (
        ["cmake", "-S", str(tmp_path), "-B", str(made), f"-DCMAKE_TOOLCHAIN_FILE={file}"],
        ["cmake", "--build", str(made)],
    ):
        done = subprocess.run(command, capture_output=True, text=True, check=False)
        assert done.returncode == 0, done.stdout + done.stderr
    for name in ("gauge", "pump"):
        head = (made / f"ros_nodes/{name}/{name}.so").read_bytes()[:20]
        assert head[:5] == b"\x7fELF\x01"
        assert int.from_bytes(head[18:20], "little") == EM_ARM
