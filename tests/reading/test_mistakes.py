"""Collecting mistakes: nothing is lost, each has its line, and a text for the user lists at most 20."""

from __future__ import annotations

import pickle
from functools import partial
from pathlib import Path

import pytest

from cfepy.mission import CppNodesError
from cfepy.reading.marked_yaml import Marked, load
from cfepy.reading.mistakes import FirstMistake, Mistakes, collected, each_of
from cfepy.status import MOST_TOLD, UsageError, alone, placed, together


def marked(folder: Path, text: str) -> Marked:
    (folder / "a.yaml").write_text(text, encoding="utf-8")
    return load(folder / "a.yaml")


def numbers(root: Marked, mistakes: Mistakes) -> list[int | None]:
    return [mistakes.attempt(item.integer) for item in mistakes.items(root)]


def test_collected_returns_the_result_of_a_right_file(tmp_path: Path) -> None:
    assert collected(partial(numbers, marked(tmp_path, "[1, 2]"))) == [1, 2]


def test_collected_raises_all_mistakes_by_line(tmp_path: Path) -> None:
    with pytest.raises(UsageError) as caught:
        collected(partial(numbers, marked(tmp_path, "- a\n- 1\n- b")))
    lines = str(caught.value).splitlines()
    assert lines == [
        f"{tmp_path / 'a.yaml'}:{line}: [{index}]: must be a whole number of at least 0, not {value!r}"
        for line, index, value in ((1, 0, "a"), (3, 2, "b"))
    ]


def test_a_text_lists_at_most_twenty_mistakes(tmp_path: Path) -> None:
    with pytest.raises(UsageError) as caught:
        collected(partial(numbers, marked(tmp_path, "[" + "x, " * 25 + "]")))
    lines = str(caught.value).splitlines()
    assert len(lines) == MOST_TOLD + 1
    assert lines[-1] == "and 5 more"


def test_all_unknown_keys_of_a_mapping_are_raised_together(tmp_path: Path) -> None:
    with pytest.raises(UsageError) as caught:
        marked(tmp_path, "{nam: 1, size: 2, zize: 3}").mapping(("name", "size"))
    assert [error.field for error in caught.value.each] == ["nam", "zize"]


def test_whole_drops_an_entry_with_a_mistake() -> None:
    def read(mistakes: Mistakes) -> int:
        mistakes.add(UsageError("a"))
        raise UsageError("b")

    mistakes = Mistakes()
    assert mistakes.whole(read) is None
    assert mistakes.whole(lambda _: 3) == 3
    assert [error.text for error in mistakes.errors] == ["a", "b"]


def test_first_mistake_ends_the_reading() -> None:
    with pytest.raises(UsageError, match="a"):
        FirstMistake().add(UsageError("a"))


def test_each_of_raises_the_mistakes_of_all_parts() -> None:
    def fail(text: str) -> int:
        raise UsageError(text)

    with pytest.raises(UsageError) as caught:
        each_of([partial(fail, "a"), partial(int, 1), partial(fail, "b")])
    assert str(caught.value) == "a\nb"


def test_together_flattens_and_keeps_the_class() -> None:
    inner = together([CppNodesError("b", line=2), UsageError("a", line=1)])
    assert [error.text for error in together([inner, UsageError("c", line=3)]).each] == ["a", "b", "c"]
    assert isinstance(together([CppNodesError("a"), UsageError("b")]), CppNodesError)
    assert [len(each.each) for each in alone(inner)] == [1, 1]


def test_placed_gives_each_mistake_its_place() -> None:
    error = placed(together([UsageError("a", field="x"), UsageError("b", field="y")]), file="f", line=3)
    assert str(error) == "f:3: x: a\nf:3: y: b"


def test_several_mistakes_survive_pickling() -> None:
    error = together([UsageError("a", file="f", line=1), UsageError("b")])
    assert str(pickle.loads(pickle.dumps(error))) == str(error)
