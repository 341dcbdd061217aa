"""Invariants, deadlines, results and measures that a run never evaluated: reported, with the probably intended name."""

from __future__ import annotations

from pathlib import Path

import pytest

from cfepy.cli.main import main
from cfepy.journal import read_journal, record, replay
from cfepy.pilot import RunPlan, fly
from cfepy.writing.markup import escaped
from tests.mission.flights import write_mission

STARTUP = "CFE_APP, talker.py, __main__, TALKER, 100, 16384, 0x0, 0;\n!"
TALKER = """
    import rospy
    from std_msgs.msg import Float64

    rospy.init_node("talker")
    silent = rospy.Publisher("silent", Float64, queue_size=1)
    energy = rospy.Publisher("energy", Float64, queue_size=1)
    while not rospy.is_shutdown():
        energy.publish(1.0)
        rospy.sleep(0.1)
"""
DEMANDS = {
    "invariants: {few: {topic: /enrgy, holds: msg.data < 3}}": "invariant 'few' (mission.yaml:1) was never judged: "
    "no message of /enrgy was sent; did you mean /energy?",
    "invariants: {few: {topic: /energy, holds: msg.data < 3, when: msg.data > 9}}": "invariant 'few' (mission.yaml:1) "
    "was never judged",
    "deadlines: {topics: {/enrgy: {latency: 1 ms}}}": "the deadline latency of /enrgy was never measured: "
    "no message of /enrgy was sent; did you mean /energy?",
    "deadlines: {topics: {/energy: {latency: 1 ms}}}": "the deadline latency of /energy was never measured",
    "deadlines: {topics: {'0x0895': {at_most_every: 1 Hz}}}": "the deadline at_most_every of 0x0895 was never "
    "measured: no message of 0x0895 was sent",
    "deadlines: {apps: {TALKR: {response: 1 ms}}}": "the deadline response of TALKR was never measured: "
    "unknown application TALKR; did you mean TALKER?",
    "results: {/enrgy: last}": "the result /enrgy (last) never occurred: no message of /enrgy "
    "was sent; did you mean /energy?",
    "results: {/ram/x.txt: file}": "the result /ram/x.txt (file) never occurred: the file does not exist",
    "results: {TALKR: output}": "the result TALKR (output) never occurred: unknown application TALKR; "
    "did you mean TALKER?",
    "results: {/energy: last}": "",
    "results: {/silent: last}": "the result /silent (last) never occurred: no message of /silent was sent",
    "invariants: {few: {topic: /energy, holds: msg.data < 3}}": "",
}


def mission(folder: Path, demands: str) -> Path:
    write_mission(folder, STARTUP, talker=TALKER, mission_yaml=demands + "\n")
    return folder


@pytest.mark.parametrize("demands", list(DEMANDS))
def test_demand_that_was_never_judged_is_reported(tmp_path: Path, demands: str) -> None:
    flown = fly(RunPlan((str(mission(tmp_path, demands)),), seconds=2))
    told = [DEMANDS[demands]] if DEMANDS[demands] else []
    assert flown.results.never_judged == told
    assert flown.results.never_happened == told
    assert list(flown.notes) == told


@pytest.mark.parametrize(
    "command",
    [
        ["run", "--no-console"],
        ["explore", "--seeds", "1", "--jobs", "1"],
        ["graph", "--mids"],
        ["rostopic", "echo", "/energy", "-n", "1"],
        ["tlm"],
    ],
    ids=lambda words: words[0],
)
def test_commands_report_an_invariant_that_was_never_judged(
    tmp_path: Path, command: list[str], capsys: pytest.CaptureFixture[str]
) -> None:
    demands = next(iter(DEMANDS))
    words = [str(mission(tmp_path, demands)), "--for", "2"]
    if command[0] == "rostopic":
        words = [words[0], *command[2:], "--for", "2"]
        main(["rostopic", "echo", *words])
    else:
        main([command[0], words[0], *command[1:], *words[1:]])
    shown = capsys.readouterr()
    assert DEMANDS[demands] in shown.err
    if command[0] == "explore":
        assert f"no failure\n  {DEMANDS[demands]}" in shown.out


@pytest.mark.slow
def test_explore_reports_a_measure_without_values(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    folder = str(mission(tmp_path, ""))
    main(["explore", folder, "--for", "1.5", "--seeds", "1", "--jobs", "1", "--worst", "age:/enrgy"])
    told = "no value of age:/enrgy was measured: no message of /enrgy was sent; did you mean /energy?"
    assert told in capsys.readouterr().out


@pytest.mark.slow
def test_sweep_is_not_clean_when_its_topic_was_never_sent(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    folder = str(mission(tmp_path, ""))
    words = ["--for", "1.5", "--board", "linux", "--measure", "/enrgy", "--jobs", "1", "--quiet", "--csv", "-"]
    main(["sweep", folder, *words])
    assert (
        "no message of /enrgy was measured: no message of /enrgy was sent; did you mean /energy?"
        in capsys.readouterr().out
    )


def test_page_reports_an_invariant_that_was_never_judged(tmp_path: Path) -> None:
    demands, page = next(iter(DEMANDS)), tmp_path / "page.html"
    main(["report", str(mission(tmp_path, demands)), "--for", "1.5", "-o", str(page)])
    text = page.read_text(encoding="utf-8")
    assert "No problems" in text
    assert f"<li>{escaped(DEMANDS[demands])}</li>" in text


@pytest.fixture
def recorded(tmp_path: Path) -> Path:
    """A journal of a mission whose rules need a file: an invariant that is never judged, and a result."""
    folder = tmp_path / "mission"
    folder.mkdir()
    rules = """
        def small(heard):
            return heard.msg.data < 3
    """
    demands = "invariants: {few: {topic: /enrgy, file: rules.py, function: small}}\nresults: {/cf/rules.py: file}\n"
    write_mission(folder, STARTUP, talker=TALKER, rules=rules, mission_yaml=demands)
    record(RunPlan((str(folder),), seconds=1), tmp_path / "run.cfepy")
    return tmp_path / "run.cfepy"


UNJUDGED = "invariant 'few' (mission.yaml:1) was never judged: no message of /enrgy was sent; did you mean /energy?"


def test_replay_has_the_notes_of_the_run_after_its_files_disappeared(recorded: Path) -> None:
    flown = replay(read_journal(recorded)).flown
    assert list(flown.notes) == [UNJUDGED]
    assert flown.results.never_judged == [UNJUDGED]


@pytest.mark.parametrize(
    "words", [["trace"], ["report", "-o", "page.html"], ["export", "csv"]], ids=lambda words: words[0]
)
def test_journal_of_rules_in_a_file_can_be_looked_at(
    words: list[str], recorded: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(recorded.parent)
    assert main([*words, "run.cfepy", *(["/energy"] if words[0] == "export" else [])]) == 0
    assert capsys.readouterr().err == f"cfepy: {UNJUDGED}\n"


def test_finished_run_keeps_its_results_when_a_file_of_its_rules_is_deleted(tmp_path: Path) -> None:
    (tmp_path / "rules.py").write_text("def small(heard): return heard.msg.data < 3", encoding="utf-8")
    flown = fly(
        RunPlan((str(mission(tmp_path, "invariants: {few: {topic: /energy, file: rules.py, function: small}}")),), 1)
    )
    (tmp_path / "rules.py").unlink()
    assert flown.results.never_judged == []
