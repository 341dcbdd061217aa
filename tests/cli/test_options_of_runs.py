"""Each option of a run with each command that flies: it becomes part of the plan, and its errors are reported."""

from __future__ import annotations

import sys
from collections.abc import Callable
from dataclasses import MISSING, fields
from pathlib import Path
from typing import Any

import pytest

from cfepy.cli.main import main
from cfepy.cli.options import RUN_OPTIONS
from cfepy.extra.exploration.trial import Trial
from cfepy.flight.flight import Flight
from cfepy.journal.recorder import record
from cfepy.pilot import pilot
from cfepy.pilot.plan import RunPlan
from cfepy.schedules.schedule import Schedule
from tests.cli.ros_packages import Launch, demo, write_launch

__all__ = ["demo", "write_launch"]  # fixtures

NODES = '<node pkg="demo" type="talker.py" name="talker"/>'
TEST = '<test pkg="demo" type="check.py" test-name="check"><param name="begins" value="hello"/></test>'
APP = "def main(cfe):\n    while cfe.es.run_loop():\n        cfe.os.task_delay(100)\n"


class TookOffError(BaseException):
    """Raised in place of a flight. No command catches it."""

    def __init__(self, plan: RunPlan) -> None:
        super().__init__(plan)
        self.plan = plan


@pytest.fixture
def words(tmp_path: Path, demo: Path, write_launch: Launch) -> dict[str, list[str]]:
    """Return the command lines of the commands that fly, by short names. Options may be added at the end."""
    (tmp_path / "startup.scr").write_text("CFE_APP, app, main, APP, 50, 16384, 0x0, 0;\n!\n", encoding="utf-8")
    (tmp_path / "app.py").write_text(APP, encoding="utf-8")
    (tmp_path / "script.txt").write_text("send CFE_ES_NOOP\n", encoding="utf-8")
    mission = str(tmp_path)
    launch, node = write_launch(NODES + TEST), str(demo / "scripts" / "talker.py")
    return {
        "run": ["run", mission],
        "run --check-determinism": ["run", mission, "--check-determinism", "2"],
        "run --record": ["run", mission, "--record", str(tmp_path / "run.cfepy")],
        "launch": ["launch", launch],
        "node": ["node", node],
        "node --check-determinism": ["node", node, "--check-determinism", "2"],
        "rostest": ["rostest", launch],
        "rostopic list": ["rostopic", "list", mission],
        "rostopic echo": ["rostopic", "echo", mission, "/chatter"],
        "rostopic pub": ["rostopic", "pub", mission, "/chatter", "std_msgs/String", "hi"],
        "rosservice list": ["rosservice", "list", mission],
        "rosservice call": ["rosservice", "call", mission, "/add"],
        "rosnode list": ["rosnode", "list", mission],
        "tf echo": ["tf", "echo", mission, "a", "b"],
        "param": ["rosparam", "list", mission, "--for", "1"],
        "cmd": ["cmd", mission, "CFE_ES_NOOP"],
        "tlm": ["tlm", mission],
        "console": ["console", mission],
        "mids": ["graph", "--mids", mission],
        "graph": ["graph", mission],
        "explore": ["explore", mission],
        "trace": ["trace", mission],
        "report": ["report", mission, "-o", str(tmp_path / "report.html")],
        "plot": ["plot", mission, "/chatter.data", "-o", str(tmp_path / "plot.png")],
        "export csv": ["export", "csv", mission, "/chatter", "-o", str(tmp_path / "values.csv")],
        "export parquet": ["export", "parquet", mission, "/chatter", "-o", str(tmp_path / "values.parquet")],
    }


