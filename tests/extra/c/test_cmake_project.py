"""A CMake project read without CMake: scopes of folders, properties of targets, and expressions about them."""

from __future__ import annotations

from pathlib import Path

import pytest

from cfepy.extra.c.toolchain.cmake_project import Project, ProjectScript
from cfepy.extra.c.toolchain.source_files import find_sources
from cfepy.status import UsageError


def project_of(folder: Path, text: str, files: dict[str, str] | None = None) -> Project:
    """Read a CMakeLists.txt, with other files beside it."""
    for name, content in {"CMakeLists.txt": text, **(files or {})}.items():
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_text(content, encoding="utf-8")
    project = Project(folder / "CMakeLists.txt")
    project.root = ProjectScript(project, folder, {})
    project.add_folder(folder, project.root)
    return project


def includes(project: Project, name: str) -> list[str]:
    """Return the include folders of a target, relative to the project's folder."""
    assert project.root is not None
    target = project.targets.all[name]
    return [Path(each).relative_to(project.root.folder).as_posix() for each in project.targets.includes(target)]


def test_subfolder_inherits_settings_that_come_before_it(tmp_path: Path) -> None:
    text = """
        include_directories(a)
        add_definitions(-DA)
        set(X outer)
        add_subdirectory(in)
        include_directories(b)
        add_library(outer MODULE ${X}.c)
    """
    inner = "include_directories(c)\nadd_library(inner MODULE i.c)\nset(X ${X}2 PARENT_SCOPE)\nset(X mine)\n"
    project = project_of(tmp_path, text, {"in/CMakeLists.txt": inner})
    assert includes(project, "inner") == ["a", "in/c"]
    assert includes(project, "outer") == ["a", "b"]
    assert project.targets.definitions(project.targets.all["inner"]) == ["A"]
    assert project.targets.sources(project.targets.all["outer"]) == [str(tmp_path / "outer2.c")]


@pytest.mark.parametrize(
    ("text", "found"),
    [
        ("target_include_directories(x PRIVATE own)", ["own"]),
        ("target_include_directories(x PRIVATE $<BUILD_INTERFACE:own> $<INSTALL_INTERFACE:no>)", []),
        ("add_library(l INTERFACE)\ntarget_include_directories(l INTERFACE i)\ntarget_link_libraries(x l)", ["i"]),
        ("add_library(l STATIC l.c)\ntarget_include_directories(l PRIVATE p)\ntarget_link_libraries(x l)", []),
        ("add_library(l STATIC l.c)\ntarget_include_directories(l PUBLIC p)\ntarget_link_libraries(x l)", ["p"]),
        (
            "add_library(l INTERFACE)\ntarget_include_directories(l INTERFACE i)\n"
            "target_include_directories(x PRIVATE $<TARGET_PROPERTY:l,INTERFACE_INCLUDE_DIRECTORIES>)",
            ["i"],
        ),
        ("target_include_directories(x PRIVATE $<TARGET_PROPERTY:gone,INTERFACE_INCLUDE_DIRECTORIES>)", []),
    ],
)
def test_target_has_the_folders_of_its_properties_and_links(text: str, found: list[str], tmp_path: Path) -> None:
    project = project_of(tmp_path, f"add_library(x MODULE x.c)\n{text}\n")
    expected = found if "BUILD_INTERFACE" not in text else ["own"]
    named = [each.removeprefix(f"{tmp_path}/") for each in project.targets.includes(project.targets.all["x"])]
    assert named == expected


def test_targets_that_refer_to_each_other_end(tmp_path: Path) -> None:
    text = "".join(
        f"add_library({one} INTERFACE)\ntarget_include_directories({one} INTERFACE {one} "
        f"$<TARGET_PROPERTY:{other},INTERFACE_INCLUDE_DIRECTORIES>)\ntarget_link_libraries({one} INTERFACE {other})\n"
        for one, other in (("a", "b"), ("b", "a"))
    )
    project = project_of(tmp_path, text + "add_library(x MODULE x.c)\ntarget_link_libraries(x a)\n")
    assert sorted(includes(project, "x")) == ["a", "b"]


def test_many_targets_that_refer_to_all_others_take_little_work(tmp_path: Path) -> None:
    names = [f"t{number}" for number in range(24)]
    lines = []
    for at, name in enumerate(names):
        lines.append(f"add_library({name} OBJECT {name}.c)\ntarget_include_directories({name} PUBLIC {name}")
        lines += [f"  $<TARGET_PROPERTY:{each},INTERFACE_INCLUDE_DIRECTORIES>" for each in names[:at]]
        lines.append(f")\ntarget_link_libraries({name} PUBLIC {' '.join(names[:at])})")
    project = project_of(tmp_path, "\n".join(lines))
    assert sorted(includes(project, names[-1])) == sorted(names)


def test_error_in_a_function_keeps_the_scope_of_its_file(tmp_path: Path) -> None:
    inner = 'set(X inner)\nfunction(f)\nset(Y own)\nmessage(FATAL_ERROR "bad")\nendfunction()\nf()\nset(Z no)\n'
    text = "set(X outer)\nadd_subdirectory(in)\nadd_library(x MODULE ${X}.c ${Y}.c)\n"
    project = project_of(tmp_path, text, {"in/CMakeLists.txt": inner})
    assert [each.text for each in project.notes] == ["bad"]
    assert project.targets.all["x"].sources == [str(tmp_path / "outer.c"), str(tmp_path / ".c")]


@pytest.mark.parametrize("prefix", ["", "../one/"])
def test_sources_of_a_relative_folder_are_relative(
    prefix: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    folder = tmp_path / "one"
    (folder / "src").mkdir(parents=True)
    (folder / "src/a.c").touch()
    (folder / "CMakeLists.txt").write_text("file(GLOB FILES src/*.c)\nadd_cfe_app(one ${FILES})\n", encoding="utf-8")
    monkeypatch.chdir(tmp_path if not prefix else folder)
    given = Path(prefix or "one")
    assert find_sources(given).code == [given / "src/a.c"]


def test_missing_source_is_named_with_its_custom_command(tmp_path: Path) -> None:
    text = "add_custom_command(OUTPUT made.c COMMAND make_it VERBATIM)\nadd_cfe_app(one made.c)\n"
    (tmp_path / "CMakeLists.txt").write_text(text, encoding="utf-8")
    with pytest.raises(UsageError, match=r"missing file: made\.c, which a custom command of the build makes: make_it"):
        find_sources(tmp_path)


def test_missing_source_of_a_submodule_is_named_with_its_url(tmp_path: Path) -> None:
    modules = '[submodule "core"]\n\tpath = one/core\n\turl = https://example.org/core.git\n'
    (tmp_path / "one/core").mkdir(parents=True)
    (tmp_path / ".gitmodules").write_text(modules, encoding="utf-8")
    (tmp_path / "one/CMakeLists.txt").write_text("add_cfe_app(one core/a.c)\n", encoding="utf-8")
    with pytest.raises(UsageError, match=r"core/a\.c, which is in a git submodule .*https://example\.org/core\.git"):
        find_sources(tmp_path / "one")
