"""Building compiled applications: sources, headers, and the resulting table files."""

from __future__ import annotations

import os
import subprocess
import sys
import textwrap
from pathlib import Path

import pytest

from cfepy.cli.main import main
from cfepy.extra.c import Built, CompilerError, Options, TableFiles, build
from cfepy.extra.c.elf import elf_file
from cfepy.extra.c.toolchain import application
from cfepy.extra.c.toolchain.compiler import compile_file
from cfepy.extra.c.toolchain.source_files import find_sources
from cfepy.fs import read_table_file
from cfepy.status import UsageError
from cfepy.writing.work_progress import WorkProgress
from tests.extra.c.building import console_of, fly, needs_compiler, needs_cpp, said, write_mission

pytestmark = needs_compiler

DATA = Path(__file__).parents[2] / "data"
MAIN = """
    #include "cfe.h"
    #include "probe_msgids.h"
    uint32 PROBE_Mid(void) { return PROBE_CMD_MID; }
    void PROBE_Main(void) { CFE_ES_ExitApp(CFE_ES_RunStatus_APP_EXIT); }
"""
TABLE = """
    #include "cfe_tbl_filedef.h"
    typedef struct { uint16 Int1, Int2; } Probe_t;
    Probe_t ExampleTable = {1, 2};
    CFE_TBL_FILEDEF(ExampleTable, SAMPLE_APP.ExampleTable, Table Utility Test Table, sample_app_tbl.tbl)
"""


def write(folder: Path, files: dict[str, str]) -> Path:
    """Files of an application, indented as they stand in the test."""
    for name, text in files.items():
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_text(textwrap.dedent(text).lstrip(), encoding="utf-8")
    return folder


@pytest.fixture
def app(tmp_path: Path) -> Path:
    """Return an application whose message id a mission may choose."""
    files = {"fsw/src/probe.c": MAIN, "config/default_probe_msgids.h": "#define PROBE_CMD_MID 0x1890\n"}
    return write(tmp_path / "apps/probe", files)


def library(built: Built) -> object:
    """Return the shared object, as pyelftools reads it."""
    return elf_file(built.library.open("rb"))  # type: ignore[arg-type]  # a file is a stream, too


def symbols(built: Built) -> dict[str, bool]:
    """Return the dynamic symbols, and whether each is defined."""
    table = library(built).get_section_by_name(".dynsym")  # type: ignore[attr-defined]
    return {each.name: each["st_shndx"] != "SHN_UNDEF" for each in table.iter_symbols() if each.name}


def sections(built: Built) -> set[str]:
    return {each.name for each in library(built).iter_sections()}  # type: ignore[attr-defined]


# -- needs and progress ------------------------------------------------------------------------------------------------


