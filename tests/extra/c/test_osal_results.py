"""Parsing the results of OSAL's own tests from a console."""

from __future__ import annotations

from dev.c.osal_tests.__main__ import row
from dev.c.osal_tests.flight import read

CONSOLE = """\
CFE_PSP: Starting the cFE with a POWER ON reset.
[BEGIN] 00 SETUP
[ INFO] nothing is tested here
[  END] No test cases
[BEGIN] 01 First
[ PASS] 01.001 queue-test.c:5 - created
[  MIR] 01.002 queue-test.c:6 - look yourself
[  END] 01 First TOTAL::2
[BEGIN] 02 Second
[ FAIL] 02.001 queue-test.c:9 - Rc=-1
[  TTF] 02.002 queue-test.c:9 - cannot clean up
COMPLETE: 2 test segments"""


def test_segments_with_a_test_are_kept() -> None:
    result = read("queue-test", CONSOLE.splitlines())
    assert [(segment.name, segment.passes) for segment in result.segments] == [("01 First", True), ("02 Second", False)]
    assert result.segments[1].failures == ["02.001 queue-test.c:9 - Rc=-1", "02.002 queue-test.c:9 - cannot clean up"]
    assert row(result) == "| queue-test | 1 of 2 | 1 | 1 | 1 |"


def test_without_an_end_is_reported() -> None:
    result = read("queue-test", CONSOLE.splitlines()[:-1])
    assert "not to its end" in row(result)
