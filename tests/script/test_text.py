"""The language of mission scripts: accepted text, and the errors about mistakes before anything runs."""

from __future__ import annotations

from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from cfepy.ground.dictionary import dictionary_of
from cfepy.mission import MissionSpec, read_mission
from cfepy.script.text import Script, Words, parse_script, read_script
from cfepy.status import UsageError
from tests.mission.flights import write_mission

STARTUP = "CFE_APP, sample_app, SAMPLE_APP_Main, SAMPLE_APP, 50, 16384, 0x0, 0;\n!\n"


def script(folder: Path, text: str) -> Script:
    spec = read_mission(write_mission(folder, STARTUP))
    path = folder / "script.txt"
    path.write_text(text, encoding="utf-8")
    return read_script(path, spec, dictionary_of(spec))


def test_words_texts_and_comments() -> None:
    words = Words('expect event  APP 3 "a # b" Name="x y" # the rest')
    assert words.source == 'expect event  APP 3 "a # b" Name="x y"'
    assert words.rest() == ["expect", "event", "APP", "3", "a # b", "Name=x y"]
    assert not Words("   # nothing")


def test_every_kind_of_step_is_understood(tmp_path: Path) -> None:
    found = script(
        tmp_path,
        """
        # comments and empty lines are no steps

        at 2.0  send CFE_ES_NOOP
        expect event CFE_ES 3 "No-op command" within 1
        expect event CFE_ES
        expect event * * ERROR
        at 5 send SAMPLE_APP_DISPLAY_PARAM ValU32=10 ValStr="a b"   # with a text
        expect tlm SAMPLE_APP_HK_TLM CommandCounter == 1 and CommandErrorCounter < 2 within 2
        expect tlm 0x0883
        expect tlm /joint_states position[2] >= -0.5
        expect no event * ERROR until 20
        expect app SAMPLE_APP RUNNING
        expect no app OTHER
        expect app SAMPLE_APP GONE within 3
        expect file /ram/x.log size 1000
        expect file /ram/x.log size >= 1000 until 30
        expect no file /ram/y
        expect console "OPERATIONAL"
        after 1.5 send raw 1806c00000010020
        after 1 reset processor
        reset power-on
        at 45 end
        """,
    )
    assert len(found.steps) == 20
    assert found.steps[0].packet == bytes.fromhex("1806c00000010020")
    assert found.steps[4].packet is not None
    assert found.steps[4].packet[8:12] == bytes([10, 0, 0, 0])
    assert found.steps[16].packet == bytes.fromhex("1806c00000010020")
    assert [step.at_ns for step in found.steps if step.at_ns is not None] == [2 * 10**9, 5 * 10**9, 45 * 10**9]
    assert found.steps[0].line == 4
    assert found.longest_ns == 45 * 10**9


@pytest.mark.parametrize(
    ("line", "said"),
    [
        ("cmd CFE_ES_NOOP", "invalid step 'cmd'; write `send NAME FIELD=VALUE`"),
        ("wait 2", "invalid step 'wait'; write `after SECONDS`"),
        ("expect telemetry CFE_ES_HK_TLM", "invalid condition 'telemetry'; write `tlm`"),
        ("sned CFE_ES_NOOP", "invalid step 'sned'; did you mean send?"),
        ("at noon send CFE_ES_NOOP", "invalid number of seconds 'noon'; expected 0 to 1e+09"),
        ("at 2", "unexpected end of line; a step such as send or expect is missing"),
        ("send", "unexpected end of line; the command's name is missing"),
        ("send CFE_ES_NOP", "unknown command CFE_ES_NOP; did you mean CFE_ES_NOOP"),
        ("send CFE_ES_NOOP X=1", "X: CFE_ES_NOOP has no fields"),
        ("send SAMPLE_APP_DISPLAY_PARAM ValU32=-1", "ValU32: -1 does not fit u32"),
        ("send raw 18zz", "invalid bytes '18zz'"),
        ("reset warm", "invalid kind of reset 'warm'; expected processor or power-on"),
        ("expect evnt CFE_ES", "invalid condition 'evnt'; did you mean event?"),
        ("expect event", "unexpected end of line; the application's name is missing"),
        ("expect event CFE_ES 3 EROR", "invalid type of event 'EROR'; did you mean ERROR?"),
        ('expect event CFE_ES 3 "No-op', 'unclosed quote: "No-op'),
        ("expect tlm SAMPLE_APP_HK", "unknown telemetry packet SAMPLE_APP_HK; did you mean SAMPLE_APP_HK_TLM?"),
        ("expect tlm SAMPLE_APP_HK_TLM Counter == 1", "Counter: unknown field of SAMPLE_APP_HK_TLM; "),
        ("expect tlm SAMPLE_APP_HK_TLM CommandCounter = 1", "invalid sign '='; expected ==, !=, <, <=, > or >="),
        ("expect tlm SAMPLE_APP_HK_TLM CommandCounter ==", "unexpected end of line; the value is missing"),
        ("expect tlm SAMPLE_APP_HK_TLM CommandCounter == x", "CommandCounter: invalid number 'x'"),
        ("expect app SAMPLE_APP RUNING", "invalid application state 'RUNING'; did you mean RUNNING?"),
        ("expect file x.log", "invalid path 'x.log'; a path in the mission's file system begins with /cf"),
        ("expect file /ram/x size big", "invalid size 'big'; expected a number of bytes"),
        ("expect console", "unexpected end of line; the text is missing"),
        ("expect app SAMPLE_APP within", "unexpected end of line; the time is missing"),
        ("expect app SAMPLE_APP within 1 2", "unexpected '2' after the end of the step"),
        ("end now", "unexpected 'now'"),
    ],
)
def test_mistake_is_reported_with_its_line(tmp_path: Path, line: str, said: str) -> None:
    with pytest.raises(UsageError) as error:
        script(tmp_path, f"# first line\n{line}\n")
    assert str(error.value).startswith(f"{tmp_path / 'script.txt'}:2: {said}")