COMMANDS = (
    *("run", "run --check-determinism", "run --record", "launch", "node", "node --check-determinism", "rostest"),
    *(
        "rostopic list",
        "rostopic echo",
        "rostopic pub",
        "rosservice list",
        "rosservice call",
        "rosnode list",
        "tf echo",
        "param",
    ),
    *("cmd", "tlm", "console"),
    *("mids", "graph", "explore", "trace", "report"),
    *("plot", "export csv", "export parquet"),
)
OPTIONS: dict[str, tuple[list[str], Any]] = {
    "launch_args": (["--arg", "rate:=20"], (("rate", "20"),)),
    "seconds": (["--for", "1.5"], 1.5),
    "seed": (["--seed", "7"], 7),
    "board": (["--board", "workstation"], "workstation"),
    "tasks": (["--tasks", "greenlet"], "greenlet"),
    "schedule": (["--schedule", "random:3"], Schedule.parse("random:3")),
    "script": (["--script", "script.txt"], "script.txt"),
    "stop_on_failure": (["--stop-on-failure"], True),
    "faults": (["--faults", "plan.yaml"], "plan.yaml"),
    "play": (["--play", "drive.bag"], "drive.bag"),
    "play_options": (["--play-options=--rate 2"], "--rate 2"),
    "stall": (["--stall", "2.5"], 2.5),
    "guard": (["--guard"], True),
    "races": (["--races"], True),
    "cpp_nodes": (["--cpp-nodes", "pool"], "pool"),
    "settings": (["--set", "/arm/rate=20"], (("/arm/rate", "20"),)),
    "spacecraft_id": (["--spacecraft-id", "67"], 67),
    "processor_id": (["--processor-id", "2"], 2),
    "beside": (["--with", "pair/client.scr@0.5"], ("pair/client.scr@0.5",)),
}
SAID_OTHERWISE = {
    ("launch", "launch_args"): "its words have them, as for roslaunch",
    ("rostest", "launch_args"): "its words have them, as for rostest",
    ("node", "launch_args"): "a node has none",
    ("node --check-determinism", "launch_args"): "a node has none",
    ("rostest", "seconds"): "each test has a time limit of its own",
    ("rosnode list", "seconds"): "is when it is asked; the run may take as long as the answer",
    ("cmd", "seconds"): "counts from the command on; the run may take as long as its boot",
    ("explore", "schedule"): "is what it explores",
    ("console", "script"): "its lines are taken before those that are typed",
}
"""Options that a command has in another way."""


def test_each_attribute_of_a_plan_has_an_option() -> None:
    named = {
        each.name for each in fields(RunPlan) if each.default is not MISSING or each.default_factory is not MISSING
    }
    assert named - {"command"} == set(RUN_OPTIONS) == set(OPTIONS)


def plan_that_takes_off(words: list[str], monkeypatch: pytest.MonkeyPatch) -> RunPlan:
    """Return the plan that a command line hands to the pilot."""

    def caught(plan: RunPlan, *_: object) -> object:
        raise TookOffError(plan)

    def compared(asked: Any, *_: object) -> object:
        raise TookOffError(asked.plan)

    monkeypatch.setattr(pilot, "_mission", caught)
    monkeypatch.setattr(pilot, "_faults", lambda plan, spec: ([], []))
    monkeypatch.setattr("cfepy.cli.run.check_determinism.started", compared)
    monkeypatch.setattr(RunPlan, "with_played_bag", lambda plan, spec: spec)
    with pytest.raises(TookOffError) as took_off:
        main(words)
    return took_off.value.plan


