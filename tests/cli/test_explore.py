"""`cfepy explore`: its findings, its report, and that both are the same with any crew."""

from __future__ import annotations

import json
import re
from pathlib import Path

import pytest

from cfepy.cli.main import BAD_USAGE, ENDED_WELL, FOUND_PROBLEMS, INTERRUPTED, main
from cfepy.extra.exploration.campaign import Inline
from cfepy.extra.exploration.shrink import Shrinker
from cfepy.extra.exploration.trial import Trial
from cfepy.writing.work_progress import WorkProgress
from tests.extra.exploration import missions
from tests.mission.flights import write_mission

ROOT = Path(__file__).parents[2]
EVENT = "event: LISTENER: ERROR event 1: nothing came in 100 ms"


@pytest.fixture(scope="module")
def late(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return missions.write_late(tmp_path_factory.mktemp("late"))


def explore(*words: object) -> int:
    return main(["explore", *map(str, words), "--tasks", "greenlet"])


@pytest.mark.slow
def test_a_failure_is_told_once_with_its_command_and_timeline(
    late: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    numbers = tmp_path / "found.json"
    words = (late, "--for", 0.7, "--policy", "random", "--seeds", 6, "--jobs", 1)
    assert explore(*words, "--json", numbers, "--shrink", 60) == FOUND_PROBLEMS
    out = capsys.readouterr().out
    assert f"failure 1: {EVENT}" in out
    assert "failure 2" not in out
    assert f"FAILURE in LISTENER: {EVENT}" in out
    found = json.loads(numbers.read_text(encoding="utf-8"))
    assert found["schedules"] == 6
    (failure,) = found["failures"]
    assert failure["command"].startswith("cfepy run --for 0.7 --tasks greenlet --schedule random:")
    assert f"replay: {failure['command']}" in out
    assert f"shrunk: {failure['shrunk']['command']}" in out
    assert failure["shrunk"]["preemptions"] <= 1
    assert main([*failure["shrunk"]["command"].split()[1:], "--quiet"]) == FOUND_PROBLEMS
    assert "LISTENER sent 1 ERROR or CRITICAL event" in capsys.readouterr().err


def test_a_mission_that_always_goes_well(late: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert explore(late, "--for", 0.7, "--seeds", 5, "--jobs", 1, "--events", "none") == ENDED_WELL
    told, orders, points, chance, kinds = capsys.readouterr().out.splitlines()
    assert told == "5 schedules, 0 failed: no failure"
    assert orders == "  5 different orders"
    assert points.startswith("  under fifo others can get in at 16 points: ")
    assert chance.endswith(" at depth 3 (PCT's bound for 13 tasks and 16 points)")
    assert kinds.startswith("  schedules of special kinds: 1 with tasks held up for up to 1ms; ")


@pytest.mark.slow
def test_a_search_of_orders_says_how_far_it_came_with_a_failure_too(capsys: pytest.CaptureFixture[str]) -> None:
    folder = ROOT / "tests/quality/missions/mutex_order"
    words = (folder, "--for", 1.3, "--from", 0.6, "--policy", "orders", "--shrink", 0, "--jobs", 1)
    assert explore(*words) == FOUND_PROBLEMS
    out = capsys.readouterr().out
    assert "6 schedules, 2 failed: 1 distinct failure\n" in out
    assert "  6 different orders of accesses, with 4 different traces; no others were found\n" in out


def test_a_failure_of_the_default_schedule_is_told_as_such(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    folder = missions.write(tmp_path, {"BAD": "raise ValueError('at once')"})
    assert explore(folder, "--for", 0.7, "--seeds", 2, "--jobs", 1, "--until-failure") == FOUND_PROBLEMS
    out = capsys.readouterr().out
    assert "failure 1: unhandled exception: BAD: ValueError: at once (bad.py:1)" in out
    assert "under the default schedule, fifo, already" in out
    assert "--schedule" not in out


@pytest.mark.slow
def test_the_report_does_not_depend_on_the_number_of_processes(late: Path, capsys: pytest.CaptureFixture[str]) -> None:
    words = (late, "--for", 0.7, "--seeds", 6, "--shrink", 8)
    explore(*words, "--jobs", 1)
    alone = capsys.readouterr().out
    explore(*words, "--jobs", 2)
    assert capsys.readouterr().out == alone
    assert "failure 1" in alone


@pytest.mark.slow
def test_it_stops_with_the_first_failure_when_asked(late: Path, capsys: pytest.CaptureFixture[str]) -> None:
    words = (late, "--for", 0.7, "--policy", "dfs", "--depth", 1, "--seeds", 100, "--shrink", 0, "--jobs", 1)
    assert explore(*words, "--until-failure") == FOUND_PROBLEMS
    out = capsys.readouterr().out
    assert "1 failed: 1 distinct failure" in out
    assert "--schedule at:" in out


@pytest.mark.slow
def test_results_are_kept_in_a_file_and_not_run_again(
    late: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    words = (late, "--for", 0.7, "--jobs", 1, "--shrink", 0, "--events", "none", "--results", tmp_path / "found.jsonl")
    explore(*words, "--seeds", 3)
    explore(*words, "--seeds", 5)
    out = capsys.readouterr().out
    assert "5 schedules, 0 failed, 3 from the results file: no failure" in out


RACE = """
    import threading
    import rospy
    from std_msgs.msg import Int32

    rospy.init_node("race")
    winner = rospy.Publisher("winner", Int32, queue_size=10)
    go = threading.Event()


    def run(number):
        go.wait()
        winner.publish(number)


    for number in range(3):
        threading.Thread(target=run, args=(number,)).start()
    go.set()
    rospy.spin()
"""


@pytest.mark.slow
def test_a_result_that_depends_on_who_goes_first(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    folder = missions.write(tmp_path, {"RACE": RACE}, "results: {/winner: last}\n")
    words = (folder, "--for", 0.7, "--seeds", 30, "--jobs", 1, "--until-failure", "--policy", "random", "--shrink", 5)
    assert explore(*words) == FOUND_PROBLEMS
    out = capsys.readouterr().out
    assert "failure 1: results differ: /winner (last): data: " in out
    assert "; under fifo data: 2" in out


OTHERS = ("--policy pct", "--depth 2", "--first-seed 5", "--any-priority", "--hold 1ms", "--from 600ms")


@pytest.mark.slow
def test_results_of_another_search_are_refused(late: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    words = (late, "--for", 0.1, "--jobs", 1, "--shrink", 0, "--results", tmp_path / "results", "--seeds")
    explore(*words, 1)
    for other in (*OTHERS, "--events none", "--seed 1", "--for 0.2"):
        capsys.readouterr()
        assert explore(*words, 1, *other.split()) == BAD_USAGE, other
        name = {"--for": "seconds"}.get(other.split()[0], other.split()[0].strip("-").replace("-", "_"))
        assert f"{name} was " in capsys.readouterr().err
    explore(*words, 2)  # more seeds of the same search


def test_an_error_of_cfepy_is_no_success(
    late: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def broken(*_: object) -> object:
        raise ZeroDivisionError("a bug in cfepy")

    monkeypatch.setattr("cfepy.extra.exploration.exploration.make_crew", lambda *_: Inline())
    monkeypatch.setattr(Trial, "run", broken)
    assert explore(late, "--for", 0.7, "--seeds", 3) == FOUND_PROBLEMS
    out = capsys.readouterr().out
    assert "an error in cfepy itself, under random:0; please report it:" in out
    assert "ZeroDivisionError: a bug in cfepy" in out
    assert "3 with an error in cfepy itself" in out


@pytest.mark.slow
def test_a_task_that_waits_for_ever_may_be_let(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    folder = missions.write(tmp_path / "pair", {"PAIR": missions.LOST_WAKE_UP})
    words = (folder, "--for", 0.8, "--seeds", 6, "--jobs", 1, "--shrink", 0, "--results", tmp_path / "results")
    assert explore(*words) == FOUND_PROBLEMS
    assert "failure 1: stuck: PAIR: PAIR.pair.1.1 waits forever for lock at pair.py:" in capsys.readouterr().out
    assert explore(*words, "--no-stuck") == BAD_USAGE
    assert "no_stuck was false, is true" in capsys.readouterr().err
    assert explore(*words[:-2], "--no-stuck") == ENDED_WELL


def test_a_node_is_explored_by_itself(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "lone.py").write_text("import sys\nraise ValueError(sys.argv[1])\n", encoding="utf-8")
    words = (tmp_path / "lone.py", "today", "--for", 0.7, "--seeds", 1, "--jobs", 1)
    assert explore(*words, "--until-failure") == FOUND_PROBLEMS
    out = capsys.readouterr().out
    assert "ValueError: today (lone.py:2)" in out
    assert f"replay: cfepy node --for 0.7 --tasks greenlet {tmp_path / 'lone.py'} today" in out


@pytest.mark.parametrize(
    ("words", "error"),
    [
        (["/no/such/mission"], "unknown mission"),
        (["{late}", "lab"], "unexpected 'lab'; expected one mission"),
        (["{late}", "--script", "/no/script"], "/no/script"),
        (["{late}", "--for", "0.7", "--jobs", "2", "--cluster", "tcp://127.0.0.1:1"], "--jobs"),
    ],
)
def test_bad_usage(late: Path, words: list[str], error: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert explore(*(word.format(late=late) for word in words)) == BAD_USAGE
    assert error in capsys.readouterr().err


@pytest.mark.parametrize(
    "option", ["--seeds=0", "--seeds=many", "--depth=0", "--first-seed=-1", "--jobs=0", "--hold=soon"]
)
def test_numbers_that_cannot_be(late: Path, option: str) -> None:
    with pytest.raises(SystemExit) as caught:
        explore(late, option)
    assert caught.value.code == BAD_USAGE


@pytest.mark.slow
def test_terminal_shows_the_runs_of_shrinking(late: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    shown: list[str] = []
    monkeypatch.setattr(WorkProgress, "show", lambda progress, text: shown.append(text))
    explore(late, "--for", 0.7, "--policy", "random", "--seeds", 3, "--jobs", 1)
    assert shown[0].endswith(f" runs, {EVENT}")
    runs = [re.match(r"shrinking: (\d+) of at most \d+ runs", each) for each in shown]
    assert [int(run[1]) for run in runs if run is not None] == [*range(1, len(shown) + 1)]
    shown.clear()
    explore(late, "--for", 0.7, "--policy", "random", "--seeds", 3, "--jobs", 1, "--quiet")
    assert shown == []


@pytest.mark.slow
def test_ctrl_c_while_shrinking_leaves_the_report(
    late: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def interrupted(_: Shrinker) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr(Shrinker, "run", interrupted)
    assert explore(late, "--for", 0.7, "--policy", "random", "--seeds", 3, "--jobs", 1) == INTERRUPTED
    out = capsys.readouterr().out
    assert f"failure 1: {EVENT}" in out
    assert "ended by Ctrl-C" in out


def test_time_of_a_failure_has_microseconds_in_every_command(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    program = """
        def Main(cfe):
            cfe.evs.register()
            cfe.es.run_loop(1)
            cfe.os.task_delay(1200)
            cfe.es.kernel.charge(1_024_000)
            cfe.evs.send_event(7, 2, "late")
            cfe.os.task_delay(9000)
    """
    rules = 'invariants: {early: {packet: CFE_EVS_LONG_EVENT_MSG, holds: "msg.PacketID.EventID != 7"}}\n'
    rules += "deadlines: {apps: {PROG: {response: 1 ms}}}\n"
    startup = "CFE_APP, prog, Main, PROG, 50, 16384, 0x0, 0;\n!"
    folder = write_mission(tmp_path, startup, prog=program, mission_yaml=rules)
    assert main(["run", folder, "--for", "3", "--no-console"]) == FOUND_PROBLEMS
    shown = capsys.readouterr()
    (invariant,) = re.findall(r"invariant 'early' \(mission.yaml:1\) at (\S+) s: ", shown.err)
    (deadline,) = re.findall(r"PROG missed its deadline .* first at (\S+) s$", shown.err, re.MULTILINE)
    assert re.fullmatch(r"1\.\d{3}024", invariant), "to the microsecond"
    assert deadline == invariant
    assert shown.out.count(f" {invariant}") == 2, "in the tables of invariants and of deadlines"
    assert explore(folder, "--for", 3, "--seeds", 1, "--jobs", 1, "--shrink", 0) == FOUND_PROBLEMS
    assert capsys.readouterr().out.count(f"  at {invariant} s\n") == 2
