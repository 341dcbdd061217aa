"""Whether the kernel and the bus are compiled, and from which sources. All tests also run compiled (`.ci/run`)."""

from __future__ import annotations

from importlib.machinery import EXTENSION_SUFFIXES
from pathlib import Path

import pytest

from cfepy.interpreter import compiled

SUFFIX = EXTENSION_SUFFIXES[0]


@pytest.fixture
def root(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder with the sources alone."""
    for module in compiled.MODULES:
        (tmp_path / module).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / module).write_bytes((compiled.ROOT / module).read_bytes())
    monkeypatch.setattr(compiled, "ROOT", tmp_path)
    return tmp_path


def build(root: Path) -> None:
    """Create files with the names of mypyc's results."""
    for module in compiled.MODULES:
        (root / module).with_suffix(SUFFIX).touch()
    (root / f"{compiled.library_name(root)}__mypyc{SUFFIX}").touch()


def test_sources_alone_are_interpreted(root: Path) -> None:
    assert compiled.state() == "kernel and bus interpreted"


def test_what_was_compiled_is_told(root: Path) -> None:
    build(root)
    assert compiled.state() == "kernel and bus compiled"


@pytest.mark.parametrize("module", compiled.MODULES)
def test_a_source_that_was_changed_since_is_told(root: Path, module: str) -> None:
    build(root)
    with (root / module).open("a") as file:
        file.write("# more\n")
    assert compiled.state().startswith("the compiled kernel and bus do not match the sources here; build them again")


def test_parts_of_a_build_are_told(root: Path) -> None:
    build(root)
    for path in root.glob("cfepy_*"):
        path.unlink()
    assert compiled.state().startswith("the compiled kernel and bus do not match")


def test_what_mypyc_is_told_of_a_class_leaves_it_as_it_is() -> None:
    class Plain:
        pass

    assert compiled.mypyc_attr(allow_interpreted_subclasses=True)(Plain) is Plain
