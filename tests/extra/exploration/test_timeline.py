"""Omissions of a timeline, and the fitting of its columns."""

from __future__ import annotations

from pathlib import Path

import pytest

from cfepy.extra.exploration.task_look import AT, DOES, PREEMPTED, SENDS, WAITS, Row
from cfepy.extra.exploration.timeline import WIDTH, Story, drawn, important, story_of_run, story_width
from cfepy.pilot import RunPlan
from cfepy.rtos import HOLD
from cfepy.schedules import Schedule
from tests.extra.exploration.made import moved


def test_tasks_of_the_last_moves_come_first() -> None:
    moves = [moved("A", "B"), moved("B", "C"), moved("C", "D"), moved("D", HOLD)]
    assert important([], moves) == ("D", "C", "B", "A")
    assert important([], [moved("A", HOLD)]) == ("A",)


def test_failed_task_comes_first_and_named_tasks_are_included() -> None:
    rows = [Row(number, name, AT, "a.py:1: pass") for number, name in enumerate("FEDCBA")]
    moves = [moved("A", "B"), moved("B", "C"), moved("C", "D")]
    assert important(rows, moves, "E", "F has it; and so on") == ("E", "D", "C", "B", "A", "F")


def test_last_task_is_included_when_a_column_would_be_alone_or_a_task_was_held() -> None:
    rows = [Row(number, name, AT, "a.py:1: pass") for number, name in enumerate("ABCDD")]
    assert important(rows, [moved("A", "A")]) == ("A", "D")
    assert important(rows, [moved("A", "B")]) == ("B", "A")
    assert important(rows, [moved("A", HOLD)]) == ("A", "D", "C")


def test_as_many_tasks_have_a_column_as_fit() -> None:
    rows = tuple(Row(number, name, AT, "a.py:1: pass") for number, name in enumerate("ABCDEF"))
    story = Story(rows, ("F", "B", "E", "A", "D", "C"), end="FAILURE in F: it broke", end_ns=5)
    assert story.lines()[2].split() == ["time,", "s", "B", "E", "F"]
    assert story.lines(160)[2].split() == ["time,", "s", "A", "B", "D", "E", "F"]
    assert story.lines(200)[2].split() == ["time,", "s", *"ABCDEF"]
    assert story.lines()[-1] == "0.000000    FAILURE in F: it broke"


def test_a_wide_terminal_shows_whole_lines() -> None:
    source = "7: " + "x" * 90
    rows = (Row(0, "A", AT, f"a.py:{source}"), Row(0, "B", AT, "b.py:1: pass"))
    assert source not in "\n".join(Story(rows, ("A", "B")).lines())
    assert source in "\n".join(Story(rows, ("A", "B")).lines(180))


def test_lock_location_is_omitted_when_the_column_is_too_narrow() -> None:
    rows = (Row(0, "A", DOES, "has self.a_lock_with_a_name (bank.py:12)"), Row(0, "B", AT, "bank.py:14: pass"))
    assert "has self.a_lock_with_a_name (line 12)" in "\n".join(drawn(rows, ("A", "B")))
    narrow = drawn([*rows, Row(0, "C", AT, "bank.py:15: " + "x" * 90)], ("A", "B", "C"))
    assert any("has self.a_lock_with_a_name" in line and "(line 12)" not in line for line in narrow)


def test_cause_is_the_first_line() -> None:
    story = Story((Row(0, "A", AT, "a.py:1: pass"),), ("A",), "one thing came before another " * 5)
    lines = story.lines()
    assert lines[0].startswith("cause: one thing")
    assert lines[1].startswith("       ")
    assert max(map(len, lines)) <= WIDTH
    assert lines[2] == ""


def test_repeated_rows_are_shown_once() -> None:
    once = [("A", AT, "a.py:1: go()"), ("A", SENDS, "sends /a: data={}"), ("B", WAITS, "waits for /a")]
    rows = [Row(turn * 1000, task, kind, text.format(turn)) for turn in range(4) for task, kind, text in once]
    lines = drawn([Row(0, "A", WAITS, "sleeps"), *rows, Row(5000, "B", AT, "a.py:9: stop()")], ("A", "B"))
    assert any("sends /a: data=0 ... data=3" in line for line in lines)
    assert sum("go()" in line for line in lines) == 1
    assert "x 4         the 3 rows above, until 0.000003" in lines


def test_line_is_not_repeated_when_its_task_continues_there() -> None:
    rows = [Row(0, "A", AT, "a.py:1: go()"), Row(0, "A", SENDS, "sends /a: 1"), Row(0, "A", AT, "a.py:1: go()")]
    again = [Row(0, "B", WAITS, "sleeps"), Row(0, "A", AT, "a.py:1: go()")]
    assert sum("go()" in line for line in drawn(rows, ("A", "B"))) == 1
    assert sum("go()" in line for line in drawn([*rows, *again], ("A", "B"))) == 2


def test_file_name_is_shown_once_when_it_is_the_only_one() -> None:
    rows = [Row(0, "A", AT, "a.py:7: go()"), Row(1, "A", WAITS, "sleeps"), Row(2, "B", AT, "b.py:1: stop()")]
    assert drawn(rows, ("A",))[0] == "lines of a.py"
    assert drawn(rows, ("A",))[4].split() == ["0.000000", "7:", "go()"]
    assert drawn(rows, ("A", "B"))[1].endswith(" lines of b.py")
    assert drawn(rows, ("A", "B"))[3].split() == ["0.000000", "7:", "go()"]
    two_files = [*rows, Row(3, "B", AT, "a.py:9: go()")]
    assert "b.py:1: stop()" in "\n".join(drawn(two_files, ("A", "B")))
    assert "a.py:9: go()" in "\n".join(drawn(two_files, ("A", "B")))


