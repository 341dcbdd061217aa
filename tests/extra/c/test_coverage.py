"""Applications that were compiled with --coverage write their counts at their end, and gcov reads them."""

from __future__ import annotations

import shutil
import subprocess
from pathlib import Path

import pytest

from cfepy.cli.main import main
from tests.extra.c.building import (
    compile_c,
    compile_cpp,
    console_of,
    fly,
    needs_compiler,
    needs_cpp,
    said,
    write_mission,
)

pytestmark = [needs_compiler, pytest.mark.skipif(shutil.which("gcov") is None, reason="there is no gcov")]

SOURCE = """
    static int kind(int number)
    {
        if (number % 2)
            return 1;
        return 2;
    }
    void TEST_Main(void)
    {
        uint32_t run = RUN;
        for (int i = 0; CFE_ES_RunLoop(&run) && i < 5; i++)
            SAY("%d", kind(i));
        if (run == EXIT)
            SAY("never");
        @
    }
"""
EXIT = "CFE_ES_ExitApp(EXIT);"
STAY = "while (CFE_ES_RunLoop(&run)) OS_TaskDelay(100);"


def counts(folder: Path) -> dict[int, str]:
    """Return the count of each line that has one, from gcov."""
    [notes] = folder.glob("*.gcno")
    done = subprocess.run(["gcov", "--stdout", notes.name], cwd=folder, check=True, capture_output=True, text=True)
    rows = [line.split(":", 2) for line in done.stdout.splitlines() if line.count(":") >= 2]
    in_app = False
    found = {}
    for count, number, text in rows:
        if int(number) == 0 and text.startswith("Source"):
            in_app = text.endswith("TEST.c")
        elif in_app and int(number) and count.strip() != "-":
            found[int(number)] = count.strip()
    return found


@pytest.mark.parametrize("end", [EXIT, STAY], ids=["of the application", "of the mission"])
def test_counts_are_written_at_the_end_of_the_application(tmp_path: Path, end: str) -> None:
    compile_c(tmp_path, "TEST", SOURCE.replace("@", end), "--coverage", "-O0")
    console = console_of(fly(write_mission(tmp_path, "TEST"), 10))
    assert "gcov" not in console
    found = counts(tmp_path)
    assert (found[3], found[4], found[5]) == ("5", "2", "3")
    assert (found[12], found[13]) == ("1", "#####")


def test_runs_add_up(tmp_path: Path) -> None:
    compile_c(tmp_path, "TEST", SOURCE.replace("@", STAY), "--coverage", "-O0")
    folder = write_mission(tmp_path, "TEST")
    fly(folder)
    fly(folder)
    assert counts(tmp_path)[3] == "10"


def test_counts_go_below_a_prefix(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    compile_c(tmp_path, "TEST", SOURCE.replace("@", STAY), "--coverage", "-O0")
    where = tmp_path / "counts"
    monkeypatch.setenv("GCOV_PREFIX", str(where))
    fly(write_mission(tmp_path, "TEST"))
    [written] = where.rglob("*.gcda")
    assert list(tmp_path.glob("*.gcda")) == []
    shutil.copy(written, tmp_path)
    assert counts(tmp_path)[3] == "5"


@needs_cpp
@pytest.mark.slow
def test_application_in_cpp_writes_counts(tmp_path: Path) -> None:
    source = SOURCE.replace("void TEST_Main", 'extern "C" void TEST_Main').replace("@", EXIT)
    compile_cpp(tmp_path, "TEST", source, "--coverage", "-O0")
    fly(write_mission(tmp_path, "TEST"), 10)
    [notes] = tmp_path.glob("*.gcno")
    assert [*tmp_path.glob("*.gcda")] == [notes.with_suffix(".gcda")]


@pytest.mark.slow
def test_counts_include_all_runs_of_an_exploration(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    compile_c(tmp_path, "TEST", SOURCE.replace("@", STAY), "--coverage", "-O0")
    assert main(["explore", write_mission(tmp_path, "TEST"), "--for", "1", "--seeds", "4"]) == 0
    capsys.readouterr()
    assert int(counts(tmp_path)[3]) >= 20


def test_other_files_of_the_host_are_inaccessible(tmp_path: Path) -> None:
    compile_c(
        tmp_path,
        "TEST",
        'int open(const char *, int, ...); void TEST_Main(void) { SAY("%d", open("/etc/passwd", 0)); }',
    )
    console = console_of(fly(write_mission(tmp_path, "TEST"), 1))
    assert said(console) == ["-1"]
    assert "open() of /etc/passwd: it is not in the file systems of the mission" in console
