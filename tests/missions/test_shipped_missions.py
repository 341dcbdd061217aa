"""The shipped missions, flown completely."""

from __future__ import annotations

import importlib.util
import shutil
from pathlib import Path
from types import ModuleType

import pytest

from apps.to_lab import packets as to_lab
from cfepy.cli.main import main
from cfepy.ground import dictionary_of, topics_of
from cfepy.ground.link import GroundLink
from cfepy.mission import Mission, PacketWatch, Seen, read_mission, shipped_missions
from cfepy.msg import MsgType, get_type
from cfepy.pilot import pilot
from cfepy.pilot.plan import RunPlan
from cfepy.reading.resources import shipped
from cfepy.tbl import build
from cfepy.writing.console import Console

MISSIONS = shipped("missions")


def fly(mission: str, seconds: float, **options: object) -> tuple[Mission, list[str]]:
    flight = Mission(mission, console=Console(quiet=True), **options)  # type: ignore[arg-type]
    try:
        flight.run_for(seconds)
        flight.shut_down_nodes()
    finally:
        flight.close()
    return flight, flight.console.lines


def topic(flight: Mission, name: str) -> tuple[int, int, int]:
    """(sent, delivered, dropped) of a topic."""
    route = flight.cfe.sb.routes[next(row.msg_id for row in flight.ros.topics() if row.name == name)]
    delivered, _, limited, overflown = route.totals()
    return route.sent, delivered, limited + overflown


@pytest.mark.slow
def test_capture_catches_the_debris() -> None:
    flight, lines = fly("capture", 21)
    assert any("capture complete: largest joint error 0.0000" in line for line in lines)
    assert [line.rpartition(" ")[2] for line in lines if "phase " in line] == ["approach", "grasp", "retract", "hold"]
    for name, early in (("/joint_states", 49), ("/motor_command", 0)):  # 49 ms before a task takes from its queue of 1
        sent, delivered, dropped = topic(flight, name)
        assert sent - dropped in (delivered, delivered + 1)
        assert sent >= 20_300
        assert dropped == early
    assert flight.cfe.evs.errors_by_app == {}
    assert not flight.record.resets


@pytest.mark.slow
def test_capture_passes_its_own_checks() -> None:
    outcome = pilot.fly(RunPlan(("capture",), script=str(MISSIONS / "capture" / "checks.txt"))).outcome
    assert outcome is not None
    assert outcome.ok, outcome.text()
    assert len(outcome.verdicts) > 15


@pytest.mark.slow
def test_hk_carries_the_nodes_housekeeping_to_a_node() -> None:
    _, lines = fly("capture", 12)
    report = next(line for line in lines if "housekeeping 0x089C" in line)
    assert "0 missing, 0 malformed" in report
    assert "SB send errors" not in report  # zeros are left out
    assert "events sent" in report
    assert "arm samples" in report
    assert "arm peak current [A]" in report


@pytest.mark.parametrize("name", shipped_missions())
def test_threads_and_greenlets_give_one_trace(name: str) -> None:
    digests = {fly(name, 3, tasks=tasks)[0].trace.digest() for tasks in ("thread", "greenlet")}
    assert len(digests) == 1


def test_seed_does_not_change_a_mission_without_randomness() -> None:
    assert fly("rx64m_pubsub", 2, seed=1)[0].trace.digest() == fly("rx64m_pubsub", 2, seed=2)[0].trace.digest()


def module(path: Path) -> ModuleType:
    spec = importlib.util.spec_from_file_location(path.stem, path)
    assert spec is not None
    assert spec.loader is not None
    found = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(found)
    return found


@pytest.mark.parametrize("table", ["hk_cpy_tbl", "sch_lab_table"])
def test_table_files_match_their_definitions(table: str) -> None:
    definition = MISSIONS / "capture" / f"{table}.py"
    assert definition.with_suffix(".tbl").read_bytes() == build(module(definition).image())


@pytest.mark.slow
def test_capture_flies_on_the_small_board() -> None:
    plan = RunPlan(("capture/rx64m.scr",), script=str(MISSIONS / "capture" / "checks.txt"))
    flown = pilot.fly(plan)
    assert flown.outcome is not None
    assert flown.outcome.ok, flown.outcome.text()
    assert (flown.results.board, flown.results.script_problems) == ("rx64m", [])
    rows = {row.name: row for row in flown.results.topics}
    assert rows["/joint_states"].rate_hz == pytest.approx(100, abs=1)
    assert rows["/joint_states"].dropped < 6  # before a task takes from its queue of 1
    assert rows["/motor_command"].dropped == 0


# -- the small board -----------------------------------------------------------------------------------------------


BOTH_WAYS = ("/left_to_right", "/right_to_left")


def with_rate(folder: Path, rate: int) -> str:
    """Return the rx64m mission with nodes of another rate."""
    copy = folder / f"rate{rate}"
    shutil.copytree(MISSIONS / "rx64m_pubsub", copy)
    text = (copy / "mission.yaml").read_text(encoding="utf-8")
    (copy / "mission.yaml").write_text(text.replace("rate: 100", f"rate: {rate}"), encoding="utf-8")
    return str(copy)


