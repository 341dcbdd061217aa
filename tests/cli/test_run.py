"""`cfepy run`: exit statuses, the report, --json, --trace, and one digest with every way of observing a run."""

from __future__ import annotations

import json
import signal
import subprocess
import sys
from pathlib import Path

import pytest

from cfepy.cli.main import main
from cfepy.rtos import AUTO, task_kind
from tests.cli.conftest import Write

SMALL_BOARD = """name: small
sram: [{name: all, size: 100 KiB}]
limits: {tbl_buf_memory_bytes: 200000, es_cds_size: 8192}
"""


def run(folder: Path, *options: str) -> int:
    return main(["run", str(folder), "--for", "2", *options])


def digest(capsys: pytest.CaptureFixture[str], folder: Path, *options: str) -> str:
    assert run(folder, *options) == 0
    last = capsys.readouterr().out.splitlines()[-2]
    assert last.startswith("trace: ")
    return last


def test_a_good_run(make_mission: Write, capsys: pytest.CaptureFixture[str]) -> None:
    assert run(make_mission("Quiet")) == 0
    shown = capsys.readouterr()
    assert "CFE_ES_Main entering OPERATIONAL state" in shown.out
    assert "QUIET" in shown.out
    assert shown.out.splitlines()[-2].startswith("trace: ")
    assert shown.err == ""


def test_no_console_shows_only_the_report(make_mission: Write, capsys: pytest.CaptureFixture[str]) -> None:
    run(make_mission("Quiet"), "--no-console")
    shown = capsys.readouterr().out
    assert "OPERATIONAL" not in shown
    assert shown.startswith("\nMessages\n")


@pytest.mark.parametrize(
    ("entry_point", "said"),
    [
        ("Dies", "DIES died: ValueError: boom"),
        ("Complains", "COMPLAINS sent 1 ERROR or CRITICAL event"),
        ("GivesUp", "GIVESUP ended with CFE_ES_RunStatus_APP_ERROR"),
        ("Missing", 'MISSING could not be started\ncfepy: the console output shows the reason; "cfepy check '),
    ],
)
def test_a_run_that_goes_wrong(
    make_mission: Write, capsys: pytest.CaptureFixture[str], entry_point: str, said: str
) -> None:
    assert run(make_mission("Quiet", entry_point), "--no-console") == 1
    assert f"cfepy: {said}" in capsys.readouterr().err


def test_a_processor_reset(make_mission: Write, capsys: pytest.CaptureFixture[str]) -> None:
    assert run(make_mission("Dies", action=1), "--no-console") == 1
    assert "the processor was reset" in capsys.readouterr().err


def test_a_bad_line_of_the_startup_script(make_mission: Write, capsys: pytest.CaptureFixture[str]) -> None:
    folder = make_mission("Quiet")
    script = folder / "startup.scr"
    script.write_text(script.read_text(encoding="utf-8").replace("!", "CFE_APP, apps, Quiet;\n!"), encoding="utf-8")
    assert run(folder, "--no-console") == 1
    assert f"{script}:2: the entry must have 8 fields, not 3" in capsys.readouterr().err


def test_a_mission_that_is_not_there(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["run", "no_such_mission"]) == 2
    assert capsys.readouterr().err.startswith("cfepy: no_such_mission: unknown mission")


def test_a_bad_mission_file(make_mission: Write, capsys: pytest.CaptureFixture[str]) -> None:
    folder = make_mission("Quiet", yaml="name: x\nbord: linux\n")
    assert run(folder) == 2
    assert f"{folder / 'mission.yaml'}:2: bord: " in capsys.readouterr().err


@pytest.mark.parametrize("options", [("--board", "abacus"), ("--json", "/no/such/x"), ("--trace", "/no/such/x")])
def test_bad_options(make_mission: Write, capsys: pytest.CaptureFixture[str], options: tuple[str, str]) -> None:
    assert run(make_mission("Quiet"), *options) == 2
    assert capsys.readouterr().err.startswith("cfepy: ")


