"""Resources that applications took and did not give back: with their lines; and loads that wait for them."""

from __future__ import annotations

import json
import textwrap
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import pytest

from cfepy.cli.main import main
from cfepy.es import ExecutiveServices
from cfepy.mission import Mission, endless_waits
from cfepy.pilot import problems_of
from cfepy.writing.console import Console

STARTUP = "CFE_APP, taker, main, TAKER, 60, 8192, 0x0, 0;\nCFE_APP, ender, main, ENDER, 70, 8192, 0x0, 0;\n!"
ENDER = """
    def main(cfe):
        cfe.os.task_delay(1000)
        cfe.es.delete_app(cfe.es.get_app_id_by_name("TAKER"))
        cfe.os.task_delay(5000)
"""
TAKER = """
    def main(cfe):
        es, sb, os, tbl = cfe.es, cfe.sb, cfe.os, cfe.tbl
        table = tbl.register("Rows", 8)
        tbl.load(table, bytes(8))
        tbl.load(table, bytes(8))
        pool = es.pool_create(4096)
        {body}
        while es.run_loop():
            os.task_delay(100)
"""


def problems(
    folder: Path, body: Sequence[str], seconds: float = 6, *, guard: bool = True, ends: bool = True
) -> list[str]:
    """Return the problems of a run in which the application TAKER has this body, and is deleted after a second."""
    source = textwrap.dedent(TAKER).format(body="\n    ".join(body))
    (folder / "taker.py").write_text(source, encoding="utf-8")
    (folder / "ender.py").write_text(textwrap.dedent(ENDER) if ends else "def main(cfe):\n    pass\n", encoding="utf-8")
    (folder / "startup.scr").write_text(STARTUP, encoding="utf-8")
    (folder / "mission.yaml").write_text(f"compiled:\n  guard: {str(guard).lower()}\n", encoding="utf-8")
    with Mission(str(folder), console=Console(quiet=True)) as mission:
        mission.run_for(seconds)
        return [each.text for each in problems_of(mission, endless_waits(mission))]


LINE = 8
"""The first line of the body in taker.py."""
LEFT = "which cFE does not delete when its application ends"
TAKEN = {
    "address": ("tbl.get_address(table)", "the address of table TAKER.Rows"),
    "addresses": ("tbl.get_addresses([table])", "the address of table TAKER.Rows"),
    "message buffer": ("sb.allocate_message_buffer(100)", "a message buffer of 100 bytes"),
    "pool block": ("es.get_pool_buf(pool, 40)", "a pool block of 40 bytes"),
    "file": ("os.open_create('/ram/x', 1, 2)", "the open file /ram/x"),
    "folder": ("os.directory_open('/ram')", f"the open folder /ram, {LEFT}"),
    "socket": ("os.socket_open(1, 1)", "a socket"),
    "mutex": ("os.mut_sem_take(os.mut_sem_create('M'))", "mutex M"),
    "condition": ("os.cond_var_create('C')", f"the condition variable C, {LEFT}"),
    "lock": ("os.rw_lock_create('L')", f"the readers-writer lock L, {LEFT}"),
    "time base": ("os.time_base_create('B')", f"the time base B, {LEFT}"),
    "counter": ("es.register_gen_counter('N')", f"the counter N, {LEFT}"),
}


@pytest.mark.parametrize(("call", "what"), TAKEN.values(), ids=TAKEN)
def test_holdings_of_an_ended_application_are_reported_with_their_lines(tmp_path: Path, call: str, what: str) -> None:
    assert problems(tmp_path, ["", call]) == [f"not given back: TAKER: {what}, taken at taker.py:{LINE + 1}"]


def test_several_from_one_line_are_told_once(tmp_path: Path) -> None:
    told = problems(tmp_path, ["for _ in range(3):", "    sb.allocate_message_buffer(8)"])
    assert told == [f"not given back: TAKER: a message buffer of 8 bytes, taken at taker.py:{LINE + 1} (3 times)"]


