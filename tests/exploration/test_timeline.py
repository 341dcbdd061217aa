"""What a timeline leaves out, and how it fits its columns."""

from __future__ import annotations

from cfepy.exploration.moves import Move
from cfepy.exploration.timeline import AT, PREEMPTED, WAITS, WIDTH, Row, columns, drawn
from cfepy.rtos.policy import HOLD


def test_the_tasks_of_the_last_moves_have_a_column() -> None:
    moves = [Move("A", 0, "B"), Move("B", 0, "C"), Move("C", 1, "D"), Move("D", 0, HOLD)]
    assert columns([], moves) == ("B", "C", "D")
    assert columns([], [Move("A", 0, HOLD)]) == ("A",)


def test_the_task_in_which_the_failure_showed_has_a_column() -> None:
    rows = [Row(number, name, AT, "a.py:1: pass") for number, name in enumerate("EDCBA")]
    moves = [Move("A", 0, "B"), Move("B", 0, "C"), Move("C", 1, "D")]
    assert columns(rows, moves, "E") == ("C", "D", "E")


def test_who_ran_last_has_a_column_when_there_would_be_one_only_or_one_was_held_up() -> None:
    rows = [Row(number, name, AT, "a.py:1: pass") for number, name in enumerate("ABCDD")]
    assert columns(rows, [Move("A", 0, "A")]) == ("A", "D")
    assert columns(rows, [Move("A", 0, "B")]) == ("A", "B")
    assert columns(rows, [Move("A", 0, HOLD)]) == ("A", "C", "D")


def test_the_name_of_the_only_file_is_told_once() -> None:
    rows = [Row(0, "A", AT, "a.py:7: go()"), Row(1, "A", WAITS, "sleeps"), Row(2, "B", AT, "b.py:1: stop()")]
    assert drawn(rows, ("A",))[0] == "lines of a.py"
    assert drawn(rows, ("A",))[4].split() == ["0.000000", "7:", "go()"]
    assert "a.py:7: go()" in "\n".join(drawn(rows, ("A", "B")))


def test_rows_far_from_moves_and_end_are_left_out() -> None:
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
    assert any("=== HELD UP ===" in line for line in lines)


def test_without_tasks_there_is_nothing_to_draw() -> None:
    assert drawn([], ()) == []