def test_missing_elf_reader_is_reported_before_anything_is_compiled(app: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    write(app, {"fsw/tables/probe_tbl.c": TABLE})
    monkeypatch.setitem(sys.modules, "elftools.elf.elffile", None)
    monkeypatch.setattr(application, "compile_files", lambda *words: pytest.fail("a compiler was started"))
    with pytest.raises(UsageError, match=r"pip install 'cfepy\[c\]'"):
        build(app)


def test_application_without_tables_is_built_without_the_elf_reader(app: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "elftools.elf.elffile", None)
    assert build(app).library.is_file()


def test_build_shows_each_source_and_its_number(app: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    class Shown(WorkProgress):
        def show(self, text: str) -> None:
            texts.append(text)

    texts: list[str] = []
    monkeypatch.setattr(application, "WorkProgress", Shown)
    write(app, {"fsw/tables/probe_tbl.c": TABLE})
    build(app)
    assert texts == ["compiling probe: 1 of 2, probe.c", "compiling probe: 2 of 2, probe_tbl.c"]


def test_sources_outside_of_the_folder_may_share_a_name(tmp_path: Path) -> None:
    files = {f"more/{each}/part.c": f"int {each.upper()}_Part(void) {{ return 1; }}\n" for each in ("a", "b")}
    main_text = (
        '#include "cfe.h"\nint A_Part(void), B_Part(void);\nint PROBE_Main(void) { return A_Part() + B_Part(); }\n'
    )
    lists = "add_cfe_app(probe main.c ../more/a/part.c ../more/b/part.c)\n"
    write(tmp_path, {**files, "probe/main.c": main_text, "probe/CMakeLists.txt": lists})
    found = symbols(build(tmp_path / "probe"))
    assert found["A_Part"]
    assert found["B_Part"]


def test_first_source_with_an_error_is_reported(app: Path) -> None:
    write(app, {f"fsw/src/a{number}.c": f"#error number {number}\n" for number in range(4)})
    with pytest.raises(CompilerError, match="number 0"):
        build(app)


# -- sources -----------------------------------------------------------------------------------------------------------


def test_folder_without_cmake_builds_all_sources_except_eds_files(app: Path) -> None:
    write(app, {"fsw/src/probe_eds_dispatch.c": "#error EDS\n", "fsw/src/more.c": "int More(void) { return 1; }\n"})
    built = build(app)
    assert built.library == app / "probe.so"
    assert symbols(built)["PROBE_Main"]
    assert symbols(built)["More"]
    assert symbols(built)["CFE_ES_ExitApp"] is False


def test_headers_of_the_first_processor_have_names_without_it(tmp_path: Path) -> None:
    (tmp_path / "app/fsw/src").mkdir(parents=True)
    (tmp_path / "app/fsw/src/app.c").write_text('#include "device_cfg.h"\nint rate(void) { return RATE; }\n')
    (tmp_path / "defs").mkdir()
    (tmp_path / "defs/cpu1_device_cfg.h").write_text("#define RATE 9600\n")
    (tmp_path / "defs/cpu2_device_cfg.h").write_text("#define RATE no\n")
    assert build(tmp_path / "app", None, Options(definitions=tmp_path / "defs")).warnings == []


def test_tables_that_cmake_does_not_name_find_the_headers_beside_the_code(tmp_path: Path) -> None:
    for name in ("src", "tables"):
        (tmp_path / "app/fsw" / name).mkdir(parents=True)
    (tmp_path / "app/CMakeLists.txt").write_text("aux_source_directory(fsw/src FILES)\nadd_cfe_app(app ${FILES})\n")
    (tmp_path / "app/fsw/src/app.c").write_text("int one;\n")
    (tmp_path / "app/fsw/src/rows.h").write_text("typedef int Row_t;\n")
    (tmp_path / "app/fsw/tables/rows.c").write_text(
        '#include "cfe_tbl_filedef.h"\n#include "rows.h"\nRow_t Rows = 7;\n'
        "CFE_TBL_FILEDEF(Rows, APP.Rows, Rows, rows.tbl)\n"
    )
    assert [each.name for each in build(tmp_path / "app").tables] == ["rows.tbl"]


def test_cmake_lists_define_name_sources_and_tables(tmp_path: Path) -> None:
    text = """
        project(CFS_PROBE C)  # a comment (with brackets
        set(PROBE_OPTION FALSE CACHE STRING "an option")
        set(FILES fsw/src/a.c
                  fsw/src/b.c)
        if (CFE_EDS_ENABLED)
          list(APPEND FILES fsw/src/eds.c)
        elseif (NOT PROBE_OPTION)
          list(APPEND FILES fsw/src/c.c)
        else()
          list(APPEND FILES fsw/src/d.c)
        endif()
        foreach(EXT_APP hs lc)
          list(FIND TGTSYS_${SYSVAR}_APPS ${EXT_APP} HAVE_APP)
          if (HAVE_APP GREATER_EQUAL 0)
            add_definitions(-DHAVE_${EXT_APP})
            include_directories($<TARGET_PROPERTY:${EXT_APP},INTERFACE_INCLUDE_DIRECTORIES>)
          endif()
        endforeach()
        aux_source_directory(fsw/more FILES)
        add_definitions(-DPROBE=1)
        include_directories(${other_MISSION_DIR}/fsw/inc)
        add_cfe_app(probe ${FILES})
        target_include_directories(probe PUBLIC fsw/inc)
        add_cfe_app_dependency(probe sample_lib)
        add_cfe_tables(probe fsw/tables/t.c)
        if (ENABLE_UNIT_TESTS)
          add_cfe_tables(probe unit-test/t.c)
        endif (ENABLE_UNIT_TESTS)
    """
    sources = ["fsw/src/a.c", "fsw/src/b.c", "fsw/src/c.c", "fsw/more/e.c", "fsw/more/f.cpp"]
    app, lc = tmp_path / "apps/x", tmp_path / "apps/lc/inc"
    write(app, {"CMakeLists.txt": text, **dict.fromkeys([*sources, "fsw/inc/x.h", "fsw/tables/t.c"], "")})
    write(lc, {"lc.h": ""})
    said = find_sources(app)
    assert said.name == "probe"
    assert said.code == [app / each for each in sources]
    assert said.tables == [app / "fsw/tables/t.c"]
    assert said.definitions == ["HAVE_lc", "PROBE=1"]
    assert said.includes == [app / "fsw/inc", lc]
    assert said.missing == ["other", "sample_lib"]


def test_missing_source_of_cmake_is_reported(app: Path) -> None:
    write(app, {"CMakeLists.txt": "add_cfe_app(probe fsw/src/gone.c)\n"})
    with pytest.raises(UsageError, match=r"CMakeLists\.txt names a missing file: fsw/src/gone\.c"):
        build(app)


@pytest.mark.parametrize("name", ["nothing", "apps"])
def test_folder_without_sources_is_refused(name: str, app: Path) -> None:
    with pytest.raises(UsageError, match=r"folder not found|missing C sources"):
        build(app.parents[1] / name)


def test_headers_of_a_mission_go_before_defaults(app: Path, tmp_path: Path) -> None:
    write(tmp_path / "defs", {"probe_msgids.h": "#define PROBE_CMD_MID 0x18A0\n#define CHOSEN\n"})
    write(app, {"fsw/src/check.c": '#include "probe_msgids.h"\n#ifndef CHOSEN\n#error default\n#endif\nint check;\n'})
    with pytest.raises(CompilerError, match="#error default"):
        build(app)
    build(app, options=Options(definitions=tmp_path / "defs"))


def test_header_of_a_mission_is_empty_when_no_mission_is_given(app: Path) -> None:
    write(app, {"mission_build.cmake": "set(PROBE_MISSION_CONFIG_FILE_LIST\n  probe_msgids.h\n  probe_extra.h\n)\n"})
    write(app, {"fsw/src/more.c": '#include "probe_extra.h"\nint more;\n'})
    assert build(app).warnings == []


def test_headers_of_a_neighbouring_library_are_found(app: Path) -> None:
    write(app, {"CMakeLists.txt": "add_cfe_app(probe fsw/src/user.c)\nadd_cfe_app_dependency(probe my_lib)\n"})
    write(app, {"fsw/src/user.c": '#include "my_lib.h"\nint user = MY_LIB;\n'})
    with pytest.raises(CompilerError, match=r"It uses headers of my_lib: put that folder next to this one"):
        build(app)
    write(app.parents[1] / "libs/my_lib", {"fsw/public_inc/my_lib.h": '#include "my_lib_cfg.h"\n'})
    write(app.parents[1] / "libs/my_lib", {"config/default_my_lib_cfg.h": "#define MY_LIB 7\n"})
    build(app)


def test_headers_of_the_missions_other_applications_are_taken_if_they_are_there(app: Path) -> None:
    text = """
        foreach(EXT_APP hs lc)
          list (FIND TGTSYS_${SYSVAR}_APPS ${EXT_APP} HAVE_APP)
          if (HAVE_APP GREATER_EQUAL 0)
            include_directories($<TARGET_PROPERTY:${EXT_APP},INTERFACE_INCLUDE_DIRECTORIES>)
            string(TOUPPER "HAVE_${EXT_APP}" APP_MACRO)
            add_definitions(-D${APP_MACRO})
          endif()
        endforeach()
        add_cfe_app(probe fsw/src/user.c)
    """
    source = """
        #include "lc_msg.h"
        #if LC != 7 || defined(HAVE_HS) || !defined(HAVE_LC)
        #error wrong
        #endif
        int user;
    """
    write(app, {"CMakeLists.txt": text, "fsw/src/user.c": source})
    (app.parent / "hs").mkdir()  # a submodule that was not fetched
    with pytest.raises(CompilerError, match=r"lc_msg\.h: No such file or directory"):
        build(app)
    write(
        app.parent / "lc",
        {
            "CMakeLists.txt": "add_cfe_app(lc lc.c)\ntarget_include_directories(lc PUBLIC fsw/headers)\n",
            "fsw/headers/lc_msg.h": "#define LC 7\n",
        },
    )
    build(app)


# -- the compiler ------------------------------------------------------------------------------------------------------


def test_compiler_error_is_reported_with_its_line(app: Path) -> None:
    write(app, {"fsw/src/wrong.c": "int wrong(void) { return nothing; }\n"})
    with pytest.raises(CompilerError, match=r"wrong\.c:1:26: error: .*nothing.* undeclared"):
        build(app)
    assert not (app / "probe.so").exists()


def test_compiler_warnings_are_returned(app: Path) -> None:
    write(app, {"fsw/src/odd.c": "static int unused;\n"})
    (warning,) = build(app).warnings
    assert "odd.c:1:12: warning: 'unused' defined but not used" in warning.replace("\u2018", "'").replace("\u2019", "'")


def test_missing_compiler_is_reported(app: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("CC", "no-such-compiler -m64")
    with pytest.raises(UsageError, match="no-such-compiler is not installed; install a C compiler"):
        build(app)


def test_debug_data_is_included_by_default(app: Path) -> None:
    assert ".debug_info" in sections(build(app))
    assert ".debug_info" not in sections(build(app, options=Options(debug=False)))


def test_two_builds_have_equal_bytes(app: Path, tmp_path: Path) -> None:
    one, other = (build(app, tmp_path / name).library.read_bytes() for name in ("one.so", "other.so"))
    assert one == other


def test_sources_of_one_name_in_two_folders_are_built(app: Path) -> None:
    write(
        app, {"CMakeLists.txt": "add_cfe_app(probe fsw/src/a.c fsw/src/x/a.c ../common.c)\n", "fsw/src/a.c": "int a;\n"}
    )
    write(app, {"fsw/src/x/a.c": "int b;\n", "../common.c": "int c;\n"})
    assert {"a", "b", "c"} <= symbols(build(app)).keys()


@needs_cpp
def test_cpp_library_is_linked(app: Path, tmp_path: Path) -> None:
    text = """
        #include <stdexcept>
        #include <string>
        #include <vector>
        #include "cfe.h"
        static std::vector<std::string> texts{"one", "two"};
        extern "C" void TEST_Main(void)
        {
            try {
                texts.at(2);
            } catch (const std::out_of_range &) {
                CFE_ES_WriteToSysLog("> %s", (texts[0] + texts[1]).c_str());
            }
            CFE_ES_ExitApp(CFE_ES_RunStatus_APP_EXIT);
        }
    """
    write(app, {"fsw/src/test.cpp": text})
    build(app, tmp_path / "TEST.so")
    assert said(console_of(fly(write_mission(tmp_path, "TEST"), 1))) == ["onetwo"]


def test_flags_and_optimisation_reach_the_compiler(app: Path) -> None:
    text = "#if !defined WANTED || !defined __OPTIMIZE__\n#error flags\n#endif\nint flags;\n"
    write(app, {"fsw/src/flags.c": text})
    build(app, options=Options(flags=["-DWANTED"], optimize="2"))
    with pytest.raises(CompilerError, match="#error flags"):
        build(app, options=Options(flags=["-DWANTED"], optimize="0"))


def test_without_deprecated_names_handles_are_ids(app: Path) -> None:
    write(app, {"fsw/src/size.c": '#include "cfe.h"\nchar size[sizeof(CFE_TBL_Handle_t) == SIZE ? 1 : -1];\n'})
    build(app, options=Options(flags=["-DSIZE=2"]))
    build(app, options=Options(flags=["-DSIZE=4"], omit_deprecated=True))


def test_memory_accesses_call_undefined_tsan_functions_when_sanitized(app: Path) -> None:
    write(app, {"fsw/src/shared.c": "int shared; int Read(void) { return shared; }\n"})
    built = build(app, options=Options(sanitize_thread=True))
    assert symbols(built)["__tsan_read4"] is False
    needed = library(built).get_section_by_name(".dynamic").iter_tags("DT_NEEDED")  # type: ignore[attr-defined]
    assert not [each.needed for each in needed if "tsan" in each.needed]


def test_notes_for_gcov_are_written_next_to_the_library(app: Path, tmp_path: Path) -> None:
    built = build(app, tmp_path / "out/probe.so", Options(coverage=True))
    assert (tmp_path / "out/probe.so.coverage/fsw/src/probe.c.gcno").is_file()
    assert any(name.startswith("__gcov") for name in symbols(built)) or ".init_array" in sections(built)


# -- a tree of the user's own ------------------------------------------------------------------------------------------


def test_headers_of_a_cfs_tree_replace_the_shipped_ones(app: Path, tmp_path: Path) -> None:
    needed = ("cfe_mission_cfg", "osconfig", "osapi")
    tree = write(
        tmp_path / "cfs",
        {
            "cfe/modules/core_api/fsw/inc/cfe.h": "".join(f'#include "{name}.h"\n' for name in needed),
            "cfe/modules/core_api/config/default_cfe_mission_cfg.h": "#error default\n",
            "osal/src/os/inc/osapi.h": "typedef unsigned uint32;\nvoid CFE_ES_ExitApp(uint32);\n",
            "my_defs/cfe_mission_cfg.h": "enum { CFE_ES_RunStatus_APP_EXIT = 2 };\n",
        },
    )
    assert symbols(build(app, options=Options(cfs=tree)))["PROBE_Main"]
    write(tree, {"build/inc/cfe_mission_cfg.h": "#error made by the build\n"})
    with pytest.raises(CompilerError, match="#error made by the build"):
        build(app, options=Options(cfs=tree))


def test_folder_without_a_cfs_tree_is_refused(app: Path, tmp_path: Path) -> None:
    with pytest.raises(UsageError, match="is not a cFS tree of cFE 7"):
        build(app, options=Options(cfs=tmp_path))


# -- tables ------------------------------------------------------------------------------------------------------------


def test_a_table_is_the_file_that_nasas_tools_make(app: Path, tmp_path: Path) -> None:
    write(app, {"fsw/tables/sample_app_tbl.c": TABLE})
    (made,) = build(app, tmp_path / "out/probe.so").tables
    assert made == tmp_path / "out/sample_app_tbl.tbl"
    assert made.read_bytes() == (DATA / "sample_app_tbl.tbl").read_bytes()


def test_table_file_with_other_contents_stays_unless_wanted(app: Path, tmp_path: Path) -> None:
    write(app, {"fsw/tables/sample_app_tbl.c": TABLE})
    table, library = tmp_path / "out/sample_app_tbl.tbl", tmp_path / "out/probe.so"
    first = build(app, library)
    usual = table.read_bytes()
    assert (first.tables, first.kept) == ([table], [])
    assert build(app, library).tables == [table]
    table.write_bytes(b"the mission's own")
    again = build(app, library)
    assert (again.tables, again.kept) == ([], [table])
    assert table.read_bytes() == b"the mission's own"
    assert build(app, library, Options(tables=TableFiles.NONE)).kept == []
    assert table.read_bytes() == b"the mission's own"
    assert build(app, library, Options(tables=TableFiles.WRITE)).tables == [table]
    assert table.read_bytes() == usual


@pytest.mark.parametrize(("option", "is_there"), [([], True), (["--tables"], True), (["--no-tables"], False)])
def test_command_writes_table_files(
    option: list[str], is_there: bool, app: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    write(app, {"fsw/tables/sample_app_tbl.c": TABLE})
    table, library = tmp_path / "sample_app_tbl.tbl", str(tmp_path / "probe.so")
    assert main(["build", str(app), "-o", library, *option]) == 0
    assert table.exists() is is_there
    table.write_bytes(b"the mission's own")
    capsys.readouterr()
    assert main(["build", str(app), "-o", library, *option]) == 0
    kept = table.read_bytes() == b"the mission's own"
    note = f"{table}: kept: it differs from the table in the application's sources; --tables overwrites it"
    assert (kept, note in capsys.readouterr().err) == (option != ["--tables"], not option)


def test_table_of_zeros_keeps_its_zeros(app: Path) -> None:
    write(app, {"fsw/tables/zeros.c": TABLE.replace("= {1, 2}", "")})
    (made,) = build(app).tables
    assert read_table_file(made.read_bytes())[2] == bytes(4)


def test_addresses_in_a_table_are_a_warning(app: Path) -> None:
    text = TABLE.replace("uint16 Int1, Int2;", "uint64 Number; const char *Text;").replace("{1, 2}", '{1, "text"}')
    write(app, {"fsw/tables/pointers.c": text})
    built = build(app)
    assert "1 words of the table are addresses" in built.warnings[0]
    assert read_table_file(built.tables[0].read_bytes())[2] == (1).to_bytes(8, "little") + bytes(8)


@pytest.mark.parametrize(
    ("old", "new", "wrong"),
    [
        ("CFE_TBL_FILEDEF(ExampleTable, ", "int ", "missing table definition"),
        (
            "CFE_TBL_FILEDEF(ExampleTable,",
            "extern int Other; CFE_TBL_FILEDEF(Other,",
            "is not an object in this file",
        ),
        ("sample_app_tbl.tbl", "/cf/x.tbl", "is not a valid file name"),
        ("SAMPLE_APP.ExampleTable", "ExampleTable", "invalid table name"),
    ],
)
def test_invalid_table_is_refused(old: str, new: str, wrong: str, app: Path) -> None:
    text = TABLE.replace(old, new)
    if "missing table" in wrong:
        text = text[: text.index("int SAMPLE")]
    write(app, {"fsw/tables/bad.c": text})
    with pytest.raises(UsageError, match=wrong):
        build(app)


def test_a_compiler_that_waits_for_a_pipe_is_ended(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("cfepy.extra.c.toolchain.compiler._LOOK_S", 0.2)
    os.mkfifo(tmp_path / "pipe.h")
    (tmp_path / "a.c").write_text('#include "pipe.h"\n', encoding="utf-8")
    with pytest.raises(CompilerError, match="was waiting for input"):
        compile_file(tmp_path / "a.c", tmp_path / "a.o", [])


def test_a_compiler_is_held_to_bounds(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("cfepy.extra.c.toolchain.compiler.OBJECT_BYTES", 1 << 20)
    (tmp_path / "a.c").write_text("char many[8 << 20] = {1};\n", encoding="utf-8")
    with pytest.raises(CompilerError):
        compile_file(tmp_path / "a.c", tmp_path / "a.o", [])
    (tmp_path / "a.c").write_text("char few[8] = {1};\n", encoding="utf-8")
    assert compile_file(tmp_path / "a.c", tmp_path / "a.o", []) == ""


@pytest.mark.parametrize("name", ["../victim", "/victim", "a/b", "..", "a b", "-o"])
def test_a_name_that_leads_out_is_refused(name: str, app: Path) -> None:
    write(app, {"CMakeLists.txt": f'add_cfe_app("{name}" fsw/src/probe.c)\n'})
    with pytest.raises(UsageError, match="invalid application name"):
        build(app)


def test_generated_header_outside_the_build_folder_is_ignored(app: Path) -> None:
    write(app, {"mission_build.cmake": "set(PROBE_PLATFORM_FILE_LIST ../../../victim.h /victim.h good.h)\n"})
    assert set(find_sources(app).chosen) == {"good.h", "probe_msgids.h"}


def test_compiler_runs_when_the_process_has_resource_limits(tmp_path: Path) -> None:
    (tmp_path / "a.c").write_text("int a;\n", encoding="utf-8")
    program = (
        "import resource, sys\n"
        "from pathlib import Path\n"
        "from cfepy.extra.c.toolchain.compiler import compile_file\n"
        "resource.setrlimit(resource.RLIMIT_AS, (2 << 30, 2 << 30))\n"
        "resource.setrlimit(resource.RLIMIT_CPU, (60, 60))\n"
        "compile_file(Path(sys.argv[1]), Path(sys.argv[2]), [])\n"
    )
    subprocess.run([sys.executable, "-c", program, str(tmp_path / "a.c"), str(tmp_path / "a.o")], check=True)
    assert (tmp_path / "a.o").is_file()