def test_rows_far_from_moves_and_end_are_omitted() -> None:
    rows = [Row(number, "A", AT, f"a.py:{number}") for number in range(40)]
    rows[15] = Row(15, "A", PREEMPTED, "B")
    lines = drawn([Row(0, "A", AT, "b.py:1"), *rows], ("A", "B"))
    text = "\n".join(lines)
    assert "=== PREEMPTED by B ===" in text
    assert "a.py:10" in text
    assert "a.py:20" in text
    assert "a.py:21" not in text
    assert "a.py:29" not in text
    assert "a.py:30" in text
    assert lines.count("...") == 2


def test_long_texts_are_cut_to_the_column() -> None:
    rows = [Row(0, "A", WAITS, "x" * 200), Row(1, "B", PREEMPTED, "y" * 200), Row(2, "A", PREEMPTED, HOLD)]
    lines = drawn(rows, ("A", "B", "C"))
    assert max(map(len, lines)) <= WIDTH
    assert any("xxx..." in line for line in lines)
    assert any("=== PREEMPTED ===" in line for line in lines)
    assert any("=== DELAYED ===" in line for line in lines)


def test_timeline_is_empty_without_tasks() -> None:
    assert drawn([], ()) == []


def of_cause(width: int) -> list[str]:
    """Return the lines of a story in which the cause names operations that are far from the moves and the end."""
    rows = [Row(0, "M", PREEMPTED, "A"), *(Row(at, "M", AT, f"a.py:{at}") for at in range(1, 12))]
    rows += [Row(12, "A", AT, "a.py:90: total = 1"), Row(13, "A", DOES, "writes total", is_of_cause=True)]
    rows += [Row(at, "M", AT, f"a.py:{at}") for at in range(14, 28)]
    rows += [Row(28, "B", AT, "a.py:91: total = 2"), Row(29, "B", DOES, "writes total", is_of_cause=True)]
    rows += [Row(30 + at, "M", DOES, f"reads x{at}") for at in range(30)]
    return Story(tuple(rows), important(rows, [moved("M", "C")], "F")).lines(width)


@pytest.mark.parametrize("width", [60, 80, 100, 120])
def test_rows_of_the_cause_are_shown_at_any_width(width: int) -> None:
    lines = of_cause(width)
    assert max(map(len, lines)) <= width
    shown = [" ".join(line.split()[-5:]) for line in lines]
    for source in ("90: total = 1", "91: total = 2"):
        at = next(number for number, line in enumerate(shown) if line.endswith(source))
        assert shown[at + 1].endswith("writes total")


def test_a_narrow_terminal_shows_a_list_with_the_names_of_tasks() -> None:
    lines = of_cause(60)
    assert lines[2].split() == ["time,", "s", "task", "operation"]
    assert any(line.split() == ["0.000000", "A", "writes", "total"] for line in lines)


ACC = """
import threading, rospy
total = 0
def add():
    global total
    before = total
    rospy.get_time()
    total = before + 1
rospy.init_node("acc")
threads = [threading.Thread(target=add) for _ in range(2)]
for t in threads: t.start()
for t in threads: t.join()
rospy.set_param("/total", total)
rospy.spin()
"""


def test_story_of_a_lost_update_shows_the_write_that_loses_it(tmp_path: Path) -> None:
    (tmp_path / "acc.py").write_text(ACC)
    (tmp_path / "check.txt").write_text("at 1 expect param /total == 2\n")
    (tmp_path / "mission.yaml").write_text("{}\n")
    (tmp_path / "startup.scr").write_text("CFE_APP, acc.py, __main__, ACC, 100, 65536, 0x0, 0;\n!\n")
    moves = "moves:ACC.acc.1@550/add.get_time=ACC,ACC.acc.1@550/next=ACC.acc.2"
    plan = RunPlan((str(tmp_path),), script=str(tmp_path / "check.txt"), schedule=Schedule.parse(moves))
    story = story_of_run(plan)
    assert story is not None
    assert "ACC.acc.1.1's write at acc.py:8" in story.cause
    written = [(row.task, row.is_of_cause) for row in story.rows if row.text == "writes acc.total"]
    assert ("ACC.acc.1.1", True) in written
    assert sum("writes acc.total" in line for line in story.lines()) == 2
    (at,) = (at for at, row in enumerate(story.table()[1]) if row[1:3] == ("ACC.acc.1.1", "writes acc.total"))
    assert story.table()[1][at - 1][2].endswith("acc.py:8: total = before + 1")


def test_message_of_the_cause_is_not_merged_with_others() -> None:
    rows = [Row(at, "A", SENDS, f"sends /a: {at}", is_of_cause=at == 2) for at in range(6)]
    assert any(line.endswith("sends /a: 2") for line in drawn(rows, ("A",)))


def test_repetitions_are_shown_when_the_cause_names_one_of_them() -> None:
    for is_of_cause in (True, False):
        rows = [Row(at, "A", DOES, f"has {'ab'[at % 2]}", is_of_cause=is_of_cause and at == 3) for at in range(8)]
        rows += [Row(8 + at, "A", DOES, f"reads x{at}") for at in range(20)]
        assert ("has b" in "\n".join(drawn(rows, ("A",)))) is is_of_cause


def test_story_has_the_width_of_the_terminal(monkeypatch: pytest.MonkeyPatch) -> None:
    for columns, width in (("40", 60), ("80", 78), ("120", 118)):
        monkeypatch.setenv("COLUMNS", columns)
        assert story_width(True, 2) == width
        assert story_width(False, 2) == WIDTH
