"""Parts of the console: completion of a line, pages of telemetry, the script of a session."""

from __future__ import annotations

from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from cfepy.cli.ground.console.completion import Completer
from cfepy.cli.ground.console.pages import CHANGED, PacketBoard, Row
from cfepy.cli.ground.console.plain import text_of_row
from cfepy.cli.ground.console.saved import SavedScript, time_text, without_when
from cfepy.cli.watched_host import Interrupts, WatchedHost
from cfepy.es.packets import HK_TLM
from cfepy.evs.packets import LONG_EVENT_MSG
from cfepy.ground import Dictionary, dictionary_of, packet_of
from cfepy.mission import FIRST_PIECE_NS, Seen
from cfepy.msg import RED, YELLOW, Layout, Measurement, Telemetry
from cfepy.pilot import RunPlan, takeoff
from cfepy.rtos import ENDLESS
from cfepy.script import Step, StepVerdict
from cfepy.script.conditions import AppCondition, EventCondition
from cfepy.status import UsageError

DICTIONARY = dictionary_of(None)


@pytest.fixture
def completer() -> Completer:
    words: dict[str, Any] = dict.fromkeys(("run", "page", "load", "until"), SimpleNamespace(text="a word"))
    scene = SimpleNamespace(dictionary=DICTIONARY, has_mission=False)
    session: Any = SimpleNamespace(words=words, craft=SimpleNamespace(script=SimpleNamespace(scene=scene)))
    return Completer(session)


@pytest.mark.parametrize(
    ("line", "candidates"),
    [
        ("ru", ["run"]),
        ("cfe_es_noo", ["CFE_ES_NOOP"]),
        ("send SAMPLE_APP_NOO", ["SAMPLE_APP_NOOP"]),
        ("at 3 send SAMPLE_APP_NOO", ["SAMPLE_APP_NOOP"]),
        ("SAMPLE_APP_DISPLAY_PARAM ValU32=1 V", ["ValI16=", "ValStr="]),
        ("CFE_EVS_SET_EVENT_FORMAT_MODE MsgFormat=", ["MsgFormat=SHORT", "MsgFormat=LONG"]),
        ("expect tlm CFE_ES_HK_TLM ResetType == PO", ["POWERON"]),
        ("expect ", ["event", "tlm", "topic", "response", "param", "app", "console", "file", "no"]),
        ("expect no ev", ["event"]),
        ("until event * ER", ["ERROR"]),
        ("expect tlm CFE_ES_HK", ["CFE_ES_HK_TLM"]),
        ("expect tlm CFE_ES_HK_TLM CommandC", ["CommandCounter"]),
        ("expect tlm CFE_ES_HK_TLM CommandCounter =", ["=="]),
        ("expect tlm CFE_ES_HK_TLM CommandCounter == 3 a", ["and"]),
        ("expect app SAMPLE_APP RUN", ["RUNNING"]),
        ("reset pow", ["power-on"]),
        ("page CFE_SB_HK", ["CFE_SB_HK_TLM"]),
        ("nonsense word", []),
    ],
)
def test_how_a_line_may_go_on(completer: Completer, line: str, candidates: list[str]) -> None:
    assert [each.text for each in completer.complete(line).choices] == candidates


def test_fields_have_their_types_and_a_line_is_extended_as_far_as_it_is_clear(completer: Completer) -> None:
    fields = completer.complete("CFE_SB_SEND_SB_STATS ").choices
    assert fields == []
    hints = dict(completer.complete("SAMPLE_APP_DISPLAY_PARAM ").choices)
    assert hints == {"ValU32=": "u32", "ValI16=": "i16", "ValStr=": "char[10]"}
    for line, extended in (
        ("cfe_es_noo", "CFE_ES_NOOP "),
        ("SAMPLE_APP_DISPLAY_PARAM ValU", "SAMPLE_APP_DISPLAY_PARAM ValU32="),
        ("SAMPLE_APP_DISPLAY_PARAM v", "SAMPLE_APP_DISPLAY_PARAM Val"),
        ("nonsense word", "nonsense word"),
    ):
        assert completer.complete(line).extended(line) == extended


