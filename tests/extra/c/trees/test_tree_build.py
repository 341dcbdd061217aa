"""From a mission tree to a mission folder: built, stood in, left out, and flown."""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path

import pytest
import yaml

from cfepy.cli.main import main
from cfepy.extra.c.toolchain import Options, TableFiles
from cfepy.extra.c.trees.build_report import BUILT, KEPT, LEFT_OUT, STANDS_IN, BuildReport
from cfepy.extra.c.trees.mission_folder import TreeOptions, build_tree
from cfepy.extra.c.trees.tree_check import check_tree
from cfepy.status import UsageError
from cfepy.tbl import image
from tests.extra.c.building import console_of, fly, needs_compiler
from tests.extra.c.trees.small_trees import FILES, MAIN, OLD_FILES, SCRIPT, TABLE, TARGETS, write_tree

pytestmark = [needs_compiler, pytest.mark.slow]
BROKEN = '#include "cfe.h"\nint broken = nothing_like_this;\n'


def built(
    tmp_path: Path, changed: Mapping[str, str | None] | None = None, options: TreeOptions | None = None
) -> BuildReport:
    """Build the small tree into the folder `mission`."""
    return build_tree(write_tree(tmp_path / "tree", changed), tmp_path / "mission", options)


def names(report: BuildReport, result: str) -> list[str]:
    return [each.name for each in report.named(result)]


def text_of(report: BuildReport, name: str) -> str:
    return next(each.text for each in report.entries if each.name == name)


def test_whole_tree_is_built_and_flies(tmp_path: Path) -> None:
    report = built(tmp_path)
    assert names(report, BUILT) == ["one", "two", "shared", "notes.txt", "startup.scr", "mission.yaml"]
    assert report.entries[0].text == "1 sources, tables rows.tbl"
    assert report.is_complete
    assert report.steps == []
    assert yaml.safe_load((tmp_path / "mission/mission.yaml").read_text()) == {
        "name": "Small",
        "cfe_version": "7.0.1",
        "limits": {"os_max_mutexes": 33, "spacecraft_id": 0x51},
    }
    console = console_of(fly(str(tmp_path / "mission")))
    assert "81/1/ONE 1: ONE has 0x1890" in console
    assert "81/1/TWO 1: TWO has 0x1892" in console


def test_only_the_chosen_processor_is_built(tmp_path: Path) -> None:
    report = built(
        tmp_path,
        {"small_defs/cpu2_cfe_es_startup.scr": SCRIPT.replace("two, TWO_Main", "one, ONE_Main")},
        TreeOptions(cpu="cpu2"),
    )
    assert names(report, BUILT) == ["shared", "startup.scr", "mission.yaml"]
    assert report.named(LEFT_OUT)[0].name == "one"
    assert "two_api.h: No such file" in text_of(report, "one")
    limits = yaml.safe_load((tmp_path / "mission/mission.yaml").read_text())["limits"]
    assert limits["processor_id"] == 2
    assert limits["processor_name"] == "cpu2"


def test_application_that_does_not_compile_is_left_out_with_the_error(tmp_path: Path) -> None:
    report = built(tmp_path, {"apps/two/parts/part.c": BROKEN})
    assert names(report, LEFT_OUT) == ["two"]
    assert text_of(report, "two").startswith("apps/two/parts/part.c:2:14: error: 'nothing_like_this' undeclared")
    assert not report.is_complete
    assert report.steps == [f"two: {text_of(report, 'two')}"]
    assert (tmp_path / "mission/one.so").is_file()


