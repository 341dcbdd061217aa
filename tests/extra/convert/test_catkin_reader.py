"""The reader of CMakeLists.txt: loops, functions, generator expressions, catkin_simple, sources without suffix."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest

from cfepy.extra.convert.cpp_package import CppPackage
from cfepy.extra.convert.packages import program_of, read_package, source_files
from cfepy.status import UsageError
from dev.convert.cmake_compare import by_cmake, by_reader, differences
from rospy_shim.types.msgs import Library, OnDisk, Packages

MANIFEST = "<package><name>demo</name></package>"
HEAD = "cmake_minimum_required(VERSION 3.0.2)\nproject(demo)\n"
WHOLE = """
set(CMAKE_BUILD_TYPE Release)
set(MORE "")
list(APPEND MORE "src/one.cpp" src/two.cpp)
include_directories(include)
file(GLOB NODES RELATIVE ${CMAKE_CURRENT_SOURCE_DIR}/src "src/*.cpp")
list(FILTER NODES EXCLUDE REGEX "^t.*")
foreach(each ${NODES})
  get_filename_component(name ${each} NAME_WE)
  string(TOUPPER "${name}" upper)
  add_executable(demo_${name} src/${each})
  target_compile_definitions(demo_${name} PRIVATE IS_${upper} $<$<CXX_COMPILER_ID:GNU>:BY_GNU> $<$<BOOL:OFF>:NEVER>)
endforeach()
function(add_node name)
  cmake_parse_arguments(NODE "" "KIND" "SOURCES" ${ARGN})
  if(NODE_KIND STREQUAL "object")
    add_library(${name}_objects OBJECT ${NODE_SOURCES})
    add_executable(${name} $<TARGET_OBJECTS:${name}_objects> src/one.cpp)
  else()
    add_executable(${name} ${NODE_SOURCES})
  endif()
  set(LAST ${name})
  set(LAST_NODE ${name} PARENT_SCOPE)
endfunction()
add_node(plain SOURCES ${MORE})
add_node(split KIND object SOURCES src/three)
if(DEFINED LAST OR NOT LAST_NODE STREQUAL "split")
  add_executable(wrong src/one.cpp)
endif()
target_include_directories(plain PUBLIC $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/more> $<INSTALL_INTERFACE:include>)
add_library(core INTERFACE)
set(at 0)
while(at LESS 3)
  math(EXPR at "${at} + 1")
  if(at EQUAL 2)
    continue()
  endif()
  add_library(part_${at} src/one.cpp)
