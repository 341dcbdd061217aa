"""The contracts of `pyproject.toml`, which import-linter checks: modules that the core must not import."""

from __future__ import annotations

import subprocess
import sys
import tomllib
from typing import Any

import pytest

from dev.house.floors import GROUND_FLOOR, LEVEL
from dev.house.tree import ROOT

PYPROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
CONTRACTS: list[dict[str, Any]] = PYPROJECT["tool"]["importlinter"]["contracts"]
COMPUTER = ("rtos", "osal", "psp", "msg", "fs", "es", "sb", "evs", "time", "tbl")
CHECK = "import sys; from importlinter.cli import lint_imports; sys.exit(lint_imports(no_cache=True, no_logo=True))"


def contract(beginning: str) -> dict[str, Any]:
    (found,) = (each for each in CONTRACTS if each["name"].startswith(beginning))
    return found


def above(parts: tuple[str, ...], base: int = GROUND_FLOOR) -> set[str]:
    """Return the packages that are neither parts nor on the ground floor, by their names in contracts."""
    own = {part for part, level in LEVEL.items() if level > base and part not in parts}
    shown = {f"cfepy.{part}" for part in own if (ROOT / "cfepy" / part).exists()}
    shown |= {f"cfepy.{part}" for part in own if (ROOT / "cfepy" / f"{part}.py").exists() and not part.startswith("__")}
    return shown | {"cfepy.extra"}


def test_contracts_are_kept() -> None:
    done = subprocess.run([sys.executable, "-c", CHECK], cwd=ROOT, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr


def test_new_package_is_in_the_contract_of_the_computer() -> None:
    named = {*contract("The computer")["forbidden_modules"]}
    assert above(COMPUTER) <= named
    assert {"rospy_shim", "ros_libraries", "apps"} <= named


@pytest.mark.parametrize("beginning", ["The computer", "Types of ROS"])
def test_modules_of_a_contract_exist(beginning: str) -> None:
    for name in contract(beginning)["forbidden_modules"]:
        place = ROOT / name.replace(".", "/")
        assert place.is_dir() or place.with_suffix(".py").is_file(), name


def test_all_add_ons_are_named() -> None:
    folders = {f"cfepy.extra.{each.parent.name}" for each in (ROOT / "cfepy" / "extra").glob("*/__init__.py")}
    assert folders == {*contract("Add-ons are independent")["modules"]}
