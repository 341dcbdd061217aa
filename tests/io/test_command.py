"""`cfepy run --realtime` and its ports, from the command line."""

from __future__ import annotations

import re
import socket

import pytest

from cfepy.cli.main import main

FAST = ["--realtime", "1000", "--for", "4"]


def trace_of(text: str) -> str:
    found = re.search(r"^trace: (\w+)$", text, re.MULTILINE)
    assert found
    return found[1]


def test_open_ports_do_not_change_the_run(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["run", "lab", *FAST, "--port", "1234=0"]) == 0
    paced = capsys.readouterr().out
    assert re.search(r"^UDP port 1234 is open at 127\.0\.0\.1:\d+$", paced, re.MULTILINE)
    assert main(["run", "lab", "--for", "4"]) == 0
    free = capsys.readouterr().out
    assert "is open at" not in free
    assert trace_of(paced) == trace_of(free)


def test_taken_port_ends_the_run_with_an_error(capsys: pytest.CaptureFixture[str]) -> None:
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as other:
        other.bind(("127.0.0.1", 0))
        port = other.getsockname()[1]
        assert main(["run", "lab", *FAST, "--port", f"1234={port}"]) == 2
    assert f"cfepy: UDP port {port} of 127.0.0.1 cannot be opened" in capsys.readouterr().err


def test_ports_require_realtime(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["run", "lab", "--port", "1234=0"]) == 2
    assert "--port" in capsys.readouterr().err


@pytest.mark.parametrize("ports", ["1234", "0=1", "1234=70000", "a=b", "1234=-1"])
def test_invalid_ports_are_refused(ports: str, capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as ended:
        main(["run", "lab", *FAST, "--port", ports])
    assert ended.value.code == 2
    assert "1234=5000" in capsys.readouterr().err
