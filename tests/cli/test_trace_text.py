"""The times of records as text: the times at which they were made, also while a task uses the CPU."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from cfepy.cli.journal import replay
from cfepy.cli.main import main
from cfepy.trace import TimedRecords

APP = """
def Main(cfe):
    cfe.os.task_delay(100)
    for _ in range(3):
        for _ in range(50):
            cfe.os.bin_sem_delete(cfe.os.bin_sem_create("S", 0))
        cfe.os.printf(f"ticks {cfe.psp.get_time()}\\n")
    while cfe.es.run_loop():
        cfe.os.task_delay(1000)
"""
TICKS = 10_000_000  # in a second: OS_time_t counts 100 ns


@pytest.fixture
def mission(tmp_path: Path) -> Path:
    (tmp_path / "app.py").write_text(APP, encoding="utf-8")
    (tmp_path / "startup.scr").write_text("CFE_APP, app, Main, APP, 90, 16384, 0, 0;\n!\n", encoding="utf-8")
    return tmp_path


def times(text: str) -> list[tuple[float, float]]:
    """Return the time of each line of the application, and the time in the line."""
    found = re.findall(r"^(\S+) APP console ticks (\d+)$", text, re.MULTILINE)
    return [(float(time), int(ticks) / TICKS) for time, ticks in found]


@pytest.mark.parametrize("tasks", ["thread", "greenlet"])
def test_a_line_has_the_time_at_which_it_was_made(
    tasks: str, mission: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    file = tmp_path / "trace.txt"
    common = [str(mission), "--board", "rx64m", "--for", "1", "--tasks", tasks]
    assert main(["run", *common, "--quiet", "--trace", str(file)]) == 0
    capsys.readouterr()
    assert main(["trace", *common]) == 0
    told = times(capsys.readouterr().out)
    assert told == times(file.read_text(encoding="utf-8"))
    assert len(told) == 3
    assert len({time for time, _ in told}) == 3
    assert all(time == pytest.approx(known, abs=2e-5) for time, known in told)


def test_a_replay_that_parts_tells_the_times_at_which_records_were_made(
    mission: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(replay, "MOST_LINES", 10_000)
    journal = str(tmp_path / "a.cfepy")
    assert main(["run", str(mission), "--board", "rx64m", "--for", "1", "--quiet", "--record", journal]) == 0
    (mission / "app.py").write_text(APP.replace("range(3)", "range(4)"), encoding="utf-8")
    assert main(["replay", journal, "--from-disk", "--quiet"]) == 1
    told = times(re.sub("^  ", "", capsys.readouterr().err, flags=re.MULTILINE))
    assert len({time for time, _ in told}) == 4
    assert all(time == pytest.approx(known, abs=2e-5) for time, known in told)


def test_records_keep_their_times() -> None:
    clock = iter(range(100))
    records = TimedRecords()
    records.now = lambda: next(clock)
    for record in (b"a", b"b", b"c"):
        records.append(record)
    assert records.pop() == b"c"
    records.append(b"d")
    records.add(b"e", 7)
    assert list(zip(records, records.times, strict=True)) == [(b"a", 0), (b"b", 1), (b"d", 3), (b"e", 7)]
    records.clear()
    assert (list(records), records.times) == ([], [])
