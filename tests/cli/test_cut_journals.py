"""A truncated journal, or one without compared content, never counts as the same run."""

from __future__ import annotations

from pathlib import Path

import pytest

from cfepy.cli.main import main
from tests.mission.flights import write_mission

Capture = pytest.CaptureFixture[str]
STARTUP = "CFE_APP, prog, Main, PROG, 50, 16384, 0x0, 0;\n!"
BUSY = """
    def Main(cfe):
        cfe.evs.register()
        while cfe.es.run_loop(1):
            cfe.sb.transmit_msg(cfe.msg.telemetry(0x0895, b"1234"))
            cfe.os.task_delay({delay_ms})
"""


@pytest.fixture
def recorded(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> bytes:
    """The journal of a run with a few checkpoints."""
    monkeypatch.chdir(tmp_path)
    return record(tmp_path, 1)


def record(folder: Path, delay_ms: int) -> bytes:
    write_mission(folder, STARTUP, prog=BUSY.format(delay_ms=delay_ms))
    assert main(["run", str(folder), "--for", "3", "--quiet", "--record", "whole.cfepy"]) == 0
    return Path("whole.cfepy").read_bytes()


def test_replay_of_a_journal_that_is_cut_off_fails_and_says_how_far_it_was_compared(
    recorded: bytes, capsys: Capture
) -> None:
    assert main(["replay", "whole.cfepy", "--quiet"]) == 0
    assert "the same run as whole.cfepy\n" in capsys.readouterr().err
    for eighth in range(1, 8):
        Path("cut.cfepy").write_bytes(recorded[: len(recorded) * eighth // 8])
        status = main(["replay", "cut.cfepy", "--quiet"])
        said = capsys.readouterr().err
        assert status
        assert "the same run as cut.cfepy\n" not in said
        assert status == 2 or "nothing was compared with cut.cfepy" in said or "the journal is truncated" in said


def test_replay_before_the_first_checkpoint_is_no_same_run(tmp_path: Path, recorded: bytes, capsys: Capture) -> None:
    assert main(["replay", "whole.cfepy", "--quiet", "--until", "0.1"]) == 1
    assert "nothing was compared with whole.cfepy" in capsys.readouterr().err


@pytest.mark.slow
def test_diff_with_a_journal_that_is_cut_off_fails(recorded: bytes, capsys: Capture) -> None:
    Path("cut.cfepy").write_bytes(recorded[:-20])
    assert main(["diff", "whole.cfepy", "cut.cfepy"]) == 1
    assert "cut.cfepy is truncated" in capsys.readouterr().out
    assert main(["diff", "whole.cfepy", "whole.cfepy"]) == 0


def test_report_of_a_journal_that_is_cut_off_warns(recorded: bytes, capsys: Capture) -> None:
    Path("cut.cfepy").write_bytes(recorded[:-20])
    assert main(["report", "cut.cfepy", "-o", "page.html"]) == 1
    assert "this may not be the run of cut.cfepy: the journal is truncated" in Path("page.html").read_text(
        encoding="utf-8"
    )


def test_diff_of_two_empty_traces_is_no_same_run(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: Capture
) -> None:
    monkeypatch.chdir(tmp_path)
    for name in ("a", "b"):
        Path(name).touch()
    assert main(["diff", "a", "b"]) == 1
    assert "nothing to compare" in capsys.readouterr().out


def test_diff_tells_of_runs_with_one_trace_and_other_numbers(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: Capture
) -> None:
    monkeypatch.chdir(tmp_path)
    node = "CFE_APP, prog.py, __main__, PROG, 100, 16384, 0x0, 0;\n!"
    for status in (0, 1):
        write_mission(tmp_path, node, prog=f"import sys\nsys.exit({status})\n")
        assert main(["run", str(tmp_path), "--for", "1", "--quiet", "--record", f"{status}.cfepy"]) == status
    capsys.readouterr()
    assert main(["diff", "0.cfepy", "1.cfepy"]) == 1
    out = capsys.readouterr().out
    assert "the same trace" in out
    assert "but the numbers of the report differ" in out
