"""Reading a mission tree without CMake: modules, neighbours, tables, headers, startup scripts and missing parts."""

from __future__ import annotations

import shutil
import textwrap
from pathlib import Path

import pytest

from cfepy.extra.c.trees.cmake_reader import read_with_cmake
from cfepy.extra.c.trees.mission_folder import Reader
from cfepy.extra.c.trees.startup_scripts import find_startup, made_startup
from cfepy.extra.c.trees.tree_layout import find_layout, is_tree
from cfepy.extra.c.trees.tree_model import TreeModel, TreeModule
from cfepy.extra.c.trees.tree_reader import read_tree
from cfepy.status import UsageError
from tests.extra.c.trees.small_trees import OLD_FILES, TARGETS, write_tree

needs_cmake = pytest.mark.skipif(shutil.which("cmake") is None, reason="there is no CMake")


WRITER = """
    function(write_script FOLDER)
      set(FILE "${CMAKE_INSTALL_PREFIX}/${FOLDER}/cfe_es_startup.scr")
      file(WRITE ${FILE}
        "CFE_LIB, shared, Shared_Init, S, 0, 0, 0, 0;\\n"
        "CFE_LIB, other, NULL, O, 0, 0, 0, 0;\\n"
      )
      foreach(APP one gone)
        list(FIND ARGN ${APP} STARTS)
        if (STARTS GREATER -1)
          file(APPEND ${FILE} "CFE_APP, ${APP}, M, A, 5, 0, 0, 0;\\n")
        endif()
      endforeach()
    endfunction()
"""
INSTALL = """
    install(SCRIPT ${MISSION_DEFS}/script.cmake)
    install(CODE "write_script(\\"${TGTNAME}/${INSTALL_SUBDIR}\\" ${${TGTNAME}_APPLIST})")
"""


def read(tree: Path, cpu: str | None = None) -> TreeModel:
    return read_tree(find_layout(tree), cpu)


def module(model: TreeModel, name: str) -> TreeModule:
    return next(each for each in model.modules if each.name == name)


def inside(model: TreeModel, paths: list[Path]) -> list[str]:
    return [each.relative_to(model.layout.tree).as_posix() for each in paths]


def test_modules_have_their_sources_and_the_folders_of_their_neighbours(tmp_path: Path) -> None:
    model = read(write_tree(tmp_path))
    assert [each.name for each in model.modules] == ["one", "two", "shared"]
    one, two = module(model, "one").sources, module(model, "two").sources
    assert one is not None
    assert two is not None
    assert inside(model, one.code) == ["apps/one/fsw/src/one.c"]
    folders = inside(model, one.includes)
    for each in ("apps/one/fsw/inc", "apps/two/fsw/public_inc", "libs/shared/fsw/public_inc", "small_defs/inc"):
        assert each in folders
    assert one.definitions == ["HAVE_TWO"]
    assert inside(model, two.code) == ["apps/two/fsw/src/two.c", "apps/two/parts/part.c"]
    assert "apps/two/parts/inside" in inside(model, two.includes)


def test_mission_and_processor_have_their_names_and_numbers(tmp_path: Path) -> None:
    model = read(write_tree(tmp_path), "cpu2")
    assert (model.mission_name, model.cpus, model.cpu) == ("Small", ["cpu1", "cpu2"], "cpu2")
    assert (model.spacecraft_id, model.processor_id) == (0x51, 2)
    assert [each.name for each in model.modules] == ["one", "shared"]


def test_unknown_processor_is_reported_with_the_known_ones(tmp_path: Path) -> None:
    with pytest.raises(UsageError, match=r"unknown processor 'cpu3'.*cpu1 or cpu2"):
        read(write_tree(tmp_path), "cpu3")


def test_processors_come_from_their_lists_when_the_environment_names_them(tmp_path: Path) -> None:
    changed = TARGETS.replace("MISSION_CPUNAMES cpu1 cpu2", "MISSION_CPUNAMES $ENV{CPUS}")
    assert read(write_tree(tmp_path, {"small_defs/targets.cmake": changed})).cpus == ["cpu1", "cpu2"]


