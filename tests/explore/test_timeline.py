"""What a timeline leaves out, and how it fits its columns."""

from __future__ import annotations

from cfepy.explore.moves import Move
from cfepy.explore.recording import AT, PREEMPTED, Row
from cfepy.explore.timeline import WIDTH, drawn, tasks_of
from cfepy.rtos.policy import HOLD


def test_the_tasks_of_the_last_moves_have_a_column() -> None:
    moves = [Move("A", 0, "B"), Move("B", 0, "C"), Move("C", 1, "D"), Move("D", 0, HOLD)]
    assert tasks_of(moves) == ("B", "C", "D")
    assert tasks_of([Move("A", 0, HOLD)]) == ("A",)


def test_rows_far_from_moves_and_end_are_left_out() -> None:
    rows = [Row(number, "A", AT, f"a.py:{number}") for number in range(40)]
    rows[15] = Row(15, "A", PREEMPTED, "B")
    lines = drawn(rows, ("A", "B"))
    text = "\n".join(lines)
    assert "=== PREEMPTED by B ===" in text
    assert "a.py:10" in text
    assert "a.py:20" in text
    assert "a.py:21" not in text
    assert "a.py:29" not in text
    assert "a.py:30" in text
    assert lines.count("...") == 2


def test_long_texts_are_cut_to_the_column() -> None:
    rows = [Row(0, "A", AT, "x" * 200), Row(1, "B", PREEMPTED, "y" * 200), Row(2, "A", PREEMPTED, HOLD)]
    lines = drawn(rows, ("A", "B", "C"))
    assert max(map(len, lines)) <= WIDTH
    assert any("xxx..." in line for line in lines)
    assert any("=== PREEMPTED ===" in line for line in lines)
    assert any("=== HELD UP ===" in line for line in lines)


def test_without_tasks_there_is_nothing_to_draw() -> None:
    assert drawn([], ()) == []
