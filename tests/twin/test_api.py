"""API calls answer as on NASA's cFE: compared with recorded answers, and with a real one if it is installed."""

from __future__ import annotations

import pytest

from dev.twin.api import real, twin
from dev.twin.api.compare import differences
from dev.twin.api.recorded import Record, read_record, records
from dev.twin.api.script import GROUPS, Writer, write_script
from dev.twin.api.words import quote, unquote
from dev.twin.api.wrong_calls import WRONG_GROUPS
from dev.twin.real import release_of

SHORT = 700
LONG_ONES = [each for each in records() if each.calls > SHORT]


def differences_from(record: Record) -> list[str]:
    script = write_script(record.seed, record.calls, record.kind)
    return differences(script, read_record(record), twin.play(script, record.release))


@pytest.mark.parametrize("record", [each for each in records() if each.calls <= SHORT])
def test_short_script_has_the_recorded_answers_of_nasas_cfe(record: Record) -> None:
    assert differences_from(record) == []


@pytest.mark.slow
@pytest.mark.parametrize("record", LONG_ONES)
def test_long_script_has_the_recorded_answers_of_nasas_cfe(record: Record) -> None:
    assert differences_from(record) == []


@pytest.mark.slow
def test_new_script_has_the_answers_of_nasas_cfe() -> None:
    built = real.installed()
    if built is None:
        pytest.skip(f"{real.VARIABLE} names no real cFE")
    script = write_script(4711, 2000)
    assert differences(script, real.play(built, script), twin.play(script, release_of(built))) == []


def test_short_and_long_records_exist() -> None:
    assert LONG_ONES
    assert len(records()) > len(LONG_ONES)


def test_difference_is_found() -> None:
    script = ["A ES_GetAppID @1", "A OS_TaskGetId"]
    real_answers = ["1 0 #110007", "E CFE_SB 5 1 'x", "2 0 #10008", "end"]
    assert differences(script, real_answers, ["1 0 #110007", "E CFE_SB 5 1 'x", "2 0 #1000b", "end"]) == []
    assert differences(script, real_answers, ["1 0 #110007", "2 0 #1000b", "end"]) == [
        "1 A ES_GetAppID @1\n  cFE   E CFE_SB 5 1 x"
    ]
    assert len(differences(script, real_answers, ["1 0 #110008", "end"])) == 2


@pytest.mark.parametrize("group", list(dict.fromkeys((*GROUPS, *WRONG_GROUPS))), ids=lambda group: group.__name__)
def test_scripts_depend_only_on_the_seed_and_call_existing_functions(group) -> None:
    first, second = Writer(5), Writer(5)
    for writer in (first, second):
        for _ in range(20):
            group(writer)
    assert first.lines == second.lines
    assert not [line for line in twin.play(first.lines[:40]) if "unknown" in line.split()]


@pytest.mark.parametrize("text", ["", "plain.txt", "two words", "100%", "\n\x01"])
def test_texts_go_through_a_line(text: str) -> None:
    assert unquote(quote(text)) == text
    assert " " not in quote(text)
