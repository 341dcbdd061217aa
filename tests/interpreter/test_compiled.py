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


def test_checkout_without_a_build_is_interpreted(root: Path) -> None:
    assert compiled.state() == "kernel and bus interpreted"


def test_compiled_modules_are_reported(root: Path) -> None:
    build(root)
    assert compiled.state() == "kernel and bus compiled"


@pytest.mark.parametrize("module", compiled.MODULES)
def test_changed_source_is_reported_as_not_matching_the_build(root: Path, module: str) -> None:
    build(root)
    with (root / module).open("a") as file:
        file.write("# more\n")
    assert compiled.state().startswith("the compiled kernel and bus do not match the sources here; build them again")


def test_incomplete_build_is_reported(root: Path) -> None:
    build(root)
    for path in root.glob("cfepy_*"):
        path.unlink()
    assert compiled.state().startswith("the compiled kernel and bus do not match")


def test_mypyc_attr_returns_the_class_unchanged() -> None:
    class Plain:
        pass

    assert compiled.mypyc_attr(allow_interpreted_subclasses=True)(Plain) is Plain