def test_files_are_completed(completer: Completer, tmp_path: Path) -> None:
    (tmp_path / "checks.txt").touch()
    (tmp_path / "more").mkdir()
    assert [each.text for each in completer.complete(f"load {tmp_path}/").choices] == [
        f"{tmp_path}/checks.txt",
        f"{tmp_path}/more/",
    ]
    assert completer.complete(f"load {tmp_path}/none/").choices == []


def test_files_with_control_characters_are_not_completed(completer: Completer, tmp_path: Path) -> None:
    (tmp_path / "x\x1b[31m").touch()
    (tmp_path / "y").touch()
    assert [each.text for each in completer.complete(f"load {tmp_path}/").choices] == [f"{tmp_path}/y"]


def packet(**values: Any) -> bytes:
    return HK_TLM.packet(values)


def cells(rows: list[Row]) -> dict[str, str]:
    return {piece.text: piece.style for row in rows for piece in row}


def test_a_page_shows_what_changed_and_fits_its_width() -> None:
    board = PacketBoard(DICTIONARY)
    assert text_of_row(board.rows(80)[0]) == "no packet of hk yet"
    board.note(Seen(10**9, packet(CommandCounter=1, SysLogSize=3072), "CFE_ES"))
    assert CHANGED not in cells(board.rows(80)).values()
    board.note(Seen(2 * 10**9, packet(CommandCounter=77, CommandErrorCounter=2, SysLogSize=3072), "CFE_ES"))
    shown = cells(board.rows(80))
    assert (shown["77"], shown["3072"]) == (CHANGED, "value")
    assert "CFE_ES_HK_TLM  n=2  at 2.000" in shown
    assert board.counters() == (77, 2)
    for width in (20, 60, 120):
        assert max(len(text_of_row(row)) for row in board.rows(width)) <= width
    board.choose(["all"])
    assert text_of_row(board.rows(60)[0]).startswith("CFE_ES_HK_TLM  2  2.000  CommandCounter=77 ")
    board.choose(["CFE_SB_*"])
    assert text_of_row(board.rows(60)[0]) == "no packet of CFE_SB_* yet"


def test_a_page_shows_control_characters_of_packets_as_escapes() -> None:
    board = PacketBoard(DICTIONARY)
    values = {"PacketID": {"AppName": "\x1b[2J\n"}, "Message": "\x1b]0;title\a"}
    board.note(Seen(10**9, LONG_EVENT_MSG.packet(values), "CFE_EVS"))
    for page in ("all", "CFE_EVS_LONG_EVENT_MSG"):
        board.choose([page])
        text = "\n".join(text_of_row(row) for row in board.rows(400))
        assert "\x1b" not in text
        assert r"\x1b[2J\n" in text
        assert r"\x1b]0;title\x07" in text
    with pytest.raises(UsageError, match="unknown telemetry packet NOPE"):
        board.choose(["NOPE"])


def test_page_shows_measurements_with_marks_and_as_raw_numbers() -> None:
    layout = Layout("Hk", [("Temp", Measurement("u16", "degC", polynomial=(-40.0, 0.1), yellow=(0, 50), red=(0, 60)))])
    hot = Telemetry("T_HK_TLM", 0x08F0, layout)
    dictionary = Dictionary()
    dictionary.add([hot])
    board = PacketBoard(dictionary)
    for raw, text, style in (
        (700, "30degC", "value"),
        (930, "53degC[yellow>50]", YELLOW),
        (1100, "70degC[red>60]", RED),
    ):
        board.note(Seen(10**9, hot.packet(Temp=raw), "T"))
        assert cells(board.rows(80)).get(text) == style
    board.show_raw(True)
    assert cells(board.rows(80))["1100"] == RED
    board.show_raw(False)
    assert cells(board.rows(80))["70degC[red>60]"] == RED


