"""Features missing in a Python that supports cfepy only in part."""

from __future__ import annotations

from pathlib import Path

import pytest

from cfepy.interpreter import host_system
from cfepy.mission import Mission
from cfepy.writing.console import Console
from tests.mission.flights import write_mission


@pytest.mark.parametrize(
    ("program", "error", "absent"),
    [
        ("no-such-program", FileNotFoundError(), True),
        ("no-such-program", PermissionError(), True),  # the answer where a folder of PATH may not be searched
        ("sh", PermissionError(), False),
        ("./no-program", PermissionError(), False),
        ("no-such-program", OSError(), False),
    ],
)
def test_absent_program_is_distinguished_from_one_that_cannot_start(program: str, error: OSError, absent: bool) -> None:
    assert host_system.is_absent(program, error) is absent


def test_modules_of_cpython_may_have_separate_builtins() -> None:
    assert host_system.has_own_builtins()


@pytest.mark.parametrize("line", ["node.py, __main__, NODE", "app, main, APP"])
def test_nodes_and_own_applications_are_refused_without_required_features(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, line: str
) -> None:
    monkeypatch.setattr(host_system, "has_own_builtins", lambda: False)
    code = {"node": "print('the node ran')\n", "app": "def main(cfe):\n    cfe.os.printf('the app ran\\n')\n"}
    folder = write_mission(
        tmp_path, f"CFE_APP, {line}, 100, 16384, 0, 0;\nCFE_APP, hk, HK_AppMain, HK, 90, 16384, 0, 0;\n!", **code
    )
    with Mission(folder, console=Console(quiet=True)) as mission:
        mission.run_for(1)
        lines = mission.console.lines
    assert not [each for each in lines if each.endswith(" ran")]
    assert [each for each in lines if "run them with CPython" in each]
    assert [each for each in lines if "HK Initialized" in each]
