"""The pytest plugin: missions in tests, its report of a failure, and its cost for tests that do not use it."""

from __future__ import annotations

import re
import subprocess
import sys
import textwrap
import threading
import tomllib
from pathlib import Path

import pytest

from cfepy.cli.main import main
from cfepy.extra.exploration import in_tests as exploration
from cfepy.ground.parameters import is_source_of_files
from cfepy.journal import read_journal, replay
from cfepy.rtos import cpu_time
from cfepy.rtos.cpu_time import Spent
from cfepy.testing import plugin
from tests.own_paths import own_files
from tests.testing.conftest import ROOT, Suite, given_verbatim, told_command, write_mission

WAITS = """
def test_it(mission):
    flight = mission("talk")
    flight.run_until_operational()
    {act}
    flight.expect_message("/count", data=77, within=0.5)
"""


def test_a_mission_flies(suite: Suite) -> None:
    suite(
        """
        def test_it(mission):
            flight = mission("talk")
            flight.run_until_operational()
            flight.publish("/jump", data=77)
            assert flight.expect_message("/count", data=77, within=0.2).data == 77
            assert flight.stdout("talker") == ["talking"]
        """
    ).assert_outcomes(passed=1)


def test_failed_expectation_reports_the_actual_values(suite: Suite) -> None:
    result = suite(WAITS.format(act="flight.publish('/jump', data=76)"))
    result.assert_outcomes(failed=1)
    result.stdout.fnmatch_lines(
        [
            "*expected message on /count with data=77 within 0.5 s, until 1.*",
            "*instead: * messages, the last: data: * at *",
            "*console until 1.*",
            "*talker*talking*",
            "*to reproduce: pytest test_it.py::test_it --cfepy-seed 0 --cfepy-schedule fifo",
        ]
    )


def test_long_work_writes_a_line_into_the_report(suite: Suite) -> None:
    result = suite(
        """
        from cfepy.units import NS_PER_S
        from cfepy.writing.work_progress import WorkProgress

        def test_it(mission):
            times = iter([4, 5, 9, 10, 11])
            progress = WorkProgress(lambda: next(times) * NS_PER_S)
            for number in range(5):
                progress.show(f"compiling {number} of 5")
        """
    )
    result.assert_outcomes(passed=1)
    shown = [line for line in result.stdout.lines if "compiling" in line]
    assert shown == ["cfepy: compiling 1 of 5 (5 s so far)", "cfepy: compiling 3 of 5 (10 s so far)"]


def test_a_failure_has_no_control_characters_of_messages(suite: Suite) -> None:
    act = "flight.publish('/jump', data=76)\n    flight.mission.console.write('[talker] \\x1b]0;title\\x07')"
    result = suite(WAITS.format(act=act))
    result.assert_outcomes(failed=1)
    assert r"\x1b]0;title\x07" in result.stdout.str()
    assert "\x1b]" not in result.stdout.str()


turns = 0
"""Of the task below, which the host's clocks go by here: nothing else is too slow for them on a busy computer."""


