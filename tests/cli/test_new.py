"""`cfepy new`: its files run at once, have no problems, and their own tests pass."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

from cfepy.cli.main import main

KINDS = [("app", "thermal"), ("mission", "orbit")]


@pytest.fixture(autouse=True)
def _in_an_empty_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)


@pytest.mark.parametrize(("kind", "name"), KINDS)
def test_it_runs_at_once(kind: str, name: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["new", kind, name]) == 0
    assert f"Now: cfepy run {name}" in capsys.readouterr().out
    assert main(["check", name]) == 0
    assert main(["run", name, "--for", "2"]) == 0
    assert "initialized, version" in capsys.readouterr().out


@pytest.mark.slow
@pytest.mark.parametrize(("kind", "name"), KINDS)
def test_its_own_tests_pass(kind: str, name: str) -> None:
    main(["new", kind, name])
    root = Path(__file__).parents[2]
    program = f"import sys, pytest; sys.path.insert(0, {str(root)!r}); sys.exit(pytest.main(['-q', {name!r}]))"
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout


def test_the_longest_name_runs(capsys: pytest.CaptureFixture[str]) -> None:
    name = "thermal_contro"
    assert main(["new", "app", name]) == 0
    assert main(["run", name, "--for", "2", "--quiet"]) == 0


def test_nothing_of_the_example_is_left() -> None:
    main(["new", "app", "thermal"])
    for file in Path("thermal").rglob("*"):
        assert file.is_dir() or b"sample" not in file.read_bytes().lower(), file
        assert file.is_dir() or b"{{" not in file.read_bytes(), file


def test_nothing_is_overwritten(capsys: pytest.CaptureFixture[str]) -> None:
    Path("thermal").mkdir()
    assert main(["new", "app", "thermal"]) == 2
    assert "thermal: already exists" in capsys.readouterr().err
    assert list(Path("thermal").iterdir()) == []


@pytest.mark.parametrize("name", ["Thermal", "2nd", "a-b", "../x", "", "json", "class", "cfepy", "fifteen_letters"])
def test_names_that_cannot_be_used(name: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["new", "app", name]) == 2
    assert capsys.readouterr().err.startswith("cfepy: NAME: ")
    assert list(Path().iterdir()) == []
