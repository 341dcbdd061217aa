"""`--junit`, `--sarif` and `--github` of each command that has them, and the verdict in one line."""

from __future__ import annotations

import json
import re
import shutil
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import pytest

from cfepy.cli.main import main
from cfepy.pilot import Failure
from tests.cli.ros_packages import Launch, demo, write_launch
from tests.mission.flights import write_mission

__all__ = ["demo", "write_launch"]  # fixtures

ROOT = Path(__file__).parents[2]
RACE = ROOT / "tests" / "quality" / "missions" / "lost_update"
PAGE = ROOT / "docs" / "how_to" / "ci.md"
APP = "CFE_APP, prog, Main, PROG, 50, 16384, 0x0, 0;\n!"
SOURCE = """
import struct


def Main(cfe):
    cfe.evs.register()
    while cfe.es.run_loop(1):
        cfe.os.task_delay(100)
        @
"""
RULES = """
invariants:
  few: {packet: CFE_EVS_LONG_EVENT_MSG, holds: "t < 0"}
  never: {packet: CFE_TBL_REG_TLM, holds: "msg.Size < 0"}
deadlines:
  topics:
    CFE_ES_HK_TLM: {at_least_every: 1 ms}
"""


def mission(folder: Path, act: str = "", rules: str = "") -> Path:
    """Write a mission whose application does something ten times a second."""
    folder.mkdir(parents=True, exist_ok=True)
    more = {"mission_yaml": rules} if rules else {}
    write_mission(folder, APP, prog=SOURCE.replace("@", act or "pass"), **more)
    return folder


def cases(file: Path) -> dict[str, ElementTree.Element]:
    """Return the test cases of a file by name, after a look at its shape."""
    root = ElementTree.parse(file).getroot()
    assert [root.tag, *(each.tag for each in root)] == ["testsuites", "testsuite"]
    suite = root[0]
    found = suite.findall("testcase")
    for kind in ("failure", "error", "skipped"):
        counted = sum(case.find(kind) is not None for case in found)
        assert (
            suite.get(kind if kind == "skipped" else f"{kind}s") == root.get(f"{kind}s", root.get(kind)) == str(counted)
        )
    assert all(case.get("name") and case.get("classname") and float(case.get("time", "-")) >= 0 for case in found)
    return {str(case.get("name")): case for case in found}


def results(file: Path) -> list[dict[str, Any]]:
    """Return the results of a SARIF log, after a look at its references."""
    log = json.loads(file.read_text(encoding="utf-8"))
    (run,) = log["runs"]
    rules = run["tool"]["driver"]["rules"]
    for each in run["results"]:
        assert rules[each["ruleIndex"]]["id"] == each["ruleId"]
        assert each["message"]["text"]
        assert each["level"] in ("error", "warning")
    found: list[dict[str, Any]] = run["results"]
    return found


def place_of(result: dict[str, Any]) -> tuple[str, int]:
    place = result["locations"][0]["physicalLocation"]
    return place["artifactLocation"]["uri"], place.get("region", {}).get("startLine", 0)


@pytest.fixture(autouse=True)
def _in_the_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    monkeypatch.delenv("GITHUB_WORKSPACE", raising=False)


OUTPUTS = ["--github", "--junit", "out.xml", "--sarif", "out.sarif"]