GIVEN = {
    "address": ["tbl.get_address(table)", "tbl.release_address(table)"],
    "addresses": ["tbl.get_addresses([table])", "tbl.release_addresses([table])"],
    "unregistered": ["tbl.get_address(table)", "tbl.unregister(table)"],
    "message buffer": ["sb.release_message_buffer(sb.allocate_message_buffer(100))"],
    "pool block": ["es.put_pool_buf(pool, es.get_pool_buf(pool, 40))"],
    "pool": ["es.get_pool_buf(pool, 40)", "es.pool_delete(pool)"],
    "file": ["os.close(os.open_create('/ram/x', 1, 2))"],
    "files": ["os.open_create('/ram/x', 1, 2)", "os.close_all_files()"],
    "folder": ["os.directory_close(os.directory_open('/ram'))"],
    "mutex": ["m = os.mut_sem_create('M')", "os.mut_sem_take(m)", "os.mut_sem_give(m)"],
    "objects that cFE deletes": ["os.queue_create('Q', 3, 8)", "sb.create_pipe(3, 'P')", "os.bin_sem_create('S', 0)"],
}


@pytest.mark.parametrize("body", GIVEN.values(), ids=GIVEN)
def test_released_resources_are_not_reported(tmp_path: Path, body: list[str]) -> None:
    assert problems(tmp_path, body) == []


def test_resources_that_a_finally_block_gives_back_are_not_reported(tmp_path: Path) -> None:
    body = ["m = os.mut_sem_create('M')", "os.mut_sem_take(m)", "tbl.get_address(table)", "es.run_loop()", "try:"]
    body += ["    os.task_delay(5000)", "finally:", "    os.mut_sem_give(m)", "    tbl.release_address(table)"]
    assert problems(tmp_path, body) == []


def test_holdings_of_an_application_that_an_exception_ends_are_not_reported(tmp_path: Path) -> None:
    told = problems(tmp_path, ["tbl.get_address(table)", "raise ValueError('wrong')"], ends=False)
    assert [each for each in told if "not given back" in each] == []


def test_without_the_guard_nothing_is_written_down(tmp_path: Path) -> None:
    assert problems(tmp_path, ["tbl.get_address(table)"], guard=False) == []


def test_without_the_guard_applications_reach_the_services_themselves(tmp_path: Path) -> None:
    (tmp_path / "startup.scr").write_text("!", encoding="utf-8")
    with Mission(str(tmp_path), console=Console(quiet=True)) as mission:
        assert mission.processor.handle is mission.cfe
        assert type(mission.cfe.es) is ExecutiveServices


WAITS = ["tbl.get_address(table)", "os.task_delay(500)", "tbl.load(table, bytes(8))"]


@pytest.mark.parametrize("guard", [False, True])
def test_a_load_that_waits_for_a_held_address_is_told(tmp_path: Path, guard: bool) -> None:
    [told] = problems(tmp_path, WAITS, guard=guard, ends=False)
    taken = f", taken at taker.py:{LINE}" if guard else ""
    assert told.startswith("waiting load: TAKER: the load of Addr 0x")
    assert told.endswith(f"TAKER holds the address of table TAKER.Rows{taken}")


def test_a_load_that_waited_only_for_a_moment_is_not_told(tmp_path: Path) -> None:
    released = [*WAITS, "os.task_delay(3000)", "tbl.release_address(table)", "tbl.manage(table)"]
    assert problems(tmp_path, released, guard=False, ends=False) == []
    assert problems(tmp_path, WAITS, 2, guard=False, ends=False) == []


def test_a_refused_load_of_a_double_buffered_table_is_told(tmp_path: Path) -> None:
    body = ["table = tbl.register('Two', 8, 1)", "tbl.load(table, bytes(8))", "tbl.get_address(table)"]
    body += ["tbl.load(table, bytes(8))", "try:", "    tbl.load(table, bytes(8))", "except Exception:", "    pass"]
    [told] = problems(tmp_path, body, guard=False, ends=False)
    assert told.startswith("waiting load: TAKER: loads are refused since 0.")
    assert told.endswith(": TAKER holds the address of table TAKER.Two")


def test_holdings_at_the_end_of_the_run_are_in_its_report(tmp_path: Path, capsys: Any) -> None:
    problems(tmp_path, ["for _ in range(2):", "    sb.allocate_message_buffer(8)"], 1, ends=False)
    assert main(["run", str(tmp_path), "--for", "2", "--guard", "--json", str(tmp_path / "run.json")]) == 0
    assert "Held at the end\n" in capsys.readouterr().out
    [held] = json.loads((tmp_path / "run.json").read_text(encoding="utf-8"))["held"]
    assert (held["app"], held["number"]) == ("TAKER", 2)
    assert held["what"] == f"a message buffer of 8 bytes, taken at taker.py:{LINE + 1}"
