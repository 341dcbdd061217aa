"""`--foxglove` on the command line."""

from __future__ import annotations

import re
import sys
import threading
from pathlib import Path

import pytest

from cfepy.cli.main import main
from tests.viewers.foxglove.client import FoxgloveClient
from tests.viewers.foxglove.runs import TALKER, spec_of


@pytest.fixture
def mission(tmp_path: Path) -> str:
    spec_of(tmp_path, {"talker": TALKER})
    return str(tmp_path)


def digest(text: str) -> str:
    """That of a report."""
    return re.findall(r"trace: (\w+)", text)[-1]


def test_a_run_that_is_shown_is_the_same_run(mission: str, capsys: pytest.CaptureFixture[str]) -> None:
    main(["run", mission, "--for", "1", "--quiet"])
    alone = digest(capsys.readouterr().out)
    assert main(["run", mission, "--for", "1", "--quiet", "--foxglove", "0"]) == 0
    shown = capsys.readouterr()
    assert digest(shown.out) == alone
    assert re.search(r"Foxglove connects to ws://127\.0\.0\.1:\d+", shown.err)


@pytest.mark.parametrize(
    ("options", "why"),
    [
        (["--foxglove", "x"], "--foxglove: 'x' is not like 9090"),
        (["--foxglove", "8765", "--viewer-token", "short"], "--viewer-token: a token has at least 8"),
        (["--foxglove", "198.51.100.1:8765"], r"--foxglove: 198\.51\.100\.1:8765 cannot be opened"),
        (["--viewer-token", "long-enough"], "--viewer-token: nobody can connect"),
        (["--foxglove", "0", "--check-determinism"], "--foxglove: runs that are compared are not shown"),
    ],
)
def test_what_is_wrong_is_told(mission: str, options: list[str], why: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["run", mission, "--for", "1", *options]) == 2
    assert re.search(why, capsys.readouterr().err)


def test_the_library_is_asked_for(
    mission: str, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setitem(sys.modules, "foxglove", None)
    assert main(["run", mission, "--foxglove", "0"]) == 2
    assert "pip install 'cfepy[viz]'" in capsys.readouterr().err


@pytest.mark.slow
@pytest.mark.parametrize("pace", [["--realtime"], []])
def test_a_journal_of_a_run_with_viewers_is_replayed_without_them(
    mission: str, tmp_path: Path, pace: list[str], capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """At the pace of the wall clock, and as fast as it goes."""
    file = str(tmp_path / "run.cfepy")
    told = threading.Event()
    urls: list[str] = []

    def to_stderr(line: str) -> None:
        urls.extend(re.findall(r"ws://\S+", line))
        told.set()

    monkeypatch.setattr("cfepy.cli.viewers._to_stderr", to_stderr)
    length = "4" if pace else "6000"
    command = ["run", mission, "--for", length, "--quiet", "--foxglove", "0", "--record", file, *pace]
    flight = threading.Thread(target=main, args=(command,))
    flight.start()
    assert told.wait(60)
    with FoxgloveClient(urls[0]) as client:
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
    flight.join(60)
    out = capsys.readouterr().out
    assert re.search(r"/orders +foxglove +in +\d+ +0 ", out)
    assert main(["replay", file, "--quiet"]) == 0
    assert digest(capsys.readouterr().out) == digest(out)
