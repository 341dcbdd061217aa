"""`--foxglove` and `--rosbridge` on the command line."""

from __future__ import annotations

import contextlib
import json
import os
import re
import sys
import threading
from collections.abc import Iterator
from pathlib import Path

import pytest
from websockets.sync.client import connect

from cfepy.cli.main import main
from tests.extra.viewers.foxglove.client import FoxgloveClient
from tests.extra.viewers.foxglove.runs import TALKER, spec_of


@pytest.fixture
def mission(tmp_path: Path) -> str:
    spec_of(tmp_path, {"talker": TALKER})
    return str(tmp_path)


@contextlib.contextmanager
def served(monkeypatch: pytest.MonkeyPatch, words: list[str]) -> Iterator[str]:
    """Run a command that flies in a separate thread until the block ends. Yields the URL of its server."""
    told = threading.Event()
    urls: list[str] = []

    def note(line: str) -> None:
        urls.extend(re.findall(r"ws://\S+", line))
        told.set()

    for user in ("cfepy.cli.run.run", "cfepy.cli.ground.console"):
        monkeypatch.setattr(f"{user}.note", note)
    flight = threading.Thread(target=main, args=(words,))
    flight.start()
    try:
        assert told.wait(60)
        yield urls[0]
    finally:
        flight.join(60)


def digest(text: str) -> str:
    """That of a report."""
    return re.findall(r"trace: (\w+)", text)[-1]


def test_a_run_that_is_shown_is_the_same_run(mission: str, capsys: pytest.CaptureFixture[str]) -> None:
    main(["run", mission, "--for", "1", "--no-console"])
    alone = digest(capsys.readouterr().out)
    assert main(["run", mission, "--for", "1", "--no-console", "--foxglove", "0"]) == 0
    shown = capsys.readouterr()
    assert digest(shown.out) == alone
    assert re.search(r"Foxglove connects to ws://127\.0\.0\.1:\d+", shown.err)
    assert main(["run", mission, "--for", "1", "--no-console", "--foxglove", "0", "--rosbridge", "0"]) == 0
    shown = capsys.readouterr()
    assert digest(shown.out) == alone
    assert re.search(r"rosbridge clients connect to ws://127\.0\.0\.1:\d+", shown.err)


@pytest.mark.parametrize(
    ("options", "why"),
    [
        (["--foxglove", "x"], "--foxglove: invalid address 'x'; expected a form such as 9090"),
        (["--foxglove", "8765", "--viewer-token", "short"], "--viewer-token: a token must have at least 8"),
        (["--foxglove", "198.51.100.1:8765"], r"--foxglove: 198\.51\.100\.1:8765 cannot be opened"),
        (["--viewer-token", "long-enough"], "--viewer-token: requires a viewer port"),
        (["--foxglove", "0", "--check-determinism"], "--foxglove: cannot be combined with --check-determinism"),
        (["--rosbridge", "x"], "--rosbridge: invalid address 'x'; expected a form such as 9090"),
        (["--rosbridge", "9090", "--viewer-token", "short"], "--viewer-token: a token must have at least 8"),
        (["--rosbridge", "198.51.100.1:9090"], r"--rosbridge: 198\.51\.100\.1:9090 cannot be opened"),
        (["--viewer-origin", "https://example.org"], "--viewer-origin: requires a viewer port"),
        (["--foxglove", "0", "--viewer-origin", "foo"], "--viewer-origin: invalid origin 'foo'"),
        (["--rosbridge", "0", "--viewer-origin", "foo"], "--viewer-origin: invalid origin 'foo'"),
        (["--rosbridge", "0", "--check-determinism"], "--rosbridge: cannot be combined with --check-determinism"),
    ],
)
def test_what_is_wrong_is_told(mission: str, options: list[str], why: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["run", mission, "--for", "1", *options]) == 2
    assert re.search(why, capsys.readouterr().err)


