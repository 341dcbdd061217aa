"""What apps declare for tools: found without starting them, and an app that is broken is named."""

from __future__ import annotations

import sys
from pathlib import Path

from cfepy.mission import read_mission
from cfepy.mission.declared import declared, table_types
from tests.mission.flights import write_mission

TABLES = """
    from cfepy.msg import Layout
    from cfepy.tbl import TableType

    TABLES = (TableType("{name}", Layout("Row", [("X", "u8")]), rows={rows}),)


    def Main(cfe):
        raise AssertionError("a tool starts no app")
"""


def test_shipped_apps_declare_their_tables() -> None:
    problems: list[str] = []
    known = table_types(None, problems)
    assert problems == []
    assert {"SAMPLE_APP.ExampleTable", "SCH.SCHED_DEF", "SCH.MSG_DEFS", "SCH_LAB.ScheduleTable"} <= set(known)
    assert all(kind.file.startswith("/cf/") and kind.file.endswith(".tbl") for kind in known.values() if kind.file)


def test_a_missions_own_apps_come_first(tmp_path: Path) -> None:
    mission = write_mission(
        tmp_path,
        "CFE_APP, own, Main, OWN, 50, 8192, 0, 0;\nCFE_APP, other, Main, OTHER, 50, 8192, 0, 0;\n!\n",
        own=TABLES.format(name="OWN.Table", rows=2),
        other=TABLES.format(name="SAMPLE_APP.ExampleTable", rows=7),
    )
    known = table_types(mission, [])
    assert known["OWN.Table"].rows == 2
    assert known["SAMPLE_APP.ExampleTable"].rows == 7


def test_each_file_is_asked_once_and_leaves_nothing_behind(tmp_path: Path) -> None:
    entries = "".join(f"CFE_APP, own, Main, OWN{number}, 50, 8192, 0, 0;\n" for number in range(3))
    mission = write_mission(tmp_path, entries + "!\n", own=TABLES.format(name="OWN.Table", rows=2))
    before = set(sys.modules)
    found = declared(read_mission(mission), ("TABLES",), [])
    assert [kind.name for kind in found] == ["OWN.Table"]
    assert not {name for name in set(sys.modules) - before if name.startswith("cfepy_app_")}


def test_broken_apps_are_named_and_the_others_found(tmp_path: Path) -> None:
    mission = write_mission(
        tmp_path,
        "CFE_APP, bad, Main, BAD, 50, 8192, 0, 0;\nCFE_APP, ends, Main, ENDS, 50, 8192, 0, 0;\n"
        "CFE_APP, own, Main, OWN, 50, 8192, 0, 0;\nCFE_APP, gone, Main, GONE, 50, 8192, 0, 0;\n!\n",
        bad="TABLES = 1 / 0\n",
        ends="import sys\nTABLES = ()\nsys.exit(3)\n",
        own=TABLES.format(name="OWN.Table", rows=2),
    )
    problems: list[str] = []
    found = declared(read_mission(mission), ("TABLES",), problems)
    assert [kind.name for kind in found] == ["OWN.Table"]
    assert [problem.rpartition("/")[2] for problem in problems] == [
        "bad.py could not be read: ZeroDivisionError: division by zero",
        "ends.py could not be read: SystemExit: 3",
    ]


def test_nodes_and_apps_that_declare_nothing_are_not_executed(tmp_path: Path) -> None:
    mission = write_mission(
        tmp_path,
        "CFE_APP, node.py, __main__, NODE, 50, 8192, 0, 0;\nCFE_APP, plain, Main, PLAIN, 50, 8192, 0, 0;\n!\n",
        node="TABLES = 1 / 0\n",
        plain="raise AssertionError('executed')\n",
    )
    problems: list[str] = []
    tables = declared(read_mission(mission), ("TABLES",), problems)
    assert {table.name.partition(".")[0] for table in tables} == {"ROS"}  # which comes with every node
    assert problems == []
