"""`--record`, `cfepy replay` and `cfepy diff` from the command line."""

from __future__ import annotations

import os
import re
import signal
import socket
import subprocess
import sys
from pathlib import Path

import pytest

from cfepy.cli.main import main
from cfepy.journal.journal import FrameWriter, read_frames
from cfepy.reading.resources import import_path
from tests.journal.missions import paths, race
from tests.mission.flights import write_mission

ADDER = """
    import rospy
    from std_msgs.msg import Int32

    rospy.init_node("adder")
    total = rospy.Publisher("total", Int32, queue_size=5)
    rospy.Subscriber("total", Int32, lambda message: None)
    rospy.sleep(0.5)
    for number in range(5):
        total.publish(STEP * number)
        rospy.sleep(0.1)
"""
STARTUP = "CFE_APP, adder.py, __main__, ADDER, 100, 16384, 0x0, 0;\n!"


@pytest.fixture(autouse=True)
def in_a_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)


def adder(folder: Path, step: int) -> str:
    folder.mkdir(exist_ok=True)
    return write_mission(folder, STARTUP, adder=ADDER.replace("STEP", str(step)))


def trace_of(text: str) -> str:
    found = re.search(r"^trace: (\w+)$", text, re.MULTILINE)
    assert found
    return found[1]


@pytest.mark.parametrize("tasks", [[], ["--tasks", "thread"]])
def test_a_run_is_replayed_with_its_console_and_report(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], tasks: list[str]
) -> None:
    mission = race(tmp_path)
    assert main(["run", mission, "--for", "2", "--seed", "3", "--schedule", "random", "--record", "a.cfepy"]) == 0
    first = capsys.readouterr().out
    assert main(["replay", "a.cfepy", "--json", "a.json", "--trace", "a.txt", *tasks]) == 0
    again = capsys.readouterr()
    speed = re.compile(r"virtual s in .*")
    assert speed.sub("", again.out) == speed.sub("", first)
    assert again.err == "cfepy: the same run as a.cfepy\n"
    assert trace_of(first) in Path("a.json").read_text(encoding="utf-8")
    assert "dispatch" in Path("a.txt").read_text(encoding="utf-8")


