"""`cfepy build`: its files, its output and its exit status."""

from __future__ import annotations

from pathlib import Path

import pytest

from cfepy.cli.main import main
from tests.extra.c.building import needs_compiler

pytestmark = needs_compiler


@pytest.fixture
def app(tmp_path: Path) -> Path:
    source = tmp_path / "probe/fsw/src/probe.c"
    source.parent.mkdir(parents=True)
    source.write_text('#include "cfe.h"\nvoid PROBE_Main(void) {}\n', encoding="utf-8")
    return tmp_path / "probe"


def test_it_names_what_it_wrote(app: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["build", str(app), "-o", str(tmp_path / "cf/probe.so")]) == 0
    assert capsys.readouterr().out == f"{tmp_path}/cf/probe.so\n"
    assert (tmp_path / "cf/probe.so").read_bytes()[:4] == b"\x7fELF"


def test_a_refused_file_is_a_finding(app: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (app / "fsw/src/probe.c").write_text("nonsense\n", encoding="utf-8")
    assert main(["build", str(app)]) == 1
    assert "probe.c:1" in capsys.readouterr().err


def test_options_reach_the_compiler(app: Path) -> None:
    (app / "fsw/src/probe.c").write_text("#if ONE + TWO != 3\n#error flags\n#endif\nint x;\n", encoding="utf-8")
    assert main(["build", str(app), "--flag=-DONE=1", "--flag=-DTWO=2", "-O2", "--no-debug"]) == 0


def test_the_headers_are_for_editors_as_well(app: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["build", "--headers"]) == 0
    assert (Path(capsys.readouterr().out.strip()) / "cfe.h").is_file()


@pytest.mark.parametrize("words", [[], ["nowhere"], [".", "--cfs", "."], [".", "--defs", "nowhere"]])
def test_bad_usage(words: list[str], app: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(app)
    assert main(["build", *words]) == 2


def test_an_output_that_cannot_be_written(app: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["build", str(app), "-o", str(app / "fsw/src/probe.c/probe.so")]) == 2
    assert "cannot be written" in capsys.readouterr().err
