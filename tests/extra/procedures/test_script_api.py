"""The functions of `openc3.script`, each in a script that flies against lab."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.extra.procedures.demo import fly, fly_script, verdicts

START = "wait_check_packet('LAB', 'CFE_ES_HK', 1, 20)\n"


@pytest.mark.parametrize(
    "lines",
    [
        "cmd('LAB', 'CFE_ES_NOOP')\nassert get_cmd_cnt('LAB CFE_ES_NOOP') == 1",
        "cmd('LAB CFE_EVS_SET_FILTER', {'x': 1}) if False else None\nassert tlm('LAB CFE_ES_APP_TLM NAME') is None",
        "assert tlm_formatted('LAB CFE_ES_HK COMMAND_COUNTER') == '0'",
        "assert get_packet('LAB CFE_ES_HK')['COMMANDCOUNTER'] == 0",
        "check_tolerance('LAB CFE_ES_HK COMMAND_COUNTER', 1, 1)",
        "check_expression(\"tlm('LAB CFE_ES_HK COMMAND_COUNTER') == 0\")",
        "check_exception('check', 'LAB CFE_ES_HK COMMAND_COUNTER == 5')",
        "check_exception('cmd', 'LAB CFE_ES_NO_SUCH')",
        "assert not wait('LAB CFE_ES_HK COMMAND_COUNTER == 5', 1)",
        "assert 1.0 <= wait(1) < 1.1",
        "assert not wait_expression('False', 1)",
        "assert wait_packet('LAB', 'CFE_ES_HK', 1, 10)",
        "wait_check_tolerance('LAB CFE_ES_HK COMMAND_COUNTER', 0.4, 0.5, 1)",
        "set_tlm('LAB CFE_ES_HK COMMAND_COUNTER = 77')\ncheck('LAB CFE_ES_HK COMMAND_COUNTER in [76, 77]')",
        "override_tlm('LAB CFE_ES_HK COMMAND_COUNTER = 5')\ncheck('LAB CFE_ES_HK COMMAND_COUNTER == 5')\n"
        "normalize_tlm('LAB CFE_ES_HK COMMAND_COUNTER')\ncheck('LAB CFE_ES_HK COMMAND_COUNTER == 0')",
        "set_limits('LAB', 'CFE_ES_HK', 'COMMAND_COUNTER', -9, -8, -7, -6)\n"
        "assert get_out_of_limits() == [['LAB', 'CFE_ES_HK_TLM', 'COMMANDCOUNTER', 'RED_HIGH']], get_out_of_limits()\n"
        "assert get_overall_limits_state() == 'RED'\n"
        "disable_limits('LAB CFE_ES_HK COMMAND_COUNTER')\nassert get_overall_limits_state() == 'GREEN'",
        "id = subscribe_packets([['LAB', 'CFE_ES_HK']])\nwait(9)\nassert len(get_packets(id)[1]) >= 2",
        "stash_set('a', 1)\nassert stash_get('a') == 1 and stash_keys() == ['a']",
        "set_line_delay(0)\nassert get_line_delay() == 0\nrun_mode()",
        "import time\nbefore = time.time()\ntime.sleep(5)\nassert 5 <= time.time() - before < 6",
        "import openc3.script as oc3\nfrom openc3.script.suite import Suite, Group\noc3.cmd('LAB CFE_ES_NOOP')",
        "cmd('LAB CFE_EVS_ENABLE_EVENT_TYPE with BIT_MASK DEBUG')",
        "wait_check('LAB CFE_ES_HK RECEIVED_COUNT > 1', 10)\nassert tlm('LAB CFE_ES_HK RECEIVED_TIMESECONDS') > 1e9",
        "assert len(get_tlm_packet('LAB CFE_ES_HK')) > 20\nassert 'CFE_ES_NOOP' in get_all_cmd_names('LAB')",
        "assert get_tlm_values(['LAB__CFE_ES_HK__COMMAND_COUNTER__RAW']) == [[0, None]]",
        "cmd('LAB CFE_ES_QUERY_ONE with APPLICATION TO_LAB')\n"
        "assert get_cmd_value('LAB CFE_ES_QUERY_ONE APPLICATION') == 'TO_LAB'\n"
        "assert get_cmd_value('LAB', 'CFE_ES_QUERY_ONE', 'APPLICATION') == 'TO_LAB'",
        "assert get_cmd_time('LAB CFE_ES_NOOP') == ['LAB', 'CFE_ES_NOOP', None, None]\ncmd('LAB CFE_ES_NOOP')\n"
        "import time\n*names, seconds, more = get_cmd_time('LAB', 'CFE_ES_NOOP')\n"
        "assert 0 < time.time() - seconds - more / 1e6 < 1",
        "cmd('LAB CFE_ES_NOOP')\nassert get_cmd_cnts([['LAB', 'CFE_ES_NOOP'], ['LAB', 'CFE_EVS_NOOP']]) == [1, 0]\n"
        "assert get_tlm_cnts([['LAB', 'CFE_ES_HK']]) == [1]",
        "cmd('LAB CFE_ES_NOOP')\nassert get_cmd_buffer('LAB CFE_ES_NOOP')['buffer'][:2] == b'\\x18\\x06'\n"
        "assert get_tlm_buffer('LAB CFE_ES_HK')['buffer'][:2] == b'\\x08\\x00'",
        "override_tlm('LAB CFE_ES_HK COMMAND_COUNTER = 5')\n(found,) = get_overrides()\n"
        "assert (found['item_name'], found['value']) == ('COMMANDCOUNTER', 5)",
        "before = get_limits_sets()\nset_limits_set('TVAC')\n"
        "assert (before, get_limits_sets()) == (['DEFAULT'], ['DEFAULT', 'TVAC'])",
        "enable_instrumentation()\nset_max_output(5)",
    ],
)
def test_function_does_as_documented(tmp_path: Path, lines: str) -> None:
    result = fly_script(tmp_path, START + lines + "\n")
    assert (result.verdict, result.message) == ("PASS", "")


@pytest.mark.parametrize(
    ("lines", "text", "line"),
    [
        ("x = 1\nscript_run('a.py')", "script_run is not supported: scripts of a COSMOS server", 2),
        ("step_mode()", "step_mode requires a user", 1),
        ("get_cmd_value('LAB CFE_ES_QUERY_ONE APPLICATION')", "LAB CFE_ES_QUERY_ONE was not sent", 1),
        ("x = 1\nenable_cmd('LAB CFE_ES_NOOP')", "enable_cmd is not supported: it changes a COSMOS server", 2),
        ("get_setting('x')", "get_setting is not supported: it belongs to the settings of a COSMOS server", 1),
        ("enable_limits_group('A')", "enable_limits_group is not supported: definitions have no limits groups", 1),
        ("ask('Ready?')", "no answer to the question 'Ready?'", 1),
        ("load_utility('LAB/procedures/a.rb')", "is Ruby", 1),
        ("cmd('LAB CFE_ES_NOP')", "has no command CFE_ES_NOP; did you mean CFE_ES_NOOP", 1),
        ("tlm('LAB CFE_ES_HK COMMAND_CONTER')", "has no item COMMAND_CONTER", 1),
        ("cmd('LAB CFE_ES_SET_MAX_PR_COUNT with MAX_PR_COUNT 99999')", "must be from 0 to 65535, not 99999", 1),
        ("check('LAB CFE_ES_HK COMMAND_COUNTER == abc')", "invalid value 'abc'", 1),
        ("cmd('NOBODY CFE_ES_NOOP')", "unknown target NOBODY", 1),
        ("wait('LAB CFE_ES_HK COMMAND_COUNTER ~ 1', 1)", "invalid comparison '~ 1'", 1),
    ],
)
def test_function_beyond_is_refused_with_file_and_line(tmp_path: Path, lines: str, text: str, line: int) -> None:
    result = fly_script(tmp_path, lines + "\n")
    assert result.verdict == "FAIL"
    assert text in result.message
    assert result.place.endswith(f"script.py:{line}")


def test_answers_come_from_a_file(tmp_path: Path) -> None:
    answers = tmp_path / "answers.yaml"
    answers.write_text("ready: Go\nhazardous: 'Yes'\n", encoding="utf-8")
    result = fly_script(tmp_path, "assert ask('Are you ready?') == 'Go'\n", answers=answers)
    assert (result.verdict, result.message) == ("PASS", "")


def test_failed_wait_says_when_its_condition_was_true(tmp_path: Path) -> None:
    lines = (
        "cmd('LAB SAMPLE_APP_NOOP')\ncmd('LAB CFE_ES_NOOP')\nwait(0.5)\n"
        "wait_check_expression(\"tlm('LAB CFE_EVS_LONG_EVENT_MSG PACKET_ID_APP_NAME') == 'SAMPLE_APP'\", 2, 0.5)\n"
    )
    result = fly_script(tmp_path, lines, line_delay=0.0)
    assert result.verdict == "FAIL"
    assert "it was true at 0." in result.message
    assert "before this wait began" in result.message


def test_pause_before_each_line_takes_virtual_time(tmp_path: Path) -> None:
    slow, fast = (fly_script(tmp_path, "a = 1\nb = 2\n", line_delay=delay) for delay in (0.5, 0.0))
    assert (slow.seconds, fast.seconds) == (1.0, 0.0)


def test_second_door_flies_tests_for_a_connection(tmp_path: Path) -> None:
    file = tmp_path / "methods.py"
    file.write_text(
        """
