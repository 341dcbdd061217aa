"""The output of a conversion stays below its folder, with any names, lists of files and links."""

from __future__ import annotations

import json
import shutil
import subprocess
from hashlib import sha256
from pathlib import Path

import pytest

from cfepy.extra.convert.output import MANIFEST, write_files
from cfepy.extra.convert.project import cmake_word
from cfepy.status import UsageError

PACKAGE = Path("/package")


def test_files_are_written_and_obsolete_ones_removed(tmp_path: Path) -> None:
    out = tmp_path / "out"
    assert write_files(out, {"a/b": b"1", "c": b"2"}) == ["a/b", "c"]
    assert write_files(out, {"a/b": b"1", "d": b"3"}) == ["d"]
    assert sorted(each.name for each in out.rglob("*") if each.is_file()) == [MANIFEST, "b", "d"]


@pytest.mark.parametrize("name", ["../x", "/x", "a/../../x", "a/./b", "a\0b", "", "a//b", "a/"])
def test_path_outside_the_folder_is_refused_before_writing(name: str, tmp_path: Path) -> None:
    out = tmp_path / "out"
    with pytest.raises(UsageError, match="is outside the target folder"):
        write_files(out, {"good": b"1", name: b"2"}, force=True)
    assert not out.exists()


def test_a_link_in_the_folder_is_not_followed(tmp_path: Path) -> None:
    out, elsewhere = tmp_path / "out", tmp_path / "elsewhere"
    out.mkdir()
    elsewhere.mkdir()
    (elsewhere / "file").write_bytes(b"mine")
    for name, target in (("folder", elsewhere), ("file", elsewhere / "file"), (MANIFEST, elsewhere / "file")):
        (out / name).symlink_to(target)
        with pytest.raises(UsageError, match="through a symbolic link"):
            write_files(out, {"folder/file": b"1", "file": b"2"}, force=True)
        (out / name).unlink()
    assert [each.name for each in elsewhere.iterdir()] == ["file"]
    assert (elsewhere / "file").read_bytes() == b"mine"
    assert list(out.iterdir()) == []


@pytest.mark.parametrize("name", ["../victim", "link/victim", "/victim"])
def test_manifest_never_removes_files_outside_the_folder(name: str, tmp_path: Path) -> None:
    """The list may come from a foreign source: the folder of a package can be that of its conversion."""
    out = tmp_path / "out"
    out.mkdir()
    (tmp_path / "victim").write_bytes(b"mine")
    (out / "link").symlink_to(tmp_path)
    (out / MANIFEST).write_text(json.dumps({name: sha256(b"mine").hexdigest()}), encoding="utf-8")
    if name.startswith("link"):
        with pytest.raises(UsageError, match="through a symbolic link"):
            write_files(out, {"a": b"1"}, force=True)
    else:
        write_files(out, {"a": b"1"}, force=True)
    assert (tmp_path / "victim").read_bytes() == b"mine"


@pytest.mark.parametrize("text", ["[" * 100_000, "{", "[1]", '{"a": 1}', "\0"])
def test_damaged_manifest_is_replaced(text: str, tmp_path: Path) -> None:
    (tmp_path / MANIFEST).write_text(text, encoding="utf-8")
    write_files(tmp_path, {"a": b"1"})
    assert list(json.loads((tmp_path / MANIFEST).read_text(encoding="utf-8"))) == ["a"]


WORDS = (
    "src/a.cpp",
    "src/a b.cpp",
    "src/$HOME.cpp",
    'A="b"',
    'A="b c"',
    "A=\\d$x",
    "a(b)c",
    "a#b",
    "ä'b",
    "${x}",
    "@x@",
)


@pytest.mark.parametrize("word", WORDS)
def test_quoted_word_is_unchanged_by_cmake(word: str, tmp_path: Path) -> None:
    cmake = shutil.which("cmake")
    if cmake is None:
        pytest.skip("there is no cmake")
    script = tmp_path / "x.cmake"
    script.write_text(f'function(show)\nlist(LENGTH ARGN n)\nmessage("${{n}}:${{ARGN}}")\nendfunction()\n'
                      f"show({cmake_word(word, PACKAGE)})\n", encoding="utf-8")  # fmt: skip
    done = subprocess.run([cmake, "-P", str(script)], capture_output=True, text=True, check=True)
    assert done.stderr.rstrip("\n") == f"1:{word}"


@pytest.mark.parametrize(
    "word", ["a;b", "a\nb", "a\0b", "[a", "a]", "$<1:a>", "a\\", ")\nexecute_process(COMMAND x", "a\x1b"]
)
def test_word_that_cmake_would_split_is_refused(word: str) -> None:
    with pytest.raises(UsageError, match="CMake does not allow"):
        cmake_word(word, PACKAGE)
