"""Nodes of the profile strict work without heap memory, and a node that allocates after its start ends."""

from __future__ import annotations

import pytest

import cfepy
from dev.convert.node_flights import NODES
from dev.convert.real_flights import GREEDY, spoken
from dev.convert.twin_flights import TWINS, recorded
from dev.roscfe.building import needs_cpp

pytestmark = [needs_cpp, pytest.mark.slow]


def test_strict_nodes_use_no_heap_memory(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("ROS_PACKAGE_PATH", f"{NODES}:{TWINS}")
    run = cfepy.run(str(NODES / "strict/mission"), seconds=4)
    sent = [recorded(line, False) for line in run.console if line.startswith("[recorder] RECORD ")]
    assert [each.topic for each in sent] == ["/greeting", *["/states"] * 10, "/large"]
    said = spoken(run.console)
    assert [line for line in said if "bytes, " in line] == [
        f"/listener {each.topic[1:]}: {len(each.data)} bytes, {fnv(each.data):08x}" for each in sent
    ]
    assert [line for line in said if " answer " in line] == [
        "/listener answer 0: 1 an answer, and no short one at that",
        "/listener answer 1: none",
        "/listener answer 2: 1 an answer, and no short one at that",
    ]
    assert [line for line in said if line.startswith("/greedy")] == ["/greedy working, with 100"]
    assert any(GREEDY in line for line in run.console)
    assert run.app("GREEDY").state != "RUNNING"


def fnv(data: bytes) -> int:
    """Return the hash of src/listener.cpp (FNV-1a, 32 bits)."""
    total = 2166136261
    for byte in data:
        total = (total ^ byte) * 16777619 & 0xFFFFFFFF
    return total