def test_cfepys_own_application_stands_in_for_a_missing_one(tmp_path: Path) -> None:
    script = SCRIPT.replace("two, TWO_Main, TWO,", "to_lab, TO_LAB_AppMain, TO_LAB_APP,")
    modules = '[submodule "to_lab"]\n\tpath = apps/to_lab\n\turl = https://example.org/to_lab.git\n'
    changed = {
        "small_defs/targets.cmake": TARGETS.replace("one two", "one two to_lab"),
        "small_defs/cpu1_cfe_es_startup.scr": script,
        ".gitmodules": modules,
    }
    report = built(tmp_path, changed)
    assert names(report, STANDS_IN) == ["to_lab"]
    assert "https://example.org/to_lab.git" in text_of(report, "to_lab")
    assert report.is_complete
    assert report.steps == [f"fetch the git submodules: git -C {tmp_path}/tree submodule update --init --recursive"]
    assert report.notes == ["the startup script does not start two"]
    table = image.read((tmp_path / "mission/to_lab_sub.tbl").read_bytes())
    assert table.name == "TO_LAB_APP.TO_LAB_Subs"
    assert "TO_LAB_APP" in console_of(fly(str(tmp_path / "mission")))


def test_step_names_the_option_for_an_application_with_a_stand_in(tmp_path: Path) -> None:
    changed = {
        "small_defs/targets.cmake": TARGETS.replace("one two", "one two to_lab"),
        "apps/to_lab/fsw/src/to_lab.c": OLD_NAMES,
        "apps/to_lab/CMakeLists.txt": TO_LAB,
    }
    report = built(tmp_path, changed)
    assert names(report, STANDS_IN) == ["to_lab"]
    assert report.steps == ["build the tree again with --cfe 6.7, because of names of cFE 6 in to_lab"]


def test_stand_in_replaces_an_application_that_could_be_built(tmp_path: Path) -> None:
    files = {"apps/to_lab/CMakeLists.txt": "add_cfe_app(to_lab a.c)\n", "apps/to_lab/a.c": BROKEN}
    changed = {**files, "small_defs/targets.cmake": TARGETS.replace("one two", "one two to_lab")}
    report = built(tmp_path, changed, TreeOptions(stand_ins=("to_lab",)))
    assert text_of(report, "to_lab") == "cfepy's own in Python (--stand-in asks for it)"
    with pytest.raises(UsageError, match="cfepy has no application 'two' that could stand in"):
        built(tmp_path, {}, TreeOptions(stand_ins=("two",)))


def test_apps_own_table_stands_in_for_one_of_the_mission_that_does_not_compile(tmp_path: Path) -> None:
    report = built(tmp_path, {"small_defs/tables/rows.c": BROKEN})
    assert names(report, STANDS_IN) == ["rows.c"]
    assert text_of(report, "rows.c").startswith("apps/one/fsw/tables/rows.c for small_defs/tables/rows.c: ")
    assert image.read((tmp_path / "mission/rows.tbl").read_bytes()).data == b"\1\0\0\0"


def test_table_that_does_not_compile_is_left_out(tmp_path: Path) -> None:
    report = built(tmp_path, {"apps/one/fsw/tables/rows.c": BROKEN})
    assert names(report, LEFT_OUT) == ["rows.c"]
    assert report.is_complete


def test_table_for_another_name_of_its_application_is_noted(tmp_path: Path) -> None:
    report = built(tmp_path, {"apps/one/fsw/tables/rows.c": TABLE.format(value=1, owner="ONE_APP")})
    assert report.notes == [
        "rows.tbl is the table ONE_APP.Rows, but the startup script names the application ONE: cFE refuses the file"
    ]
    assert report.steps == ["in startup.scr, name the application ONE_APP in place of ONE"]


