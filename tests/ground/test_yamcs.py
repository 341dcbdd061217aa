"""A real Yamcs with our XTCE: docs/how_to/ground_tools.md, and all commands and telemetry of the shipped missions."""

from __future__ import annotations

import re
import shutil
from pathlib import Path

import pytest

from tests.ground import yamcs
from tests.ground.test_xtce_missions import MISSIONS
from tests.own_network import needs_own_network, run_in_own_network

pytestmark = [
    pytest.mark.slow,
    needs_own_network,
    pytest.mark.skipif(not yamcs.is_installed(), reason=f"{yamcs.VARIABLE} names no folder with a Yamcs"),
]
FLIGHT = "tests.ground.yamcs_flight"


@pytest.mark.skipif(shutil.which("yamcs") is None, reason="yamcs-cli is not installed")
def test_loop_of_the_page_works_with_yamcs(tmp_path: Path) -> None:
    run_in_own_network(FLIGHT, "loop", cwd=tmp_path)


def test_every_command_and_packet_of_every_mission(tmp_path: Path) -> None:
    said = run_in_own_network(FLIGHT, "compare", 10, cwd=tmp_path)
    found = re.findall(r"^\w+ (\d+) commands, (\d+) values of telemetry$", said, re.MULTILINE)
    assert len(found) == len(MISSIONS) + 1
    assert re.search(r"^topics 2\d$", said, re.MULTILINE)
    assert sum(int(commands) for commands, _ in found) > 4000
    assert sum(int(values) for _, values in found) > 40_000
