"""Whole missions: the speed relative to real time, messages per second from node to node, and the time of a boot."""

from __future__ import annotations

import subprocess
import sys
import tempfile
from pathlib import Path
from time import perf_counter

from cfepy.mission import Mission
from cfepy.writing.console import Console

NODES = Path(__file__).parent / "nodes"
CAPTURE_S = 60
REPEATS = 3


def capture_speed(context: str) -> float:
    """Return virtual seconds per wall second of missions/capture, boot and loading of the nodes included."""
    return CAPTURE_S / min(_whole("capture", context, CAPTURE_S) for _ in range(REPEATS))


def _whole(mission: str, context: str, seconds: float) -> float:
    begin = perf_counter()
    with Mission(mission, tasks=context, console=Console(quiet=True)) as flight:
        flight.run_for(seconds)
        return perf_counter() - begin


def publish_to_callback(context: str) -> float:
    """Return JointState messages per second from a publisher in one node to a callback in another.

    No message is lost.
    """
    return max(_messages_per_second(context) for _ in range(REPEATS))


def _messages_per_second(context: str) -> float:
    with Mission(str(NODES), tasks=context, console=Console(quiet=True)) as flight:
        flight.run_for(1)
        (before, lost_before), begin = _counts(flight), perf_counter()
        flight.run_for(1)
        seconds = perf_counter() - begin
        delivered, lost = _counts(flight)
        if lost > lost_before:
            raise RuntimeError(f"{lost - lost_before} messages were lost")
        return (delivered - before) / seconds


def _counts(flight: Mission) -> tuple[int, int]:
    """Return the messages delivered so far, and lost.

    During the start, the publisher may be ahead of the subscriber.
    """
    assert flight.ros is not None
    msg_id = next(row.msg_id for row in flight.ros.topics() if row.name == "/joints")
    delivered, _, limited, overflown = flight.cfe.sb.routes[msg_id].totals()
    return delivered, limited + overflown


def boot_s() -> float:
    """Return the wall time in s of `cfepy run` of an empty mission for 0.6 virtual s, which ends OPERATIONAL."""
    with tempfile.TemporaryDirectory() as folder:
        (Path(folder) / "startup.scr").write_text("!\n", encoding="utf-8")
        command = [sys.executable, "-m", "cfepy", "run", folder, "--for", "0.6"]
        best = 1e9
        for _ in range(REPEATS + 2):
            begin = perf_counter()
            done = subprocess.run(command, capture_output=True, text=True, check=True)
            best = min(best, perf_counter() - begin)
        if "entering OPERATIONAL state" not in done.stdout:
            raise RuntimeError(f"the mission did not boot:\n{done.stdout}")
        return best


def missions(contexts: tuple[str, ...]) -> dict[str, float]:
    """Return figures by name: speeds in virtual seconds per wall second, rates in 1/s, times in s."""
    figures = {"boot_empty_mission_s": boot_s()}
    for context in contexts:
        figures[f"capture_speed.{context}"] = capture_speed(context)
        figures[f"publish_to_callback.{context}"] = publish_to_callback(context)
    return figures
