"""`cfepy convert --cmake`: the sources of a node are those that CMake lists."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest

from cfepy.cli.main import main
from cfepy.extra.convert.cmake_answers import CMakeAnswers
from cfepy.extra.convert.packages import read_package
from cfepy.status import UsageError

CMAKE = """cmake_minimum_required(VERSION 3.0.2)
project(demo CXX)
execute_process(COMMAND ${CMAKE_COMMAND} -E echo more OUTPUT_VARIABLE more OUTPUT_STRIP_TRAILING_WHITESPACE)
add_library(core src/${more}.cpp)
target_include_directories(core PUBLIC include /usr/include)
target_compile_definitions(core PUBLIC ${more}=1)
add_executable(node src/node.cpp)
target_link_libraries(node core)
"""
NODE = "#include <ros/ros.h>\nint main() { return 0; }\n"

needs_cmake = pytest.mark.skipif(shutil.which("cmake") is None, reason="CMake is not installed")


def package(folder: Path, cmake: str = CMAKE) -> Path:
    files = {"CMakeLists.txt": cmake, "package.xml": "<package><name>demo</name></package>", "src/node.cpp": NODE}
    for name, text in {**files, "src/more.cpp": "", "include/demo.h": ""}.items():
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_text(text, encoding="utf-8")
    return folder


@needs_cmake
@pytest.mark.slow
def test_targets_come_from_cmake(tmp_path: Path) -> None:
    found = read_package(package(tmp_path), "demo")
    assert found.targets["core"].sources == ["src/.cpp"]
    CMakeAnswers().adjust(found)
    core, node = found.targets["core"], found.targets["node"]
    assert (core.sources, core.definitions, core.includes) == (["src/more.cpp"], ["more=1"], [tmp_path / "include"])
    assert (node.sources, node.links, node.includes) == (["src/node.cpp"], ["core"], [tmp_path / "include"])


@needs_cmake
@pytest.mark.slow
def test_conversion_says_that_it_asks_cmake(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    folder = package(tmp_path / "demo")
    words = ["convert", str(folder), "-o", str(tmp_path / "out"), "--no-check"]
    assert main([*words, "--cmake"]) == 0
    assert "the sources of nodes are those that CMake 3" in capsys.readouterr().err
    assert main(["convert", "check", str(folder), "--cmake"]) == 2


@needs_cmake
@pytest.mark.slow
def test_error_of_cmake_is_reported(tmp_path: Path) -> None:
    found = read_package(package(tmp_path, CMAKE + 'message(FATAL_ERROR "no such thing")\n'), "demo")
    with pytest.raises(UsageError, match=r"CMake cannot configure it: .*no such thing"):
        CMakeAnswers().adjust(found)


def test_missing_cmake_is_reported(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("PATH", "/nowhere")
    with pytest.raises(UsageError, match="CMake is not installed"):
        CMakeAnswers()