endwhile()
set_property(TARGET part_1 PROPERTY COMPILE_DEFINITIONS FIRST=1)
include(cmake/extra.cmake)
add_subdirectory(inner)
"""
SIMPLE = """
catkin_simple(ALL_DEPS_REQUIRED)
cs_add_library(core core.cpp)
cs_add_library(own NO_AUTO_EXPORT own.cpp)
cs_add_executable(node NO_AUTO_DEP node.cpp)
target_link_libraries(node ${PROJECT_NAME}_core core)
cs_export()
"""
FILES = {
    "package.xml": MANIFEST,
    "CMakeLists.txt": HEAD + WHOLE,
    "cmake/extra.cmake": 'macro(more NAME)\nadd_executable(${NAME} ${ARGN})\nendmacro()\nmore(extra "src/two.cpp")\n',
    "inner/CMakeLists.txt": "more(inner in.cpp ${PROJECT_SOURCE_DIR}/src/one.cpp)\n",
    **dict.fromkeys(("src/one.cpp", "src/two.cpp", "src/three.cc", "inner/in.cpp", "include/a.h", "more/b.h"), ""),
}


def write(folder: Path, files: dict[str, str]) -> CppPackage:
    for name, text in files.items():
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_text(text, encoding="utf-8")
    return read_package(folder, "demo")


def made_by(folder: Path, cmake: str, *names: str) -> CppPackage:
    return write(folder, {"package.xml": MANIFEST, "CMakeLists.txt": HEAD + cmake, **dict.fromkeys(names, "")})


def test_targets_follow_cmake_s_language(tmp_path: Path) -> None:
    package = write(tmp_path, FILES)
    assert package.executables() == ["demo_one", "extra", "inner", "plain", "split"]
    made = {name: [each.name for each in source_files(target)] for name, target in package.targets.items()}
    assert made["plain"] == ["one.cpp", "two.cpp"]
    assert (made["split"], package.targets["split"].links) == (["one.cpp"], ["split_objects"])
    assert (made["split_objects"], made["inner"]) == (["three.cc"], ["in.cpp", "one.cpp"])
    assert package.targets["demo_one"].definitions == ["IS_ONE", "BY_GNU", "NDEBUG"]
    assert package.targets["plain"].includes == [tmp_path / "more", tmp_path / "include"]
    assert [name for name in package.targets if name.startswith("part")] == ["part_1", "part_3"]
    assert package.targets["part_1"].definitions == ["FIRST=1", "NDEBUG"]


@pytest.mark.slow
@pytest.mark.skipif(shutil.which("cmake") is None, reason="CMake is not installed")
def test_targets_equal_cmake_s_own(tmp_path: Path) -> None:
    package = write(tmp_path / "demo", FILES)
    cmake = by_cmake(tmp_path / "demo", tmp_path / "build")
    assert not isinstance(cmake, str), cmake
    assert len(cmake) == 8
    assert list(differences(cmake, by_reader(package))) == []


@pytest.mark.parametrize(
    ("there", "taken"),
    [(("node.cc", "node.cpp"), "node.cc"), (("node.cpp", "node.c"), "node.c"), (("node.C", "node.cxx"), "node.C")],
)
def test_source_without_suffix_is_found_in_the_order_of_cmake(
    there: tuple[str, ...], taken: str, tmp_path: Path
) -> None:
    package = made_by(tmp_path, "add_executable(node src/node)\n", *(f"src/{name}" for name in there))
    assert [each.name for each in source_files(package.targets["node"])] == [taken]


def test_source_without_suffix_is_missing_for_new_cmake_and_without_a_file(tmp_path: Path) -> None:
    made_by(tmp_path, "add_executable(node src/node)\n", "src/node.cpp")
    text = (tmp_path / "CMakeLists.txt").read_text(encoding="utf-8").replace("3.0.2", "3.20")
    (tmp_path / "CMakeLists.txt").write_text(text, encoding="utf-8")
    for folder in (tmp_path, tmp_path / "other"):
        if folder != tmp_path:
            made_by(folder, "add_executable(node src/node)\n")
        with pytest.raises(UsageError, match="node has a missing source: src/node"):
            program_of(read_package(folder, "demo"), "node", Packages(folder, {}))


def test_generated_source_is_named_as_such(tmp_path: Path) -> None:
    package = made_by(tmp_path, "add_executable(node ${CMAKE_CURRENT_BINARY_DIR}/made.cpp)\n")
    with pytest.raises(UsageError, match=r"missing source: made\.cpp: it is generated when CMake builds the package"):
        program_of(package, "node", Packages(tmp_path, {}))


def test_catkin_simple_finds_its_headers_and_exports_its_libraries(tmp_path: Path) -> None:
    package = made_by(tmp_path, SIMPLE, "core.cpp", "own.cpp", "node.cpp", "include/demo/core.h")
    assert package.targets["node"].includes == [tmp_path / "include"]
    assert package.targets["node"].sources == ["node.cpp"]
    assert (package.includes, package.exported) == ([tmp_path / "include"], ["core"])


@pytest.mark.parametrize(
    ("written", "values"),
    [
        ("$<$<AND:$<PLATFORM_ID:Linux>,$<NOT:$<CONFIG:Debug>>>:A>", ["A"]),
        ("$<IF:$<STREQUAL:a,b>,A,B>", ["B"]),
        ("$<$<TARGET_EXISTS:node>:A;B>", ["A", "B"]),
        ("$<LOWER_CASE:A>$<COMMA>b", ["a,b"]),
        ("$<UNKNOWN:x>", []),
        ("$<$<OR:0,1>", []),
    ],
)
def test_generator_expression_has_the_value_of_the_build(written: str, values: list[str], tmp_path: Path) -> None:
    cmake = f"add_executable(node node.cpp)\ntarget_compile_definitions(node PRIVATE {written})\n"
    assert made_by(tmp_path, cmake, "node.cpp").targets["node"].definitions == values


def test_definitions_in_a_named_folder_are_found(tmp_path: Path) -> None:
    cmake = "add_message_files(DIRECTORY msg/more FILES Far.msg)\nadd_service_files(\n  DIRECTORY calls FILES Do.srv)\n"
    cmake += "# add_action_files(DIRECTORY acts)\n"
    made_by(tmp_path, cmake)
    for name, text in {
        "msg/more/Far.msg": "int32 x\n",
        "calls/Do.srv": "---\n",
        "acts/Go.action": "---\n---\n",
    }.items():
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_text(text, encoding="utf-8")
    library = Library([OnDisk(Packages(tmp_path / "CMakeLists.txt", {}))])
    assert library.names("demo") == ["Far"]
    assert library.names("demo", "srv") == ["Do"]