@pytest.mark.parametrize("seconds", ["0", "-1", "nan", "inf", "soon", "1e300", ""])
def test_a_bad_time(seconds: str, capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as ended:
        main(["run", "capture", f"--for={seconds}"])
    assert ended.value.code == 2
    assert "expected more than 0 to 1e+09" in capsys.readouterr().err


@pytest.mark.parametrize("factor", ["0", "-1", "nan", "1e-300", "inf", "fast"])
def test_a_bad_factor(factor: str, capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as ended:
        main(["run", "capture", f"--realtime={factor}"])
    assert ended.value.code == 2
    assert "expected 0.001 to 1e+09" in capsys.readouterr().err


def test_numbers_that_cannot_be_written_do_not_cost_the_report(
    make_mission: Write, capsys: pytest.CaptureFixture[str]
) -> None:
    if not Path("/dev/full").exists():
        pytest.skip("needs a full device")
    assert run(make_mission("Quiet"), "--no-console", "--json", "/dev/full") == 2
    shown = capsys.readouterr()
    assert shown.out.splitlines()[-2].startswith("trace: ")
    assert shown.err == "cfepy: /dev/full: --json: cannot be written: No space left on device\n"


@pytest.mark.parametrize("command", ["run", "check"])
def test_a_process_without_standard_output(make_mission: Write, command: str) -> None:
    script = f'exec "{sys.executable}" -m cfepy {command} "{make_mission("Quiet")}" >&-'
    ended = subprocess.run(["sh", "-c", script], stderr=subprocess.PIPE, text=True, check=False)
    assert (ended.returncode, ended.stderr) == (0, "")


def test_an_app_that_raises_keyboard_interrupt_ends_the_run_like_ctrl_c(
    make_mission: Write, capsys: pytest.CaptureFixture[str]
) -> None:
    folder = make_mission("Quiet")
    (folder / "apps.py").write_text("def Quiet(cfe):\n    raise KeyboardInterrupt\n", encoding="utf-8")
    assert run(folder, "--no-console") == 130
    assert "ended by Ctrl-C" in capsys.readouterr().err


def test_a_board_on_which_the_core_cannot_boot(
    make_mission: Write, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    board = tmp_path / "small.yaml"
    board.write_text(SMALL_BOARD, encoding="utf-8")
    assert run(make_mission("Quiet"), "--board", str(board), "--no-console") == 2
    said = capsys.readouterr().err
    assert "cannot boot" in said
    assert "the board is full: CFE_SB" in said


def test_too_short_to_boot(make_mission: Write, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["run", str(make_mission("Quiet")), "--for", "0.1", "--no-console"]) == 2
    assert "not OPERATIONAL after 0.1 virtual seconds" in capsys.readouterr().err


def test_numbers_as_json(make_mission: Write, tmp_path: Path) -> None:
    file = tmp_path / "numbers.json"
    run(make_mission("Chatty", "Quiet"), "--no-console", "--json", str(file), "--seed", "7", "--board", "rx64m")
    numbers = json.loads(file.read_text(encoding="utf-8"))
    assert numbers["virtual_s"] == pytest.approx(2, abs=0.001)
    assert numbers["speed"] == pytest.approx(numbers["virtual_s"] / numbers["wall_s"])
    assert (numbers["seed"], numbers["board"], numbers["tasks"]) == (7, "rx64m", task_kind(AUTO).name)
    assert len(numbers["trace"]) == 32
    topic = next(topic for topic in numbers["topics"] if topic["msg_id"] == 0x0890)
    assert topic["dropped"] == topic["dropped_limit"] == topic["sent"] - 4
    assert (topic["delivered"], topic["waiting"]) == (0, 4)
    assert topic["rate_hz"] == pytest.approx(10, rel=0.2)
    app = next(app for app in numbers["apps"] if app["name"] == "QUIET")
    assert app["state"] == "RUNNING"
    assert app["restarts"] == 0
    assert 0 < app["cpu_share"] < 0.01
    assert set(numbers["events"]) == {"DEBUG", "INFORMATION", "ERROR", "CRITICAL"}
    assert numbers["sb"]["MsgLimitErrorCounter"] == topic["dropped"]
    assert numbers["memory"]["limit"] == 552 * 1024


def test_names_and_reasons_in_the_report(make_mission: Write, capsys: pytest.CaptureFixture[str]) -> None:
    run(make_mission("Chatty"), "--no-console")
    shown = capsys.readouterr().out
    line = next(line for line in shown.splitlines() if "0x0890" in line)
    assert "message limit, 4 not taken yet" in line
    assert "CFE_EVS_LONG_EVENT_MSG" in shown


def test_a_rate_beyond_the_board_is_marked(make_mission: Write, capsys: pytest.CaptureFixture[str]) -> None:
    board = make_mission("Chatty") / "slow.yaml"
    board.write_text("name: slow\nmax_publish_hz: 5\n", encoding="utf-8")
    run(board.parent, "--no-console", "--board", str(board))
    shown = capsys.readouterr().out
    assert "! more than the 5 Hz that slow is made for" in shown


def test_the_trace_file(make_mission: Write, tmp_path: Path) -> None:
    file = tmp_path / "trace.txt"
    run(make_mission("Chatty"), "--no-console", "--trace", str(file))
    lines = file.read_text(encoding="utf-8").splitlines()
    assert any(line.endswith("CHATTY send 0x0890 sequence 1 length 20") for line in lines)
    assert any(line.endswith("CHATTY drop at CHATTY") for line in lines)
    assert any(" console " in line and "OPERATIONAL" in line for line in lines)
    assert any(line.endswith(" CHATTY dispatch") for line in lines)
    times = [float(line.split()[0]) for line in lines]
    assert times == sorted(times)


def test_one_digest_however_it_is_run(make_mission: Write, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    pytest.importorskip("greenlet")
    folder = make_mission("Chatty", "Quiet", yaml="board: rx64m\n")
    expected = digest(capsys, folder)
    for options in (
        ("--tasks", "thread"),
        ("--realtime", "50"),
        ("--no-console",),
        ("--trace", str(tmp_path / "trace.txt")),
        ("--seed", "3"),
    ):
        assert digest(capsys, folder, *options) == expected


def test_a_random_schedule_depends_on_the_seed_alone(make_mission: Write, capsys: pytest.CaptureFixture[str]) -> None:
    folder = make_mission("Chatty", "Quiet", "Complains")
    options = ("--no-console", "--schedule", "random", "--seed")
    digests = set()
    for seed in ("1", "1", "2", "3"):
        run(folder, *options, seed)
        digests.add(capsys.readouterr().out.splitlines()[-2])
    assert 1 < len(digests) <= 3


@pytest.mark.parametrize("text", ["pct:1:3", "at:0=1,2=1", "random:4:any:hold=1ms:from=1ms"])
def test_a_schedule_is_a_text(make_mission: Write, capsys: pytest.CaptureFixture[str], text: str) -> None:
    folder = make_mission("Chatty", "Quiet")
    digests = [digest(capsys, folder, "--schedule", text, "--tasks", tasks) for tasks in ("thread", "greenlet")]
    assert digests[0] == digests[1]


def test_a_text_that_is_no_schedule(make_mission: Write, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["run", str(make_mission("Chatty")), "--schedule", "randon:1"]) == 2
    assert "--schedule: unknown schedule 'randon'; did you mean random?" in capsys.readouterr().err


def on_terminal(*arguments: str) -> str:
    """Return the output of `cfepy` on a terminal."""
    pty = pytest.importorskip("pty")
    import os

    master, slave = pty.openpty()
    process = subprocess.Popen([sys.executable, "-m", "cfepy", *arguments], stdout=slave, stderr=slave)
    os.close(slave)
    shown = b""
    while True:
        try:
            part = os.read(master, 65536)
        except OSError:  # Linux reports in this way that the other end is closed
            break
        if not part:
            break
        shown += part
    os.close(master)
    process.wait()
    return shown.decode()


def test_a_terminal_gets_a_status_line_and_the_same_digest(
    make_mission: Write, capsys: pytest.CaptureFixture[str]
) -> None:
    folder = make_mission("Chatty")
    shown = on_terminal("run", str(folder), "--for", "2")
    assert "x real time" in shown
    assert "messages/s" in shown
    assert shown.rstrip().splitlines()[-2].strip() == digest(capsys, folder)


@pytest.mark.parametrize("options", [("--for", "1000000"), ("--realtime",)])
@pytest.mark.parametrize("how", [signal.SIGINT, signal.SIGTERM])
def test_ctrl_c_ends_a_run_with_its_report(make_mission: Write, options: tuple[str, ...], how: signal.Signals) -> None:
    process = start("run", str(make_mission("Quiet")), *options)
    read_up_to(process, "OPERATIONAL")
    process.send_signal(how)
    out, err = process.communicate()
    assert process.returncode == 130
    assert out.splitlines()[-2].startswith("trace: ")
    assert "ended by Ctrl-C or SIGTERM after " in err


@pytest.mark.slow
@pytest.mark.parametrize(
    ("body", "told"),
    [
        ("    while True: pass\n", "task QUIET has not given up the CPU since"),
        pytest.param(
            "    try:\n        while True: cfe.os.task_delay(100)\n    finally:\n        while True: pass\n",
            "",
            marks=pytest.mark.slow,
        ),
        pytest.param(
            "    import time\n    time.sleep(1000)\n",
            "task QUIET has been waiting for something outside the simulation",
            marks=pytest.mark.slow,
        ),
    ],
)
@pytest.mark.parametrize("tasks", [pytest.param("thread", marks=pytest.mark.slow), "greenlet"])
def test_ctrl_c_ends_the_run_whatever_a_task_does(make_mission: Write, body: str, told: str, tasks: str) -> None:
    folder = make_mission("Quiet")
    (folder / "apps.py").write_text(f"def Quiet(cfe):\n{body}", encoding="utf-8")
    process = start("run", str(folder), "--for", "1000000", "--tasks", tasks)
    read_up_to(process, "Loading file")
    process.send_signal(signal.SIGINT)
    out, err = process.communicate()
    assert process.returncode == 130
    assert out.splitlines()[-2].startswith("trace: none" if told else "trace: ")
    assert told in err
    assert "Traceback" not in err


def test_a_reader_that_went_away_is_no_error(make_mission: Write) -> None:
    process = start("run", str(make_mission("Quiet")), "--for", "5000")
    assert process.stdout is not None
    assert process.stderr is not None
    process.stdout.readline()
    process.stdout.close()
    assert "Traceback" not in process.stderr.read()
    process.stderr.close()
    assert process.wait() == 0


def read_up_to(process: subprocess.Popen[str], text: str) -> None:
    """Read a command's output until a line contains a text. Fail if the command ends before."""
    assert process.stdout is not None
    assert any(text in line for line in process.stdout), process.communicate()[1]


def start(*arguments: str) -> subprocess.Popen[str]:
    """`cfepy` in a process of its own, its output in pipes."""
    return subprocess.Popen(
        [sys.executable, "-u", "-m", "cfepy", *arguments], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    )


@pytest.mark.parametrize(
    ("schedule", "note"),
    [
        ("moves:NO=ONE", "0 of 1 moves of the schedule were possible; not possible: NO=ONE"),
        ("at:999999=1", "0 of 1 deviations of the schedule were possible; not possible: 999999=1"),
    ],
)
@pytest.mark.parametrize("output", ["--quiet", "--no-console"])
def test_impossible_schedule_is_reported_with_every_output(
    make_mission: Write, capsys: pytest.CaptureFixture[str], output: str, schedule: str, note: str
) -> None:
    assert main(["run", str(make_mission("Quiet")), "--for", "1", output, "--schedule", schedule]) == 0
    assert capsys.readouterr().err.count(f"cfepy: {note}\n") == 1
