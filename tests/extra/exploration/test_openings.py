"""The first look at a mission finds data without an order, and tasks of different priority that overlap."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from textwrap import dedent

import pytest

from cfepy.cli.main import main
from cfepy.extra.exploration import Expedition, Report, Trial
from cfepy.extra.exploration.missing_points import OpenPlaces, openings_of
from cfepy.pilot import RunPlan
from cfepy.schedules import SHARED, Points, Schedule, name_of
from cfepy.status import UsageError

NODE = "CFE_APP, {}.py, __main__, {}, 100, 16384, 0x0, 1;\n!\n"
COUNTERS = """
    import sys
    import threading
    import time


    class Counters:
        def __init__(self):
            self.n = 0
            self.alone = 0
            self.guarded = 0
            self.rows = {}
            self.lock = threading.Lock()

        def add(self):
            for _ in range(3):
                time.sleep(0.01)
                with self.lock:
                    self.guarded = self.guarded + 1
                if "sum" in self.rows:
                    self.rows["sum"] += 1
                self.n = self.n + 1


    def run():
        counters = Counters()
        counters.rows["sum"] = 0
        threads = [threading.Thread(target=counters.add) for _ in range(2)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        if counters.n != 6:
            sys.exit(f"counted {counters.n}")


    run()
"""
PRIORITIES = """
    def main(cfe):
        cfe.evs.register()
        go = cfe.os.bin_sem_create("GO", 0)
        came = []

        def urgent():
            cfe.os.bin_sem_take(go)
            if came:
                cfe.evs.send_err(1, "the less urgent task came first")

        def relaxed():
            cfe.os.task_delay(100)
            cfe.os.bin_sem_give(go)
            came.append(1)

        cfe.es.create_child_task("URGENT", urgent, 8192, 50)
        cfe.es.create_child_task("RELAXED", relaxed, 8192, 150)
        while cfe.es.run_loop():
            cfe.os.task_delay(100)
"""
Plans = Callable[..., RunPlan]


@pytest.fixture
def plan_of(tmp_path: Path) -> Plans:
    def write(source: str, **options: str) -> RunPlan:
        (tmp_path / "counters.py").write_text(dedent(source), encoding="utf-8")
        (tmp_path / "startup.scr").write_text(NODE.format("counters", "COUNTERS"), encoding="utf-8")
        return RunPlan((str(tmp_path),), seconds=1.0, **options)

    return write


@pytest.fixture
def apps(tmp_path: Path) -> RunPlan:
    (tmp_path / "app.py").write_text(dedent(PRIORITIES), encoding="utf-8")
    (tmp_path / "startup.scr").write_text("CFE_APP, app, main, APP, 100, 16384, 0x0, 0;\n!\n", encoding="utf-8")
    return RunPlan((str(tmp_path),), seconds=1.0)


def found_in(plan: RunPlan) -> OpenPlaces:
    return openings_of(Trial(plan), Schedule("at"))


def explored(plan: RunPlan, seeds: int, **options: str) -> Report:
    return Expedition(plan, seeds=seeds, jobs=1, shrink=60, **options).run()


def test_name_of_an_access_is_its_last_word_before_any_bracket() -> None:
    texts = ("Arm.position", "self.goals", "self.goals['x']", "self.goals[0]['y.z']", "total", "arm.Arm._Arm__x", "")
    assert [name_of(text) for text in texts] == ["position", "goals", "goals", "goals", "total", "_Arm__x", ""]


def test_shared_points_need_names() -> None:
    assert Points.parse("shared,n,rows,n") == Points(SHARED, names=("n", "rows"))
    assert Points.parse("shared:n").text() == "shared,n"
    with pytest.raises(UsageError, match="missing names; write for instance shared:total,goals"):
        Points.parse("shared")


def test_data_without_an_order_is_shared_and_data_behind_a_lock_is_not(plan_of: Plans) -> None:
    """The lock orders the accesses to `n` in this run only: it is given before them."""
    assert found_in(plan_of(COUNTERS)).shared == ("n", "rows")


def test_shared_points_are_at_the_named_data_only(plan_of: Plans) -> None:
    trial = Trial(plan_of(COUNTERS))
    schedules = {name: [Schedule.parse(f"random:{seed}:points=shared,{name}") for seed in range(20)] for name in "nx"}
    assert any(trial.run(each).failed for each in schedules["n"])
    assert not any(trial.run(each).failed for each in schedules["x"])


@pytest.mark.parametrize("text", ["random:3", "pct:3:3:200"])
def test_shared_points_are_the_same_with_observers_and_on_threads(plan_of: Plans, text: str) -> None:
    """A search flies without observers of accesses, a timeline with them."""
    schedule = Schedule.parse(f"{text}:hold=1ms:late=1ms:points=shared,n,rows")
    verdicts = [Trial(plan_of(COUNTERS, tasks=tasks)).run(schedule) for tasks in ("thread", "greenlet")]
    verdicts.append(Trial(RunPlan(plan_of(COUNTERS).words, seconds=1.0, races=True), events="none").run(schedule))
    assert {(each.trace, each.decisions) for each in verdicts} == {(verdicts[0].trace, verdicts[0].decisions)}


def test_default_finds_an_update_that_is_lost_between_two_accesses(plan_of: Plans) -> None:
    report = explored(plan_of(COUNTERS), 24)
    (told,) = report.findings
    assert told.repeats
    assert told.finding.verdict.schedule.points == "shared,n,rows"
    again = Schedule.parse(told.finding.verdict.schedule.text())
    assert report.trial.run(again).trace == told.finding.verdict.trace
    assert told.shrunk is not None
    assert told.shrunk.verdict.schedule.points == "shared,n,rows"


def test_tasks_of_different_priority_overlap(apps: RunPlan, plan_of: Plans) -> None:
    assert found_in(apps).overlaps
    assert not found_in(plan_of(COUNTERS)).overlaps


def test_priorities_stay_strict_if_a_task_computes_for_long(apps: RunPlan) -> None:
    """The other task would miss its deadlines, although it has a core of its own on a computer with several."""
    file = Path(apps.words[0]) / "app.py"
    text = file.read_text(encoding="utf-8")
    for time_us, overlap in ((900, True), (1000, False)):
        computing = text.replace("came.append(1)", f"came.append(cfe.psp.compute({time_us}))")
        file.write_text(computing, encoding="utf-8")
        assert found_in(apps).overlaps == overlap


def test_default_ignores_priorities_unless_the_board_has_one_core(apps: RunPlan, tmp_path: Path) -> None:
    (told,) = explored(apps, 60).findings
    assert told.finding.failure.text.endswith("the less urgent task came first")
    assert told.finding.verdict.schedule.any_priority
    board = tmp_path / "single.yaml"
    board.write_text("name: single\ncores: 1\n", encoding="utf-8")
    single = explored(RunPlan(apps.words, seconds=1.0, board=str(board)), 60)
    assert single.findings == []
    assert single.breadth.overlapping == 0


def test_report_says_that_a_failure_needs_several_cores(apps: RunPlan, capsys: pytest.CaptureFixture[str]) -> None:
    command = ["explore", *apps.words, "--for", "1", "--seeds", "60", "--jobs", "1", "--quiet"]
    assert main(command) == 1
    assert "fails only if less urgent tasks run beside more urgent ones, as on several cores" in capsys.readouterr().out
    assert main([*command, "--any-priority"]) == 1
    assert "as on several cores" not in capsys.readouterr().out


def test_report_says_which_kinds_of_schedules_were_flown(plan_of: Plans) -> None:
    report = explored(plan_of("import time\n\ntime.sleep(0.1)\n"), 12)
    assert report.findings == []
    line = (
        "schedules of special kinds: 2 with tasks held up for up to 1ms; more with --any-priority: any priority in all "
        "schedules, --hold TIME: longer holds, in all schedules, --connect TIME: connections of nodes that take time"
    )
    assert line in report.breadth.lines()