@pytest.mark.parametrize(
    ("files", "chosen"),
    [
        ([], "apps/one/fsw/tables/rows.c"),
        (["tables/rows.c"], "tables/rows.c"),
        (["tables/rows.c", "small_defs/tables/rows.c"], "small_defs/tables/rows.c"),
        (["small_defs/tables/rows.c", "small_defs/tables/cpu1_rows.c"], "small_defs/tables/cpu1_rows.c"),
        (["small_defs/tables/cpu1_rows.c", "small_defs/cpu1/tables/rows.c"], "small_defs/cpu1/tables/rows.c"),
        (["small_defs/tables/cpu2_rows.c"], "apps/one/fsw/tables/rows.c"),
    ],
)
def test_table_of_the_processor_goes_before_the_mission_and_the_app(
    files: list[str], chosen: str, tmp_path: Path
) -> None:
    model = read(write_tree(tmp_path, dict.fromkeys(files, "")))
    sources = module(model, "one").sources
    assert sources is not None
    assert inside(model, sources.tables) == [chosen]


@pytest.mark.parametrize(
    ("files", "chosen"),
    [
        ([], "apps/one/config/default_one_msgids.h"),
        (["small_defs/one_msgids.h"], "small_defs/one_msgids.h"),
        (["small_defs/one_msgids.h", "small_defs/cpu1_one_msgids.h"], "small_defs/cpu1_one_msgids.h"),
        (["small_defs/cpu1_one_msgids.h", "small_defs/cpu1/one_msgids.h"], "small_defs/cpu1/one_msgids.h"),
        (["small_defs/cpu2/one_msgids.h"], "apps/one/config/default_one_msgids.h"),
    ],
)
def test_header_of_the_processor_goes_before_the_mission_and_the_app(
    files: list[str], chosen: str, tmp_path: Path
) -> None:
    model = read(write_tree(tmp_path, dict.fromkeys(files, "")))
    header = model.headers["one_msgids.h"]
    assert header is not None
    assert inside(model, [header]) == [chosen]
    assert model.headers["two_own.h"] is None


def test_install_custom_adds_tables_and_folders(tmp_path: Path) -> None:
    text = """
        add_cfe_tables(one more.c)
        target_include_directories(one.table INTERFACE $<TARGET_PROPERTY:two,INCLUDE_DIRECTORIES>)
        target_compile_definitions(one.table INTERFACE FOR_TABLES)
    """
    changed = {"small_defs/cpu1/install_custom.cmake": text, "small_defs/tables/more.c": ""}
    model = read(write_tree(tmp_path, changed))
    sources = module(model, "one").sources
    assert sources is not None
    assert inside(model, sources.tables)[1:] == ["small_defs/tables/more.c"]
    assert "apps/two/fsw/public_inc" in inside(model, sources.table_includes)
    assert "FOR_TABLES" in sources.table_definitions
    assert "FOR_TABLES" not in sources.definitions


def test_startup_script_that_cmake_would_write_is_made_in_memory(tmp_path: Path) -> None:
    changed = {
        "small_defs/script.cmake": WRITER,
        "small_defs/cpu1/install_custom.cmake": INSTALL,
        "small_defs/cpu1_cfe_es_startup.scr": None,
    }
    model = read(write_tree(tmp_path, changed))
    found = find_startup(model)
    assert found is not None
    assert [each.file for each in found.lines] == ["shared", "other", "one"]
    assert not (tmp_path / "cpu1").exists()


# -- missing parts -----------------------------------------------------------------------------------------------------

MODULES = '[submodule "two"]\n\tpath = apps/two\n\turl = https://example.org/two.git\n'


@pytest.mark.parametrize("is_empty", [True, False])
def test_submodule_that_was_not_fetched_is_reported_with_its_url(is_empty: bool, tmp_path: Path) -> None:
    write_tree(tmp_path, {".gitmodules": MODULES})
    shutil.rmtree(tmp_path / "apps/two")
    if is_empty:
        (tmp_path / "apps/two").mkdir()
    assert module(read(tmp_path), "two").reason == (
        "is a git submodule that was not fetched; its URL is https://example.org/two.git"
    )


def test_module_that_is_nowhere_is_reported(tmp_path: Path) -> None:
    changed = {"small_defs/targets.cmake": TARGETS.replace("one two", "one three")}
    assert module(read(write_tree(tmp_path, changed)), "three").reason == "is not in apps or libs"


def test_source_of_a_custom_command_is_reported_with_the_command(tmp_path: Path) -> None:
    text = """
        add_custom_command(OUTPUT ${CMAKE_CURRENT_SOURCE_DIR}/made.c COMMAND python3 make.py --all DEPENDS make.py)
        add_cfe_app(two made.c)
    """
    reason = module(read(write_tree(tmp_path, {"apps/two/CMakeLists.txt": text})), "two").reason
    assert reason == "made.c is made by a custom command of the build: python3 make.py --all DEPENDS make.py"


