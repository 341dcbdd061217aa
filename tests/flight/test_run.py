"""`cfepy.run`, `boot` and `replay`: plans by name, and the properties of a run."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

import cfepy
from cfepy.flight.plans import plan_of
from cfepy.ground import Dictionary
from cfepy.pilot import NODE, RunPlan, fly

KNOWN = cfepy.RunOptions.__annotations__


@pytest.fixture(scope="module")
def run(tmp_path_factory: pytest.TempPathFactory) -> cfepy.Run:
    journal = tmp_path_factory.mktemp("runs") / "run.cfepy"
    return cfepy.run("capture", seconds=3, seed=3, tasks="greenlet", journal=journal)


@pytest.fixture
def flight() -> Iterator[cfepy.Flight]:
    with cfepy.boot("lab", tasks="greenlet") as flight:
        yield flight


def test_plans() -> None:
    options = {"seconds": 2, "schedule": "random:7", "args": {"rate": 5}, "faults": "seed:3", "board": Path("b.yaml")}
    plan = plan_of("my.launch", options, KNOWN)
    assert plan.command_line() == (
        "cfepy run --arg rate:=5 --for 2 --board b.yaml --schedule random:7 --faults seed:3 my.launch"
    )
    node = plan_of((Path("talker.py"), "_rate:=5"), {"seed": 4, "board": None}, KNOWN)
    assert (node.command, node.words, node.seed) == (NODE, ("talker.py", "_rate:=5"), 4)


def test_unknown_option_is_refused() -> None:
    with pytest.raises(TypeError, match=r"unknown option 'second'; did you mean seconds\?"):
        cfepy.run("capture", second=3)  # type: ignore[call-arg]
    with pytest.raises(TypeError, match="unknown option 'schedule'"):
        cfepy.explore("capture", schedule="random:7")
    with pytest.raises(TypeError, match="must be the file of a plan"):
        cfepy.explore("capture", faults={"faults": []})


def test_unknown_mission_is_refused() -> None:
    with pytest.raises(cfepy.UsageError, match="captur"):
        cfepy.run("captur")


def test_run_equals_the_run_of_the_pilot(run: cfepy.Run) -> None:
    assert run.trace == fly(RunPlan(("capture",), seconds=3, seed=3)).trace
    assert run.command() == "cfepy run --for 3 --seed 3 --tasks greenlet capture"
    assert (run.now, run.problems, run.notes) == (3, [], ())
    assert run.speed > 0


def test_run_has_topics_apps_events_console_and_packets(run: cfepy.Run) -> None:
    rows = {row.name: row for row in run.topics}
    assert len(run.topic("/joint_states")) == len(run.messages("/joint_states"))
    assert rows["/joint_states"].sent == len(run.topic("/joint_states")) - 1, "the first one had no subscriber"
    assert {app.name: app.state for app in run.apps}["HK"] == "RUNNING"
    assert [event.text for event in run.events if event.app == "HK"] == ["HK Initialized.  Version 7.0.0.0"]
    assert any("HK Initialized" in line for line in run.console)
    assert run.packets("CFE_ES_HK_TLM")[-1].values == run.telemetry("CFE_ES_HK_TLM").values
    assert run.history("/joint_states")[0].sender == "/arm_control"


def test_values_over_time(run: cfepy.Run) -> None:
    times, positions = run.topic("/joint_states").to_numpy("position")
    assert positions.shape == (len(times), 7)
    assert (times[1:] >= times[:-1]).all()
    counter = run.topic("CFE_ES_HK_TLM").to_numpy("CommandCounter")
    assert counter.values.tolist() == [0] * len(counter.times)
    assert {"/joint_states", "CFE_ES_HK_TLM"} <= set(run.series.names)
    with pytest.raises(cfepy.UsageError, match="did you mean /joint_states"):
        run.topic("/joint_state")


@pytest.mark.slow
def test_journal_is_replayed(run: cfepy.Run, tmp_path_factory: pytest.TempPathFactory) -> None:
    journal = next(tmp_path_factory.getbasetemp().glob("runs*/run.cfepy"))
    again = cfepy.replay(journal)
    assert again.trace == run.trace
    assert len(again.topic("CFE_ES_HK_TLM")) == len(run.topic("CFE_ES_HK_TLM"))


def test_a_flight_has_numbers_until_now(flight: cfepy.Flight) -> None:
    flight.run_for(1)
    assert "flies" in repr(flight)
    early = {row.name: row.sent for row in flight.topics}
    flight.run_for(2)
    late = {row.name: row.sent for row in flight.topics}
    assert sum(late.values()) > sum(early.values())
    assert len(flight.topic("CFE_EVS_LONG_EVENT_MSG")) == late["CFE_EVS_LONG_EVENT_MSG"]
    assert flight.trace in repr(flight)
    assert flight.speed > 0


def test_a_picture(run: cfepy.Run, tmp_path: Path) -> None:
    picture = run.plot("/joint_states", "position[0]", file=tmp_path / "arm.svg")
    assert picture._repr_png_().startswith(b"\x89PNG")
    assert "<svg" in (tmp_path / "arm.svg").read_text(encoding="utf-8")
    with pytest.raises(cfepy.UsageError, match="cannot be written"):
        run.plot("/joint_states", "position[0]", file=tmp_path / "arm.nothing")


def test_failed_file_of_a_node_is_reported(tmp_path: Path) -> None:
    (tmp_path / "broken.py").write_text("import sys\nsys.exit(3)\n", encoding="utf-8")
    run = cfepy.run(tmp_path / "broken.py", seconds=1, tasks="greenlet")
    assert run.problems == ["BROKEN ended with exit status 3 (node /BROKEN)"]
    assert [line for line in run.console if "BROKEN ended with exit status 3" in line]


def test_last_telemetry_and_series_decode_only_new_packets(
    flight: cfepy.Flight, monkeypatch: pytest.MonkeyPatch
) -> None:
    name, count = "CFE_ES_HK_TLM", 0
    flight.run_for(12)
    before = len(flight.topic(name))
    decode, declared = Dictionary.decode, Dictionary.declared_as

    def counted(usual: Callable[[Dictionary, bytes], Any]) -> Callable[[Dictionary, bytes], Any]:
        def call(dictionary: Dictionary, packet: bytes) -> Any:
            nonlocal count
            count += 1
            return usual(dictionary, packet)

        return call

    monkeypatch.setattr(Dictionary, "decode", counted(decode))
    monkeypatch.setattr(Dictionary, "declared_as", counted(declared))
    last = flight.telemetry(name)
    assert (count, last.at) == (1, flight.packets(name)[-1].at)
    count = 0
    assert len(flight.topic(name)) == before
    assert count <= 1  # of its first packet, for the name
    flight.run_for(12)
    assert len(flight.topic(name)) == len(flight.packets(name)) > before


@pytest.mark.parametrize("tasks", ["thread", "greenlet"])
def test_program_that_leaves_a_flight_open_ends_quietly(tasks: str) -> None:
    program = f"import cfepy; flight = cfepy.boot('lab', tasks={tasks!r}); flight.run_for(1); print(flight.now)"
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True)
    assert (done.stdout, done.stderr) == ("1.0\n", "")
