"""Damaged commands through CI_LAB: no application dies, and a counter records every one of them."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.apps.uplink_fuzz import CI_LAB, SAMPLE, fly


def survive(folder: Path, seed: int, count: int, monkeypatch: pytest.MonkeyPatch) -> None:
    """Send damaged commands and check the books."""
    books = fly(folder, seed, count, monkeypatch)
    assert books.refused + books.deliverable == count
    assert min(books.refused, books.handled[SAMPLE], books.handled[CI_LAB]) > count // 200  # all kinds occur


@pytest.mark.parametrize(
    ("seed", "count"), [(3, 2_000), *(pytest.param(seed, 5_000, marks=pytest.mark.slow) for seed in (1, 2))]
)
def test_thousands_of_damaged_commands(tmp_path: Path, seed: int, count: int, monkeypatch: pytest.MonkeyPatch) -> None:
    survive(tmp_path, seed, count, monkeypatch)


@pytest.mark.slow
def test_a_quarter_of_a_million_damaged_commands(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    survive(tmp_path, 3, 250_000, monkeypatch)


BROKE = {
    "a file name that is no UTF-8": "1804c00200410266" + "2f63662fdcb0" + "ff" * 58,
    "an address that is no UTF-8": "1880c0000011069b" + "ff" * 16,
    "an application name that is no UTF-8": "1806c00000150866" + "fe" * 20,
}


@pytest.mark.parametrize("name", BROKE)
def test_texts_with_invalid_bytes_do_no_harm(tmp_path: Path, name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    packet = bytes.fromhex(BROKE[name])
    monkeypatch.setattr("tests.apps.uplink_fuzz.damaged", lambda seed, count: iter([packet] * count))
    books = fly(tmp_path, 0, 3, monkeypatch)
    assert books.deliverable == 3
