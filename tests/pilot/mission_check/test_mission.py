"""All errors of a mission before it boots: each finding has its file and line."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

from cfepy.mission.mission_file import read_mission_file
from cfepy.monitors.run_rules import read_demands
from cfepy.pilot.mission_check import check_mission
from cfepy.psp.profile import load_profile
from cfepy.reading.mistakes import collected
from cfepy.status import UsageError
from dev.house.tree import ROOT

HK = "CFE_APP, hk, HK_AppMain, HK, 60, 16384, 0, 0;\n"


def check(folder: Path, script: str, yaml: str | None = None, board: str | None = None) -> list[tuple[str, int, str]]:
    """Findings as (file name, line, text)."""
    (folder / "startup.scr").write_text(script, encoding="utf-8")
    if yaml is not None:
        (folder / "mission.yaml").write_text(yaml, encoding="utf-8")
    return [(finding.file.name, finding.line, finding.text) for finding in check_mission(str(folder), board)]


def node(folder: Path, name: str = "talker") -> str:
    (folder / f"{name}.py").write_text("import rospy\n", encoding="utf-8")
    return f"CFE_APP, {name}.py, __main__, {name.upper()}, 60, 16384, 0, 0;\n"


def test_valid_mission_has_no_problem(tmp_path: Path) -> None:
    assert check(tmp_path, HK + node(tmp_path) + "!", "nodes:\n  TALKER: {name: talker}\n") == []


@pytest.mark.parametrize(
    ("line", "said"),
    [
        ("CFE_APP, hk, HK_AppMain, HK2, 60, 16384, 0;", "the entry must have 8 fields, not 7"),
        ("CFE_APP, nothere, X_Main, X, 60, 16384, 0, 0;", "missing code for /cf/nothere.so"),
        ("CFE_APP, hkk, HK_AppMain, HK2, 60, 16384, 0, 0;", "add it, or correct the name; did you mean hk?"),
        ("CFE_APP, hk, HK_AppMian, HK2, 60, 16384, 0, 0;", "has no function HK_AppMian; did you mean HK_AppMain?"),
        ("CFE_APP, hk, , HK2, 60, 16384, 0, 0;", "the application never runs, and the start waits for it; write"),
        (
            "CFE_APP, hk, HK_AppMain, , 60, 16384, 0, 0;",
            "is missing: cFE starts it, but no command can address it; write",
        ),
        ("CFE_APP, hk, HK_AppMain, HK, 60, 16384, 0, 0;", "the name 'HK' is already taken by line 1"),
        (
            "CFE_APP, hk, HK_AppMain, CFE_ES, 60, 16384, 0, 0;",
            "the name 'CFE_ES' is already taken by the core application",
        ),
        ("CFE_APP, hk, HK_AppMain, TWENTY_CHARACTERS_XX, 60, 1, 0, 0;", "at most 19 characters"),
        (
            "CFE_APP, twenty_characters.py, A, HK2, 60, 16384, 0, 0;",
            "twenty_characters.py must have fewer than 20 characters",
        ),
        ("CFE_APP, /ram/hk, HK_AppMain, HK2, 60, 16384, 0, 0;", "/ram/hk.so must be below /cf"),
        ("CFE_LIB, hk, HK_LibInit, LIB, 0, 0, 0, 0;", "has no function HK_LibInit"),
        ("CFE_APP, hk, HK_AppMain, HK2, 60, 16384, 0, 0", "the last entry is ignored, because its ';' is missing"),
    ],
)
def test_invalid_line_is_reported(tmp_path: Path, line: str, said: str) -> None:
    ((file, number, text),) = check(tmp_path, f"{HK}{line}\n!")
    assert (file, number) == ("startup.scr", 2)
    assert said in text


@pytest.mark.parametrize(
    ("entry", "said"),
    [
        (
            "invariants:\n  a: {packet: HK_TML, holds: 'True'}",
            "invariants.a: unknown telemetry packet HK_TML",
        ),
        (
            "invariants:\n  a: {topic: /a, within: 1, then: {packet: [HK_NOOP, HKK]}}",
            "invariants.a: unknown telemetry packet HKK",
        ),
        ("results:\n  HK: count", "results.HK: unknown telemetry packet HK"),
        (
            "invariants:\n  a: {topic: /a, file: checks.py, function: Count}",
            "checks.py has seen or Counts",
        ),
    ],
)
def test_missing_packages_and_functions_are_reported(tmp_path: Path, entry: str, said: str) -> None:
    (tmp_path / "checks.py").write_text("def seen(event): ...\n\n\nclass Counts: ...\n", encoding="utf-8")
    ((file, line, text),) = check(tmp_path, HK + "!", entry)
    assert (file, line) == ("mission.yaml", 2)
    assert said in text
    good = "invariants: {a: {packet: [HK_HK_TLM, HK_NOOP, 0x0808], holds: 'True'}}\nresults: {/x: last, HK_NOOP: last}"
    assert check(tmp_path, HK + "!", good) == []


def test_app_and_library_may_have_the_same_name(tmp_path: Path) -> None:
    assert check(tmp_path, HK + "CFE_LIB, hk, NULL, HK, 0, 0, 0, 0;\n!") == []


def test_all_problems_are_reported_at_once(tmp_path: Path) -> None:
    script = "CFE_APP, a;\nCFE_APP, nothere, X, X, 60, 1, 0, 0;\nCFE_APP, hk, Nope, Y, 60, 1, 0, 0;\n!"
    assert [line for _, line, _ in check(tmp_path, script)] == [1, 2, 3]


def test_sources_that_are_not_python(tmp_path: Path) -> None:
    (tmp_path / "broken.py").write_text("import rospy\n\ndef f(:\n", encoding="utf-8")
    found = check(tmp_path, "CFE_APP, broken.py, __main__, B, 60, 16384, 0, 0;!")
    assert found == [("broken.py", 3, "is not Python: invalid syntax")]


@pytest.mark.parametrize(
    "source",
    [
        "def Main(cfe): ...",
        "async def other(): ...\nclass Main: ...",
        "Main = lambda cfe: None",
        "try:\n    from x import Main\nexcept ImportError:\n    Main = None",
        "if True:\n    def Main(cfe): ...",
        "from .part import Main",
        "from .part import Main_Function as Main",
        "from .part import *",
        "from os import *",
        "def __getattr__(name): ...",
    ],
)
def test_entry_point_may_come_from_any_kind_of_statement(tmp_path: Path, source: str) -> None:
    (tmp_path / "app").mkdir()
    (tmp_path / "app/__init__.py").write_text(source, encoding="utf-8")
    (tmp_path / "app/part.py").write_text("def Main(cfe): ...\ndef Main_Function(cfe): ...\n", encoding="utf-8")
    assert check(tmp_path, "CFE_APP, app, Main, A, 60, 16384, 0, 0;!") == []


@pytest.mark.parametrize("source", ["", "def f():\n    Main = 1", "from .part import Main"])
def test_missing_entry_point_is_reported(tmp_path: Path, source: str) -> None:
    (tmp_path / "app").mkdir()
    (tmp_path / "app/__init__.py").write_text(source, encoding="utf-8")
    (tmp_path / "app/part.py").write_text("def other(cfe): ...\n", encoding="utf-8")
    ((_, line, text),) = check(tmp_path, "CFE_APP, app, Main, A, 60, 16384, 0, 0;!")
    assert line == 1
    assert "has no function Main" in text


def test_node_scripts_may_have_any_file_name(tmp_path: Path) -> None:
    (tmp_path / "a_talker_without_suffix").write_text("import rospy\n", encoding="utf-8")
    (tmp_path / "a_script_with_a_long_name.py").write_text("import rospy\n", encoding="utf-8")
    line = "CFE_APP, a_talker_without_suffix, __main__, TALKER, 60, 16384, 0, 0;\n"
    line += "CFE_APP, a_script_with_a_long_name.py, __main__, OTHER, 60, 16384, 0, 0;\n"
    assert check(tmp_path, line + "!") == []


def test_node_outside_the_folder_is_checked(tmp_path: Path) -> None:
    (tmp_path / "mission").mkdir()
    (tmp_path / "talker.py").write_text("import rospy\n", encoding="utf-8")
    found = check(tmp_path / "mission", "CFE_APP, /cf/../talker.py, __main__, TALKER, 60, 16384, 0, 0;\n!")
    assert [line for _, line, text in found if "/cf/../talker.py must be below /cf" in text] == [1]


def test_check_executes_nothing(tmp_path: Path) -> None:
    (tmp_path / "app.py").write_text("raise SystemExit('executed')\ndef Main(cfe): ...\n", encoding="utf-8")
    assert check(tmp_path, "CFE_APP, app, Main, A, 60, 16384, 0, 0;!") == []


def test_the_mission_file(tmp_path: Path) -> None:
    yaml = """\
