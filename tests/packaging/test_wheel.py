"""A wheel of cfepy, installed in a separate environment, works away from the checkout."""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
import venv
import zipfile
from pathlib import Path

import pytest

from cfepy import __version__
from cfepy.mission import Mission
from cfepy.writing.console import Console
from tests.extra.c.building import needs_compiler

ROOT = Path(__file__).parents[2]
SHIPPED = [
    "cfepy/extra/c/engine/engine.h",
    "cfepy/extra/c/engine/run.c",
    "cfepy/extra/c/engine/switch_x86_64.S",
    "cfepy/extra/c/headers/es.h",
    "cfepy/extra/c/headers/names.txt",
    "cfepy/cli/run/templates/c_app/fsw/src/NAME.c.in",
    "cfepy/py.typed",
    "cfepy/share/apps/hk/tables/hk_cpy_tbl.tbl",
    "cfepy/share/boards/rx64m.yaml",
    "cfepy/share/missions/capture/startup.scr",
    "cfepy/share/missions/rx64m_pubsub/mission.yaml",
    "ros_libraries/tf/transformations/__init__.py",
    "cfepy/share/ros_packages/cfepy_plant/nodes/laser.py",
    "cfepy/share/ros_packages/cfepy_plant/maps/room.pgm",
    "ros_libraries/tf2_ros/__init__.py",
    "rospy_shim/public_names.txt",
    "rospy_shim/types/msgs/definitions/std_msgs.msgs",
]

pytestmark = pytest.mark.slow


@pytest.fixture(scope="module")
def wheel(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("wheel")
    execute([sys.executable, "-m", "pip", "wheel", "--no-deps", "--wheel-dir", str(folder), str(ROOT)], folder)
    (built,) = folder.glob("cfepy-*.whl")
    return built


@pytest.fixture(scope="module")
def home(wheel: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return a folder away from the checkout, with an environment in which the wheel is installed."""
    folder = tmp_path_factory.mktemp("elsewhere")
    venv.create(folder / "venv", with_pip=True)
    execute([str(folder / "venv/bin/python"), "-m", "pip", "install", "--quiet", str(wheel)], folder)
    return folder


def execute(command: list[str], folder: Path, **more: str) -> str:
    environment = {name: value for name, value in os.environ.items() if not name.startswith("PYTHON")} | more
    done = subprocess.run(command, cwd=folder, env=environment, capture_output=True, text=True)
    assert done.returncode == 0, f"{' '.join(command)}\n{done.stdout}\n{done.stderr}"
    return done.stdout


def cfepy(home: Path, *arguments: str) -> str:
    return execute([str(home / "venv/bin/cfepy"), *arguments], home)


def test_wheel_has_all_shipped_files(wheel: Path) -> None:
    names = set(zipfile.ZipFile(wheel).namelist())
    assert names.issuperset(SHIPPED)
    assert any(name.endswith("licenses/LICENSE") for name in names)
    assert not [
        name for name in names if name.startswith(("tests/", "dev/", "benchmarks/", "docs/")) or "__pycache__" in name
    ]


def test_capture_mission_has_the_trace_of_the_checkout(home: Path) -> None:
    output = cfepy(home, "run", "capture", "--for", "1", "--no-console", "--json", "numbers.json")
    numbers = json.loads((home / "numbers.json").read_text(encoding="utf-8"))
    assert output.splitlines()[-2] == f"trace: {numbers['trace']}"
    assert {topic["name"] for topic in numbers["topics"]} >= {"/joint_states", "/motor_command"}
    with Mission("capture", console=Console(quiet=True)) as mission:
        mission.run_for(1)
        mission.shut_down_nodes()
        assert mission.trace.digest() == numbers["trace"]


def test_boards_are_found(home: Path) -> None:
    output = cfepy(home, "board", "list")
    assert "linux" in output
    assert "rx64m" in output


@needs_compiler
def test_compiled_application_is_created_built_and_flown_away_from_the_checkout(home: Path, wheel: Path) -> None:
    execute([str(home / "venv/bin/python"), "-m", "pip", "install", "--quiet", f"{wheel}[c]"], home)
    cfepy(home, "new", "app", "probe", "--c")
    cfepy(home, "build", "probe")
    assert cfepy(home, "check", "probe").splitlines()[-1] == "nothing found"
    output = cfepy(home, "run", "probe", "--for", "2", "--no-console")
    with Mission(str(home / "probe"), console=Console(quiet=True)) as mission:
        mission.run_for(2)
        assert output.splitlines()[-2] == f"trace: {mission.trace.digest()}"


@needs_compiler
def test_engine_kernel_and_bus_are_compiled_on_request(home: Path, tmp_path: Path) -> None:
    """As docs/how_to/install.md has it."""
    venv.create(tmp_path / "venv", with_pip=True)
    python = str(tmp_path / "venv/bin/python")
    execute([python, "-m", "pip", "install", "--quiet", str(ROOT)], tmp_path, CFEPY_ENGINE="1")
    (packages,) = tmp_path.glob("venv/lib/python*/site-packages")
    assert list((packages / "cfepy" / "extra" / "c").glob("_engine.*"))
    (tags,) = packages.glob("cfepy-*.dist-info/WHEEL")
    assert "Root-Is-Purelib: false" in tags.read_text(encoding="utf-8")
    for folder, state in ((home, "interpreted"), (tmp_path, "compiled")):
        first, second, *_ = cfepy(folder, "--version").splitlines()
        assert (first, second[:18]) == (f"cfepy {__version__} (kernel and bus {state})", "cfe_version 7.0.1:")
    flights = [cfepy(each, "run", "capture", "--for", "1", "--no-console") for each in (home, tmp_path)]
    traces = [re.search(r"^trace: \w{32}$", each, re.MULTILINE) for each in flights]
    assert traces[0] is not None
    assert traces[1] is not None
    assert traces[0][0] == traces[1][0]
