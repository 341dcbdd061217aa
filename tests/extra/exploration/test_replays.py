"""The failures of a results file are replayed in the current mission."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from cfepy.cli.main import main
from cfepy.extra.exploration import Expedition
from cfepy.extra.exploration.replays import GONE, NOT_POSSIBLE, STILL_THERE, replay_all
from cfepy.extra.exploration.results_file import ResultsFile, keep_failure, read_failures, read_results
from cfepy.extra.exploration.verdict import Failure, Verdict
from cfepy.pilot import RunPlan
from cfepy.schedules import Schedule
from cfepy.status import UsageError
from tests.extra.exploration import missions

PAID = 'invariants: {all paid: {topic: /total, holds: "msg.data == 6"}}\n'
RACE = "moves:BANK.bank.1@550/pay.get_time/3=BANK,BANK.bank.1@550/next=BANK.bank.2"
IMPOSSIBLE = "moves:BANK.bank.1@550/pay.get_time/3=BANK,NOBODY@550=BANK"


def bank(folder: Path) -> Path:
    """Return a mission with a lost update."""
    return missions.write(folder, {"BANK": missions.LOST_UPDATE}, PAID)


def results_of(path: Path, mission: Path) -> Path:
    """Return a results file of the mission with three failures."""
    plan = RunPlan((str(mission),), seconds=0.7, tasks="greenlet")
    ResultsFile(path, {"plan": plan.to_dict(), "search": {"events": "error", "no_stuck": True}}).close()
    keep_failure(
        path, "invariant|all paid|msg.data == # does not hold; msg.data is #", "too little", Schedule.parse(RACE)
    )
    keep_failure(path, "died|BANK|x", "dead", Schedule.parse(RACE.partition(",")[0]))
    keep_failure(path, "died|BANK|y", "dead by two moves", Schedule.parse(IMPOSSIBLE))
    return path


@pytest.mark.slow
def test_replayed_failures_are_reported_as_present_gone_or_not_possible(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    mission = bank(tmp_path / "bank")
    path = results_of(tmp_path / "f.results", mission)
    found = list(replay_all(str(path), jobs=1))
    assert [each.state for each in found] == [STILL_THERE, GONE, NOT_POSSIBLE]
    assert found[2].verdict.missed == ("NOBODY@550=BANK",)
    assert [each.command.split()[:4] for each in found] == [["cfepy", "run", "--for", "0.7"]] * 3
    source = mission / "bank.py"
    source.write_text(
        "# mended\n\n" + source.read_text(encoding="utf-8").replace("rospy.get_time()", "pass"), encoding="utf-8"
    )
    assert main(["explore", "--replay-all", str(path), "--json", str(tmp_path / "f.json"), "--jobs", "1"]) == 0
    told = capsys.readouterr().out.splitlines()
    assert told[0] == "schedule no longer applies: too little"
    lost = "BANK.bank.1@550/pay.get_time/3=BANK, BANK.bank.1@550/next=BANK.bank.2"
    assert told[1] == f"  0 of its 2 moves were possible; not possible: {lost}"
    assert told[-1] == "3 failures: 3 whose schedule no longer applies"
    assert main(["explore", "--replay-all", str(path), "--jobs", "1", "--quiet"]) == 0
    assert capsys.readouterr().out.splitlines() == told
    plain = json.loads((tmp_path / "f.json").read_text(encoding="utf-8"))["failures"]
    assert [each["state"] for each in plain] == [NOT_POSSIBLE] * 3


@pytest.mark.slow
def test_shrunk_schedule_is_kept_and_replayed_in_a_mended_mission(tmp_path: Path) -> None:
    mission, path = bank(tmp_path / "bank"), tmp_path / "f.results"
    plan = RunPlan((str(mission),), seconds=0.7, tasks="greenlet")
    expedition = Expedition(plan, seeds=12, jobs=1, shrink=20, results=str(path))
    (told,) = expedition.run().findings
    assert told.shrunk is not None
    assert read_failures(path) == {
        told.finding.failure.group: (told.finding.failure.title, told.shrunk.verdict.schedule)
    }
    assert expedition.run().tally.resumed == 12
    assert main(["explore", "--replay-all", str(path), "--jobs", "1"]) == 1
    source = mission / "bank.py"
    source.write_text(source.read_text(encoding="utf-8") + "\n# one more line\n", encoding="utf-8")
    assert main(["explore", "--replay-all", str(path), "--jobs", "1"]) == 1


def test_last_line_of_a_failure_counts_and_other_readers_ignore_it(tmp_path: Path) -> None:
    path = tmp_path / "f.results"
    with_failure = Verdict(Schedule("random", 7), (Failure("died", "A", "x", cause="c"),))
    file = ResultsFile(path, {"a": 1})
    file.append(0, with_failure.to_dict())
    file.close()
    assert read_failures(path) == {"died|A|c": ("died: A: x", Schedule("random", 7))}
    for text in ("moves:A=B,C=D", "moves:A=B"):
        keep_failure(path, "died|A|c", "died: A: x", Schedule.parse(text))
    assert read_failures(path) == {"died|A|c": ("died: A: x", Schedule.parse("moves:A=B"))}
    assert [number for number, _ in read_results(path)[1]] == [0]
    file = ResultsFile(path, {"a": 1})
    assert len(file) == 1
    file.append(1, with_failure.to_dict())
    file.close()
    assert [number for number, _ in read_results(path)[1]] == [0, 1]


def test_invalid_failure_line_is_reported(tmp_path: Path) -> None:
    path = tmp_path / "f.results"
    ResultsFile(path, {"a": 1}).close()
    path.write_text(path.read_text(encoding="utf-8") + '{"failure": {"group": "x"}}\n', encoding="utf-8")
    with pytest.raises(UsageError, match=r"f\.results:2"):
        read_failures(path)
    with pytest.raises(UsageError, match="does not name its mission"):
        next(replay_all(str(path)))


@pytest.mark.parametrize(("options", "said"), [(["--seed", "3"], "--seed"), (["--for", "2"], "--for"), ([], "MISSION")])
def test_replay_refuses_options_that_decide_a_run(
    options: list[str], said: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    words = ["--replay-all", str(tmp_path / "f.results"), *options] if options else []
    assert main(["explore", *words]) == 2
    assert said in capsys.readouterr().err