@pytest.fixture
def handed(words: dict[str, list[str]], tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Callable[..., RunPlan]:
    """Give a command with options, and take the plan that it hands to the pilot."""

    def plan_of(command: str, *options: str) -> RunPlan:
        if "launch_args" in options:  # which only a launch file takes, and reading it comes before the flight
            monkeypatch.setattr("cfepy.pilot.plan.read_mission", lambda word, args, build: read_mission_of(tmp_path))
        monkeypatch.chdir(tmp_path)
        said = [word for option in options for word in OPTIONS[option][0]]
        return plan_that_takes_off([*words[command], *said], monkeypatch)

    return plan_of


def test_all_commands_are_tried(words: dict[str, list[str]]) -> None:
    assert list(words) == list(COMMANDS)


@pytest.mark.parametrize("command", COMMANDS)
def test_every_command_hands_all_options_to_the_pilot(command: str, handed: Callable[..., RunPlan]) -> None:
    options = [option for option in OPTIONS if (command, option) not in SAID_OTHERWISE]
    plan = handed(command, *options)
    assert {option: getattr(plan, option) for option in options} == {option: OPTIONS[option][1] for option in options}


@pytest.mark.slow
@pytest.mark.parametrize("option", OPTIONS)
@pytest.mark.parametrize("command", COMMANDS)
def test_every_command_hands_every_option_to_the_pilot(
    command: str, option: str, handed: Callable[..., RunPlan]
) -> None:
    if (command, option) not in SAID_OTHERWISE:
        assert getattr(handed(command, option), option) == OPTIONS[option][1]


def read_mission_of(folder: Path) -> object:
    from cfepy.mission import read_mission

    return read_mission(str(folder))


# -- all commands report errors ----------------------------------------------------------------------------------------


def trial_of(plan: RunPlan) -> object:
    return Trial(plan).run(Schedule())


def flight_of(plan: RunPlan) -> object:
    with Flight(plan) as flight:
        return flight.results


def journal_of(plan: RunPlan) -> object:
    return record(plan, Path(plan.words[0], "recorded.cfepy"))


LIBRARY: dict[str, Callable[[RunPlan], object]] = {
    "fly": pilot.fly,
    "a trial, as workers of explore fly it": trial_of,
    "a mission under test": flight_of,
    "a journal": journal_of,
}


@pytest.mark.parametrize("command", [name for name in COMMANDS if "--check-determinism" not in name])
def test_greenlet_that_is_not_installed(
    command: str,
    words: dict[str, list[str]],
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.setitem(sys.modules, "greenlet", None)
    assert main([*words[command], "--tasks", "greenlet"]) == 2
    assert "--tasks: greenlet tasks require the library greenlet: pip install 'cfepy[fast]'" in capsys.readouterr().err


@pytest.mark.parametrize("way", LIBRARY)
def test_greenlet_that_is_not_installed_in_the_library(
    way: str, words: dict[str, list[str]], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, "greenlet", None)
    with pytest.raises(pilot.UsageError, match="greenlet tasks require the library greenlet"):
        LIBRARY[way](RunPlan((str(tmp_path),), tasks="greenlet"))


@pytest.mark.parametrize("command", [name for name in COMMANDS if "--check-determinism" not in name])
def test_faults_that_do_not_fit_or_never_strike(
    command: str,
    words: dict[str, list[str]],
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
) -> None:
    plan = tmp_path / "plan.yaml"
    plan.write_text(
        "faults:\n  - drop: /nothing\n    name: lost\n  - crash: NOBODY\n    name: gone\n    at: 0.1\n",
        encoding="utf-8",
    )
    short = [] if command in ("rostest", "param") else ["--for", "1"]
    quick = ["--seeds", "1", "--jobs", "1", "--no-stuck"] if command == "explore" else []
    main([*words[command], *short, *quick, "--faults", str(plan)])
    said = capsys.readouterr().err
    assert "unknown application NOBODY" in said
    assert "fault lost (" in said
    assert ") never happened: " in said


@pytest.mark.parametrize(
    "command",
    [
        pytest.param(name, marks=[pytest.mark.slow] * ("--check-determinism" in name))  # which starts processes
        for name in COMMANDS
    ],
)
def test_a_script_with_a_mistake(
    command: str,
    words: dict[str, list[str]],
    tmp_path: Path,
    capfd: pytest.CaptureFixture[str],
) -> None:
    script = tmp_path / "wrong.txt"
    script.write_text("send NO_SUCH_COMMAND\n", encoding="utf-8")
    assert main([*words[command], "--script", str(script)]) == 2
    assert f"{script}:1" in capfd.readouterr().err


@pytest.mark.parametrize(
    ("words", "why"),
    [
        (["rostopic", "list", "drive.bag"], "--seed: only valid for a mission, and drive.bag is a bag"),
        (
            ["cmd", "127.0.0.1", "CFE_ES_NOOP"],
            "--seed: only valid for a mission, and 127.0.0.1:1234 is a remote target",
        ),
        (["tlm", "127.0.0.1"], "--seed: requires a mission, and none is named"),
        (["console", "--udp", "127.0.0.1"], "--seed: only valid for a mission, and 127.0.0.1 is a remote target"),
        (["rosparam", "list", "capture"], "--seed: requires a mission that runs; say how long"),
        (["trace", "run.cfepy"], "--seed: only valid for a mission; the journal run.cfepy contains this setting"),
    ],
)
def test_what_is_not_flown_takes_no_option_of_a_run(
    words: list[str], why: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "drive.bag").write_bytes(b"#ROSBAG V2.0\n")
    record(RunPlan(("lab",), seconds=0.1), tmp_path / "run.cfepy")
    monkeypatch.chdir(tmp_path)
    assert main([*words, "--seed", "7"]) == 2
    assert why in capsys.readouterr().err
