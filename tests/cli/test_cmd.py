"""`cfepy cmd`: listing, showing, sending by UDP, and trying a command out in virtual time."""

from __future__ import annotations

import pytest

from cfepy.cli.ground.command_target import RemoteHost, host_of
from cfepy.cli.main import main
from cfepy.io.udp import UdpListener
from cfepy.status import UsageError
from tests.cli.conftest import Write

MISSION = "CFE_APP, sample_app, SAMPLE_APP_Main, SAMPLE_APP, 50, 16384, 0x0, 0;\n!\n"


@pytest.fixture
def mission(make_mission: Write) -> str:
    folder = make_mission("Quiet")
    (folder / "startup.scr").write_text(MISSION, encoding="utf-8")
    return str(folder)


@pytest.mark.parametrize(
    ("text", "host"),
    [
        ("127.0.0.1", RemoteHost("127.0.0.1", 1234)),
        ("10.0.0.7:99", RemoteHost("10.0.0.7", 99)),
        ("localhost", RemoteHost("localhost", 1234)),
        ("board.local:2000", RemoteHost("board.local", 2000)),
        ("capture", None),
        ("missions/capture", None),
        ("C:/missions", None),
    ],
)
def test_what_looks_like_a_computer(text: str, host: RemoteHost | None) -> None:
    assert host_of(text, 1234) == host


def test_a_port_that_cannot_be() -> None:
    with pytest.raises(UsageError, match="invalid port 70000"):
        host_of("127.0.0.1:70000", 1234)