def test_the_library_is_asked_for(
    mission: str, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setitem(sys.modules, "websockets", None)
    assert main(["run", mission, "--foxglove", "0"]) == 2
    assert "pip install 'cfepy[viz]'" in capsys.readouterr().err
    assert main(["run", mission, "--rosbridge", "0"]) == 2
    assert "pip install 'cfepy[web]'" in capsys.readouterr().err


def test_one_token_is_made_for_all_servers(
    mission: str, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.delenv("CFEPY_VIEWER_TOKEN", raising=False)
    assert (
        main(["run", mission, "--for", "1", "--no-console", "--foxglove", "0.0.0.0:0", "--rosbridge", "0.0.0.0:0"]) == 0
    )
    shown = capsys.readouterr()
    assert len(re.findall(r"viewers require the token \S{24} ", shown.err)) == 1
    assert "token" not in shown.out


@pytest.mark.slow
@pytest.mark.parametrize("pace", [["--realtime"], []])
def test_a_journal_of_a_run_with_rosbridge_is_replayed_without_clients(
    mission: str, tmp_path: Path, pace: list[str], capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """It is replayed at the pace of the wall clock, and as fast as possible. The token is in no journal."""
    file, token = tmp_path / "run.cfepy", "a-long-secret"
    length = "4" if pace else "6000"
    command = ["run", mission, "--for", length, "--no-console", "--rosbridge", "0", "--viewer-token", token]
    with (
        served(monkeypatch, [*command, "--record", str(file), *pace]) as url,
        connect(f"{url}/?token={token}") as client,
    ):
        client.send(json.dumps({"op": "subscribe", "topic": "/chatter", "type": "std_msgs/String"}))
        hearers: list[str] = []
        while not hearers:  # the talker has not started yet
            client.send(json.dumps({"op": "call_service", "service": "/rosapi/subscribers", "args": ["/orders"]}))
            hearers = json.loads(client.recv(60))["values"]["subscribers"]
        client.send(json.dumps({"op": "publish", "topic": "/orders", "msg": {"data": "hi"}}))
        assert json.loads(client.recv(60))["topic"] == "/chatter"
    out = capsys.readouterr().out
    assert re.search(r"/orders +rosbridge 127\.0\.0\.1 +in +1 +0 ", out)
    assert token.encode() not in file.read_bytes()
    assert main(["replay", str(file), "--no-console"]) == 0
    assert digest(capsys.readouterr().out) == digest(out)
    assert main(["replay", str(file), "--info"]) == 0
    assert token not in capsys.readouterr().out


def test_what_keeps_a_mission_from_taking_off_is_told(mission: str, capsys: pytest.CaptureFixture[str]) -> None:
    script = f"{mission}/script.txt"
    Path(script).write_text("nonsense\n", encoding="utf-8")
    assert main(["run", mission, "--script", script, "--foxglove", "0"]) == 2
    assert "script.txt:1" in capsys.readouterr().err


@pytest.mark.slow
@pytest.mark.parametrize("pace", [["--realtime"], []])
def test_a_journal_of_a_run_with_viewers_is_replayed_without_them(
    mission: str, tmp_path: Path, pace: list[str], capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """It is replayed at the pace of the wall clock, and as fast as possible."""
    file = str(tmp_path / "run.cfepy")
    length = "4" if pace else "6000"
    command = ["run", mission, "--for", length, "--no-console", "--foxglove", "0", "--record", file, *pace]
    with served(monkeypatch, command) as url, FoxgloveClient(url) as client:
        client.subscribe("/chatter", "/cfe/events")
        client.advertise(1, "/orders", "std_msgs/String", "json")
        client.advertise(2, "/cfe/CFE_ES_NOOP", "", "json")
        client.publish(2, b"{}")
        client.send(op="setParameters", parameters=[{"name": "/speed", "value": 5}])
        while not client.of("/chatter"):
            client.publish(1, b'{"data": "hi"}')
            before = len(client.messages)
            client.wait_for(lambda before=before: len(client.messages) > before)  # type: ignore[misc]  # a loop's
        client.take_rest()
        assert any(b"No-op" in each for each in client.of("/cfe/events"))
    out = capsys.readouterr().out
    assert re.search(r"/orders +foxglove +in +\d+ +0 ", out)
    assert main(["replay", file, "--no-console"]) == 0
    assert digest(capsys.readouterr().out) == digest(out)


@pytest.mark.slow
@pytest.mark.parametrize("pace", [["--realtime"], []])
def test_a_session_of_the_console_serves_viewers_also_while_time_stands_still(
    mission: str, tmp_path: Path, pace: list[str], capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Virtual time stands still at first, and continues only after the client has connected and subscribed."""
    file = str(tmp_path / "run.cfepy")
    typed, typing = os.pipe()
    words = ["console", mission, "--plain", "--rosbridge", "0", "--record", file, *pace]
    with os.fdopen(typed) as stdin:
        monkeypatch.setattr(sys, "stdin", stdin)
        with served(monkeypatch, words) as url, os.fdopen(typing, "w", buffering=1) as keys:
            keys.write("pause\n")
            with connect(url) as client:
                client.send(json.dumps({"op": "subscribe", "topic": "/latched", "type": "std_msgs/String"}))
                client.send(json.dumps({"op": "call_service", "service": "/rosapi/topics"}))
                assert json.loads(client.recv(60))["values"]["topics"] == ["/latched"]
                keys.write("run 3\n")
                assert json.loads(client.recv(60))["topic"] == "/latched"
                client.send(json.dumps({"op": "publish", "topic": "/orders", "msg": {"data": "hi"}}))
            keys.write("quit\n")
    out = capsys.readouterr().out
    assert main(["replay", file, "--no-console"]) == 0
    assert digest(capsys.readouterr().out) == digest(out)


def test_a_computer_elsewhere_is_shown_by_nobody(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["console", "--udp", "127.0.0.1", "--rosbridge", "0"]) == 2
    assert "--rosbridge: only valid for a mission, and 127.0.0.1 is a remote target" in capsys.readouterr().err
