"""The startup script, compared with the system log of a real cFE for a script full of bad entries."""

from __future__ import annotations

import pytest

from cfepy import status
from cfepy.config.versions import RELEASES
from cfepy.es.startup_script import CFE_APP, CFE_LIB, BadLine, StartupEntry, check, parse, strtoul

BAD_SCRIPT = b"""\
CFE_LIB, cfe_assert,  CFE_Assert_LibInit, ASSERT_LIB,  0,   0,     0x0, 0;
CFE_LIB, sample_lib,  SAMPLE_LIB_Init,    SAMPLE_LIB,  0,   0,     0x0, 0;
CFE_APP, sample_app,  SAMPLE_APP_Main,    SAMPLE_APP,  50,  16384, 0x0, 0;
CFE_APP, sample_app,  SAMPLE_APP_Main,    SAMPLE_APP,  50,  16384, 0x0, 0;
CFE_APP, ci_lab,      CI_LAB_AppMain,     CI_LAB,      60,  16384, 0x0, 0;
CFE_APP, to_lab,      TO_LAB_AppMain,     TO_LAB,      70,  16384, 0x0, 0;
CFE_APP, short, Short_Main;
CFE_FOO, hk, HK_AppMain, FOO, 90, 16384, 0x0, 0;
CFE_APP, nofile, NOFILE_Main, NOFILE, 90, 16384, 0x0, 0;
CFE_APP, hk, No_Such_Symbol, NOSYM, 90, 16384, 0x0, 0;
CFE_APP, hk, HK_AppMain,
         A_NAME_THAT_IS_TOO_LONG_FOR_CFE, 90, 16384, 0x0, 0;
CFE_APP, hk, HK_AppMain, NINE_TOKENS, 90, 16384, 0x0, 0, 0;
CFE_APP, hk, %s, LONG, 90, 16384, 0x0, 0;
CFE_APP, ./bad/../name?, Bad_Main, BADPATH, 90, 16384, 0x0, 0;
# comment;
CFE_APP, lost, Lost_Main, LOST, 90, 16384, 0x0, 0
! what follows is free text; it is never read
""" % (b"x" * 132)

REAL_LOG = """\
CFE_ES_ParseFileEntry: Loading shared library: /cf/cfe_assert.so
CFE_ES_ParseFileEntry: Loading shared library: /cf/sample_lib.so
CFE_ES_ParseFileEntry: Loading file: /cf/sample_app.so, APP: SAMPLE_APP
CFE_ES_ParseFileEntry: Loading file: /cf/sample_app.so, APP: SAMPLE_APP
CFE_ES_ParseFileEntry: Loading file: /cf/ci_lab.so, APP: CI_LAB
CFE_ES_ParseFileEntry: Loading file: /cf/to_lab.so, APP: TO_LAB
CFE_ES_ParseFileEntry: Invalid ES Startup file entry: 3
CFE_ES_ParseFileEntry: Unexpected EntryType CFE_FOO in startup file.
CFE_ES_ParseFileEntry: Loading file: /cf/nofile.so, APP: NOFILE
CFE_ES_ParseFileEntry: Loading file: /cf/hk.so, APP: NOSYM
CFE_ES_ParseFileEntry: Loading file: /cf/hk.so, APP: A_NAME_THAT_IS_TOO_LONG_FOR_CFE
CFE_ES_StartApplications: **WARNING** File Line 12 is malformed: 50 bytes, 8 tokens.
CFE_ES_StartApplications: **WARNING** File Line 13 is malformed: 163 bytes, 7 tokens.
CFE_ES_ParseFileEntry: Loading file: ./bad/../name?.so, APP: BADPATH
CFE_ES_ParseFileEntry: Invalid ES Startup file entry: 1
""".splitlines()


def log_of(script: bytes) -> list[str]:
    found: list[str] = []
    for result in parse(script):
        found += [result.log_text] if isinstance(result, StartupEntry) else result.log_texts
    return found


def only(script: bytes) -> StartupEntry | BadLine:
    (result,) = parse(script)
    return result


def app(*, name: bytes = b"HK", priority: bytes = b"90", stack: bytes = b"16384", action: bytes = b"0") -> bytes:
    return b"CFE_APP,hk,HK_AppMain,%s,%s,%s,0x0,%s;" % (name, priority, stack, action)


def test_valid_entry_is_parsed() -> None:
    entry = only(b"\n\n  CFE_APP, apps/hk, HK_AppMain,\n HK, 90, 0x4000, 0x0, 3;")
    assert entry == StartupEntry(
        kind=CFE_APP,
        file="apps/hk",
        path="apps/hk.so",
        symbol="HK_AppMain",
        name="HK",
        priority=90,
        stack_size=16384,
        exception_action=1,
        number=1,
        line=3,
        log_text="CFE_ES_ParseFileEntry: Loading file: apps/hk.so, APP: HK",
    )


