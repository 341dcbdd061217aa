"""The whole library on computers of other kinds, big-endian and of 32 bits: nodes have the same output as with roscpp.

The probes of `dev.roscfe.probing` run with a stand-in for cFE, here and emulated.
"""

from __future__ import annotations

from pathlib import Path

import pytest

from dev.roscfe.building import needs_cpp, target_named
from dev.roscfe.probing import PROBES
from tests.roscfe.alone import Alone

pytestmark = [pytest.mark.slow, needs_cpp]
NODES = ("actions", "clouds", "logs", "names", "params", "timers", "topics", "values")
"""Probes whose topics have MsgIds there (`tests.roscfe.alone.TOPICS`)."""
NUMERIC = ("clouds",)
"""Those that call libm, whose sines differ in the last bit between computers."""


@pytest.mark.parametrize("target", ["here", "powerpc", "arm"])
def test_probes_print_the_recorded_output(tmp_path: Path, target: str) -> None:
    nodes = [PROBES / f"{name}.cpp" for name in NODES if target == "here" or name not in NUMERIC]
    alone = Alone(tmp_path, nodes, target_named(target))
    for node in nodes:
        assert alone.fly(node) == node.with_suffix(".txt").read_text(encoding="utf-8").splitlines(), node.stem
