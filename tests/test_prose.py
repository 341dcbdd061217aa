"""Texts that people read name things and actors: the number of riddles of a file may only fall."""

from __future__ import annotations

from pathlib import Path

import pytest

from dev.prose import counts, files, lowered, read_table, riddles_in, texts_of, write_table


def test_no_file_has_more_riddles_than_the_table_says() -> None:
    table = read_table()
    more = {file: f"{number}, not {table.get(file, 0)}" for file, number in counts(files()).items()}
    risen = {file: text for file, text in more.items() if int(text.split(",")[0]) > table.get(file, 0)}
    assert risen == {}, "name the thing and the actor; this prints the places: python -m dev.prose FILE"


def found(path: Path, text: str) -> list[tuple[int, str, str, str]]:
    path.write_text(text, encoding="utf-8")
    return [
        (riddle.line, each.kind, riddle.pattern, riddle.match) for each in texts_of(path) for riddle in riddles_in(each)
    ]


def test_riddles_of_a_page_are_found_with_their_lines(tmp_path: Path) -> None:
    text = (
        "# Page\n\n```\nwhat is told\n```\n\nWhat comes `what` is told.\n| what | those of |\nThose of [it](what.md).\n"
    )
    assert found(tmp_path / "page.md", text) == [
        (7, "docs", "what", "What"),
        (7, "docs", "told, said", "is told"),
        (9, "docs", "those of", "Those of"),
    ]


@pytest.mark.parametrize(
    ("line", "riddles"),
    [
        ('raise UsageError(f"{text!r} is no size; write bytes", field=option)', [("errors", "is no")]),
        ('raise UsageError(f"invalid size {text!r}; expected bytes")', []),
        ('parser.error("nobody listens")', [("errors", "nobody")]),
        ('add("--json", help="what was found")', [("help", "what")]),
        ('add("--json", help="the `what` of it", metavar="what")', []),
        ("def test_what_is_left(): pass", [("test names", "test name")]),
        ("def test_journal_keeps_complete_messages(): pass", []),
        ('def look():\n    """What a task does."""', [("docstrings", "what")]),
        ('def look():\n    """Return the `what` of a task."""', []),
        ('name = "what is told"', []),
    ],
)
def test_riddles_of_python_are_found_by_kind(line: str, riddles: list[tuple[str, str]], tmp_path: Path) -> None:
    assert [(kind, pattern) for _, kind, pattern, _ in found(tmp_path / "some.py", line)] == riddles


def test_numbers_of_the_table_only_fall() -> None:
    assert lowered({"a.py": 3, "b.py": 2, "c.py": 1}, {"a.py": 5, "b.py": 1, "d.py": 7}) == {"a.py": 3, "b.py": 1}


def test_table_is_the_same_after_writing_and_reading(tmp_path: Path) -> None:
    write_table({"b.py": 2, "a b.md": 11}, tmp_path / "prose.tsv")
    assert read_table(tmp_path / "prose.tsv") == {"a b.md": 11, "b.py": 2}
