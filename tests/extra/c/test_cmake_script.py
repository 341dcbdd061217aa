"""The reader of CMake's language: the meaning of commands, words and conditions, and its limits."""

from __future__ import annotations

from pathlib import Path

import pytest

from cfepy.extra.c.toolchain.cmake_script import CMakeScript
from cfepy.status import UsageError


def values(folder: Path, text: str, name: str = "r") -> list[str]:
    """Return the final value of a variable after a text."""
    script = CMakeScript(folder, {"UNIX": ["1"]})
    script.run(text)
    return script.variables.get(name, [])


@pytest.mark.parametrize(
    ("text", "found"),
    [
        ("set(r a b;c)", ["a", "b", "c"]),
        ('set(r "a b" c) # not d', ["a b", "c"]),
        ('set(r "a # b")', ["a # b"]),
        ("set(r a #[[ b\n c ]] d)", ["a", "d"]),
        ("#[==[ set(r x) ]==]\nset(r a)", ["a"]),
        ("set(x a b)\nset(r ${x} ${x}c)", ["a", "b", "a", "bc"]),
        ("set(x y)\nset(y z)\nset(r ${${x}})", ["z"]),
        ("foreach(i RANGE 1 3)\nlist(APPEND r ${i})\nendforeach()", ["1", "2", "3"]),
        ("foreach(i IN ITEMS a b)\nlist(APPEND r ${i})\nendforeach()", ["a", "b"]),
        ("function(f a)\nset(r ${a} ${ARGN} PARENT_SCOPE)\nendfunction()\nf(1 2 3)", ["1", "2", "3"]),
        ("if(NOT NOT UNIX AND (X OR (UNIX AND NOT X)))\nset(r yes)\nendif()", ["yes"]),
        ("set(l a b)\nlist(FIND l b r)", ["1"]),
        ("list(FIND nothing b r)", ["-1"]),
        ('string(TOUPPER "have_${x}" r)', ["HAVE_"]),
        ("string(TOLOWER Ab r)", ["ab"]),
        (
            "set(x 10)\nif(x GREATER_EQUAL 9 AND x GREATER 9 AND 9 LESS x AND 9 LESS_EQUAL 9)\nset(r yes)\nendif()",
            ["yes"],
        ),
        ("set(r no)\nif(-1 GREATER_EQUAL 0 OR x GREATER_EQUAL 0 OR 1 LESS y)\nset(r yes)\nendif()", ["no"]),
        ("if(1.10 VERSION_GREATER 1.9 AND 01 VERSION_EQUAL 1)\nset(r yes)\nendif()", ["yes"]),
        ("if(X)\nif(UNIX)\nset(r no)\nendif()\nelseif(UNIX)\nset(r yes)\nelse()\nset(r no)\nendif()", ["yes"]),
        ("set(r a b a)\nlist(REMOVE_ITEM r a)", ["b"]),
        ("set(r a)\nset(q (\nset(r b)", ["a"]),
    ],
)
def test_a_text_sets_a_variable(text: str, found: list[str], tmp_path: Path) -> None:
    assert values(tmp_path, text) == found


def test_patterns_find_files(tmp_path: Path) -> None:
    for name in ("a.cpp", "b.c", "in/c.cpp", "in/deep/d.cpp", ".h/e.cpp"):
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).touch()
    (tmp_path / "in/round").symlink_to(tmp_path)
    for pattern, found in (
        ("*.cpp", ["a.cpp"]),
        ("in/*.cpp *.c", ["in/c.cpp", "b.c"]),
        ("./in//c.cpp", ["in/c.cpp"]),
        ("i?/*/*.cpp", ["in/deep/d.cpp", "in/round/a.cpp"]),
        ("none/*", []),
        ("/etc/*", []),
    ):
        assert values(tmp_path, f"file(GLOB r {pattern})") == found
    deep = [".h/e.cpp", "a.cpp", "in/c.cpp", "in/deep/d.cpp"]
    assert values(tmp_path, "file(GLOB_RECURSE r *.cpp)") == deep
    assert values(tmp_path / "in", "file(GLOB r ../*.cpp)") == ["../a.cpp"]


def test_commands_of_a_file_count_for_all_its_subfolders(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("cfepy.extra.c.toolchain.cmake_budget.CMAKE_COMMANDS", 100)
    outer = CMakeScript(tmp_path, {})
    outer.run("set(r a)\n" * 60)
    inner = CMakeScript(tmp_path / "in", outer.variables, outer.budget)
    with pytest.raises(UsageError, match=r"CMakeLists\.txt: executes more than 100 commands") as caught:
        inner.run("set(r a)\n" * 60)
    assert caught.value.file == str(tmp_path / "CMakeLists.txt")


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("foreach(i RANGE 0 999999)\nendforeach()", "a loop of 1,000,000 iterations|a loop of 999,999 iterations"),
        ("macro(f)\nf()\nendmacro()\nf()", "nested"),
        ("set(a x)\n" + 'set(a "${a}${a}")\n' * 40, "more than 10,000,000 characters"),
        ("if(" + "(" * 50 + "UNIX" + ")" * 50 + ")\nendif()", "nested"),
    ],
)
def test_a_file_without_end_is_refused(text: str, said: str, tmp_path: Path) -> None:
    with pytest.raises(UsageError, match=said):
        values(tmp_path, text)


def test_long_list_can_grow_by_one_word_at_a_time(tmp_path: Path) -> None:
    word = "/" + 80 * "a"
    text = f"foreach(i RANGE 1 700)\nlist(APPEND r {word})\nendforeach()"
    assert len(values(tmp_path, text)) == 700
