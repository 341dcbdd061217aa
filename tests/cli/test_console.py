"""`cfepy console` without a terminal: lines piped in, a mission in virtual time, a remote computer over UDP."""

from __future__ import annotations

import io
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

from cfepy.cli.ground.console import remote
from cfepy.cli.main import main
from cfepy.evs.packets import LONG_EVENT
from cfepy.msg import get_fcn_code, get_msg_id, telemetry
from tests.cli.conftest import Write
from tests.script.rover import write_rover

EVENT = bytes(
    telemetry(0x0808, LONG_EVENT.pack(PacketID={"AppName": "APP", "EventID": 3, "EventType": 2}, Message="all is well"))
)
Console = Callable[..., tuple[int, str]]


@pytest.fixture
def console(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> Console:
    """Run a session: words of the command line, then typed lines. Returns status and output."""

    def run(*words: str, lines: str) -> tuple[int, str]:
        monkeypatch.setattr(sys, "stdin", io.StringIO(lines))
        status = main(["console", *words])
        captured = capsys.readouterr()
        return status, captured.out + captured.err

    return run


def trace_of(output: str) -> str:
    return next(line for line in output.splitlines() if line.startswith("trace: "))


SESSION = """
run 1
# a comment
SAMPLE_APP_DISPLAY_PARAM ValU32=7 ValStr="two words"
expect event SAMPLE_APP * INFORMATION "ValU32=7"
run 20ms
sample_app_noop
until event SAMPLE_APP
run 0.1
expect app SAMPLE_APP RUNNING
send raw 1806c00000010000
expect no event * CRITICAL
step 3
reset processor
run 0.7
hk
page SAMPLE_APP_HK_TLM
"""


def test_the_saved_script_repeats_the_run(console: Console, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    script = tmp_path / "session.txt"
    status, output = console("lab", "--save-script", str(script), lines=SESSION)
    assert status == 0, output
    assert "SAMPLE_APP 6 INFORMATION: SAMPLE: ValU32=7, " in output or "ValU32=7" in output
    assert f"again: cfepy run --script {script} lab" in output
    saved = script.read_text(encoding="utf-8")
    assert 'at 1 send SAMPLE_APP_DISPLAY_PARAM ValU32=7 ValStr="two words"\n        expect event' in saved
    assert "send CFE_ES_RESTART RestartType=1" in saved
    assert main(["run", "lab", "--script", str(script), "--no-console"]) == 0
    again = capsys.readouterr().out
    assert trace_of(again) == trace_of(output)
    assert "FAILED" not in again


def test_what_is_wrong_is_told_and_the_session_goes_on(console: Console) -> None:
    status, output = console(
        "lab",
        lines="CFE_ES_NOPE\nrun 0\nuntil\npage NO_SUCH\nload none.txt\nspeed x\nexpect bus\n"
        "SAMPLE_APP_DISPLAY_PARAM ValU=1 ValI16=x\nrun 0.7\nevents HK\n",
    )
    assert status == 1
    for text in (
        "unknown command CFE_ES_NOPE; did you mean CFE_ES_NOOP or ",
        "invalid number of seconds '0'; expected more than 0 ",
        "missing condition; write for instance: until event CFE_ES 3",
        "unknown telemetry packet NO_SUCH",
        "cannot be read: No such file or directory",
        "invalid factor 'x'",
        "invalid condition 'bus'; expected event, tlm, topic, response, param, app, file or console",
        "ValU: unknown field of SAMPLE_APP_DISPLAY_PARAM; did you mean ValU32? (expected ValU32, ValI16 or ValStr); "
        "ValI16: must be an integer, not 'x'",
    ):
        assert f"FAILED {text}" in output
    assert "OPERATIONAL" in output


def test_stop_on_failure_ends_the_session(console: Console) -> None:
    status, output = console("lab", "--stop-on-failure", lines="run 0.7\nexpect app NOBODY\nrun 5\n")
    assert status == 1
    assert "FAILED 0.700 expect app NOBODY: there are CFE_ES, " in output
    assert "> run 5" not in output


def test_a_file_is_done_step_by_step(console: Console, tmp_path: Path) -> None:
    script = tmp_path / "steps.txt"
    script.write_text("at 1.25 send CFE_ES_NOOP\nexpect event CFE_ES 3\nafter 0.5 end\n", encoding="utf-8")
    status, output = console("lab", lines=f"load {script}\nhelp CFE_EVS_ADD_EVENT_FILTER\n")
    assert status == 0
    assert f"1.250 {script}:1: at 1.25 send CFE_ES_NOOP" in output
    assert f"1.760 {script}:3: after 0.5 end" in output
    assert "CFE_EVS_ADD_EVENT_FILTER AppName:char[20] EventID:u16" in output
    assert console("lab", "--script", str(script), lines="")[1].count("CFE_ES 3 INFORMATION") == 1


def test_the_run_ends_with_its_time_and_an_application_that_died_is_told(console: Console, make_mission: Write) -> None:
    status, output = console(str(make_mission("Dies")), "--for", "2", lines="run\nrun 1\n")
    assert status == 1
    assert "the run is over" in output
    assert "DIES died: ValueError: boom" in output


@pytest.mark.parametrize("lines", ["run 1\nSAMPLE_APP_NOOP\nrun 0.5\n", "CFE_ES_NOOP\nrun 0.1\n", "CFE_ES_NOOP\n"])
def test_a_journal_has_what_was_typed(
    lines: str, console: Console, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """Also before time has begun, when no application can receive it yet."""
    journal = tmp_path / "run.cfepy"
    _, output = console("lab", "--record", str(journal), lines=lines)
    assert main(["replay", str(journal), "--no-console"]) == 0
    assert trace_of(capsys.readouterr().out) == trace_of(output)
    assert main(["replay", str(journal), "--info"]) == 0
    assert "-" not in capsys.readouterr().out.partition("goes to:")[2].splitlines()[0]


def test_ros_steps_are_in_the_journal_and_in_the_saved_script(
    console: Console, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    mission, journal, script = write_rover(tmp_path), str(tmp_path / "run.journal"), str(tmp_path / "session.txt")
    lines = "run 1\npublish /cmd_vel linear.x=0.5\nexpect topic /moved linear.x == 0.5\nset /speed 7\nrun 1\n"
    lines += 'call /enable data=true\nrun 1\nexpect response message == "enabled at 7"\n'
    status, output = console(mission, "--record", journal, "--save-script", script, lines=lines)
    assert status == 0, output
    assert main(["replay", journal, "--no-console"]) == 0
    assert trace_of(capsys.readouterr().out) == trace_of(output)
    assert main(["run", mission, "--script", script, "--no-console"]) == 0
    assert trace_of(capsys.readouterr().out) == trace_of(output)


def test_a_paced_session_is_repeated_by_its_script(
    console: Console, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    script = str(tmp_path / "session.txt")
    lines = "until app SCH RUNNING\nCFE_ES_NOOP\nexpect event CFE_ES 3\nCFE_SB_NOOP\nrun 0.2\nspeed max\nCFE_TBL_NOOP\n"
    paced = console("sched", "--realtime", "200", "--port", "1234=0", "--save-script", script, lines=lines)[1]
    main(["run", "sched", "--script", script, "--no-console"])
    assert trace_of(capsys.readouterr().out) == trace_of(paced)


class Sky:
    """The port that receives telemetry, and the port that sends commands."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch, *datagrams: bytes) -> None:
        self.left = list(datagrams)
        self.sent: list[tuple[str, int, bytes]] = []
        self.port = 1235
        monkeypatch.setattr(remote, "UdpListener", self)
        monkeypatch.setattr(remote, "send_datagram", self.send)

    def __call__(self, host: str, port: int) -> Sky:
        self.port = port
        return self

    def __enter__(self) -> Sky:
        return self

    def __exit__(self, *error: object) -> None:
        pass

    def receive(self, timeout_s: float | None = None) -> bytes | None:
        return self.left.pop(0) if self.left and self.sent else None

    def send(self, host: str, port: int, data: bytes) -> bool:
        self.sent.append((host, port, data))
        return port != 9


def test_a_computer_elsewhere(console: Console, monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    sky = Sky(monkeypatch, b"no packet", EVENT, bytes(telemetry(0x0999, b"\x01\x02")))
    script = tmp_path / "session.txt"
    lines = "CFE_ES_NOOP\nexpect event APP 3 within 60\npage 0x0999\nexpect app HK\npause\nreset processor\n"
    words = ("--udp", "127.0.0.1:5000", "--listen", "7000", "--save-script", str(script))
    status, output = console(*words, lines=lines)
    assert status == 1
    assert "commands go to 127.0.0.1:5000, telemetry comes to port 7000" in output
    assert "until you enable it: TO_LAB_OUTPUT_ENABLE dest_IP=127.0.0.1" in output
    assert [(host, port, get_msg_id(packet), get_fcn_code(packet)) for host, port, packet in sky.sent] == [
        ("127.0.0.1", 5000, 0x1806, 0)
    ]
    assert "APP 3 INFORMATION: all is well" in output
    assert "expect event APP 3 within 60\n" in output
    assert "0x0999  n=1" in output
    assert output.count("a remote target can only be checked by its packets") == 2
    assert "a remote target cannot be paused" in output
    assert " send CFE_ES_NOOP\n" in script.read_text(encoding="utf-8")


def test_nobody_listens_and_to_lab_is_asked(console: Console, monkeypatch: pytest.MonkeyPatch) -> None:
    sky = Sky(monkeypatch)
    status, output = console("--udp", "127.0.0.1:9", "--enable", lines="")
    assert status == 1
    assert len(sky.sent) == 1
    assert "send TO_LAB_OUTPUT_ENABLE dest_IP=127.0.0.1: 127.0.0.1:9: no receiver is listening" in output


@pytest.mark.parametrize(
    ("words", "why"),
    [
        ([], "requires one target: cfepy console MISSION, or cfepy console --udp HOST:PORT"),
        (["lab", "--udp", "127.0.0.1"], "requires one target"),
        (["lab", "--listen", "7000"], "--listen: only valid with --udp"),
        (["lab", "--mission", "lab"], "--mission: only valid with --udp"),
        (["lab", "--port", "1234=0"], "--port: requires --realtime"),
        (["--udp", "127.0.0.1", "--seed", "7"], "--seed: only valid for a mission, and 127.0.0.1 is a remote target"),
        (
            ["--udp", "127.0.0.1", "--realtime"],
            "--realtime: only valid for a mission, and 127.0.0.1 is a remote target",
        ),
        (
            ["--udp", "127.0.0.1", "--listen", "no place"],
            "--listen: invalid address 'no place'; expected an address of this computer",
        ),
        (["no_such_mission"], "no_such_mission"),
        (["lab", "--save-script", "/none/x"], "--save-script: "),
    ],
)
def test_bad_usage(console: Console, words: list[str], why: str) -> None:
    status, output = console(*words, lines="")
    assert status == 2
    assert why in output
