"""`cfepy console` on a terminal: the screen, keys, history and completion."""

from __future__ import annotations

import pytest
from textual.pilot import Pilot
from textual.widgets import RichLog, Static

from cfepy.cli.ground.console.screen import KEYS, ConsoleScreen, LineInput
from cfepy.cli.main import main
from dev.pages.console_picture import idle, in_a_console, say


def text_of(screen: ConsoleScreen, name: str) -> str:
    """Return the text of a pane."""
    widget = screen.query_one(f"#{name}")
    if isinstance(widget, RichLog):
        return " ".join(line.text.rstrip() for line in widget.lines)
    assert isinstance(widget, Static)
    return str(widget.render())


async def type_keys(pilot: Pilot[None], text: str) -> None:
    names = {" ": "space", "_": "underscore", "=": "equals_sign"}
    await pilot.press(*(names.get(letter, letter) for letter in text))


@pytest.mark.slow
def test_a_session_on_a_screen_of_120_columns() -> None:
    async def use(screen: ConsoleScreen, pilot: Pilot[None]) -> None:
        line = screen.query_one(LineInput)
        assert text_of(screen, "hint") == KEYS
        await type_keys(pilot, "run 1")
        await pilot.press("enter")
        await idle(screen, pilot)
        assert text_of(screen, "status").startswith("lab  1.000 s  paused  sent 0")
        assert "CFE_ES_Main entering OPERATIONAL state" in text_of(screen, "log")
        assert "1.000 CFE_TIME 21 INFORMATION: Stop FLYWHEEL" in text_of(screen, "events")

        await type_keys(pilot, "sample_app_n")
        assert text_of(screen, "hint").startswith("SAMPLE_APP_NOOP")
        await pilot.press("tab")
        assert line.value == "SAMPLE_APP_NOOP "
        await pilot.press("enter")
        await idle(screen, pilot)
        assert "1.000 send SAMPLE_APP_NOOP" in text_of(screen, "log")
        await say(screen, pilot, ["hk", "run 0.1", "page SAMPLE_APP_HK_TLM"])
        assert screen.query_one("#telemetry").border_title == "telemetry: SAMPLE_APP_HK_TLM"
        page = text_of(screen, "page")
        assert page.startswith("SAMPLE_APP_HK_TLM  n=")
        assert "CommandCounter         1" in page

        await pilot.press("up")
        assert line.value == "SAMPLE_APP_NOOP"
        await pilot.press("up")
        assert line.value == "run 1"
        await pilot.press("down", "down")
        assert line.value == ""

        await pilot.press("f3")
        await idle(screen, pilot)
        assert text_of(screen, "events") == ""
        await pilot.press("f3", "f2")
        await idle(screen, pilot)
        assert "SAMPLE: NOOP command" in text_of(screen, "events")
        assert screen.query_one("#telemetry").border_title == "telemetry: hk"

    ended = in_a_console(["lab"], use).ended
    assert ended.status == 0
    assert ended.lines[-1].startswith("trace: ")


def test_a_run_that_goes_on_is_paused_by_ctrl_c_and_the_screen_is_usable_at_60_columns() -> None:
    async def use(screen: ConsoleScreen, pilot: Pilot[None]) -> None:
        screen.enter("run")
        while "x real time" not in text_of(screen, "status"):
            await pilot.pause(0.01)
        await pilot.press("ctrl+c")
        await idle(screen, pilot)
        assert "paused" in text_of(screen, "status")
        assert {screen.query_one(f"#{name}").size.width for name in ("telemetry", "events", "log")} == {60}
        assert screen.query_one("#log").size.height >= 5

    assert in_a_console(["lab"], use, (60, 24)).ended.status == 0


def test_without_textual_there_is_a_hint(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    monkeypatch.setattr("cfepy.cli.ground.console.is_terminal", lambda: True)
    monkeypatch.setattr("cfepy.cli.ground.console.find_spec", lambda name: None)
    assert main(["console", "lab"]) == 2
    assert "pip install 'cfepy[console]'; or use --plain" in capsys.readouterr().err
