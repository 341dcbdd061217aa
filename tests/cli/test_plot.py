"""`cfepy plot`. tests/extra/reports/test_curves.py tests the picture."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest

from cfepy.cli.main import main

CAPTURE = ("capture", "--for", "1")


@pytest.mark.parametrize("kind", ["svg", *(pytest.param(kind, marks=pytest.mark.slow) for kind in ("png", "pdf"))])
def test_a_picture(kind: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    pytest.importorskip("matplotlib")
    file = tmp_path / f"one.{kind}"
    words = ["/joint_states.position", "CFE_EVS_LONG_EVENT_MSG.PacketID.EventID", "/phase.data", "--subplots"]
    assert main(["plot", *CAPTURE, *words, "-o", str(file)]) == 0
    assert capsys.readouterr().out == f"{file}: 8 lines\n"
    assert file.read_bytes().startswith({"png": b"\x89PNG", "svg": b"<?xml", "pdf": b"%PDF"}[kind])


@pytest.mark.parametrize(
    ("words", "why"),
    [
        (
            ["/phase.data", "-o", "x.jpg"],
            "x.jpg: --output: must be a picture with a name that ends with .png, .svg, .pdf",
        ),
        (["/joint_state.position", "-o", "{}/x.png"], "did you mean /joint_states?"),
        (["/joint_states.name", "-o", "{}/x.png"], "/joint_states: name: cannot be drawn: neither numbers nor a text"),
        (["/phase.data", "-o", "/no/such/x.png"], "/no/such/x.png: --output: cannot be written"),
        (["/phase.data", "-o", "{}/x.png", "--from", "9s"], "no message was sent after 9 s"),
    ],
)
def test_bad_usage(words: list[str], why: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    pytest.importorskip("matplotlib")
    assert main(["plot", *CAPTURE, *(word.format(tmp_path) for word in words)]) == 2
    assert why in capsys.readouterr().err


@pytest.mark.parametrize("size", ["10", "0x3", "axb", "10x1000"])
def test_a_size_that_is_none(size: str, capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit):
        main(["plot", *CAPTURE, "/phase.data", "--size", size])
    assert "expected WIDTHxHEIGHT such as 10x4.5" in capsys.readouterr().err


def test_without_matplotlib(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    for module in ("matplotlib", "matplotlib.figure"):
        monkeypatch.setitem(sys.modules, module, None)
    assert main(["plot", "capture", "/phase.data"]) == 2
    assert "pip install 'cfepy[plot]'" in capsys.readouterr().err
