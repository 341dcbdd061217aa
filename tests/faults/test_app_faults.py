"""Faults on applications: crash, hang, slow, stop, restart; the reactions of Executive Services and other
applications."""

from __future__ import annotations

from pathlib import Path

import pytest

from cfepy.mission import Mission
from tests.faults.worlds import fly, row, told, values

BOTH = pytest.mark.parametrize("tasks", ["thread", "greenlet"])
NODE_STARTUP = "CFE_APP, talker.py, __main__, TALKER, 100, 8192, 0x0, 0;\n!"
TALKER = """
    import rospy
    rospy.init_node("talker")
    rate = rospy.Rate(10)
    while not rospy.is_shutdown():
        try:
            rate.sleep()
        except Exception as error:
            print("caught", error)
        print("now", round(rospy.get_time() - 1e9, 2))
"""


@BOTH
def test_crash_is_an_exception_handled_by_es(tmp_path: Path, tasks: str) -> None:
    mission = fly(tmp_path, {"crash": "TAKER", "at": 1.8}, tasks=tasks, seconds=12)
    history = mission.record.history["TAKER"]
    assert (history.deaths, history.restarts) == (1, 1)
    assert type(history.last_error).__name__ == "InjectedCrash"
    assert any("TAKER: task TAKER died" in line for line in mission.console.lines)
    assert values(mission)[:3] == [0, 1, 2]
    assert len(values(mission)) > 10
    assert row(mission, "crash-1")["at_s"] == [1.8]


def test_application_cannot_catch_its_crash(tmp_path: Path) -> None:
    stubborn = """
        def taker_main(cfe):
            cfe.es.run_loop()
            while cfe.es.run_loop():
                try:
                    cfe.os.task_delay(100)
                except Exception:
                    cfe.os.printf("TAKER caught it")
    """
    mission = fly(tmp_path, {"crash": "TAKER", "at": 1.8}, taker=stubborn)
    assert mission.record.history["TAKER"].deaths == 1
    assert not told(mission, "TAKER caught it")


def test_a_crash_with_the_other_exception_action_resets_the_processor(tmp_path: Path) -> None:
    startup = """
        CFE_APP, source, source_main, SOURCE, 50, 16384, 0x0, 0;
        CFE_APP, taker,  taker_main,  TAKER,  60, 16384, 0x0, 1;
        !
    """
    mission = fly(tmp_path, {"crash": "TAKER", "at": 1.8}, startup=startup)
    assert [reset.fault for reset in mission.record.resets] == [True]


def test_a_crash_at_the_nth_message(tmp_path: Path) -> None:
    mission = fly(tmp_path, {"crash": "TAKER", "message": "NUMBER_TLM", "number": 4}, {"crash": "OTHER", "number": 3})
    assert mission.record.history["TAKER"].deaths == mission.record.history["OTHER"].deaths == 1
    assert told(mission, "cfepy fault crash-1: crashes TAKER")
    assert mission.record.rows("faults")[1]["times"] == 1


@BOTH
def test_hanging_application_reads_no_messages(tmp_path: Path, tasks: str) -> None:
    mission = fly(tmp_path, {"hang": "TAKER", "at": 1.8}, tasks=tasks, seconds=5)
    assert values(mission) == [0, 1, 2]
    assert values(mission, "OTHER")[:9] == list(range(9))
    assert any("Pipe Overflow" in line and "TAKER_PIPE" in line for line in mission.console.lines)


def test_hang_ends_after_its_duration(tmp_path: Path) -> None:
    mission = fly(tmp_path, {"hang": "TAKER", "at": 1.8, "for": 0.17})
    assert values(mission)[:8] == list(range(8))
    assert "for 0.17 s" in row(mission, "hang-1")["details"][0]


def test_a_hanging_application_can_be_restarted(tmp_path: Path) -> None:
    mission = fly(tmp_path, {"hang": "TAKER", "at": 1.8}, {"restart": "TAKER", "at": 2.2}, seconds=15)
    assert mission.record.history["TAKER"].restarts == 1
    assert values(mission)[:3] == [0, 1, 2]
    assert len(values(mission)) > 5