def test_source_that_cmake_writes_is_reported(tmp_path: Path) -> None:
    text = 'file(WRITE ${CMAKE_CURRENT_BINARY_DIR}/a.c "")\nadd_cfe_app(two ${CMAKE_CURRENT_BINARY_DIR}/a.c)\n'
    reason = module(read(write_tree(tmp_path, {"apps/two/CMakeLists.txt": text})), "two").reason
    assert reason == "a.c is written by the tree's CMake files; the code is elsewhere, such as in Rust"


def test_error_in_a_file_ends_that_file_only(tmp_path: Path) -> None:
    text = 'add_cfe_app(two fsw/src/two.c)\nmessage(FATAL_ERROR "no radio")\nadd_cfe_app(three fsw/src/two.c)\n'
    model = read(write_tree(tmp_path, {"apps/two/CMakeLists.txt": text}))
    assert [each.name for each in model.modules] == ["one", "two", "shared"]
    assert model.notes == ["apps/two: the file ends with an error: no radio"]


def test_program_of_the_tree_is_not_executed(tmp_path: Path) -> None:
    text = f"execute_process(COMMAND touch {tmp_path}/ran OUTPUT_VARIABLE X)\nfile(WRITE {tmp_path}/wrote x)\n"
    model = read(write_tree(tmp_path, {"small_defs/mission_build_custom.cmake": text}))
    assert not (tmp_path / "ran").exists()
    assert not (tmp_path / "wrote").exists()
    assert any("not executed: execute_process(COMMAND touch" in each for each in model.notes)


# -- layouts -----------------------------------------------------------------------------------------------------------


def test_application_without_cmake_is_found_by_convention(tmp_path: Path) -> None:
    model = read(write_tree(tmp_path, files=OLD_FILES))
    assert (model.cpus, model.processor_id, model.spacecraft_id) == (["cpu1"], 1, 42)
    sources = module(model, "one").sources
    assert sources is not None
    assert inside(model, sources.code) == ["apps/one/fsw/src/one.c"]
    assert "apps/one/fsw/platform_inc" in inside(model, sources.includes)
    assert "apps/one/fsw/src" in inside(model, sources.includes)


def test_definitions_as_delivered_are_used_when_a_tree_has_no_others(tmp_path: Path) -> None:
    write_tree(tmp_path, files={"cfe/cmake/sample_defs/targets.cmake": TARGETS})
    assert is_tree(tmp_path)
    assert find_layout(tmp_path).config_name == "sample"


def test_tree_with_several_definitions_asks_for_one(tmp_path: Path) -> None:
    write_tree(tmp_path, {"other_defs/targets.cmake": TARGETS})
    with pytest.raises(UsageError, match="other_defs small_defs; choose one with --defs"):
        find_layout(tmp_path)
    assert find_layout(tmp_path, "other_defs").config_name == "other"


def test_folder_without_targets_is_not_a_tree(tmp_path: Path) -> None:
    assert not is_tree(tmp_path)
    with pytest.raises(UsageError, match=r"is not a cFS mission tree: \*_defs/targets\.cmake is missing"):
        find_layout(tmp_path)


@pytest.mark.parametrize("entry", ["ONE_AppMain", "ONE_Main", "OneAppMain", "one_app_main"])
def test_made_startup_script_finds_the_entry_point(entry: str) -> None:
    script = made_startup([("one", ["ONE_Init", "ONE_HelperOfMainLoop", entry], ["ONE_APP.Rows"])])
    [line] = script.lines
    assert (line.symbol, line.name) == (entry, "ONE_APP")


APART = {
    "cfg/apart_defs/targets.cmake": """
        SET(MISSION_NAME "Apart")
        list(APPEND MISSION_GLOBAL_APPLIST imu/fsw/cfs two)
        foreach(X ${MISSION_GLOBAL_APPLIST})
            list(APPEND APPLICATION_PLATFORM_INC_LIST ${${X}_MISSION_DIR}/inc ${${X}_MISSION_DIR}/../common)
        endforeach()
        SET(MISSION_CPUNAMES cpu1)
    """,
    "cfg/apart_defs/cpu1_cfe_es_startup.scr": "CFE_APP, imu, IMU_Main, IMU, 50, 16384, 0x0, 0;\n!\n",
    "components/imu/fsw/cfs/CMakeLists.txt": "add_cfe_app(imu imu.c)\n",
    "components/imu/fsw/cfs/imu.c": "",
    "components/imu/fsw/cfs/inc/imu.h": "",
    "components/imu/fsw/common/imu_device.h": "",
    "components/two/CMakeLists.txt": "add_cfe_app(two two.c)\n",
    "components/two/two.c": "",
    "fsw/apps/two/CMakeLists.txt": "add_cfe_app(two other.c)\n",
}
"""A mission whose definitions and components are beside the tree, with a module in a subfolder."""