def test_all_wrong_steps_are_raised_together(tmp_path: Path) -> None:
    text = "sned CFE_ES_NOOP\nsend CFE_ES_NOOP\nsend SAMPLE_APP_DISPLAY_PARAM ValU32=-1 ValU=2\nexpect app X Y\n"
    with pytest.raises(UsageError) as error:
        script(tmp_path, text)
    found = [(each.line, each.field, each.text) for each in error.value.each]
    assert [(line, field) for line, field, _ in found] == [(1, None), (3, "ValU32"), (3, "ValU"), (4, None)]
    assert (
        found[2][2]
        == "unknown field of SAMPLE_APP_DISPLAY_PARAM; did you mean ValU32? (expected ValU32, ValI16 or ValStr)"
    )


def test_times_that_go_back_are_refused(tmp_path: Path) -> None:
    with pytest.raises(UsageError, match="at 2 is earlier than a step before, at 3"):
        script(tmp_path, "at 3 send CFE_ES_NOOP\nat 2 send CFE_ES_NOOP\n")


def test_invalid_script_file_is_refused(tmp_path: Path) -> None:
    with pytest.raises(UsageError, match="has no steps; add at least one, such as `at 5 send CFE_ES_NOOP`"):
        script(tmp_path, "# nothing\n")
    spec = read_mission(write_mission(tmp_path, STARTUP))
    with pytest.raises(UsageError, match="cannot be read"):
        read_script(tmp_path / "no_such_file", spec, dictionary_of(spec))


@pytest.mark.parametrize(
    ("text", "longest_s"),
    [
        ("send CFE_ES_NOOP", 0),
        ("at 2 send CFE_ES_NOOP\nexpect event CFE_ES within 1", 3),
        ("at 2 send CFE_ES_NOOP\nexpect event CFE_ES", 7),
        ("at 2 send CFE_ES_NOOP\nexpect event CFE_ES until 4\nafter 3 send CFE_ES_NOOP", 7),
        ("expect no event * ERROR until 9\nat 2 send CFE_ES_NOOP", 9),
        ("at 2 expect no event * ERROR\nafter 1 end", 3),
        ("at 2 expect app SAMPLE_APP RUNNING", 2),
    ],
)
def test_longest_time_of_a_script_is_computed(tmp_path: Path, text: str, longest_s: float) -> None:
    assert script(tmp_path, text).longest_ns == longest_s * 10**9


DICTIONARY = dictionary_of(None)
WORDS = [
    "at", "after", "send", "raw", "reset", "expect", "no", "event", "tlm", "app", "file", "console", "end", "within",
    "until", "size", "and", "==", ">=", "*", "1", "2.5", "-1", "0x10", '"text"', '"', "#", "ERROR", "RUNNING", "GONE",
    "CFE_ES", "CFE_ES_NOOP", "SAMPLE_APP_HK_TLM", "CommandCounter", "/topic", "/ram/x", "processor", "ValU32=1", "=",
]  # fmt: skip


@pytest.fixture(scope="module")
def spec(tmp_path_factory: pytest.TempPathFactory) -> MissionSpec:
    return read_mission(write_mission(tmp_path_factory.mktemp("words"), STARTUP))


@given(st.lists(st.lists(st.sampled_from(WORDS), max_size=8), min_size=1, max_size=4))
@settings(max_examples=150, deadline=None)
def test_any_words_are_a_script_or_a_mistake_with_its_line(spec: MissionSpec, lines: list[list[str]]) -> None:
    text = "\n".join(" ".join(words) for words in lines)
    said = [line for line in (line.partition("#")[0].strip() for line in text.split("\n")) if line]
    try:
        script = parse_script(text, "words.txt", spec, DICTIONARY)
    except UsageError as error:
        is_placed = error.line is not None
    else:
        is_placed = True
        assert [step.text for step in script.steps] == said
        assert script.longest_ns >= max(step.at_ns or 0 for step in script.steps)
    assert is_placed or not said