def test_100_hz_on_the_rx64m_lose_no_message() -> None:
    flight, lines = fly("rx64m_pubsub", 10)
    assert flight.board.name == "rx64m"
    for name in BOTH_WAYS:
        sent, delivered, dropped = topic(flight, name)
        assert (sent - delivered, dropped) == (0, 0)
        assert sent == pytest.approx(100 * 9.3, abs=15)
    rows = [row for row in flight.ros.topics() if row.name in BOTH_WAYS]
    assert [row.held_back for row in rows] == [0, 0]
    assert [line for line in lines if " lost, " in line]
    assert all("0 lost, 0 out of order" in line for line in lines if " lost, " in line)


@pytest.mark.parametrize("rate", [150, 200, 1000])
def test_more_than_100_hz_is_held_back_and_reported(tmp_path: Path, rate: int) -> None:
    flight, lines = fly(with_rate(tmp_path, rate), 10)
    for name in BOTH_WAYS:
        sent, delivered, dropped = topic(flight, name)
        assert dropped == 0
        assert sent - delivered <= 1
        assert sent == pytest.approx(100 * 9.3, abs=15)
        row = next(row for row in flight.ros.topics() if row.name == name)
        assert row.held_back > 400
    assert any("0 lost, 0 out of order" in line for line in lines)


def test_same_rate_on_linux_is_not_delayed(tmp_path: Path) -> None:
    flight, _ = fly(with_rate(tmp_path, 200), 5, board="linux")
    assert topic(flight, "/left_to_right")[0] == pytest.approx(200 * 4.4, abs=20)


def test_all_events_on_the_rx64m_happen_at_ticks() -> None:
    flight, _ = fly("rx64m_pubsub", 2)
    assert flight.booted is not None
    assert flight.booted % 10_000_000 < 100_000  # the work of one tick after the tick


def test_memory_report_names_the_users_when_the_board_is_full(tmp_path: Path) -> None:
    folder = Path(with_rate(tmp_path, 100))
    script = (folder / "startup.scr").read_text(encoding="utf-8")
    (folder / "startup.scr").write_text(script.replace("RIGHT, 100, 8192", "RIGHT, 100, 500000"), encoding="utf-8")
    flight, lines = fly(str(folder), 3)
    text = "\n".join(lines)
    assert "CFE_ES_StartAppTask: AppCreate Error: TaskCreate RIGHT Failed." in text
    assert "RIGHT asks for 500256 bytes (stack)" in text
    assert "RAM of rx64m" in text
    assert "CFE_TBL" in text
    assert flight.cfe.es.app_named("RIGHT") is None
    assert flight.cfe.es.app_named("LEFT") is not None


def test_work_costs_virtual_time_on_the_board() -> None:
    flight, _ = fly("rx64m_pubsub", 5)
    for name in ("LEFT", "RIGHT"):
        assert 0 < flight.cfe.es.history[name].cpu_ns / flight.kernel.now < 0.05


def test_application_that_does_not_fit_fails_the_run(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    folder = Path(with_rate(tmp_path, 100))
    script = (folder / "startup.scr").read_text(encoding="utf-8")
    (folder / "startup.scr").write_text(script.replace("RIGHT, 100, 8192", "RIGHT, 100, 500000"), encoding="utf-8")
    assert main(["run", str(folder), "--for", "1", "--no-console"]) == 1
    captured = capsys.readouterr()
    assert "NOT STARTED" in captured.out
    assert "RIGHT could not be started" in captured.err


def test_lab_matches_nasas_sample_mission() -> None:
    with Mission("lab", console=Console(quiet=True)) as flight, GroundLink(flight) as ground:
        flight.run_for(2)
        ground.send(to_lab.OUTPUT_ENABLE.packet(dest_IP="127.0.0.1"))
        flight.run_for(4)
        down = {int.from_bytes(packet[:2], "big") for _, packet in ground.received()}
    housekeeping = {0x0800, 0x0801, 0x0803, 0x0804, 0x0805, 0x0880, 0x0883, 0x0884}
    assert down == housekeeping | {0x0808}
    assert not flight.record.resets
    assert flight.cfe.evs.errors_by_app == {}


# -- the dictionary ------------------------------------------------------------------------------------------------


@pytest.mark.slow
@pytest.mark.parametrize("name", shipped_missions())
def test_dictionary_has_all_sent_telemetry(name: str) -> None:
    """No packet of theirs is opaque."""
    seen: dict[int, Seen] = {}
    spec = read_mission(name)
    watch = PacketWatch(lambda each: seen.setdefault(each.msg_id, each))
    with Mission(spec, console=Console(quiet=True), attachments=[watch]) as flight:
        flight.run_for(25)
        dictionary = dictionary_of(spec)
        dictionary.learn(topics_of(flight))
    decoded = [dictionary.decode(each.packet) for each in seen.values() if get_type(each.packet) == MsgType.TLM]
    assert len(decoded) >= 3
    assert {each.name: each.problem for each in decoded if each.problem} == {}
