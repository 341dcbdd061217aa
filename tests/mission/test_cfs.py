"""The mission of NASA's applications: its tables match their texts, and with the compiled code its scenario happens."""

from __future__ import annotations

import os
import runpy
import shutil
from pathlib import Path

import pytest

from cfepy.cli.main import main
from cfepy.pilot import RunPlan, fly
from dev.twin.flight_apps import FLIGHT_APPS

FOLDER = Path(__file__).parents[2] / "missions" / "cfs"
DEFINITIONS = sorted(
    each for each in FOLDER.iterdir() if each.suffix in (".yaml", ".py") and each.with_suffix(".tbl").exists()
)
BUILT = os.environ.get("CFEPY_REAL_CFE", "")
NAMES = [app.name.lower() for app in FLIGHT_APPS]


def test_every_table_has_a_definition() -> None:
    assert sorted(each.stem for each in FOLDER.glob("*.tbl")) == sorted(each.stem for each in DEFINITIONS)


@pytest.mark.parametrize("definition", DEFINITIONS, ids=lambda path: path.name)
def test_tables_match_their_definitions(definition: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    shutil.copytree(FOLDER, tmp_path / "cfs")
    made = tmp_path / "cfs" / f"{definition.stem}.tbl"
    made.unlink()
    if definition.suffix == ".yaml":
        assert main(["tbl", "build", str(definition), "-o", str(made)]) == 0
    else:
        monkeypatch.syspath_prepend(str(tmp_path / "cfs"))
        runpy.run_path(str(tmp_path / "cfs" / definition.name), run_name="__main__")
    assert made.read_bytes() == definition.with_suffix(".tbl").read_bytes()


@pytest.mark.slow
@pytest.mark.skipif(not (Path(BUILT) / "cf/lc.so").exists(), reason="CFEPY_REAL_CFE names no folder with LC's code")
@pytest.mark.parametrize("tasks", ["thread", "greenlet"])
def test_scenario_succeeds(tasks: str, tmp_path: Path) -> None:
    shutil.copytree(FOLDER, tmp_path / "cfs")
    for name in NAMES:
        shutil.copy(Path(BUILT) / "cf" / f"{name}.so", tmp_path / "cfs")
    plan = RunPlan((str(tmp_path / "cfs"),), script=str(tmp_path / "cfs" / "scenario.txt"), tasks=tasks)
    outcome = fly(plan).outcome
    assert outcome.ok, outcome.text()


@pytest.mark.slow
@pytest.mark.skipif(not (Path(BUILT) / "cf/cf.so").exists(), reason="CFEPY_REAL_CFE names no folder with CF's code")
def test_files_are_downlinked_and_uplinked(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    pytest.importorskip("cfdppy", reason="cfdp-py is not installed")
    shutil.copytree(FOLDER, tmp_path / "cfs")
    for name in NAMES:
        shutil.copy(Path(BUILT) / "cf" / f"{name}.so", tmp_path / "cfs")
    received = tmp_path / "received"
    monkeypatch.setattr("sys.argv", ["downlink.py", str(tmp_path / "cfs"), str(received)])
    with pytest.raises(SystemExit) as ended:
        runpy.run_path(str(FOLDER / "downlink.py"), run_name="__main__")
    assert ended.value.code == 0
    sent = (FOLDER / "lc_def_adt.tbl").read_bytes()
    assert [(received / name).read_bytes() == sent for name in ("class_1.tbl", "class_2.tbl")] == [True, True]
