"""`cfepy replay` with --break, --step and --pdb: the user's input and output."""

from __future__ import annotations

import io
from pathlib import Path

import pytest

from cfepy.cli.main import main
from tests.mission.flights import write_mission

APP = """
def counter_main(cfe):
    cfe.evs.register()
    number = 0
    while cfe.es.run_loop():
        cfe.os.task_delay(100)
        number += 1
        cfe.evs.send_event(1, 2, f"number {number}")
        total = number
"""
NODE = """
import rospy
from std_msgs.msg import Int32
rospy.init_node("counter")
publisher = rospy.Publisher("/numbers", Int32, queue_size=10)
for number in range(4):
    rospy.sleep(0.1)
    publisher.publish(number)
"""


@pytest.fixture
def journal(tmp_path: Path) -> str:
    """The journal of a node that counts."""
    script, file = tmp_path / "counter.py", tmp_path / "run.cfepy"
    script.write_text(NODE, encoding="utf-8")
    assert main(["node", "--for", "2", "--record", str(file), str(script)]) == 0
    return str(file)


def replayed(journal: str, *options: str, typed: str, monkeypatch: pytest.MonkeyPatch) -> int:
    """Return the exit status of a replay whose user types this."""
    monkeypatch.setattr("sys.stdin", io.StringIO(typed))
    return main(["replay", journal, *options])


def test_a_run_that_stops_is_still_the_same(
    journal: str, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    assert replayed(journal, "--break", "/numbers", typed="w\nc\n", monkeypatch=monkeypatch) == 0
    said = capsys.readouterr()
    assert said.out.count("/numbers of /counter: data: ") == 4
    assert "the same run as" in said.err


def test_a_user_who_has_seen_enough(
    journal: str, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    assert replayed(journal, "--break", "msg.data == 2", typed="q\n", monkeypatch=monkeypatch) == 0
    said = capsys.readouterr()
    assert said.out.count("/numbers of /counter: data: ") == 1
    assert "where it was compared for the last time" in said.err


def test_a_breakpoint_that_was_not_met(
    journal: str, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    assert replayed(journal, "--break", "/number", "--break", "/numbers", typed="", monkeypatch=monkeypatch) == 0
    err = capsys.readouterr().err
    assert "cfepy: --break '/number' never matched\n" in err
    assert "'/numbers'" not in err


def test_steps_from_a_time_on(
    journal: str, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    assert replayed(journal, "--step", "--until", "0.8", typed="s\ns\nq\n", monkeypatch=monkeypatch) == 0
    lines = [line for line in capsys.readouterr().out.splitlines() if line.startswith("0.")]
    assert len(lines) == 3
    assert all(float(line.split()[0]) >= 0.8 for line in lines)


@pytest.mark.parametrize("name", ["counter", "/counter", "COUNTER"])
def test_the_debugger_of_python(
    journal: str, name: str, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    typed = "p number\nc\n"
    options = ["--pdb", name, "--break", "msg.data == 3"]
    assert replayed(journal, *options, typed=typed, monkeypatch=monkeypatch) == 0
    out, err = capsys.readouterr()
    assert "(Pdb) 3\n" in out
    assert "tasks run on threads, because Python's debugger requires a thread of its own" in err


def test_an_application_that_there_is_not(
    journal: str, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    assert replayed(journal, "--pdb", "countre", typed="", monkeypatch=monkeypatch) == 2
    assert "--pdb: unknown application 'countre'; did you mean COUNTER?" in capsys.readouterr().err


@pytest.fixture
def app_journal(tmp_path: Path) -> str:
    """Return the journal of an application that counts. The application is then removed."""
    path = write_mission(tmp_path, "CFE_APP, counter, counter_main, COUNTER, 50, 16384, 0x0, 0;\n!", counter=APP)
    file = tmp_path / "app.cfepy"
    assert main(["run", "--for", "2", "--quiet", "--record", str(file), str(path)]) == 0
    (tmp_path / "counter.py").unlink()
    return str(file)


def test_an_application_has_the_path_that_it_had(
    app_journal: str, tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    place, stop = f"{tmp_path / 'counter.py'}", ["--break", "COUNTER:1"]
    assert replayed(app_journal, *stop, typed="w\nq\n", monkeypatch=monkeypatch) == 0
    out = capsys.readouterr().out
    assert f"    {place}:8 in counter_main: cfe.evs.send_event(1, 2, " in out
    assert "cfepy-replay-" not in out


def test_breakpoints_of_python_take_the_path_that_it_had(
    app_journal: str, tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    place, options = f"{tmp_path / 'counter.py'}", ["--pdb", "COUNTER", "--break", "COUNTER:1"]
    typed = f"w\nb {place}:7\nc\np 'total', number\nb\nq\n"
    assert replayed(app_journal, *options, typed=typed, monkeypatch=monkeypatch) == 0
    out = capsys.readouterr().out
    assert f"> {place}(" in out
    assert f"Breakpoint 1 at {place}:7" in out
    assert "breakpoint already hit 1 time" in out
    assert "('total', 1)" in out
    assert "cfepy-replay-" not in out


def test_a_user_who_goes_back_from_the_end(
    journal: str, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Earlier output is not shown again, and the last flight is the one that is reported and compared."""
    typed = "bt /numbers\nbt number == 1\nb\nc\nc\n"
    assert replayed(journal, "--back", typed=typed, monkeypatch=monkeypatch) == 0
    said = capsys.readouterr()
    lines = [line for line in said.out.splitlines() if line.startswith("0.")]
    assert "the end of the run" in lines[0]
    assert lines[1].endswith("/numbers of /counter: data: 3")
    assert float(lines[1].split()[0]) > float(lines[2].split()[0]) >= float(lines[3].split()[0])
    assert "the end of the run" in lines[4]
    assert said.out.count("CFE_ES_Main entering OPERATIONAL") == 1
    assert "the same run as" in said.err


@pytest.mark.slow
def test_the_last_time_of_something(
    journal: str, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    assert replayed(journal, "--back-to", "msg.data < 2", "--quiet", typed="c\n", monkeypatch=monkeypatch) == 0
    said = capsys.readouterr()
    assert said.out.splitlines()[0].endswith("/numbers of /counter: data: 1")
    assert "the same run as" in said.err
    assert replayed(journal, "--back-to", "msg.data > 9", "--quiet", typed="", monkeypatch=monkeypatch) == 0
    assert "no match before this point" in capsys.readouterr().out


def test_there_is_no_way_back_from_gdb(journal: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["replay", journal, "--back", "--gdb", "COUNTER"]) == 2
    assert "cannot be combined with --gdb" in capsys.readouterr().err
