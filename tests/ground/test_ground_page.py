"""docs/how_to/ground_tools.md: its commands work unchanged and do what the page describes."""

from __future__ import annotations

import os
import re
from pathlib import Path

import pytest

from apps.sample_app.packets import DISPLAY_PARAM, NOOP
from apps.to_lab.packets import OUTPUT_ENABLE
from tests.ground.page_flight import PARTS
from tests.own_network import needs_own_network, run_in_own_network

GROUND_SYSTEM = "CFEPY_GROUND_SYSTEM"
FOLDER = Path(os.environ.get(GROUND_SYSTEM, "/nowhere"))
pytestmark = [pytest.mark.slow, needs_own_network]


@pytest.mark.parametrize("part", PARTS)
def test_the_commands_of_the_page(part: str, tmp_path: Path) -> None:
    run_in_own_network("tests.ground.page_flight", part, cwd=tmp_path)


@pytest.mark.skipif(
    not (FOLDER / "Subsystems/cmdUtil/cmdUtil").exists(),
    reason=f"{GROUND_SYSTEM} names no folder with NASA's cFS-GroundSystem and its cmdUtil",
)
def test_nasas_command_tool_sends_the_same_packets_as_cfepy(tmp_path: Path) -> None:
    said = run_in_own_network("tests.ground.page_flight", "ground_system", FOLDER, cwd=tmp_path)
    assert [bytes.fromhex(packet) for packet in re.findall(r"^packet (\w+)$", said, re.MULTILINE)] == [
        bytes(OUTPUT_ENABLE.packet(dest_IP="127.0.0.1")),
        bytes(NOOP.packet()),
        bytes(DISPLAY_PARAM.packet(ValU32=10, ValI16=-3, ValStr="hello")),
    ]