def test_the_list(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["cmd", "--list", "cfe_e*_noop"]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert [line.split()[:3] for line in lines[3:]] == [["CFE_ES_NOOP", "0x1806", "0"], ["CFE_EVS_NOOP", "0x1801", "0"]]


def test_the_list_of_a_mission_has_its_apps_alone(mission: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["cmd", mission, "--list"]) == 0
    shown = capsys.readouterr().out
    assert "SAMPLE_APP_NOOP" in shown
    assert "TO_LAB_NOOP" not in shown
    assert main(["cmd", mission, "--list", "TO_LAB*"]) == 1


def test_the_fields_of_a_command(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["cmd", "--show", "SAMPLE_APP_DISPLAY_PARAM"]) == 0
    shown = capsys.readouterr().out
    assert ["ValI16", "i16", "12", "2"] in [line.split() for line in shown.splitlines()]
    assert "MsgId 0x1882, function code 3, 24 bytes" in shown


def test_the_bytes_of_a_command(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["cmd", "--hex", "127.0.0.1", "CFE_ES_NOOP"]) == 0
    assert capsys.readouterr().out == "1806c00000010020\n"


def test_options_may_stand_between_the_words(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["cmd", "127.0.0.1", "--hex", "SAMPLE_APP_DISPLAY_PARAM", "--for", "1", "ValU32=1", "ValI16=-1"]) == 0
    assert capsys.readouterr().out.startswith("1882c000001103")


def test_a_command_goes_to_a_computer(capsys: pytest.CaptureFixture[str]) -> None:
    with UdpListener("127.0.0.1", 0) as ci_lab:
        assert main(["cmd", f"127.0.0.1:{ci_lab.port}", "CFE_ES_NOOP"]) == 0
        assert ci_lab.receive(5) == bytes.fromhex("1806c00000010020")
    assert capsys.readouterr().out == f"CFE_ES_NOOP sent to 127.0.0.1:{ci_lab.port}, 8 bytes\n"


def test_names_of_a_mission_for_a_computer(mission: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["cmd", "--hex", "--mission", mission, "127.0.0.1", "SAMPLE_APP_NOOP"]) == 0
    assert main(["cmd", "--hex", "--mission", mission, "127.0.0.1", "TO_LAB_NOOP"]) == 2
    assert "unknown command TO_LAB_NOOP" in capsys.readouterr().err


def test_a_command_tried_out(mission: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["cmd", mission, "SAMPLE_APP_DISPLAY_PARAM", "ValU32=7", "ValStr=hello"]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert lines[0] == "0.600 SAMPLE_APP_DISPLAY_PARAM sent to SAMPLE_APP"
    assert "ValU32=7, ValI16=0, ValStr=hello" in lines[1]
    assert lines[-1].split()[1:4] == ["SAMPLE_APP_HK_TLM", "CommandErrorCounter=0", "CommandCounter=1"]


def test_an_error_event_is_a_failure(mission: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["cmd", mission, "CFE_EVS_DISABLE_APP_EVENTS", "AppName=NOBODY"]) == 1
    assert " CFE_EVS 9 ERROR: " in capsys.readouterr().out


def test_a_command_that_nobody_takes_is_a_failure(make_mission: Write, capsys: pytest.CaptureFixture[str]) -> None:
    folder = make_mission("Quiet")
    source = "from cfepy.msg import Command\nCOMMANDS = (Command('QUIET_NOOP', 0x1890, 0),)\n"
    (folder / "apps.py").write_text(source + (folder / "apps.py").read_text(encoding="utf-8"), encoding="utf-8")
    assert main(["cmd", str(folder), "QUIET_NOOP", "--for", "0.5"]) == 1
    assert "QUIET_NOOP sent to no receiver" in capsys.readouterr().out


def test_a_command_for_a_processor_beside_it_waits_for_the_way_there(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["cmd", "pair", "SAMPLE_APP_NOOP", "--with", "pair/client.scr"]) == 0
    sent, *_, counted, _ = capsys.readouterr().out.splitlines()
    assert sent == "0.850 SAMPLE_APP_NOOP sent to SBN"
    assert "SAMPLE_APP_HK_TLM CommandErrorCounter=0 CommandCounter=1" in counted


def test_a_command_that_nobody_takes_beside_it_either(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["cmd", "pair", "SAMPLE_APP_NOOP", "--with", "lab"]) == 1
    assert capsys.readouterr().out.startswith("5.600 SAMPLE_APP_NOOP sent to no receiver")


def test_an_app_that_dies_of_a_command_is_a_failure(make_mission: Write, capsys: pytest.CaptureFixture[str]) -> None:
    folder = make_mission("Dies")
    assert main(["cmd", str(folder), "CFE_ES_NOOP"]) == 1
    assert "cfepy: DIES died: ValueError: boom" in capsys.readouterr().err


def test_a_computer_on_which_nobody_listens(capsys: pytest.CaptureFixture[str]) -> None:
    with UdpListener("127.0.0.1", 0) as closed:
        place = f"127.0.0.1:{closed.port}"
    assert main(["cmd", place, "CFE_ES_NOOP"]) == 1
    said = capsys.readouterr()
    assert (said.out, said.err) == ("", f"cfepy: {place}: no receiver is listening; CFE_ES_NOOP was not delivered\n")


@pytest.mark.parametrize(
    ("words", "said"),
    [
        ([], "missing target or command name"),
        (["127.0.0.1"], "missing target or command name"),
        (["127.0.0.1", "CFE_ES_NOP"], "unknown command CFE_ES_NOP; did you mean CFE_ES_NOOP"),
        (["127.0.0.1", "CFE_ES_NOOP", "X=1"], "X: CFE_ES_NOOP has no fields"),
        (["no_such_mission", "CFE_ES_NOOP"], "no_such_mission: unknown mission"),
        (["nohost", "CFE_ES_NOOP"], "; a host must be an address such as 192.168.1.5, localhost, or NAME:PORT"),
        (["CFE_ES_NOOP"], "CFE_ES_NOOP: this is a command name; put the mission"),
        (["--show", "CFE_ES_NOP"], "unknown command CFE_ES_NOP"),
    ],
)
def test_bad_usage(words: list[str], said: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["cmd", *words]) == 2
    assert said in capsys.readouterr().err
