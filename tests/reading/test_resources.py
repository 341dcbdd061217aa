"""Shipped files are found."""

from __future__ import annotations

import pytest

from cfepy.reading.resources import shipped
from cfepy.status import UsageError


def test_boards_are_found() -> None:
    assert (shipped("boards") / "rx64m.yaml").is_file()


def test_unknown_kind_names_the_searched_folders() -> None:
    with pytest.raises(UsageError, match="nonsense missing"):
        shipped("nonsense")
