"""Small nodes of roscpp have the same output on cfepy as recorded with Debian's roscpp (`dev.roscfe.probing`)."""

from __future__ import annotations

from pathlib import Path

import pytest

from dev.roscfe.building import needs_cpp
from dev.roscfe.probing import NAMES, PROBES, fly

pytestmark = [pytest.mark.slow, needs_cpp]


@pytest.mark.parametrize("name", NAMES)
def test_probe_prints_the_recorded_output(name: str, tmp_path: Path) -> None:
    assert fly(name, tmp_path) == (PROBES / f"{name}.txt").read_text(encoding="utf-8").splitlines()
