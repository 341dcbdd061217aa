"""`cfepy new app --c`: an application in C that builds, flies and passes its own tests without changes."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

from cfepy.cli.main import main
from cfepy.extra.c import Options, build
from cfepy.extra.c.toolchain.source_files import find_sources
from tests.extra.c.building import needs_compiler

pytestmark = needs_compiler

STRICT = ("-Werror", "-Wextra", "-pedantic", "-Wstrict-prototypes", "-Wwrite-strings", "-Wpointer-arith", "-std=c99")
"""The flags of cFS's own build, and more."""


@pytest.fixture(autouse=True)
def _in_an_empty_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)


def test_it_is_built_and_flies(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["new", "app", "thermal", "--c"]) == 0
    assert "Now: cfepy build thermal && cfepy run thermal" in capsys.readouterr().out
    assert main(["build", "thermal"]) == 0
    assert main(["check", "thermal"]) == 0
    assert main(["run", "thermal", "--for", "2"]) == 0
    assert "THERMAL initialized" in capsys.readouterr().out


@pytest.mark.slow
def test_its_own_tests_pass() -> None:
    main(["new", "app", "--c", "thermal"])
    root = Path(__file__).parents[2]
    program = f"import sys, pytest; sys.path.insert(0, {str(root)!r}); sys.exit(pytest.main(['-q', 'thermal']))"
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout


def test_one_that_is_not_built_is_found_by_check(capsys: pytest.CaptureFixture[str]) -> None:
    main(["new", "app", "thermal", "--c"])
    assert main(["check", "thermal"]) == 1
    assert "if it is the application in fsw/src, compile it: cfepy build thermal" in capsys.readouterr().out


@pytest.mark.parametrize("omit_deprecated", [False, True])
def test_it_compiles_without_a_warning(omit_deprecated: bool) -> None:
    main(["new", "app", "--c", "thermal"])
    assert build("thermal", options=Options(flags=STRICT, omit_deprecated=omit_deprecated)).warnings == []


def test_its_cmake_lists_name_all_sources() -> None:
    main(["new", "app", "--c", "thermal"])
    said = find_sources(Path("thermal"))
    assert {*said.code, *said.tables} == set(Path("thermal").rglob("*.c"))


def test_the_longest_name_flies(capsys: pytest.CaptureFixture[str]) -> None:
    name = "thermal_contro"
    assert main(["new", "app", "--c", name]) == 0
    assert main(["build", name]) == 0
    assert main(["run", name, "--for", "2"]) == 0
    assert f"{name.upper()} initialized" in capsys.readouterr().out


def test_nothing_of_the_templates_is_left() -> None:
    main(["new", "app", "--c", "thermal"])
    for file in Path("thermal").rglob("*"):
        assert "NAME" not in file.name
        assert file.is_dir() or b"{{" not in file.read_bytes(), file


@pytest.mark.parametrize("name", ["cfe_es", "os_extra"])
def test_names_of_cfe_cannot_be_used(name: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["new", "app", name, "--c"]) == 2
    assert "would clash with cFE's own" in capsys.readouterr().err
    assert list(Path().iterdir()) == []


def test_only_applications_are_in_c(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit):
        main(["new", "mission", "orbit", "--c"])
    assert "unrecognized arguments: --c; only applications can be in C" in capsys.readouterr().err
    assert list(Path().iterdir()) == []
