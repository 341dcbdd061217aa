"""The capture mission's nodes under resets at random instants: they restart, and nothing of the old ones remains."""

from __future__ import annotations

import gc
import sys
import threading
from pathlib import Path
from random import Random

import pytest

from cfepy.mission import Mission
from cfepy.psp.psp import RST_TYPE_POWERON, RST_TYPE_PROCESSOR
from cfepy.rtos.context import drain
from cfepy.writing.console import Console
from tests.mission.flights import write_mission

NODES = ("ARM", "MAIN_CTRL", "ARM_HEALTH", "HK_MONITOR")


def reset_at_random(mission: Mission, random: Random, count: int) -> None:
    """Reset the processor so often: while it boots, while nodes import, while they work."""
    for _ in range(count):
        mission.run_for(random.choice((random.uniform(0, 0.2), random.uniform(0.4, 0.7), random.uniform(0, 2))))
        reset_type = RST_TYPE_PROCESSOR if random.random() < 0.8 else RST_TYPE_POWERON
        mission.processor.psp.restart(reset_type, "the test wants it")


@pytest.mark.slow
@pytest.mark.parametrize("tasks", ["thread", "greenlet"])
def test_nodes_restart_after_any_reset(tasks: str) -> None:
    drain()
    threads, random = threading.active_count(), Random(5)
    with Mission("capture", console=Console(quiet=True), tasks=tasks) as mission:
        mission.run_for(2)
        modules = len(sys.modules)
        reset_at_random(mission, random, 8)
        mission.run_for(2)
        assert len(sys.modules) == modules
        reasons = {reset.reason for reset in mission.record.resets}
        assert reasons <= {"the test wants it", "POWER ON RESET due to max proc resets (Watchdog)."}
        mission.console.lines.clear()
        mission.run_for(6)
        assert any("phase grasp" in line for line in mission.console.lines)
        assert mission.ros is not None
        assert {app.name for app in mission.cfe.es.apps} >= set(NODES)
        assert mission.record.errors_by_app == {}
        mission.shut_down_nodes()
        assert mission.ros.all_finished()
    drain()
    assert threading.active_count() <= threads


HOOKED = """
    import logging
    import rospy

    rospy.init_node("hooked")
    print("started")
    logging.getLogger("rosout").warning("logging works")
    rospy.on_shutdown(lambda: print("hook"))
    rospy.spin()
    print("spun")
    """


def test_reset_is_a_crash_of_a_node(tmp_path: Path) -> None:
    startup = "CFE_APP, hooked.py, __main__, HOOKED, 100, 65536, 0x0, 0;\n!"
    folder = write_mission(tmp_path, startup, hooked=HOOKED)
    with Mission(folder, console=Console(quiet=True)) as mission:
        mission.run_for(2)
        for _ in range(3):
            mission.processor.psp.restart(RST_TYPE_PROCESSOR, "the test wants it")
            mission.run_for(2)
        mission.shut_down_nodes()
        said = [line.replace(":", "").rpartition("] ")[2] for line in mission.console.lines if "hooked]" in line]
    assert said == ["started", "logging works"] * 4 + ["hook", "spun"]


@pytest.mark.slow
def test_hundred_resets_leave_no_node_behind() -> None:
    random = Random(6)
    with Mission("capture", console=Console(quiet=True)) as mission:
        mission.run_for(2)
        sizes: list[int] = []
        for _ in range(5):
            reset_at_random(mission, random, 20)
            mission.run_for(2)
            mission.console.lines.clear()
            gc.collect()
            sizes.append(len(gc.get_objects()))
    assert max(sizes) < sizes[0] * 1.02
