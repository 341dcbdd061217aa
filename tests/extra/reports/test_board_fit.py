"""A mission's requirements for a board, and the changes that make it fit."""

from __future__ import annotations

import re
import shutil
from pathlib import Path

import pytest

from cfepy.extra.reports.board_fit import fit_of
from cfepy.pilot import pilot
from cfepy.pilot.plan import RunPlan
from cfepy.reading.resources import shipped

CAPTURE = shipped("missions") / "capture"


def test_mission_that_fits_needs_no_changes() -> None:
    fit = fit_of(RunPlan(("rx64m_pubsub",), seconds=1))
    assert (fit.board, fit.missing, fit.changes) == ("rx64m", 0, ())
    assert ("LEFT", "stack", 3 * (8192 + 256)) in fit.rows
    assert [(row.app, row.tasks, row.size, row.used) for row in fit.stacks] == [
        ("LEFT", 3, 8192, None),
        ("RIGHT", 3, 8192, None),
    ]
    assert 0 < fit.cpu < 0.01
    assert ("CFE_ES", "CDS", 8192) in fit.rows  # in RAM that outlives a reset, and RAM all the same
    assert fit.to_dict()["missing"] == 0


OWNERS = """
from cfepy.app import Cfe
from cfepy.tbl import OPT_CRITICAL, OPT_DBL_BUFFER


def OWNERS_Main(cfe: Cfe) -> None:
    cfe.es.register_cds(100, "Counts")
    cfe.tbl.register("Small", 40)
    cfe.tbl.register("Double", 1000, OPT_DBL_BUFFER | OPT_CRITICAL)
    while cfe.es.run_loop():
        cfe.osal.task_delay(1000)
"""


def test_memory_of_pools_is_attributed_to_owners_of_tables_and_blocks(tmp_path: Path) -> None:
    (tmp_path / "owners.py").write_text(OWNERS, encoding="utf-8")
    (tmp_path / "startup.scr").write_text(
        "CFE_APP, owners.py, OWNERS_Main, OWNERS, 50, 8192, 0, 0;\n!\n", encoding="utf-8"
    )
    fit = fit_of(RunPlan((str(tmp_path),), seconds=1, board="rx64m"))
    rows = {(row.pool, row.owner, row.what): row.size for row in fit.pools}
    # a block has the next block size of NASA's pools, plus 24 bytes; tables' blocks lie on multiples of 16
    assert rows["CFE_TBL memory pool", "OWNERS", "table Small"] == 48 + 32
    assert rows["CFE_TBL memory pool", "OWNERS", "table Double, 2 buffers"] == 2 * (1024 + 32)
    assert rows["CDS", "OWNERS", "block Counts"] == 128 + 24
    assert rows["CDS", "OWNERS", "critical table Double"] == 1024 + 24
    for pool, owner in (("CFE_TBL memory pool", "CFE_TBL"), ("CDS", "CFE_ES"), ("CFE_SB memory pool", "CFE_SB")):
        booked = next(size for who, what, size in fit.rows if who == owner and f"{who} {what}".endswith(pool))
        assert sum(row.size for row in fit.pools if row.pool == pool) == booked
    assert {row.pool for row in fit.pools} == {"CFE_TBL memory pool", "CDS", "CFE_SB memory pool"}


@pytest.mark.slow
def test_the_changes_make_capture_fit(tmp_path: Path) -> None:
    fit = fit_of(RunPlan(("capture",), seconds=2, board="rx64m"))
    assert fit.missing == 336_896
    assert fit.fits_changed
    assert [(change.place, change.saves) for change in fit.changes] == [
        ("startup.scr:6", 172_032),
        ("startup.scr:4", 172_032),
    ]
    folder = shutil.copytree(CAPTURE, tmp_path / "capture")
    script = (folder / "startup.scr").read_text(encoding="utf-8")
    for name in ("MAIN_CTRL", "HK_MONITOR"):
        script = re.sub(rf"({name}, +\d+, )65536", r"\g<1>8192", script)
    (folder / "startup.scr").write_text(script, encoding="utf-8")
    changed = RunPlan((str(folder),), seconds=2, board="rx64m")
    assert fit_of(changed).missing == 0
    assert all(app.state == "RUNNING" for app in pilot.fly(changed).results.apps)


def test_changes_take_the_largest_first_and_stop_when_the_mission_fits(tmp_path: Path) -> None:
    board = tmp_path / "small.yaml"
    board.write_text(
        (shipped("boards") / "gr716.yaml").read_text(encoding="utf-8").replace("192 KiB}", "200 KiB}"), encoding="utf-8"
    )
    fit = fit_of(RunPlan(("capture/rx64m.scr",), seconds=1, board=str(board)))
    assert fit.changes[0].text.startswith("limits: {sb_buf_memory_bytes: 16384} in place of 49152; ")
    assert fit.fits_changed
    assert sum(change.saves for change in fit.changes[:-1]) < fit.missing
