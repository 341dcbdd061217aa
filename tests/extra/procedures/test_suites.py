"""Suites of procedures in flights: definitions with ERB, resets, verdicts and requirements."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest

from cfepy.cli.main import main
from cfepy.extra.procedures import CampaignResult, explore_procedures
from cfepy.extra.procedures.procedures_command import place_of
from cfepy.status import UsageError
from tests.extra.procedures.demo import PLUGIN, SUITE, fly, fly_script, settings, verdicts


@pytest.fixture(scope="module")
def flown() -> CampaignResult:
    return fly(SUITE)


def test_suite_has_a_verdict_for_each_test(flown: CampaignResult) -> None:
    assert verdicts(flown) == [
        ("es_group::test_noop", "PASS"),
        ("es_group::test_processor_reset", "PASS"),
        ("es_group::test_skipped", "SKIP"),
        ("es_group::test_wrong", "FAIL"),
    ]


def test_failed_test_names_its_line_and_value(flown: CampaignResult) -> None:
    failed = flown.tests[3]
    assert failed.place.endswith("groups/es_group.py:28")
    assert "COMMAND_ERROR_COUNTER == 9 failed with value == 0 after waiting 1.000 seconds" in failed.message


def test_processor_reset_inside_a_procedure_leaves_the_station_connected(flown: CampaignResult) -> None:
    assert any("CFE_EVS" in line for line in flown.tests[1].events)
    assert flown.tests[1].seconds > 2.0


def test_requirements_have_the_states_of_their_tests(flown: CampaignResult) -> None:
    states = {each.name: each.state for each in flown.requirements.rows()}
    assert states == {"cES1001": "P", "cES1002": "P", "cES1003": "F", "cES1009": "I"}


def test_equal_flights_of_a_suite_have_equal_times(flown: CampaignResult) -> None:
    again = fly(SUITE)
    assert [each.seconds for each in again.tests] == [each.seconds for each in flown.tests]
    assert [each.events for each in again.tests] == [each.events for each in flown.tests]


def test_command_writes_matrix_json_and_junit(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    texts = tmp_path / "requirements.yaml"
    texts.write_text("cES1001: accepts a no-op\ncES2000: never tested\n", encoding="utf-8")
    names = {name: str(tmp_path / name) for name in ("a.json", "a.csv", "a.html", "a.xml")}
    options = ["--json", names["a.json"], "--csv", names["a.csv"], "--html", names["a.html"], "--junit", names["a.xml"]]
    assert main(["procedures", str(SUITE), "lab", "--requirements", str(texts), *options]) == 1
    assert "tests: 2 passed, 1 failed, 1 skipped" in capsys.readouterr().out
    table = (tmp_path / "a.csv").read_text(encoding="utf-8")
    assert "cES1001,accepts a no-op,passed,demo_suite::es_group::test_noop,passed," in table
    assert "cES2000,never tested,not run,," in table
    assert 'name="requirement" value="cES1001"' in (tmp_path / "a.xml").read_text(encoding="utf-8")
    assert "never tested" in (tmp_path / "a.html").read_text(encoding="utf-8")
    again = ["--test", "test_noop", "--baseline", names["a.json"]]
    assert main(["procedures", str(SUITE), "lab", *again]) == 0
    assert "changed: requirement cES1003: failed before, gone now" in capsys.readouterr().out


def test_test_is_racy_if_its_verdict_depends_on_the_schedule(tmp_path: Path) -> None:
    file = tmp_path / "racy.py"
    file.write_text(
        "wait_check_packet('LAB', 'CFE_ES_HK', 1, 10)\nwait(0.78)\n"
        "wait_check('LAB CFE_ES_HK RECEIVED_COUNT == 1', 0.2)\n",
        encoding="utf-8",
    )
    notes: list[str] = []
    (found,) = explore_procedures([file], settings(through_lab=False, line_delay=0.0), 8, notes.append, probes=0)
    assert (found.passed + found.failed, found.is_racy) == (8, True)
    assert found.cause.startswith("the procedure looks too rarely: its condition was true at ")
    assert notes[1].startswith("random:1, ground seed 1: ")


def test_group_names_the_current_suite_group_and_script(tmp_path: Path) -> None:
    file = tmp_path / "names.py"
    file.write_text(
        "from openc3.script.suite import Group, Suite\n"
        "class Named(Group):\n"
        "    def test_it(self):\n"
        "        print(Group.current_suite(), self.current_group(), Named.current_script())\n"
        "class All(Suite):\n"
        "    def __init__(self):\n"
        "        self.add_group(Named)\n",
        encoding="utf-8",
    )
    (result,) = fly(file).tests
    assert result.output == ["All Named test_it"], result.message


def test_explored_tests_are_written_for_ci(tmp_path: Path) -> None:
    junit, sarif = tmp_path / "a.xml", tmp_path / "a.sarif"
    options = ["--explore", "2", "--test", "test_wrong", "--junit", str(junit), "--sarif", str(sarif)]
    assert main(["procedures", str(SUITE), "lab", *options]) == 1
    assert 'message="failed test: 0 passed, 2 failed: CHECK' in junit.read_text(encoding="utf-8")
    assert "failed-test" in sarif.read_text(encoding="utf-8")


def test_output_about_one_flight_is_refused_with_explore(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    page = str(tmp_path / "a.html")
    assert main(["procedures", str(SUITE), "lab", "--explore", "2", "--html", page]) == 2
    assert "--html: is about one flight" in capsys.readouterr().err


def test_folder_without_a_suite_is_refused(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "plain.py").write_text("x = 1\n", encoding="utf-8")
    assert main(["procedures", str(tmp_path), "lab"]) == 2
    assert "has no suite" in capsys.readouterr().err


def test_folder_finds_its_suites() -> None:
    assert verdicts(fly(PLUGIN, tests=("test_noop",))) == [("es_group::test_noop", "PASS")]


@pytest.mark.parametrize(
    ("text", "place"),
    [
        ("ground", ("ground", 1234, 1235)),
        ("10.0.0.1:2000", ("10.0.0.1", 2000, 1235)),
        ("10.0.0.1:2000:2001", ("10.0.0.1", 2000, 2001)),
    ],
)
def test_computer_has_a_host_and_two_ports(text: str, place: tuple[str, int, int]) -> None:
    assert place_of(text) == place


@pytest.mark.parametrize("text", ["h:1:2:3", "h:0", "h:65536", "h:x", "h:-1", ":1"])
def test_wrong_computer_is_reported(text: str) -> None:
    with pytest.raises(UsageError, match="--computer: expected HOST"):
        place_of(text)


def test_package_of_an_environment_below_the_procedures_stays_loaded(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    packages = tmp_path / "venv" / "site-packages"
    packages.mkdir(parents=True)
    (packages / "installed_once.py").write_text("", encoding="utf-8")
    (tmp_path / "helper_of_procedures.py").write_text("", encoding="utf-8")
    monkeypatch.syspath_prepend(packages)
    result = fly_script(tmp_path, "import installed_once, helper_of_procedures\n")
    assert result.verdict == "PASS", result.message
    assert "installed_once" in sys.modules
    assert "helper_of_procedures" not in sys.modules