def test_log_of_an_invalid_script_matches_nasas() -> None:
    assert log_of(BAD_SCRIPT) == REAL_LOG


def test_entry_numbers_and_text_lines() -> None:
    results = list(parse(BAD_SCRIPT))
    assert [result.number for result in results] == list(range(1, 16))
    assert [result.line for result in results] == [*range(1, 12), *range(13, 17)]
    assert [result.number for result in results if isinstance(result, BadLine)] == [7, 8, 11, 12, 13, 15]
    assert isinstance(results[0], StartupEntry)
    assert results[0].kind == CFE_LIB


def test_invalid_lines_have_an_explanation() -> None:
    bad = {result.number: result for result in parse(BAD_SCRIPT) if isinstance(result, BadLine)}
    assert bad[7].explanation == "the entry must have 8 fields, not 3"
    assert bad[8].status == status.CFE_ES_ERR_APP_CREATE
    assert "at most 19 characters" in bad[11].explanation
    assert "not 9" in bad[12].explanation
    assert "not 163" in bad[13].explanation
    assert "comments are only allowed after" in bad[15].explanation
    assert bad[15].source == "#comment"


def test_check_reports_the_incomplete_last_entry() -> None:
    notes = check(BAD_SCRIPT)
    assert [note.line for note in notes] == [7, 8, 11, 13, 14, 16, 17]
    assert "is ignored, because its ';' is missing" in notes[-1].explanation


def test_check_of_a_valid_script_reports_nothing() -> None:
    assert check(b"CFE_LIB, l, L_Init, L, 0, 0, 0x0, 0;\n" + app() + b"\n! the end") == []


@pytest.mark.parametrize(
    ("script", "text"),
    [
        (app(priority=b"high"), "invalid priority 'high', which cFE reads as 0"),
        (app(priority=b"300"), "the priority 300 is cut to 255"),
        (app(stack=b"010000"), "invalid stack size '010000', which cFE reads as 4096"),
        (app(name="Ü".encode() + b"X"), "characters that are not ASCII"),
        (app().replace(b"HK_AppMain", b"A_Symbol_Beyond_20_Chars"), "is cut to 'A_Symbol_Beyond_20_'"),
    ],
)
def test_check_reports_silent_changes(script: bytes, text: str) -> None:
    (note,) = check(script)
    assert text in note.explanation


def test_check_tells_of_all_mistakes_of_an_entry() -> None:
    notes = check(b"CFE_AP, , A_Main, A_NAME_BEYOND_20_CHARACTERS, high, 8192, 0, 0;")
    assert [(note.explanation, note.is_warning) for note in notes] == [
        ("the file name cannot be used: '' has no file name", False),
        ("the first field must be CFE_APP or CFE_LIB, not 'CFE_AP'; did you mean CFE_APP?", False),
        (
            "the name 'A_NAME_BEYOND_20_CHARACTERS' must have at most 19 characters, not 27; cFE does not report this",
            False,
        ),
        ("invalid priority 'high', which cFE reads as 0; write a number, such as 60 or 0x3C", True),
    ]


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("90", 90),
        ("0x10", 16),
        ("0X1f", 31),
        ("010", 8),
        ("089", 0),
        ("0x", 0),
        ("12ab", 12),
        ("", 0),
        ("junk", 0),
        ("+7", 7),
        ("-1", (1 << 64) - 1),
        ("99999999999999999999999", (1 << 64) - 1),
    ],
)
def test_strtoul(text: str, value: int) -> None:
    assert strtoul(text) == value


def test_priority_and_action_are_clamped() -> None:
    entry = only(app(priority=b"-1", action=b"7"))
    assert isinstance(entry, StartupEntry)
    assert (entry.priority, entry.exception_action) == (255, 1)


def test_an_empty_file_name() -> None:
    bad = only(b"CFE_APP,,M,N,1,1,0,0;")
    assert isinstance(bad, BadLine)
    assert bad.log_texts == ("CFE_ES_ParseFileEntry: Invalid ES Startup script file name: ",)
    assert bad.status == status.CFE_FS_INVALID_PATH


@pytest.mark.parametrize(("version", "longest"), [("7.0.0", 128), ("7.0.1", 127)])
def test_the_longest_entry(version: str, longest: int) -> None:
    entry = b"CFE_APP,hk,%s,HK,90,16384,0x0,0;"
    symbol = b"s" * (longest - len(entry) + 3)
    (good,) = parse(entry % symbol, RELEASES[version].longest_entry)
    (bad,) = parse(entry % (symbol + b"s"), RELEASES[version].longest_entry)
    assert isinstance(good, StartupEntry)
    assert isinstance(bad, BadLine)


def test_bytes_beyond_ascii_are_skipped_like_blanks() -> None:
    assert only(app(name=b"H\xffK\x80")) == only(app(name=b"HK"))
