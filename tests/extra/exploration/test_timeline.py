"""Omissions of a timeline, and the fitting of its columns."""

from __future__ import annotations

from cfepy.extra.exploration.task_look import AT, DOES, PREEMPTED, SENDS, WAITS, Row
from cfepy.extra.exploration.timeline import WIDTH, Story, drawn, important
from cfepy.rtos import HOLD
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
    source = "a.py:7: " + "x" * 90
    rows = (Row(0, "A", AT, source), Row(0, "B", AT, "b.py:1: pass"))
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
    assert "a.py:7: go()" in "\n".join(drawn(rows, ("A", "B")))


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
