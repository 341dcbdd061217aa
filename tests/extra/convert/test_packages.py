"""The C++ parts of a catkin package: targets, sources, definitions, libraries, plugins."""

from __future__ import annotations

from pathlib import Path

import pytest

from cfepy.extra.convert import catkin_reader
from cfepy.extra.convert.packages import program_of, read_package
from cfepy.status import UsageError
from rospy_shim.types.msgs import Packages

CMAKE = """
cmake_minimum_required(VERSION 3.0.2)
project(demo)
find_package(catkin REQUIRED COMPONENTS roscpp std_msgs helpers)
find_package(PCL REQUIRED)
find_package(Qt5 COMPONENTS Core)
set(CMAKE_CXX_FLAGS "${CMAKE_CXX_FLAGS} -O3 -DFAST")
add_definitions(-DRATE=10 -Wall)
include_directories(include ${catkin_INCLUDE_DIRS})
catkin_package(INCLUDE_DIRS include LIBRARIES ${PROJECT_NAME}_core CATKIN_DEPENDS roscpp)
file(GLOB CORE ${CMAKE_CURRENT_SOURCE_DIR}/src/core/*.cpp)
add_library(${PROJECT_NAME}_core ${CORE})
if(NOT WIN32 AND (UNIX OR APPLE))
  target_compile_definitions(${PROJECT_NAME}_core PRIVATE ON_UNIX=1)
endif()
if(Qt5_FOUND)
  add_executable(window src/window.cpp)
endif()
macro(node NAME)
  add_executable(${NAME} src/${NAME}.cpp)
  target_link_libraries(${NAME} PRIVATE ${PROJECT_NAME}_core ${catkin_LIBRARIES} ${PCL_LIBRARIES} pthread)
endmacro()
foreach(each talker listener)
  node(${each})
endforeach()
set_target_properties(listener PROPERTIES OUTPUT_NAME hearer PREFIX "")
if(CATKIN_ENABLE_TESTING)
  catkin_add_gtest(test_core test/test_core.cpp)
endif()
add_subdirectory(more)
"""
MANIFEST = """<package format="2"><name>demo</name><depend>roscpp</depend><exec_depend>helpers</exec_depend>
  <export><nodelet plugin="${prefix}/nodelets.xml"/></export></package>"""
NODELETS = """<library path="lib/libdemo_core">
  <class name="demo/Filter" type="demo::Filter" base_class_type="nodelet::Nodelet"/></library>"""
HELPERS = """
project(helpers)
include_directories(include)
add_library(helping lib/helping.cc)
catkin_package(INCLUDE_DIRS include LIBRARIES helping)
"""
FILES = {
    "demo/CMakeLists.txt": CMAKE,
    "demo/package.xml": MANIFEST,
    "demo/nodelets.xml": NODELETS,
    "demo/include/demo/core.h": "",
    "demo/src/core/a.cpp": "",
    "demo/src/core/b.cpp": "",
    "demo/src/talker.cpp": "#include <helpers.h>\n",
    "demo/more/CMakeLists.txt": "rosbuild_add_executable(old ${CMAKE_CURRENT_SOURCE_DIR}/old.cpp gone.cpp)\n",
    "demo/more/old.cpp": "",
    "helpers/CMakeLists.txt": HELPERS,
    "helpers/package.xml": "<package><name>helpers</name></package>",
    "helpers/include/helpers.h": "",
    "helpers/lib/helping.cc": "",
}


def write(folder: Path, files: dict[str, str]) -> None:
    for name, text in files.items():
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_text(text, encoding="utf-8")


def test_package_is_parsed_as_by_catkin(tmp_path: Path) -> None:
    write(tmp_path, FILES)
    package = read_package(tmp_path / "demo", "demo")
    assert package.executables() == ["hearer", "old", "talker"]
    assert package.exported == ["demo_core"]
    assert package.plugins["demo/Filter"].library == "demo_core"
    program = program_of(package, "talker", Packages(tmp_path / "demo/src/talker.cpp", {}), ours=["roscpp"])
    names = [str(each.relative_to(tmp_path)) for each in program.sources]
    assert names == ["demo/src/talker.cpp", "demo/src/core/a.cpp", "demo/src/core/b.cpp", "helpers/lib/helping.cc"]
    assert [str(each.relative_to(tmp_path)) for each in program.includes] == ["demo/include", "helpers/include"]
    assert program.definitions == ['ROS_PACKAGE_NAME="demo"', "RATE=10", "FAST", "ON_UNIX=1"]
    assert program.outside == ["PCL"]