def test_a_slow_application_uses_more_cpu_time(tmp_path: Path) -> None:
    usual = fly(tmp_path)
    slow = fly(tmp_path, {"slow": "TAKER", "extra": 0.03, "after": 2, "until": 2.5})
    before, after = (each.record.history["TAKER"].cpu_ns for each in (usual, slow))
    assert before == 0
    assert after >= 5 * 30_000_000
    assert row(slow, "slow-1")["times"] == 1


def test_slow_fault_multiplies_call_costs_on_a_board(tmp_path: Path) -> None:
    cpu_ns = {}
    for times in (1, 10):
        faults = [{"slow": "TAKER", "times": times}] if times > 1 else []
        cpu_ns[times] = fly(tmp_path, *faults, board="rx64m").record.history["TAKER"].cpu_ns
    assert cpu_ns[10] > 3 * cpu_ns[1] > 0


def test_stop_and_restart_use_es(tmp_path: Path) -> None:
    mission = fly(tmp_path, {"stop": "OTHER", "at": 1.8}, {"restart": "TAKER", "at": 1.8}, seconds=5)
    assert [app.name for app in mission.cfe.es.apps if app.name in ("TAKER", "OTHER")] == ["TAKER"]
    assert any("Stop Application OTHER Completed" in line for line in mission.console.lines)
    assert any("Restart Application TAKER Completed" in line for line in mission.console.lines)
    assert mission.record.history["TAKER"].restarts == 1


def test_unknown_application_is_reported(tmp_path: Path) -> None:
    mission = fly(
        tmp_path, {"crash": "NOBODY", "at": 1.5}, {"restart": "CFE_ES", "at": 1.5}, {"hang": "TAKER", "at": 0}
    )
    nevers = [each["never"] for each in mission.record.rows("faults")]
    assert nevers[0] == "no application NOBODY runs at 1.5 s"
    assert "CFE_ES" in nevers[1]
    assert nevers[2] == "no application TAKER runs at 0 s"


def test_fault_on_several_applications_strikes_all(tmp_path: Path) -> None:
    mission = fly(tmp_path, {"crash": ["TAKER", "OTHER"], "at": 1.8})
    assert row(mission, "crash-1")["times"] == 2


@BOTH
def test_crashed_node_ends_like_a_process(tmp_path: Path, tasks: str) -> None:
    mission = fly(tmp_path, {"crash": "TALKER", "at": 1.8}, startup=NODE_STARTUP, talker=TALKER, tasks=tasks)
    assert not any("caught" in line or "cleaned up" in line for line in mission.console.lines)
    assert told(mission, "[talker] Segmentation fault (fault crash-1)")
    assert mission.ros.ended["TALKER"].status == 139
    assert mission.record.history["TALKER"].deaths == 1


def goes_on(mission: Mission) -> bool:
    """Return whether the node runs again after its crash."""
    lines = mission.console.lines
    crash = next(at for at, line in enumerate(lines) if "Segmentation fault" in line)
    return any("now" in line for line in lines[crash:])


@pytest.mark.parametrize("action", [0, 1])
def test_crashed_node_gets_the_exception_action_of_its_startup_line(tmp_path: Path, action: int) -> None:
    startup = NODE_STARTUP.replace("0x0, 0;", f"0x0, {action};")
    mission = fly(tmp_path, {"crash": "TALKER", "at": 1.8}, startup=startup, talker=TALKER, seconds=12)
    assert (mission.record.history["TALKER"].restarts, len(mission.record.resets)) == (1 - action, action)
    assert goes_on(mission)


def test_respawning_node_is_not_an_exception(tmp_path: Path) -> None:
    mission_yaml = "nodes: {TALKER: {respawn: true, respawn_delay: 0.5 s}}"
    crash = {"crash": "TALKER", "at": 1.8}
    mission = fly(tmp_path, crash, startup=NODE_STARTUP, talker=TALKER, mission_yaml=mission_yaml)
    assert told(mission, "launch: TALKER ended with exit status 139 and is restarted")
    assert mission.record.history["TALKER"].deaths == 0
    assert goes_on(mission)


def test_a_node_that_hangs_prints_nothing(tmp_path: Path) -> None:
    usual = fly(tmp_path, startup=NODE_STARTUP, talker=TALKER)
    mission = fly(tmp_path, {"hang": "TALKER", "at": 1.8}, startup=NODE_STARTUP, talker=TALKER)
    count = sum(" now " in line for line in mission.console.lines)
    assert 0 < count < sum(" now " in line for line in usual.console.lines) - 10