def test_msgid_bases_of_the_processor_reach_the_applications(tmp_path: Path) -> None:
    header = "#define CFE_PLATFORM_BASE_MIDVAL(x) SMALL_##x\n#define SMALL_CMD 0x1900\n#define SMALL_TLM 0x0900\n"
    header += "#define CFE_GLOBAL_BASE_MIDVAL(x) SMALL_GLOBAL_##x\n#define SMALL_GLOBAL_CMD 0x1860\n"
    header += "#define SMALL_GLOBAL_TLM 0x0860\n"
    report = built(tmp_path, {"small_defs/cpu1/cfe_core_api_base_msgid_values.h": header})
    assert report.notes == [
        "MsgId bases of the mission: commands 0x1900, telemetry 0x0900; applications have the mission's MsgIds; cFE's "
        "own packets keep 0x1800 and 0x0800"
    ]
    assert "ONE has 0x1990" in console_of(fly(str(tmp_path / "mission")))


def test_release_of_cfe_6_is_noted(tmp_path: Path) -> None:
    header = "#define CFE_MAJOR_VERSION 6 /* as it was */\n#define CFE_MINOR_VERSION 7\n#define CFE_REVISION (1)\n"
    report = built(tmp_path, {"cfe/fsw/cfe-core/src/inc/cfe_version.h": header})
    assert report.notes == ["the tree has cFE 6.7.1; the mission runs on cFE 7.0.1, and the sources need --cfe 6.7"]


TO_LAB = "project(TO_LAB C)\nadd_cfe_app(to_lab fsw/src/to_lab.c)\n"
OLD_NAMES = """
    #include "cfe.h"
    void ONE_Main(void)
    {
        CFE_SB_MsgPtr_t Msg;
        CFE_SB_PipeId_t Pipe;
        uint32 Status = CFE_ES_APP_RUN;
        CFE_EVS_Register(NULL, 0, CFE_EVS_EventFilter_BINARY);
        CFE_SB_CreatePipe(&Pipe, 4, "ONE");
        CFE_EVS_SendEvent(1, CFE_EVS_INFORMATION, "old ONE");
        while (CFE_ES_RunLoop(&Status)) CFE_SB_RcvMsg(&Msg, Pipe, 500);
    }
"""


def test_sources_of_cfe_6_need_the_option(tmp_path: Path) -> None:
    files = {**OLD_FILES, "apps/one/fsw/src/one.c": OLD_NAMES, "apps/one/fsw/src/two.c": "int OS_SocketClose(int);\n"}
    tree = write_tree(tmp_path / "tree", files=files)
    report = build_tree(tree, tmp_path / "without")
    assert report.steps == ["build the tree again with --cfe 6.7, because of names of cFE 6 in one"]
    assert " (It uses names of cFE 6: CFE_SB_MsgPtr_t, CFE_ES_APP_RUN, " in text_of(report, "one")
    found = [str(each) for each in check_tree(tree) or ()]
    assert (
        found[0]
        == f"{tree}/apps/one/fsw/src/one.c:4: warning: one uses CFE_SB_MsgPtr_t of cFE 6; build it with --cfe 6.7"
    )
    report = build_tree(tree, tmp_path / "mission", TreeOptions(build=Options(cfe="6.7")))
    assert names(report, BUILT)[0] == "one"
    assert "old ONE" in console_of(fly(str(tmp_path / "mission")))
    with pytest.raises(UsageError, match=r"--cfe: unknown release '7'"):
        build_tree(tree, tmp_path / "other", TreeOptions(build=Options(cfe="7")))


def test_startup_script_of_an_option_replaces_the_trees(tmp_path: Path) -> None:
    (tmp_path / "mine.scr").write_text("CFE_APP, two, TWO_Main, SECOND, 60, 16384, 0x0, 0;\n!\n", encoding="utf-8")
    report = built(tmp_path, options=TreeOptions(startup=tmp_path / "mine.scr"))
    assert text_of(report, "startup.scr") == str(tmp_path / "mine.scr")
    assert report.notes == ["the startup script does not start one, shared"]
    with pytest.raises(UsageError, match=r"none\.scr: cannot be read: No such file or directory"):
        built(tmp_path, options=TreeOptions(startup=tmp_path / "none.scr"))


