"""Headers that CMake's configure_file makes: their text, and the node of another package that includes one."""

from __future__ import annotations

import shutil
import subprocess
from pathlib import Path

import pytest

from cfepy.extra.convert.configured_headers import configured_text
from cfepy.extra.convert.message_headers import Profile
from cfepy.extra.convert.node_check import check_program, programs_of
from cfepy.extra.convert.packages import program_of, read_package
from rospy_shim.types.msgs import Packages
from tests.extra.convert.test_packages import write

TEMPLATE = """#cmakedefine HAS_FAST
#  cmakedefine STATES @STATES@
#cmakedefine LIMIT @LIMIT@
#cmakedefine01 HAS_SLOW
#cmakedefine01 HAS_FAST
const int states = @STATES@;  // ${STATES} @ a@b.c
const char *name = "@NAME@";
"""
VARIABLES = {"STATES": ["18"], "HAS_FAST": ["ON"], "HAS_SLOW": ["OFF"], "NAME": ['a "b"', "c"]}
OPTIONS = [(), ("@ONLY",), ("ESCAPE_QUOTES",), ("COPYONLY",), ("@ONLY", "ESCAPE_QUOTES")]


@pytest.mark.skipif(shutil.which("cmake") is None, reason="needs CMake")
@pytest.mark.parametrize("options", OPTIONS, ids=" ".join)
def test_configured_text_equals_cmake_s(options: tuple[str, ...], tmp_path: Path) -> None:
    values = {name: ";".join(value).replace('"', '\\"') for name, value in VARIABLES.items()}
    script = "".join(f'set({name} "{value}")\n' for name, value in values.items())
    script += f"configure_file(in.h.in out.h {' '.join(options)})\n"
    write(tmp_path, {"in.h.in": TEMPLATE, "made.cmake": script})
    subprocess.run(["cmake", "-P", "made.cmake"], cwd=tmp_path, check=True)
    assert configured_text(TEMPLATE, VARIABLES, options) == (tmp_path / "out.h").read_text(encoding="utf-8")


def test_template_with_an_unknown_variable_makes_no_text() -> None:
    assert configured_text("@GIT_VERSION@", {}) is None
    assert configured_text("${GIT_VERSION}", {}) is None
    assert configured_text("$ENV{HOME}", {"HOME": ["x"]}) is None
    assert configured_text("${GIT_VERSION}", {}, ["@ONLY"]) == "${GIT_VERSION}"
    assert configured_text("#cmakedefine HAS_GIT", {}) == "/* #undef HAS_GIT */"


CORE = """project(core)
set(CORE_STATES 18 CACHE STRING "number of states")
configure_file(include/core/config.h.in ${CATKIN_DEVEL_PREFIX}/include/core/config.h @ONLY)
catkin_package(INCLUDE_DIRS include ${CATKIN_DEVEL_PREFIX}/include LIBRARIES core)
include_directories(include ${CATKIN_DEVEL_PREFIX}/include)
add_library(core core.cpp)
"""
NODE = """project(node)
find_package(catkin REQUIRED COMPONENTS roscpp core)
configure_file(own.h.in ${CMAKE_CURRENT_BINARY_DIR}/own.h)
configure_file(../../outside.h.in ${CMAKE_CURRENT_BINARY_DIR}/outside.h)
configure_file(own.h.in /tmp/elsewhere.h)
configure_file(gone.h.in ${CMAKE_CURRENT_BINARY_DIR}/gone.h)
include_directories(${CMAKE_CURRENT_BINARY_DIR} ${catkin_INCLUDE_DIRS})
add_executable(node node.cpp)
target_link_libraries(node ${catkin_LIBRARIES})
"""
FILES = {
    "src/core/package.xml": "<package><name>core</name></package>",
    "src/core/CMakeLists.txt": CORE,
    "src/core/include/core/config.h.in": "static const int states = @CORE_STATES@;\n",
    "src/core/core.cpp": "#include <core/config.h>\nint doubled() { return 2 * states; }\n",
    "src/node/package.xml": "<package><name>node</name></package>",
    "src/node/CMakeLists.txt": NODE,
    "src/node/own.h.in": '#define OWN_NAME "${PROJECT_NAME}"\n',
    "outside.h.in": "",
    "src/node/node.cpp": """#include <core/config.h>
#include "own.h"
int doubled();
static_assert(states == 18 && sizeof(OWN_NAME) == 5);
int main() { return doubled(); }
""",
}


def test_only_headers_of_the_package_are_configured(tmp_path: Path) -> None:
    write(tmp_path, FILES)
    package = read_package(tmp_path / "src/node", "node")
    assert package.configured == {tmp_path / "src/node/build/own.h": '#define OWN_NAME "node"\n'}


def test_configured_headers_have_the_same_folders_for_the_same_texts(tmp_path: Path) -> None:
    found = []
    for name in ("one", "other"):
        write(tmp_path / name, FILES)
        package = read_package(tmp_path / name / "src/node", "node")
        program = program_of(package, "node", Packages(package.folder / "node.cpp", {}), ours=["roscpp"])
        assert [each.name for each in program.sources] == ["node.cpp", "core.cpp"]
        found.append([each for each in program.includes if not each.is_relative_to(tmp_path)])
    assert len(found[0]) == 2
    assert found[0] == found[1]


def test_node_with_configured_headers_converts(tmp_path: Path) -> None:
    write(tmp_path, FILES)
    program = programs_of([str(tmp_path / "src/node")], {})[0]
    assert [str(each) for each in check_program(program, Profile.HOST, {}).findings] == []
