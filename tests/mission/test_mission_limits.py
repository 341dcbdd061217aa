"""`limits:` of a mission file: limits that it raises and lowers, limits of a board, and room for many nodes."""

from __future__ import annotations

import gc
import sys
from pathlib import Path

import pytest

from cfepy.config.platform import PlatformConfig
from cfepy.mission import Mission, read_mission
from cfepy.mission.limits import ROS_ROOM, MissionLimits, limits_for
from cfepy.pilot.mission_check import check_mission
from cfepy.psp.profile import load_profile
from cfepy.status import UsageError
from cfepy.writing.console import Console
from tests.mission.flights import write_mission

LINUX, RX64M = load_profile("linux"), load_profile("rx64m")


def test_mission_without_limits_has_nasas_numbers() -> None:
    assert MissionLimits().config(LINUX, has_nodes=False) == PlatformConfig()
    assert MissionLimits().config(RX64M, has_nodes=True) == RX64M.config()


def test_nodes_add_memory_for_parameters_and_images_where_ram_is_unlimited() -> None:
    assert MissionLimits().config(LINUX, has_nodes=True) == PlatformConfig().with_limits(ROS_ROOM)


def test_memory_for_many_nodes_does_not_reduce_memory_for_images() -> None:
    config = MissionLimits(nodes=50).config(LINUX, has_nodes=True)
    assert config.sb_buf_memory_bytes == ROS_ROOM["sb_buf_memory_bytes"]


def test_a_mission_raises_and_lowers() -> None:
    config = MissionLimits({"os_max_tasks": 300, "sb_max_pipes": 10}).config(LINUX, has_nodes=False)
    assert (config.os_max_tasks, config.sb_max_pipes, config.os_max_queues) == (300, 10, 64)


def test_refused_limits_of_the_time_leave_nothing_to_close(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    unraised: list[object] = []
    monkeypatch.setattr(sys, "unraisablehook", unraised.append)
    (tmp_path / "startup.scr").write_text("!\n", encoding="utf-8")
    (tmp_path / "mission.yaml").write_text("limits: {time_cfg_source: true}\n", encoding="utf-8")
    with pytest.raises(UsageError, match="needs exactly one of"):
        Mission(str(tmp_path), console=Console(quiet=True))
    gc.collect()
    assert unraised == []


def test_limit_above_the_board_is_refused() -> None:
    assert MissionLimits({"os_max_tasks": 20}).config(RX64M, has_nodes=True).os_max_tasks == 20
    with pytest.raises(
        UsageError, match=r"limits.os_max_tasks: must be at most 32 on the board rx64m, not 33; lower it"
    ):
        MissionLimits({"os_max_tasks": 33}).config(RX64M, has_nodes=True)
    with pytest.raises(UsageError, match=r"limits.nodes: is 5, which requires es_max_applications: 38, but the board"):
        MissionLimits(nodes=5).config(RX64M, has_nodes=True)


@pytest.mark.parametrize("nodes", [1, 50, 500, 4000])
def test_any_number_of_nodes_has_room(nodes: int) -> None:
    config = MissionLimits(nodes=nodes).config(LINUX, has_nodes=True)
    assert config.es_max_applications - 6 >= nodes
    assert config.os_max_tasks >= 8 * nodes
    assert all(value < 0xFFFF for name, value in limits_for(nodes).items() if name != "sb_buf_memory_bytes")


@pytest.mark.slow
def test_fifty_nodes_fly_with_one_limit(tmp_path: Path) -> None:
    startup = "".join(f"CFE_APP, n, __main__, N{number}, 100, 4096, 0, 0;\n" for number in range(50))
    node = """
        import os, rospy
        from std_msgs.msg import String
        rospy.init_node("n", anonymous=True)
        rospy.Subscriber("all", String, lambda message: None)
        publisher = rospy.Publisher("all", String, queue_size=1)
        rospy.spin()
        """
    mission = write_mission(tmp_path, startup + "!\n", n=node, mission_yaml="limits: {nodes: 50}\n")
    assert check_mission(mission) == []
    with Mission(mission, console=Console(quiet=True)) as flight:
        flight.run_for(1)
        assert len(flight.ros.graph.nodes) == 50
        assert len(flight.ros.graph.topics["/all"].subscriptions) == 50


def test_check_reports_the_line_beyond_a_limit_and_the_limit_to_raise(tmp_path: Path) -> None:
    startup = "".join(f"CFE_APP, n, __main__, N{number}, 100, 4096, 0, 0;\n" for number in range(27)) + "!\n"
    mission = write_mission(tmp_path, startup, n="import rospy\n")
    assert [(found.line, found.text) for found in check_mission(mission)] == [
        (27, "N26 exceeds the limit: linux allows 26 application entries; start fewer, "
         "or raise limits.es_max_applications in the mission file")
    ]  # fmt: skip
    (tmp_path / "mission.yaml").write_text(
        "limits:\n  os_max_tasks: 40\n  os_max_pipes: 3\n  sb_max_pipes: 70000\n", encoding="utf-8"
    )
    texts = [f"{found.line}: {found.text}" for found in check_mission(mission, "rx64m")]
    assert any(text.startswith("3: limits.os_max_pipes: unknown field") for text in texts), texts
    assert "4: limits.sb_max_pipes: must be at most 65534, not 70000" in texts
    assert (
        "2: limits.os_max_tasks: must be at most 32 on the board rx64m, not 40; lower it, or use another board" in texts
    )


def test_invalid_limit_stops_a_run_with_file_and_line(tmp_path: Path) -> None:
    mission = write_mission(tmp_path, "!\n", mission_yaml="board: rx64m\nlimits:\n  sb_max_pipes: 99\n")
    with pytest.raises(
        UsageError, match=r"mission.yaml:3: limits.sb_max_pipes: must be at most 32 on the board rx64m, not 99"
    ):
        Mission(read_mission(mission), console=Console(quiet=True))


def test_mission_without_queue_limits_gets_long_queues_except_on_a_board_with_own_limits() -> None:
    nobody_said = MissionLimits(nodes=10, yields=True)
    assert nobody_said.config(LINUX, has_nodes=True).os_queue_max_depth == 10_000
    assert nobody_said.config(RX64M, has_nodes=True).os_queue_max_depth == RX64M.config().os_queue_max_depth
    assert MissionLimits(nodes=10).config(LINUX, True).os_queue_max_depth == 50