def test_tree_of_cfs_6_gives_its_limits_and_folders(tmp_path: Path) -> None:
    report = build_tree(write_tree(tmp_path / "tree", files=OLD_FILES), tmp_path / "mission")
    assert names(report, BUILT) == ["one", "startup.scr", "mission.yaml"]
    assert (tmp_path / "mission/apps/one.so").is_file()
    assert (tmp_path / "mission/apps/rows.tbl").is_file()
    assert yaml.safe_load((tmp_path / "mission/mission.yaml").read_text())["limits"] == {
        "es_max_applications": 40,
        "es_default_stack_size": 16384,
        "es_start_task_stack_size": 16384,
        "time_def_leaps": 32,
        "spacecraft_id": 42,
    }
    assert report.notes == ["CFE_MISSION_ES_CRC_16 is 2 in the mission and 1 in cfepy, which cannot change it"]
    assert "ONE has 0x1890" in console_of(fly(str(tmp_path / "mission")))


def test_settings_of_the_time_that_contradict_each_other_are_left_out(tmp_path: Path) -> None:
    header = "#define CFE_PLATFORM_TIME_CFG_SOURCE true\n#define CFE_PLATFORM_ES_MAX_LIBRARIES 12\n"
    report = built(tmp_path, {"small_defs/cfe_platform_cfg.h": header})
    assert report.notes == [
        "cFE's defaults replace time_cfg_source, which contradict each other: limits.time_cfg_source: needs exactly "
        "one of time_cfg_src_met, _gps, _time"
    ]
    assert yaml.safe_load((tmp_path / "mission/mission.yaml").read_text())["limits"]["es_max_libraries"] == 12


def test_stand_in_gets_its_entry_point_in_an_older_startup_script(tmp_path: Path) -> None:
    script = SCRIPT.replace("two, TWO_Main, TWO,", "ci_lab, CI_Lab_AppMain, CI_LAB_APP,")
    report = built(tmp_path, {"small_defs/cpu1_cfe_es_startup.scr": script})
    assert report.notes[0] == "startup.scr: CI_LAB_AppMain, as cfepy's own ci_lab has it, for CI_Lab_AppMain"
    assert "CI_LAB_APP" in console_of(fly(str(tmp_path / "mission")))


def test_table_is_also_written_where_the_code_looks_for_it(tmp_path: Path) -> None:
    main_text = FILES["apps/one/fsw/src/one.c"] + 'const char *const Place = "/cf/apps/rows.tbl";\n'
    built(tmp_path, {"apps/one/fsw/src/one.c": main_text})
    files = [tmp_path / "mission" / each for each in ("rows.tbl", "apps/rows.tbl")]
    assert files[0].read_bytes() == files[1].read_bytes()


def test_startup_script_is_made_when_the_tree_has_none(tmp_path: Path) -> None:
    script = {"small_defs/cpu1_cfe_es_startup.scr": None}
    table = {"apps/one/fsw/tables/rows.c": TABLE.format(value=1, owner="ONE_APP")}
    report = built(tmp_path, {**script, **table})
    assert text_of(report, "startup.scr").startswith("made from the modules")
    lines = (tmp_path / "mission/startup.scr").read_text().splitlines()
    assert lines[:3] == [
        "CFE_LIB, shared, Shared_Init, SHARED, 0, 0, 0x0, 0;",
        "CFE_APP, one, ONE_Main, ONE_APP, 50, 16384, 0x0, 0;",
        "CFE_APP, two, TWO_Main, TWO, 55, 16384, 0x0, 0;",
    ]
    assert "TWO has 0x1892" in console_of(fly(str(tmp_path / "mission")))