from cfs_test_connection import CfsTest_Connection

class sample_methods:
    DEFAULT_APP_NAME = "SAMPLE_APP"

    def __init__(self, connection: CfsTest_Connection):
        self.connection = connection

    def test_aliveness(self):
        self.connection.wait_check_packet("HK", 1, 100)
        count = self.connection.tlm("HK", "CommandCounter")
        self.connection.cmd("Noop")
        self.connection.wait_check("HK", "CommandCounter", count + 1, 100)
        es = self.connection.spawn_child("CFE_ES")
        es.cmd("SetMaxPRCount", MaxPRCount=3)
        es.wait(5)
        assert es.tlm("HK", "MaxProcessorResets") == 3
""",
        encoding="utf-8",
    )
    result = fly(file, through_lab=False)
    assert verdicts(result) == [("sample_methods::test_aliveness", "PASS")]


def test_requirement_tracker_of_a_procedure_is_read_at_the_end(tmp_path: Path) -> None:
    (tmp_path / "my_utils.py").write_text(
        """
import time
from openc3.script import *

class RequirementTracker:
    def __init__(self):
        self.requirements = {}

    def set_requirement(self, name, state, message):
        self.requirements[name] = {"state": state, "events": [{"message": message}]}

tracker = RequirementTracker()

def pause():
    time.sleep(3)
""",
        encoding="utf-8",
    )
    file = tmp_path / "script.py"
    lines = "from my_utils import pause, tracker\npause()\ntracker.set_requirement('R7', 'P', 'it waited')\n"
    file.write_text(lines, encoding="utf-8")
    result = fly(file, through_lab=False, line_delay=0.0)
    assert result.tests[0].seconds == 3.0
    assert [(each.name, each.state, each.tests) for each in result.requirements.rows()] == [
        ("R7", "P", {"script": ("P", "it waited")})
    ]
