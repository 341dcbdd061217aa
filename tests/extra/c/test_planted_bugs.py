"""Common mistakes in C, planted in small applications: the tool that finds each, and that the mended form is clean.

docs/how_to/c_apps.md has the table.
"""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any, NamedTuple

import pytest

from cfepy.cli.main import main
from tests.extra.c.building import compile_c, needs_compiler

pytestmark = needs_compiler

PLANTED = Path(__file__).parent / "planted"
MISSION = "CFE_APP, BUG, BUG_Main, BUG, 50, 16384, 0x0, 0;\n!"


class Bug(NamedTuple):
    """How a bug is found: the command with its options, and its report."""

    command: list[str]
    told: tuple[str, ...]
    status: int = 1


RUN, GUARD = ["run", "--for", "3"], ["run", "--for", "3", "--guard"]
EXPLORE = ["explore", "--for", "2", "--seeds", "60"]
BUGS = {
    "lost_update": Bug(EXPLORE, ("counted to",)),
    "overrun": Bug(GUARD, ("SIGSEGV", "overrun.c:12")),
    "use_after_free": Bug(GUARD, ("SIGSEGV", "use_after_free.c:22")),
    "table_rows": Bug(GUARD, ("SIGSEGV", "table_rows.c:20", "offset 44 of table BUG.Rows of 40 bytes")),
    "table_validation": Bug(
        GUARD, ("SIGSEGV", "table_validation.c:14", "offset 36 of an image of table List of 36 bytes")
    ),
    "pool_name": Bug(GUARD, ("a pool block of 23 bytes that was written past its end", "pool_name.c:21")),
    "pool_queue": Bug(GUARD, ("SIGSEGV", "pool_queue.c:28", "a pool block of 16 bytes that was given back")),
    "uninitialised": Bug(GUARD, ()),
    "leaked_buffer": Bug(["run", "--for", "10"], ("no buffer after",)),
    "held_address": Bug(["run", "--for", "4"], ("waiting load: BUG: ", "BUG holds the address of table BUG.Rows")),
    "kept_blocks": Bug(
        ["run", "--for", "8", "--guard"],
        (
            "not given back: BUG: a message buffer of 100 bytes, taken at kept_blocks.c:10 (3 times)",
            "not given back: BUG: a pool block of 64 bytes, taken at kept_blocks.c:11 (3 times)",
        ),
    ),
    "deadlock": Bug(EXPLORE, ("deadlock", "FIRST", "SECOND")),
    "priority_inversion": Bug(RUN, ("late by",)),
    "unlocked_table": Bug(EXPLORE, ("low ", ", high ")),
    "stack_overflow": Bug(RUN, ("stack overflow", "stack_overflow.c:")),
    "byte_order": Bug(RUN, ("CFE_SB 15: Send Err:Msg Too Big MsgId=0x899,app=BUG",), 0),
    "counter_wrap": Bug(["run", "--for", "90"], ("0x0899",)),
    "double_release": Bug(GUARD, ("is used after it was sent", "double_release.c:10")),
}


def fly(folder: Path, bug: Bug, capsys: Any) -> tuple[int, str]:
    command, *options = bug.command
    status = main([command, str(folder), *options])
    captured = capsys.readouterr()
    return status, captured.out + captured.err


def write(folder: Path, name: str, *flags: str) -> None:
    made = compile_c(folder, name, (PLANTED / f"{name}.c").read_text(encoding="utf-8"), "-O0", "-w", *flags)
    made.rename(folder / "BUG.so")
    (folder / "startup.scr").write_text(MISSION, encoding="utf-8")


FAMILY = ("table_rows", "table_validation", "pool_name", "pool_queue")
"""Those of the guard that test_guard_blocks has quick ones of."""
SEARCHED = ("deadlock", "unlocked_table", "lost_update")
"""Those that are searched for; test_races and the tests of exploration have quick ones."""
LONG = dict.fromkeys((*SEARCHED, *FAMILY, "priority_inversion"), pytest.mark.slow)
SLOW = dict.fromkeys((*(name for name, bug in BUGS.items() if bug.command == EXPLORE), *LONG), pytest.mark.slow)
"""Searches that find nothing take their time."""
SIMPLE = [name for name in BUGS if name not in ("uninitialised", "counter_wrap")]


@pytest.mark.parametrize("name", [pytest.param(name, marks=LONG.get(name, ())) for name in SIMPLE])
def test_planted_bug_is_found(tmp_path: Path, name: str, capsys: Any) -> None:
    write(tmp_path, name)
    status, told = fly(tmp_path, BUGS[name], capsys)
    assert status == BUGS[name].status
    for each in BUGS[name].told:
        assert each in told


@pytest.mark.parametrize("name", [pytest.param(name, marks=SLOW.get(name, ())) for name in SIMPLE])
def test_the_mended_form_is_clean(tmp_path: Path, name: str, capsys: Any) -> None:
    write(tmp_path, name, "-DMENDED")
    status, told = fly(tmp_path, BUGS[name], capsys)
    assert status == 0, told
    assert "Send Err" not in told


@pytest.mark.parametrize(
    "name", [pytest.param(name, marks=LONG.get(name, ())) for name in SIMPLE if "--guard" in BUGS[name].command]
)
def test_planted_bug_is_not_noticed_without_the_guard(tmp_path: Path, name: str, capsys: Any) -> None:
    write(tmp_path, name)
    assert fly(tmp_path, Bug(RUN, ()), capsys)[0] == 0


@pytest.mark.slow
@pytest.mark.parametrize("flags", [(), ("-DMENDED",)])
def test_unwritten_memory_makes_two_runs_differ(tmp_path: Path, flags: tuple[str, ...], capsys: Any) -> None:
    """An application sends the same with and without the guard, unless it sends memory that it never wrote."""
    write(tmp_path, "uninitialised", *flags)
    journals = [str(tmp_path / name) for name in ("plain.cfepy", "guarded.cfepy")]
    for journal, options in zip(journals, ([], ["--guard"]), strict=True):
        assert main(["run", str(tmp_path), "--for", "3", "--record", journal, *options]) == 0
    status = main(["diff", *journals])
    told = capsys.readouterr().out
    assert status == (0 if flags else 1)
    assert flags or "00 00 00 00 and a5 a5 a5 a5" in told


@pytest.mark.parametrize(("flags", "least"), [((), 60), (("-DMENDED",), 88)])
def test_a_counter_that_wraps_shows_in_the_rate_of_a_packet(tmp_path: Path, flags: tuple[str, ...], least: int) -> None:
    write(tmp_path, "counter_wrap", *flags)
    out = tmp_path / "run.json"
    assert main(["run", str(tmp_path), "--for", "90", "--json", str(out)]) == 0
    [row] = [row for row in json.loads(out.read_text(encoding="utf-8"))["topics"] if row["msg_id"] == 0x0899]
    assert least <= row["sent"] <= least + 8
