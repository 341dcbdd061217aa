"""The core flies without its add-ons: each is taken out of a copy, and the rest still works."""

from __future__ import annotations

from pathlib import Path

import pytest

from dev.take_out import ALL, NAMES, Copy

pytestmark = pytest.mark.slow


@pytest.mark.parametrize("name", [*NAMES, ALL])
def test_core_flies_without_an_add_on(name: str, tmp_path: Path) -> None:
    copy = Copy(tmp_path / "cfepy", NAMES if name == ALL else [name])
    for tried in copy.flights():
        assert not tried.trouble, tried.what


def test_computer_needs_no_add_on(tmp_path: Path) -> None:
    tried = Copy(tmp_path / "cfepy", NAMES).computer()
    assert not tried.trouble