def test_files_that_the_user_changed_stay(tmp_path: Path) -> None:
    built(tmp_path)
    for name in ("startup.scr", "mission.yaml", "rows.tbl"):
        (tmp_path / "mission" / name).write_text("changed")
    report = built(tmp_path)
    assert sorted(names(report, KEPT)) == ["mission.yaml", "rows.tbl", "startup.scr"]
    assert (tmp_path / "mission/rows.tbl").read_text() == "changed"
    built(tmp_path, options=TreeOptions(build=Options(tables=TableFiles.WRITE)))
    assert (tmp_path / "mission/startup.scr").read_text() != "changed"
    assert (tmp_path / "mission/rows.tbl").read_bytes() != b"changed"


def test_only_builds_the_named_application(tmp_path: Path) -> None:
    report = built(tmp_path, options=TreeOptions(only=("two",)))
    assert names(report, BUILT)[0] == "two"
    assert "one" not in names(report, BUILT)


def test_folder_that_cannot_be_written_is_reported(tmp_path: Path) -> None:
    (tmp_path / "file").touch()
    with pytest.raises(UsageError, match=r"cannot be written") as caught:
        build_tree(write_tree(tmp_path / "tree"), tmp_path / "file/mission")
    assert caught.value.field == "--output"


# -- commands ----------------------------------------------------------------------------------------------------------


def test_build_command_prints_the_report(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    write_tree(tmp_path / "tree", {"apps/two/parts/part.c": BROKEN})
    assert main(["build", "tree", "--json", "report.json"]) == 1
    said = capsys.readouterr().out
    assert said.startswith("Small, processor cpu1; files of the tree read by cfepy\nbuilt: 5\n  one")
    assert "left out: 1\n  two" in said
    assert said.endswith("\nNow: cfepy run tree_cpu1\n")
    report = json.loads((tmp_path / "report.json").read_text())
    assert (report["cpu"], report["folder"]) == ("cpu1", "tree_cpu1")
    assert [each["name"] for each in report["entries"] if each["result"] == "left out"] == ["two"]


def test_options_of_trees_are_refused_for_an_application(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    write_tree(tmp_path)
    assert main(["build", str(tmp_path / "apps/two"), "--stand-in", "to_lab"]) == 2
    assert "--stand-in: only valid for a mission tree" in capsys.readouterr().err


def test_check_command_reports_a_tree_without_a_compiler(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("PATH", str(tmp_path))
    changed = {"small_defs/targets.cmake": TARGETS.replace("one two", "one two gone ci_lab")}
    write_tree(tmp_path, changed)
    assert main(["check", str(tmp_path)]) == 1
    said = capsys.readouterr().out
    assert "targets.cmake: gone is not in apps or libs" in said
    assert "warning: ci_lab is not in apps or libs; cfepy's own would stand in for it" in said


def test_new_mission_walks_from_a_tree_to_a_flight(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    write_tree(tmp_path / "tree")
    assert main(["new", "mission", "--from", "tree"]) == 0
    said = capsys.readouterr().out
    assert [each for each in ("build: ", "check: ", "flight: ") if each not in said] == []
    assert said.endswith("The mission flies: tree_cpu1\n")


def test_new_mission_ends_with_things_to_do(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    write_tree(tmp_path / "tree", {"apps/two/parts/part.c": BROKEN})
    assert main(["new", "mission", "flown", "--from", "tree"]) == 1
    said = capsys.readouterr().out
    steps = said.partition("\nto do:\n")[2].splitlines()
    assert steps[0].startswith("  1. two: apps/two/parts/part.c:2:14: error:")
    assert len(steps) <= 10
    assert main(["new", "mission", "flown", "--from", "tree"]) == 2


def test_new_mission_flies_a_single_application(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    plain = MAIN.format(name="one", NAME="ONE", more="")
    files = {"src/one.c": plain, "inc/one_msgids.h": "#define ONE_CMD_MID 0x1890\n"}
    write_tree(tmp_path / "one", files=files)
    assert main(["new", "mission", "--from", "one"]) == 0
    said = capsys.readouterr().out
    assert "ONE has 0x1890" in said
    assert said.endswith("The mission flies: one_mission\n")