def test_plugin_file_with_several_libraries_is_read(tmp_path: Path) -> None:
    more = NODELETS.replace("demo/Filter", "demo/Other").replace("libdemo_core", "libother")
    write(tmp_path, FILES | {"demo/nodelets.xml": f'<?xml version="1.0"?>\n{NODELETS}\n{more}\n'})
    found = read_package(tmp_path / "demo", "demo").nodelets()
    assert {name: each.library for name, each in found.items()} == {"demo/Filter": "demo_core", "demo/Other": "other"}


def test_eigen_headers_exported_by_a_package_reach_its_users(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    eigen = tmp_path / "eigen3"
    eigen.mkdir()
    monkeypatch.setattr(catkin_reader, "EIGEN", str(eigen))
    write(tmp_path, {**FILES, "helpers/CMakeLists.txt": "project(helpers)\ncatkin_package(DEPENDS EIGEN3)\n"})
    package = read_package(tmp_path / "demo", "demo")
    program = program_of(package, "talker", Packages(tmp_path / "demo/src/talker.cpp", {}), ours=["roscpp"])
    assert eigen in program.includes


@pytest.mark.parametrize(("text", "is_linked"), [("", False), ("#include <helpers.h>\n", True)])
def test_library_of_another_package_is_linked_only_if_its_headers_are_included(
    text: str, is_linked: bool, tmp_path: Path
) -> None:
    write(tmp_path, {**FILES, "demo/src/talker.cpp": text})
    package = read_package(tmp_path / "demo", "demo")
    program = program_of(package, "talker", Packages(tmp_path / "demo/src/talker.cpp", {}), ours=["roscpp"])
    assert (tmp_path / "helpers/lib/helping.cc" in program.sources) is is_linked
    assert tmp_path / "helpers/include" in program.includes


def test_library_behind_a_header_of_a_library_is_linked(tmp_path: Path) -> None:
    more = {
        "helpers/CMakeLists.txt": f"{HELPERS}find_package(catkin REQUIRED COMPONENTS deep)\n",
        "helpers/lib/helping.cc": "#include <deep/deep.h>\n",
        "deep/package.xml": "<package><name>deep</name></package>",
        "deep/CMakeLists.txt": "project(deep)\nadd_library(deep deep.cpp)\n"
        "catkin_package(INCLUDE_DIRS include LIBRARIES deep)\n",
        "deep/include/deep/deep.h": "",
        "deep/deep.cpp": "",
    }
    write(tmp_path, FILES | more)
    package = read_package(tmp_path / "demo", "demo")
    program = program_of(package, "talker", Packages(tmp_path / "demo/src/talker.cpp", {}), ours=["roscpp"])
    assert program.sources[-2:] == [tmp_path / "helpers/lib/helping.cc", tmp_path / "deep/deep.cpp"]


def test_all_libraries_are_linked_if_a_source_is_too_large_to_be_read(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    write(tmp_path, FILES | {"demo/src/talker.cpp": "// " + "x" * 100})
    monkeypatch.setattr("cfepy.extra.convert.cpp_sources.CPP_BYTES", 50)
    package = read_package(tmp_path / "demo", "demo")
    program = program_of(package, "talker", Packages(tmp_path / "demo/src/talker.cpp", {}), ours=["roscpp"])
    assert tmp_path / "helpers/lib/helping.cc" in program.sources


def test_missing_target_is_reported(tmp_path: Path) -> None:
    write(tmp_path, FILES)
    package = read_package(tmp_path / "demo", "demo")
    known = Packages(tmp_path / "demo/src/talker.cpp", {})
    with pytest.raises(UsageError, match=r"has no C\+\+ node 'walker'; did you mean talker?"):
        program_of(package, "walker", known)
    with pytest.raises(UsageError, match=r"old has a missing source: gone\.cpp"):
        program_of(package, "old", known)