def test_run_reports_steps_rules_and_the_line_that_raised(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    mission(tmp_path / "m", "struct.pack('B', 300)", RULES)
    Path("steps.txt").write_text("at 1 send CFE_ES_NOOP\nexpect event CFE_ES 99 within 0.1\n", encoding="utf-8")
    assert main(["run", "m", "--script", "steps.txt", "--quiet", *OUTPUTS]) == 1
    found = cases(Path("out.xml"))
    kinds = {name: [each.tag for each in case] for name, case in found.items()}
    assert kinds == {
        "boot": [],
        "1: at 1 send CFE_ES_NOOP": [],
        "2: expect event CFE_ES 99 within 0.1": ["failure"],
        "few": ["failure"],
        "never": ["skipped"],
        "CFE_ES_HK_TLM at_least_every": ["failure"],
        "died PROG": ["failure"],
    }
    places = {name: (case.get("file"), case.get("line")) for name, case in found.items()}
    assert places["2: expect event CFE_ES 99 within 0.1"] == ("steps.txt", "2")
    assert places["few"] == ("m/mission.yaml", "3")
    assert places["CFE_ES_HK_TLM at_least_every"] == ("m/mission.yaml", "7")
    assert places["died PROG"] == ("m/prog.py", "9")
    by_rule = {each["ruleId"]: place_of(each) for each in results(Path("out.sarif"))}
    assert by_rule == {
        "died": ("m/prog.py", 9),
        "invariant": ("m/mission.yaml", 3),
        "deadline": ("m/mission.yaml", 7),
        "missed-expectation": ("steps.txt", 2),
    }
    shown = capsys.readouterr().out
    assert "::error file=m/prog.py,line=9,title=cfepy%3A died::PROG died: error: ubyte " in shown
    assert len(re.findall(r"^::error ", shown, re.MULTILINE)) == len(by_rule)


def test_run_without_problems_has_only_passed_cases(tmp_path: Path) -> None:
    mission(tmp_path / "m")
    assert main(["run", "m", "--for", "1", "--quiet", *OUTPUTS]) == 0
    assert [list(case) for case in cases(Path("out.xml")).values()] == [[]]
    assert results(Path("out.sarif")) == []


def test_files_are_named_from_the_top_of_the_repository(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    mission(tmp_path / "ground" / "m", "1 / 0")
    monkeypatch.setenv("GITHUB_WORKSPACE", str(tmp_path))
    monkeypatch.chdir(tmp_path / "ground")
    assert main(["run", "m", "--for", "1", "--quiet", "--github"]) == 1
    assert "::error file=ground/m/prog.py,line=9," in capsys.readouterr().out


def test_races_name_both_accesses(tmp_path: Path) -> None:
    words = ["run", str(RACE), "--for", "0.7", "--schedule", "random:0", "--races", "--quiet"]
    assert main([*words, "--sarif", "out.sarif"]) == 1
    race = next(each for each in results(Path("out.sarif")) if "travelled" in each["message"]["text"])
    related = [each["physicalLocation"]["region"]["startLine"] for each in race["relatedLocations"]]
    assert {place_of(race)[1], *related} == {15, 17}


def test_check_reports_each_mistake_at_its_line(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    mission(tmp_path / "m", rules="board: linux\nrosss: {}\n")
    assert main(["check", "m", *OUTPUTS]) == 1
    assert [place_of(each) for each in results(Path("out.sarif"))] == [("m/mission.yaml", 2)]
    assert [case.get("line") for case in cases(Path("out.xml")).values()] == ["2"]
    assert "::error file=m/mission.yaml,line=2,title=cfepy%3A mistake::" in capsys.readouterr().out
    mission(tmp_path / "m", rules="board: linux\n")
    assert main(["check", "m", *OUTPUTS]) == 0
    assert list(cases(Path("out.xml"))) == ["no mistakes"]


def test_explore_reports_each_failure_with_cause_and_command(capsys: pytest.CaptureFixture[str]) -> None:
    shutil.copytree(RACE, "race")
    words = ["explore", "race", "--for", "1.3", "--seeds", "4", "--jobs", "1", "--results", "r.results"]
    assert main([*words, "--quiet", *OUTPUTS]) == 1
    ((name, case),) = cases(Path("out.xml")).items()
    words = "the wheels made # ticks, the odometer says #"
    assert name == f"ended with an error: WHEELS: exit status # (node /wheels): {words}"
    title, cause, *_ = case[0].get("message", "").splitlines()
    assert re.sub(r"\d+", "#", title) == name
    assert cause.startswith("cause: an update of Odometer.travelled is lost: ")
    assert 0.5 < float(case.get("time", "")) <= 1.3
    assert "time, s     ODOMETER.left_tic.1" in (case[0].text or "")
    (found,) = results(Path("out.sarif"))
    lines = [
        place_of(found)[1],
        *(each["physicalLocation"]["region"]["startLine"] for each in found["relatedLocations"]),
    ]
    assert sorted(lines) == [15, 17]
    assert "replay: cfepy run --for " in found["message"]["text"]
    shown = capsys.readouterr().out
    annotated = re.findall(r"^::(\w+) file=race/odometer\.py,line=(\d+),", shown, re.MULTILINE)
    assert annotated in ([("error", "15"), ("notice", "17")], [("error", "17"), ("notice", "15")])
    assert "schedules" in shown.splitlines()[-1]
    assert main(["explore", "--replay-all", "r.results", *OUTPUTS]) == 1
    replayed = cases(Path("out.xml"))
    assert {name: [each.tag for each in case] for name, case in replayed.items()} == {name: ["failure"]}
    assert replayed[name][0].get("message") == f"still there: {title}"
    assert float(replayed[name].get("time", "")) > 0.5
    assert len(results(Path("out.sarif"))) == 1


def test_explore_without_a_failure_has_a_passed_case(tmp_path: Path) -> None:
    mission(tmp_path / "m")
    assert main(["explore", "m", "--for", "1", "--seeds", "1", "--jobs", "1", "--quiet", *OUTPUTS]) == 0
    ((name, case),) = cases(Path("out.xml")).items()
    assert (name, case.get("time")) == ("no failure", "1.000")


def test_name_of_a_failure_is_the_same_in_runs_with_other_numbers() -> None:
    texts = [f"job {number} is sent again, but was done at {at}" for number, at in ((4, 2.050040), (17, 1.1))]
    failures = [Failure("invariant", "not again after done", text) for text in texts]
    assert {each.name for each in failures} == {
        "invariant: not again after done: job # is sent again, but was done at #"
    }
    assert Failure("data race", "", "x").name == "data race: x"


def test_rostest_reports_the_line_of_the_failed_assertion(
    demo: Path, write_launch: Launch, capsys: pytest.CaptureFixture[str]
) -> None:
    talker = '<node pkg="demo" type="talker.py" name="talker"/>\n'
    file = write_launch(
        talker + '<test pkg="demo" type="check.py" test-name="check"><param name="begins" value="x"/></test>'
    )
    assert main(["rostest", file, *OUTPUTS]) == 1
    failed = [case for case in cases(Path("out.xml")).values() if len(case)]
    assert [(Path(case.get("file", "")).suffix, case.get("line")) for case in failed] == [(".launch", "2")]
    (found,) = results(Path("out.sarif"))
    assert place_of(found)[0].endswith("check.py")
    assert "::error file=" in capsys.readouterr().out


def test_mistake_of_the_command_line_is_annotated(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["run", "none_such", "--github"]) == 2
    assert "::error file=none_such,title=cfepy%3A usage::unknown mission; " in capsys.readouterr().out


@pytest.mark.parametrize("option", ["--junit", "--sarif"])
@pytest.mark.parametrize("words", [["run", "m"], ["check", "m"], ["explore", "m"], ["rostest", "a.test"]])
def test_file_that_cannot_be_written_is_reported_before_the_run(
    words: list[str], option: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    mission(tmp_path / "m")
    assert main([*words, option, "none/out"]) == 2
    shown = capsys.readouterr()
    assert f"none/out: {option}: " in shown.err
    assert shown.out == ""


def test_standard_output_can_be_the_file(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    mission(tmp_path / "m")
    assert main(["run", "m", "--for", "1", "--junit", "-"]) == 0
    assert ElementTree.fromstring(capsys.readouterr().out.encode()).tag == "testsuites"


def test_annotations_and_a_file_cannot_share_standard_output(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    mission(tmp_path / "m")
    assert main(["run", "m", "--for", "1", "--json", "-", "--github"]) == 2
    assert "--github: cannot be combined with `-` of another option" in capsys.readouterr().err


# -- the verdict -------------------------------------------------------------------------------------------------------

VERDICT = re.compile(re.search(r"^\^verdict.*\$$", PAGE.read_text(encoding="utf-8"), re.MULTILINE)[0])  # type: ignore[index]
COUNTED = re.compile(r"(\w+) \(")


@pytest.mark.parametrize(
    ("act", "seconds", "status", "outcome", "counts"),
    [
        ("", "1", 0, "passed", {}),
        ("1 / 0", "1", 1, "failed", {"crashes": 1}),
        ("cfe.evs.send_event(7, 3, 'bad')", "1", 1, "failed", {"events": 1}),
        ("cfe.os.bin_sem_take(cfe.os.bin_sem_create('S', 0, 0))", "1", 1, "failed", {"hangs": 1}),
        ("", "0.1", 2, "inconclusive", {}),
    ],
)
def test_run_ends_with_a_verdict(
    act: str,
    seconds: str,
    status: int,
    outcome: str,
    counts: dict[str, int],
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
) -> None:
    mission(tmp_path / "m", act)
    names = COUNTED.findall(VERDICT.pattern.partition(";")[2].partition("(?:")[0])
    expected = dict.fromkeys(names, 0) | counts
    assert main(["run", "m", "--for", seconds, "--json", "n.json"]) == status
    found = VERDICT.fullmatch(capsys.readouterr().out.splitlines()[-1])
    assert found is not None
    assert (found[1], dict(zip(names, map(int, found.groups()[1:-1]), strict=True))) == (outcome, expected)
    assert json.loads(Path("n.json").read_text(encoding="utf-8"))["verdict"] == {
        "outcome": outcome,
        **expected,
        "left_out": [],
    }


def test_quiet_run_prints_only_problems_and_the_verdict(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    mission(tmp_path / "m")
    Path("steps.txt").write_text("at 1 send CFE_ES_NOOP\nat 1.1 expect app NONE RUNNING\n", encoding="utf-8")
    assert main(["run", "m", "--script", "steps.txt", "--quiet", "--save-files", "saved"]) == 1
    shown = capsys.readouterr()
    assert [line[:27] for line in shown.out.splitlines()] == [
        "FAILED     1.100000  steps.",
        "verdict: failed; steps 1, i",
    ]
    assert shown.err == ""
    assert main(["run", "m", "--for", "1", "--quiet"]) == 0
    shown = capsys.readouterr()
    assert VERDICT.fullmatch(shown.out.rstrip("\n"))
    assert shown.err == ""


def test_quiet_outputs_report_rules_and_moves_that_never_applied(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    mission(tmp_path / "m", rules='invariants:\n  never: {packet: CFE_TBL_REG_TLM, holds: "msg.Size < 0"}\n')
    never = "invariant 'never' (mission.yaml:2) was never judged: no message of CFE_TBL_REG_TLM was sent\n"
    moves = "moves:NOBODY.x@550/add.get_time=NOONE"
    assert main(["run", "m", "--for", "1", "--quiet", "--schedule", moves]) == 0
    note = f"0 of 1 moves of the schedule were possible; not possible: {moves[6:]}"
    assert capsys.readouterr().err == f"cfepy: {note}\ncfepy: {never}"
    assert main(["explore", "m", "--for", "1", "--seeds", "2", "--jobs", "1", "--quiet"]) == 0
    assert capsys.readouterr().out == f"2 schedules, 0 failed: no failure\n  {never}"


def test_quiet_exploration_prints_only_the_summary(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    mission(tmp_path / "m")
    assert main(["explore", "m", "--for", "1", "--seeds", "2", "--jobs", "1", "--quiet"]) == 0
    assert capsys.readouterr() == ("2 schedules, 0 failed: no failure\n", "")
