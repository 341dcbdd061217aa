"""`cfepy rostest`: each test of a launch file in its own run; its results are read, shown and written."""

from __future__ import annotations

from pathlib import Path
from xml.etree import ElementTree

import pytest

from cfepy.cli.main import main
from cfepy.pilot import check_mission
from tests.cli.ros_packages import Launch, demo, write_launch

__all__ = ["demo", "write_launch"]  # fixtures

TALKER = '<node pkg="demo" type="talker.py" name="talker"/>'
CHECK = '<test pkg="demo" type="check.py" test-name="check" {}><param name="begins" value="{}"/>{}</test>'


def test_tests_that_pass(write_launch: Launch, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["rostest", write_launch(TALKER + CHECK.format("", "hello", ""))]) == 0
    shown = capsys.readouterr().out.splitlines()
    assert shown[2:4] == [
        "[demo.check.__main__.TestTalker/test_hears][passed]",
        "[demo.check.__main__.TestTalker/test_waits][passed]",
    ]
    assert shown[-5:] == ["SUMMARY", " * RESULT: SUCCESS", " * TESTS: 2", " * ERRORS: 0", " * FAILURES: 0"]


def test_a_test_that_fails(write_launch: Launch, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    written = tmp_path / "results.xml"
    file = write_launch(TALKER + CHECK.format("", "bye", ""))
    assert main(["rostest", file, "--results", str(written)]) == 1
    shown = capsys.readouterr().out
    assert "[demo.check.__main__.TestTalker/test_hears][FAILURE]\n    'hello' != 'bye'" in shown
    assert " * RESULT: FAIL\n * TESTS: 2\n * ERRORS: 0\n * FAILURES: 1" in shown
    suite = ElementTree.parse(written).getroot()
    assert {name: suite.get(name) for name in ("tests", "errors", "failures")} == {
        "tests": "2",
        "errors": "0",
        "failures": "1",
    }


def test_the_time_limit_is_virtual(write_launch: Launch, capsys: pytest.CaptureFixture[str]) -> None:
    slow = '<param name="sleeps" value="100"/>'
    assert main(["rostest", write_launch(TALKER + CHECK.format('time-limit="120"', "hello", slow))]) == 0
    assert main(["rostest", write_launch(TALKER + CHECK.format('time-limit="20"', "hello", slow))]) == 1
    assert "[demo.check.time_limit][FAILURE]\n    did not end within its 20 virtual seconds" in capsys.readouterr().out


def test_a_test_without_results_says_what_it_printed(
    demo: Path, write_launch: Launch, capsys: pytest.CaptureFixture[str]
) -> None:
    (demo / "scripts/broken.py").write_text("import no_such_module\n", encoding="utf-8")
    assert main(["rostest", write_launch('<test pkg="demo" type="broken.py" test-name="b"/>')]) == 1
    shown = capsys.readouterr().out
    assert "the test node wrote no results, exit status 1" in shown
    assert "| ModuleNotFoundError: No module named 'no_such_module'" in shown
    assert " * ERRORS: 1" in shown


def test_a_test_in_another_language_is_an_error(write_launch: Launch, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["rostest", write_launch('<test pkg="demo" type="gtest" test-name="g"/>')]) == 1
    assert "[demo.g.can_run_here][ERROR]\n    package 'demo' has no file 'gtest'" in capsys.readouterr().out


@pytest.mark.slow
def test_a_test_is_retried_with_another_seed(demo: Path, write_launch: Launch) -> None:
    (demo / "scripts/flaky.py").write_text(
        "import random, sys, unittest, rostest\n"
        "class TestFlaky(unittest.TestCase):\n"
        "    def test_third_time(self):\n"
        "        self.assertGreater(random.random(), 0.5)\n"
        "rostest.rosrun('demo', 'flaky', TestFlaky, sys.argv)\n",
        encoding="utf-8",
    )
    test = '<test pkg="demo" type="flaky.py" test-name="f" retry="{}"/>'
    found = [main(["rostest", "--seed", "2", write_launch(test.format(tries))]) for tries in range(4)]
    assert found == [1, 1, 0, 0]


def test_a_file_without_tests(write_launch: Launch, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["rostest", write_launch(TALKER)]) == 2
    assert "missing <test>; use `cfepy launch` to run a launch file without tests" in capsys.readouterr().err


def test_rostests_own_test_nodes(write_launch: Launch, capsys: pytest.CaptureFixture[str]) -> None:
    params = '<param name="topic" value="chatter"/><param name="hz" value="{}"/><param name="hzerror" value="0.5"/>'
    rate = (
        '<test pkg="rostest" type="hztest" test-name="{}">' + params + '<param name="test_duration" value="5"/></test>'
    )
    topics = "<rosparam>topics: [{name: chatter}, {name: nothing, negative: true, timeout: 2}]</rosparam>"
    file = write_launch(
        TALKER
        + rate.format("right", 10)
        + rate.format("wrong", 20)
        + f'<test pkg="rostest" type="publishtest" test-name="published">{topics}</test>'
        + '<test pkg="rostest" type="paramtest" test-name="there">'
        '<param name="param_name_target" value="/there/param_name_target"/></test>'
    )
    assert main(["rostest", file]) == 1
    shown = capsys.readouterr().out
    assert "[rostest.right.__main__.HzTest/test_hz][passed]" in shown
    assert "average rate (10.000Hz) is below the minimum (19.500Hz)" in shown
    assert "[rostest.published.__main__.PublishTest/test_publish][passed]" in shown
    assert "[rostest.there.__main__.ParamTest/test_param][passed]" in shown
    assert " * TESTS: 4\n * ERRORS: 0\n * FAILURES: 1" in shown


def test_test_with_the_name_of_a_node_is_named(write_launch: Launch, capsys: pytest.CaptureFixture[str]) -> None:
    file = write_launch(TALKER + CHECK.format('name="talker" time-limit="2"', "hello", ""))
    told = (
        "test check runs as node /talker, so it shuts down the node /talker of line 1 (type talker.py); "
        'give the test another name: name="talker_test"'
    )
    assert main(["rostest", file]) == 1
    shown = capsys.readouterr().err
    assert f"{file}:1: {told}" in shown
    assert "/talker: the node of TALKER was shut down when the node of TALKER2 took its name" in shown
    assert [each.text for each in check_mission(file)] == [told]