EXPECTED = Step(1, "expect event HK", condition=EventCondition("HK"))
GUARD = Step(1, "after 1 expect no event HK", condition=EventCondition("HK"), must_not=True)
STATE = Step(1, "expect app HK", condition=AppCondition("HK"))
S = 10**9


def saved(*noted: tuple[Step | None, int, int, str], end_ns: int = 20 * S) -> list[str]:
    """Return the lines of a script: steps or commands with when they began and were done, and the verdict's detail."""
    script = SavedScript(DICTIONARY)
    for step, began_ns, done_ns, detail in noted:
        if step is None:
            script.sent(packet_of(DICTIONARY.command("CFE_ES_NOOP"), []), began_ns)
        else:
            script.expected(step, StepVerdict(1, step.text, not detail, 0.0, detail), began_ns, done_ns)
    return script.text(end_ns).splitlines()


SENT = (None, S, S, "")
OVER = "the run ended earlier"


@pytest.mark.parametrize(
    ("step", "began_ns", "done_ns", "detail", "line"),
    [
        (EXPECTED, S, 2 * S, "", "        expect event HK"),
        (EXPECTED, S, 2 * S, "no event was sent", "        expect event HK"),
        (EXPECTED, 2 * S, 3 * S, "", "        expect event HK"),
        (EXPECTED, 2 * S, 4 * S, "", "# 2: expect event HK"),  # checking every 10 ms may be too late
        (EXPECTED, S, 5 * S, "", "# 1: expect event HK"),
        (EXPECTED, S, 4 * S, OVER, "# 1: expect event HK"),
        (GUARD, 2 * S, 20 * S, "", "at 2 expect no event HK"),
        (STATE, S, S, "", "        expect app HK"),
        (STATE, 2 * S, 2 * S, "", "at 2 expect app HK"),
    ],
)
def test_an_expectation_is_saved_where_it_cannot_hold_up_what_follows(
    step: Step, began_ns: int, done_ns: int, detail: str, line: str
) -> None:
    lines = saved(SENT, (step, began_ns, done_ns, detail), (None, 4 * S, 4 * S, ""))
    assert lines == ["at 1 send CFE_ES_NOOP", line, "at 4 send CFE_ES_NOOP", "at 20 end"]


def test_packets_that_have_no_name_are_saved_as_bytes() -> None:
    script = SavedScript(DICTIONARY, ["a heading"])
    script.sent(
        packet_of(DICTIONARY.command("SAMPLE_APP_DISPLAY_PARAM"), ["ValStr=two words", "ValU32=7"]), 1_000_000_001
    )
    script.sent(b"\x18\x06\xc0\x00\x00\x01\x63\x00", 2 * S)
    assert script.text(3 * S).splitlines() == [
        "# a heading",
        'at 1.000000001 send SAMPLE_APP_DISPLAY_PARAM ValU32=7 ValStr="two words"',
        "at 2 send raw 1806c00000016300",
        "at 3 end",
    ]
    assert script.count == 2


def test_times_and_texts() -> None:
    assert [time_text(ns) for ns in (-1, 0, 10, 1_500_000_000)] == ["0", "0", "0.00000001", "1.5"]
    assert [without_when(text) for text in ("at 2   send X", "after 0.5 end", "expect app HK")] == [
        "send X",
        "end",
        "expect app HK",
    ]


def test_a_pace_that_nobody_can_keep_up_with_is_gone_in_short_pieces() -> None:
    host = WatchedHost(Interrupts())
    with host, takeoff(RunPlan(("lab",), seconds=1e6), host=host) as run:
        host.pace(1e9)
        assert run.step(ENDLESS)
        assert 0 < run.mission.kernel.now <= FIRST_PIECE_NS
        host.pace(None)
        assert run.step(ENDLESS)