@pytest.mark.parametrize("reader", [read_tree, pytest.param(read_with_cmake, marks=[needs_cmake, pytest.mark.slow])])
def test_modules_of_other_folders_go_before_the_trees(reader: Reader, tmp_path: Path) -> None:
    write_tree(tmp_path, files=APART)
    tree, definitions = tmp_path / "fsw", tmp_path / "cfg/apart_defs"
    assert is_tree(tree, definitions)
    assert not is_tree(tree)
    model = reader(find_layout(tree, definitions, [str(tmp_path / "components")]), None, ())
    assert [each.name for each in model.modules] == ["imu", "two"]
    imu, two = (each.sources for each in model.modules)
    assert imu is not None
    assert two is not None
    assert imu.code == [tmp_path / "components/imu/fsw/cfs/imu.c"]
    assert two.code == [tmp_path / "components/two/two.c"]
    for each in (imu, two):
        assert {tmp_path / "components/imu/fsw/cfs/inc", tmp_path / "components/imu/fsw/common"} <= set(each.includes)
    assert find_startup(model).origin == "../cfg/apart_defs/cpu1_cfe_es_startup.scr"


def test_folder_of_modules_must_exist(tmp_path: Path) -> None:
    with pytest.raises(UsageError, match="folder not found") as caught:
        find_layout(write_tree(tmp_path), None, ["gone"])
    assert caught.value.field == "--modules"


# -- CMake -------------------------------------------------------------------------------------------------------------


@needs_cmake
@pytest.mark.slow
@pytest.mark.parametrize("is_old", [False, True])
def test_cmake_and_cfepys_reader_agree(is_old: bool, tmp_path: Path) -> None:
    install = {
        "small_defs/cpu1/install_custom.cmake": f"add_cfe_tables(one more.c)\n{textwrap.dedent(INSTALL)}",
        "small_defs/script.cmake": WRITER,
        "small_defs/tables/more.c": "",
    }
    write_tree(tmp_path, files=OLD_FILES) if is_old else write_tree(tmp_path, install)
    layout = find_layout(tmp_path)
    own, other = read_tree(layout), read_with_cmake(layout)
    assert other.read_by.startswith("CMake 3") or other.read_by.startswith("CMake 4")
    assert own.headers == other.headers
    assert own.files == other.files
    assert list(own.written.values()) == list(other.written.values())
    assert (own.cpus, own.spacecraft_id, own.mission_name) == (other.cpus, other.spacecraft_id, other.mission_name)
    assert [each.name for each in own.modules] == [each.name for each in other.modules]
    for one, two in zip(own.modules, other.modules, strict=True):
        assert one.sources is not None
        assert two.sources is not None
        assert one.sources.code == two.sources.code
        assert one.sources.tables == two.sources.tables
        assert set(one.sources.includes) == set(two.sources.includes)
        assert set(one.sources.definitions) == set(two.sources.definitions)


@needs_cmake
@pytest.mark.slow
def test_cmake_reads_a_tree_with_unknown_commands_errors_and_missing_sources(tmp_path: Path) -> None:
    text = """
        some_unknown_command(a b)
        find_package(Nothing REQUIRED)
        add_subdirectory(nowhere)
        add_cfe_app(two fsw/src/two.c gone.c)
        message(FATAL_ERROR "no radio")
    """
    model = read_with_cmake(find_layout(write_tree(tmp_path, {"apps/two/CMakeLists.txt": text})))
    assert module(model, "two").reason == "source files are missing: apps/two/gone.c"
    assert module(model, "one").sources is not None
    assert "apps/two: the file ends with an error: no radio" in model.notes
    assert "apps/two: not searched for: Nothing" in model.notes
    assert "apps/two: subfolder is missing: apps/two/nowhere" in model.notes


@pytest.mark.slow
def test_missing_cmake_is_reported(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("PATH", str(tmp_path))
    with pytest.raises(UsageError, match="requires CMake"):
        read_with_cmake(find_layout(write_tree(tmp_path)))