def test_until_ends_earlier(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    main(["run", "capture", "--for", "3", "--no-console", "--record", "a.cfepy"])
    assert main(["replay", "a.cfepy", "--until", "1.5", "--no-console"]) == 0
    said = capsys.readouterr()
    assert "1.500 virtual s" in said.out
    assert "where it was compared for the last time" in said.err


def test_other_files_on_disk_are_told_and_not_used(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    mission = adder(tmp_path / "mission", 1)
    main(["run", mission, "--for", "2", "--quiet", "--record", "a.cfepy"])
    adder(tmp_path / "mission", 2)
    capsys.readouterr()
    assert main(["replay", "a.cfepy", "--quiet"]) == 0
    assert capsys.readouterr().err == "cfepy: the same run as a.cfepy\n"
    assert main(["replay", "a.cfepy", "--no-console"]) == 0
    assert f"on this computer others are now: {tmp_path}/mission/adder.py" in capsys.readouterr().err
    assert main(["replay", "a.cfepy", "--quiet", "--from-disk"]) == 1
    said = capsys.readouterr().err
    assert re.search(r"not the run of a\.cfepy: the same up to record \d+ at \d", said)
    assert "the replay continued with" in said
    assert f"other files than then: {tmp_path}/mission/adder.py" in said


def test_a_node_is_replayed_with_its_own_exit_of_the_command(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    paths(tmp_path)
    assert main(["node", "paths.py", "--record", "../node.cfepy", "--", "x"]) == 1
    first = capsys.readouterr().out
    assert "as asked" in first
    assert main(["replay", "../node.cfepy"]) == 1  # the status of the run; the replay is identical nevertheless
    again = capsys.readouterr()
    assert again.out == first
    assert "the same run as ../node.cfepy" in again.err


@pytest.mark.slow
def test_a_paced_run_that_ctrl_c_ended_is_replayed(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    command = ["run", "lab", "--realtime", "5", "--port", "1234=0", "--record", "a.cfepy"]
    environment = {**os.environ, "PYTHONPATH": import_path(), "PYTHONUNBUFFERED": "1"}
    with subprocess.Popen(
        [sys.executable, "-m", "cfepy", *command], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, env=environment
    ) as process:
        assert process.stdout is not None
        for line in process.stdout:
            opened = re.search(rb"is open at 127\.0\.0\.1:(\d+)", line)
            if opened:
                with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as ground:
                    ground.sendto(bytes.fromhex("1884c000000100a2"), ("127.0.0.1", int(opened[1])))
            if b"CI: NOOP command" in line:
                process.send_signal(signal.SIGINT)
                break
        rest = process.stdout.read().decode()
    assert process.returncode == 130
    assert main(["replay", "a.cfepy"]) == 0
    said = capsys.readouterr()
    assert "CI: NOOP command" in said.out
    assert "is open at" not in said.out
    assert trace_of(said.out) == trace_of(rest)
    assert "the same run as a.cfepy" in said.err


def test_another_version_is_warned_of(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    main(["run", race(tmp_path), "--for", "1", "--quiet", "--record", "a.cfepy"])
    writer = FrameWriter("b.cfepy")
    for kind, body in read_frames("a.cfepy"):
        if kind == "header":
            body["versions"].update(cfepy="0.0.7", python="3.99.1")
        writer.write(kind, body)
    writer.close()
    capsys.readouterr()
    assert main(["replay", "b.cfepy", "--no-console"]) == 0
    said = capsys.readouterr().err
    assert "recorded with cfepy 0.0.7, this is" in said
    assert "recorded with Python 3.99.1, this is" in said


def test_a_journal_without_an_end_says_so(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    main(["run", "capture", "--for", "2", "--quiet", "--record", "a.cfepy"])
    data = Path("a.cfepy").read_bytes()
    Path("a.cfepy").write_bytes(data[:-300])
    assert main(["replay", "a.cfepy", "--quiet"]) == 1
    said = capsys.readouterr().err
    assert "the journal has no end" in said
    assert "the journal is truncated, and the rest of the run is not known" in said


@pytest.mark.parametrize("command", [["replay", "x"], ["diff", "x", "x"], ["replay", "startup.scr"]])
def test_what_is_no_journal(command: list[str], tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    race(tmp_path)
    assert main(command) == 2
    assert capsys.readouterr().err.startswith(f"cfepy: {command[1]}: ")


def test_folder_of_a_new_journal_that_is_missing_is_named(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    folder = tmp_path / "missing"
    assert main(["run", race(tmp_path), "--for", "1", "--record", str(folder / "run.journal")]) == 2
    assert capsys.readouterr().err.endswith(f"; create the folder {folder} first\n")


def test_a_full_disk_is_told_at_the_end(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["run", race(tmp_path), "--for", "1", "--quiet", "--record", "/dev/full"]) == 2
    assert "/dev/full: --record: cannot be written" in capsys.readouterr().err


@pytest.mark.slow
def test_diff_of_a_change_in_the_code(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    for step in (1, 2):
        main(["run", adder(tmp_path / "mission", step), "--for", "2", "--quiet", "--record", f"{step}.cfepy"])
    capsys.readouterr()
    assert main(["diff", "1.cfepy", "2.cfepy", "--lines", "3"]) == 1
    said = capsys.readouterr().out
    assert re.search(r"^file adder\.py: not the same, from line 10 on$", said, re.MULTILINE)
    assert re.search(r"the first \d+ records are alike, until \d\.\d{6} s; then the runs differ:", said)
    assert re.search(r"record \d+ is the first that differs", said)
    assert said.count("send 0x") >= 2
    assert "/total" in said
    assert f"{tmp_path}/mission/adder.py:10" in said
    assert "total.publish(1 * number)" in said
    assert "total.publish(2 * number)" in said
    values = r"has other values in 1\.cfepy and 2\.cfepy: data 1 and 2 \(\+1\)$"
    assert re.search(rf"^  message \d+ of /total from \S+ {values}", said, re.MULTILINE)


RAISER = """
def Main(cfe):
    while cfe.es.run_loop():
        cfe.os.task_delay(100)
        cfe.es.write_to_sys_log("step STEP")
"""


@pytest.mark.slow
def test_diff_shows_where_files_were_and_leaves_nothing_behind(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    mission, temporary = tmp_path / "app", tmp_path / "temporary"
    mission.mkdir()
    temporary.mkdir()
    (mission / "startup.scr").write_text("CFE_APP, steps, Main, STEPS, 60, 8192, 0, 0;\n!\n", encoding="utf-8")
    for step, name in (("1", "one"), ("2", "three")):  # other lengths: Python compares files of one second by size
        (mission / "steps.py").write_text(RAISER.replace("STEP", name), encoding="utf-8")
        main(["run", str(mission), "--for", "1", "--quiet", "--record", f"{step}.cfepy"])
    capsys.readouterr()
    monkeypatch.setenv("TMPDIR", str(temporary))
    assert main(["diff", "1.cfepy", "2.cfepy", "--lines", "0"]) == 1
    assert f"made at {mission}/steps.py:5 in Main" in capsys.readouterr().out
    assert list(temporary.iterdir()) == []


def test_diff_of_the_same_run(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    for name, tasks in (("a", "thread"), ("b", "greenlet")):
        main(["run", race(tmp_path), "--for", "1", "--quiet", "--tasks", tasks, "--record", f"{name}.cfepy"])
    capsys.readouterr()
    assert main(["diff", "a.cfepy", "b.cfepy"]) == 0
    said = capsys.readouterr().out
    assert "tasks: thread, greenlet" in said
    assert "the same run: all" in said


@pytest.mark.slow
def test_diff_of_seeds_boards_and_schedules(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    main(["run", race(tmp_path), "--for", "1", "--quiet", "--record", "a.cfepy"])
    main(["run", str(tmp_path), "--for", "1", "--quiet", "--seed", "2", "--schedule", "pct", "--record", "b.cfepy"])
    capsys.readouterr()
    assert main(["diff", "a.cfepy", "b.cfepy"]) == 1
    said = capsys.readouterr().out
    assert "seed: 0, 2" in said
    assert "schedule: fifo, pct:2:3" in said


def test_diff_of_traces(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    for step in (1, 2):
        mission = adder(tmp_path / str(step), 1)
        main(["run", mission, "--for", str(step), "--quiet", "--trace", f"{step}.txt", "--record", f"{step}.cfepy"])
    capsys.readouterr()
    assert main(["diff", "1.txt", "1.txt"]) == 0
    assert main(["diff", "1.txt", "2.txt", "--lines", "1"]) == 1
    said = capsys.readouterr().out
    assert re.search(r"the first [\d,]+ lines are alike; line [\d,]+ differs", said)
    assert main(["diff", "1.txt", "1.cfepy"]) == 2
    assert "cannot compare a journal with a trace" in capsys.readouterr().err


def test_info_runs_nothing(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    main(
        [
            "run",
            race(tmp_path),
            "--for",
            "1",
            "--no-console",
            "--seed",
            "4",
            "--schedule",
            "random",
            "--record",
            "a.cfepy",
        ]
    )
    trace = trace_of(capsys.readouterr().out)
    assert main(["replay", "a.cfepy", "--info"]) == 0
    said = capsys.readouterr().out
    assert f"cfepy run --for 1 --seed 4 --schedule random:4 {tmp_path}" in said
    assert re.search(rf"^trace: +{trace}$", said, re.MULTILINE)
    assert "OPERATIONAL" not in said


def test_runs_that_are_compared_are_not_recorded(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["run", race(tmp_path), "--check-determinism", "--record", "a.cfepy"]) == 2
    assert "--record: cannot be combined with --check-determinism" in capsys.readouterr().err


def test_a_replay_that_ends_before_the_boot_does_says_why(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    def said_of(*command: str) -> str:
        main(["replay", *command, "--quiet"])
        (line,) = [line for line in capsys.readouterr().err.splitlines() if "OPERATIONAL" in line]
        return line.removeprefix("cfepy: not OPERATIONAL after ")

    main(["run", "capture", "--for", "0.1", "--quiet", "--record", "a.cfepy"])
    assert "run it for longer (--for)" in capsys.readouterr().err
    writer = FrameWriter("cut.cfepy")
    for kind, body in read_frames("a.cfepy"):
        if kind in ("header", "file"):
            writer.write(kind, body)
    writer.close()
    assert said_of("a.cfepy") == "0.1 virtual seconds; the recorded run ended there"
    assert said_of("a.cfepy", "--until", "0.05") == "0.05 virtual seconds; the replay ended there"
    assert said_of("cut.cfepy") == "0 virtual seconds; the journal ends there; continue with --until SECONDS"


def test_a_replay_of_a_node_that_still_runs_says_why(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "spin.py").write_text("import rospy\nrospy.init_node('spin')\nrospy.spin()\n", encoding="utf-8")
    main(["node", "--for", "1", "--record", "a.cfepy", "spin.py"])
    assert "the node still runs after 1 virtual seconds; --for runs longer" in capsys.readouterr().err
    main(["replay", "a.cfepy"])
    assert "the node still runs after 1 virtual seconds; the recorded run ended there" in capsys.readouterr().err