@pytest.mark.parametrize("tasks", ["thread", "greenlet"])
def test_task_that_does_not_give_up_the_cpu_fails_its_own_test_only(
    suite: Suite, tasks: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(cpu_time.Expenses, "__call__", lambda self: Spent(turns / 1e5, turns / 1e5, 0.0))
    result = suite(
        """
        from pathlib import Path

        def test_it(mission, tmp_path):
            (tmp_path / "startup.scr").write_text("CFE_APP, app, main, SPIN, 50, 16384, 0x0, 0;\\n!\\n")
            (tmp_path / "app.py").write_text(
                "from tests.testing import test_plugin\\n"
                "def main(cfe):\\n    while True:\\n        test_plugin.turns += 1\\n"
            )
            mission(tmp_path).run_for(2)

        def test_next(mission):
            mission("talk").run_until_operational()
        """,
        "--cfepy-stall",
        "0.2",
        "--cfepy-tasks",
        tasks,
    )
    result.assert_outcomes(passed=1, failed=1)
    result.stdout.fnmatch_lines(
        ["*StallError: task SPIN has not given up the CPU since*", "*app.py:3 in main: while True:*"]
    )


@pytest.mark.slow
def test_replay_command_fails_in_the_same_way(suite: Suite, missions: Path) -> None:
    result = suite(
        WAITS.format(act="flight.set_param('/talker/step', 7)"), "--cfepy-seed", "3", "--cfepy-tasks", "thread"
    )
    again = given_verbatim(told_command(result), missions)
    assert again.returncode == 1
    said = [
        re.findall(r"E\s+(.*(?:expected|instead|console|the same).*)", text)
        for text in (result.stdout.str(), again.stdout)
    ]
    assert said[0] == said[1] != []


def test_without_actions_equals_a_run_of_the_command_line(
    suite: Suite, missions: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    text = WAITS.format(act="pass") + "\ndef test_trace(mission):\n    flight = mission('talk')\n"
    text += "    flight.run_until(1.5)\n    open('trace', 'w').write(flight.results.trace)\n"
    result = suite(text, "--cfepy-seed", "5", "--cfepy-schedule", "random:2")
    result.assert_outcomes(failed=1, passed=1)
    commands = re.findall(r"to reproduce: cfepy (run .*)", result.stdout.str())
    assert commands == ["run --for 1.100001 --seed 5 --schedule random:2 talk"]
    monkeypatch.chdir(missions)
    assert main([*commands[0].replace("1.100001", "1.5").split(), "--no-console"]) == 0
    assert capsys.readouterr().out.splitlines()[-2].split()[-1] == (missions / "trace").read_text(encoding="utf-8")


def test_missions_are_closed_and_threads_ended(suite: Suite) -> None:
    before = {each for each in threading.enumerate() if "cfepy" not in each.name}
    result = suite(
        """
        import pytest

        kept = []

        @pytest.fixture
        def flight(mission):
            flight = mission("talk")
            kept.append(flight)
            yield flight
            assert not flight.closed

        @pytest.fixture(scope="module")
        def shared(mission):
            flight = mission("talk")
            flight.run_until_operational()
            return flight

        def test_fails(mission, flight, shared):
            kept.append(mission("talk"))
            kept[-1].run_for(1)
            raise ValueError("whatever")

        def test_all_are_over(shared):
            assert [flight.closed for flight in kept] == [True, True]
            shared.run_for(0.1)
            assert not shared.closed
        """
    )
    result.assert_outcomes(passed=1, failed=1)
    assert {each for each in threading.enumerate() if "cfepy" not in each.name} == before


def test_failed_assertion_shows_the_console(suite: Suite) -> None:
    result = suite(
        """
        def test_it(mission):
            flight = mission('talk')
            flight.run_for(1)
            assert not flight.messages('/count')
        """
    )
    result.stdout.fnmatch_lines(["*cfepy*", "console until 1.000:", "*to reproduce: pytest test_it.py::test_it *"])


def test_paths_are_relative_to_the_test_file(pytester: pytest.Pytester, missions: Path) -> None:
    inner = pytester.mkdir("tests")
    (inner / "test_deep.py").write_text(
        "def test_it(mission):\n    assert mission('../talk').plan.words == ('talk',)\n", encoding="utf-8"
    )
    pytester.runpytest_inprocess("-p", "cfepy.testing.plugin").assert_outcomes(passed=1)


def test_folder_with_launch_files_alone_is_a_mission(pytester: pytest.Pytester, loaded: None) -> None:
    folder = pytester.mkdir("drive")
    (folder / "mission.yaml").write_text("launch: [drive.launch]\n", encoding="utf-8")
    (folder / "drive.launch").write_text("<launch/>\n", encoding="utf-8")
    (folder / "test_drive.py").write_text(
        "def test_it(mission):\n    assert mission('.').plan.words == ('drive',)\n", encoding="utf-8"
    )
    pytester.runpytest_inprocess("-p", "cfepy.testing.plugin").assert_outcomes(passed=1)
    assert not is_source_of_files(str(folder))
    assert is_source_of_files(str(folder.parent))


NODE = """
import rospy
rospy.init_node("acc")
rospy.set_param("/total", 2)
rospy.spin()
"""


@pytest.mark.parametrize("name", ["acc.py", "acc"])
def test_program_of_a_node_is_a_mission(name: str, suite: Suite, missions: Path) -> None:
    (missions / name).write_text(f"#!/usr/bin/env python3\n{NODE}", encoding="utf-8")
    suite(
        f"""
        def test_it(mission):
            flight = mission({name!r})
            flight.run_for(1)
            assert flight.param("/total") == 2
            assert flight.plan.command == "node"
        """
    ).assert_outcomes(passed=1)


@pytest.mark.parametrize(
    ("line", "says"),
    [
        ("mission('nowhere')", "UsageError: nowhere: unknown mission; expected a startup script*"),
        ("mission('talk', board='linxu')", "*unknown board 'linxu'; did you mean linux?*"),
        ("mission('talk').send('CFE_ES_NOP')", "*unknown command CFE_ES_NOP; did you mean*"),
        ("mission('talk').expect_event('CFE_ES', 999, within=1)", "*ExpectationError*"),
    ],
)
def test_mistake_in_a_test_shows_its_own_line(line: str, says: str, suite: Suite) -> None:
    result = suite(f"def test_it(mission):\n    {line}\n")
    result.stdout.fnmatch_lines([f">*{line}", f"E  *{says}"])
    shown = result.stdout.str().split("= FAILURES")[1].split("short test summary")[0]
    assert own_files(re.sub(r"replay: .*|to reproduce: .*", "", shown)) == []
    assert "contextlib.py" not in shown


def test_journals_of_failed_tests_are_kept_and_replay(suite: Suite, missions: Path) -> None:
    text = WAITS.format(act="flight.publish('/jump', data=76); flight.call_service('/reset')")
    result = suite(text + "\ndef test_fine(mission):\n    mission('talk').run_for(1)\n", "--cfepy-record", "journals")
    result.assert_outcomes(failed=1, passed=1)
    found = list((missions / "journals").iterdir())
    assert [each.name for each in found] == ["test_it.py-test_it.cfepy"]
    result.stdout.fnmatch_lines(["journal: journals/test_it.py-test_it.cfepy"])
    replayed = replay(read_journal(found[0]))
    assert replayed.verdict.same
    assert "[talker] talking" in replayed.flown.mission.console.lines


@pytest.mark.skipif(sys.flags.optimize > 1, reason="python -OO leaves docstrings out")
def test_fixture_has_a_description(pytester: pytest.Pytester) -> None:
    result = pytester.runpytest_inprocess("-p", "cfepy.testing.plugin", "--fixtures")
    result.stdout.fnmatch_lines(["mission [[]session scope[]]*", "*Boot missions*"])


def test_plugin_imports_nothing_for_other_suites() -> None:
    code = "import pytest, sys; before = set(sys.modules); import cfepy.testing.plugin as plugin"
    code += "; print(*sorted(set(sys.modules) - before))"
    done = subprocess.run([sys.executable, "-c", code], cwd=ROOT, capture_output=True, text=True, check=True)
    assert done.stdout.split() == [
        "cfepy",
        "cfepy.interpreter",
        "cfepy.interpreter.faces",
        "cfepy.testing",
        "cfepy.testing.plugin",
    ]


def test_plugin_defines_the_mark_of_explored_tests() -> None:
    assert plugin.EXPLORE_MARK == exploration.EXPLORE_MARK


@pytest.mark.slow
def test_suite_without_missions_loads_no_further_module(pytester: pytest.Pytester) -> None:
    pytester.makepyfile(
        "import sys\n\ndef test_it():\n    print(*(name for name in sys.modules if name.startswith('cfepy.')))\n"
    )
    code = "import sys, pytest; sys.exit(pytest.main(['-s', '-q', '-p', 'cfepy.testing.plugin']))"
    done = subprocess.run(
        [sys.executable, "-c", code], cwd=pytester.path, env={"PYTHONPATH": str(ROOT)}, capture_output=True, text=True
    )
    assert "cfepy.testing cfepy.testing.plugin\n" in done.stdout


def test_problems_are_reported_with_every_failure(suite: Suite, missions: Path) -> None:
    stuck = """
    import threading
    import rospy

    def take(first, second):
        with first:
            rospy.sleep(0.1)
            with second:
                pass

    rospy.init_node("stuck")
    one, other = threading.RLock(), threading.RLock()
    threading.Thread(target=take, args=(one, other)).start()
    take(other, one)
    """
    write_mission(missions / "deadly", stuck=textwrap.dedent(stuck), dying="import rospy\n1 / 0\n")
    result = suite(
        """
        def test_it(mission):
            flight = mission("deadly")
            flight.run_for(2)
            assert len(flight.problems) == 3
            flight.expect_event("DYING", within=0.1)
        """
    )
    result.stdout.fnmatch_lines(
        ["*instead: no event of DYING*", "*problem: *DYING*", "*problem: deadlock: STUCK* waits for *, held by STUCK*"]
    )


@pytest.mark.slow
def test_installed_plugin_is_found_by_pytest(pytester: pytest.Pytester) -> None:
    points = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]["entry-points"]["pytest11"]
    installed = pytester.mkdir("cfepy-0.dist-info")
    (installed / "METADATA").write_text("Metadata-Version: 2.1\nName: cfepy\nVersion: 0\n", encoding="utf-8")
    lines = [f"{name} = {place}" for name, place in points.items()]
    (installed / "entry_points.txt").write_text("\n".join(["[pytest11]", *lines, ""]), encoding="utf-8")
    pytester.makeconftest("pytest_plugins = ['cfepy.testing.plugin']")  # which must not be one too many
    env = {"PYTHONPATH": f"{pytester.path}:{ROOT}"}
    words = [sys.executable, "-m", "pytest", "--fixtures"]
    done = subprocess.run(words, cwd=pytester.path, env=env, capture_output=True, text=True, check=False)
    assert "mission [session scope] -- " in done.stdout, done.stdout + done.stderr