bord: linux
board: abacus
nodes:
  TALKER: {namespace: robot, nme: x}
  TALKR: {}
  HK: {}
topics:
  /a: {msg_id: 0x0901}
  b: {msg_id: 0x0902}
  /c: {msg_id: 0x0901}
  /d: {raw: true}
"""
    found = check(tmp_path, HK + node(tmp_path) + "!", yaml)
    assert {file for file, _, _ in found} == {"mission.yaml"}
    assert [(line, text.partition(":")[0]) for _, line, text in found] == [
        (1, "bord"),
        (2, "board"),
        (4, "nodes.TALKER.namespace"),
        (4, "nodes.TALKER.nme"),
        (5, "nodes.TALKR"),
        (6, "nodes.HK"),
        (9, "topics.b"),
        (10, "topics./c"),
        (11, "topics./d"),
    ]


def test_two_nodes_of_one_name_are_reported(tmp_path: Path) -> None:
    yaml = "nodes:\n  A: {name: robot}\n  B: {name: robot, namespace: /}\n"
    ((_, line, text),) = check(tmp_path, node(tmp_path, "a") + node(tmp_path, "b") + "!", yaml)
    assert line == 3
    assert "the node name /robot is also used by A" in text


def test_a_mission_file_that_is_not_yaml(tmp_path: Path) -> None:
    ((file, line, text),) = check(tmp_path, HK + "!", "nodes: {\n")
    assert (file, line) == ("mission.yaml", 2)
    assert "is not YAML" in text


def test_more_applications_than_the_board_takes(tmp_path: Path) -> None:
    script = "".join(HK.replace(" HK,", f" HK{number},") for number in range(13)) + "!"
    found = check(tmp_path, script, board="rx64m")
    assert [(line, text.split(";")[0]) for _, line, text in found] == [
        (12, "HK11 exceeds the limit: rx64m allows 11 application entries"),
        (13, "HK12 exceeds the limit: rx64m allows 11 application entries"),
    ]


def test_stacks_beyond_the_memory(tmp_path: Path) -> None:
    script = HK + HK.replace(" HK,", " BIG,").replace("16384", "550000") + "!"
    ((_, line, text),) = check(tmp_path, script, board="rx64m")
    assert line == 2
    assert "with the stack of BIG (550,000 bytes)" in text
    assert check(tmp_path, script, board="linux") == []


def test_unknown_board_is_reported(tmp_path: Path) -> None:
    ((_, _, text),) = check(tmp_path, HK + "!", board="abacus")
    assert "unknown board 'abacus'" in text


def test_missing_mission_is_reported(tmp_path: Path) -> None:
    with pytest.raises(UsageError):
        check_mission(str(tmp_path / "nothing"))


def read_all(path: Path) -> None:
    """Read all sections of a mission file. All mistakes are raised together."""
    collected(lambda mistakes: read_demands(read_mission_file(path, mistakes).demands, mistakes))


@pytest.mark.parametrize(("document", "read"), [("mission_file", read_all), ("board_profiles", load_profile)])
def test_example_in_the_documentation_is_up_to_date(
    tmp_path: Path, document: str, read: Callable[[Path], object]
) -> None:
    text = (ROOT / "docs/reference" / f"{document}.md").read_text(encoding="utf-8")
    example = tmp_path / "example.yaml"
    example.write_text(text.partition("```yaml\n")[2].partition("```")[0], encoding="utf-8")
    read(example)


@pytest.mark.parametrize(
    ("line", "said"),
    [
        ("CFE_APP, hk, HK_AppMain, HK, high, 16384, 0, 0;", "invalid priority 'high', which cFE reads as 0"),
        ("CFE_APP, hk, HK_AppMain, HK, 60, 16k, 0, 0;", "invalid stack size '16k', which cFE reads as 16"),
        (
            "CFE_APP, hk, HK_AppMain, HK, 60, 16384, 0, restart;",
            "invalid exception action 'restart', which cFE reads as 0",
        ),
        ("CFE_APP, hk, HK_AppMain, HK, 017, 16384, 0, 0;", "invalid priority '017', which cFE reads as 15"),
        ("CFE_APP, hk, HK_AppMain, HK, 256, 16384, 0, 0;", "the priority 256 is cut to 255"),
        ("CFE_APP, hk, HK_AppMain, HK, 60, 16384, 0, 2;", "the exception action 2 is taken as 1"),
    ],
)
def test_field_that_cfe_reads_differently_is_a_warning(tmp_path: Path, line: str, said: str) -> None:
    (tmp_path / "startup.scr").write_text(f"\n{line}\n!", encoding="utf-8")
    (problem,) = check_mission(str(tmp_path))
    assert (problem.line, problem.is_warning) == (2, True)
    assert said in problem.text


@pytest.mark.parametrize(
    ("head", "said"),
    [
        ("async def Main(cfe):", "the entry point Main of A must not be async"),
        ("def Main():", "the entry point Main of A must take one argument"),
        ("def Main(cfe, more):", "the entry point Main of A must take one argument"),
        ("def Main(*, cfe):", "the entry point Main of A must take one argument"),
        ("def Main(cfe, more=1, *, name=''):", ""),
        ("def Main(*args):", ""),
        ("@wrapped\ndef Main():", ""),
    ],
)
def test_function_that_cannot_be_an_entry_point_is_reported(tmp_path: Path, head: str, said: str) -> None:
    (tmp_path / "app.py").write_text(f"{head}\n    pass\n", encoding="utf-8")
    found = check(tmp_path, "CFE_APP, app, Main, A, 60, 16384, 0, 0;!")
    assert [(file, line) for file, line, _ in found] == ([("app.py", 1)] if said else [])
    assert all(said in text for _, _, text in found)


def test_unknown_name_of_the_handle_is_reported(tmp_path: Path) -> None:
    (tmp_path / "app.py").write_text("def Main(cfe):\n    cfe.sb.transmitt_msg(b'')\n", encoding="utf-8")
    found = check(tmp_path, "CFE_APP, app, Main, A, 60, 16384, 0, 0;!")
    assert found == [("app.py", 2, "cfe.sb has no 'transmitt_msg'; did you mean cfe.sb.transmit_msg?")]


SCRIPTS = sorted(
    path for folder in ("missions", "examples", "tests/quality") for path in (ROOT / folder).rglob("*.scr")
)
COMPILED = (ROOT / "missions/cfs/startup.scr",)
"""A mission of NASA's applications, whose shared objects are not in this repository."""


@pytest.mark.slow
def test_missions_of_this_repository_are_valid() -> None:
    assert [problem for script in SCRIPTS if script not in COMPILED for problem in check_mission(str(script))] == []
    assert len(SCRIPTS) > 30


def test_missing_compiled_applications_are_named() -> None:
    missing = [problem.text.partition(":")[0] for script in COMPILED for problem in check_mission(str(script))]
    assert missing == [
        f"missing code for /cf/{name}.so" for name in ("lc", "ds", "md", "cf", "sc", "hs", "fm", "mm", "cs")
    ]
