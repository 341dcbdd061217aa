"""The results file survives interruptions and damage, and never mixes campaigns."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from cfepy.extra.exploration.results_file import ResultsFile, read_results
from cfepy.status import UsageError
from tests.disk import room_for

IDENTITY = {"plan": {"words": ["capture"], "seed": 0}, "mission": "aa", "versions": {"cfepy": "0.1.0"}}


@pytest.fixture
def path(tmp_path: Path) -> Path:
    return tmp_path / "results"


def write(path: Path, *numbers: int) -> None:
    file = ResultsFile(path, IDENTITY)
    for number in numbers:
        file.append(number, {"schedule": f"random:{number}"})
    file.close()


def stored(path: Path) -> list[int]:
    return [number for number, _ in read_results(path)[1]]


def test_verdicts_are_read_in_any_order(path: Path) -> None:
    write(path, 3, 0, 1)
    file = ResultsFile(path, IDENTITY)
    assert len(file) == 3
    assert file.verdict(3) == {"schedule": "random:3"}
    assert file.verdict(2) is None
    assert file.verdict(4) is None
    file.append(2, {"schedule": "random:2"})
    assert file.verdict(2) == {"schedule": "random:2"}
    assert file.verdict(1) == {"schedule": "random:1"}
    file.close()
    assert stored(path) == [3, 0, 1, 2]
    assert read_results(path)[0] == IDENTITY


def test_write_that_was_cut_off_is_ignored(path: Path) -> None:
    """Whole lines stay, the rest of the file is made anew: also half of the first line."""
    write(path, 0, 1, 2)
    whole = path.read_bytes()
    ends = [at + 1 for at, byte in enumerate(whole) if byte == ord("\n")]
    for cut in range(len(whole)):
        path.write_bytes(whole[:cut])
        file = ResultsFile(path, IDENTITY)
        kept = max(0, sum(end <= cut for end in ends) - 1)
        assert len(file) == kept
        file.append(7, {"schedule": "random:7"})
        file.close()
        assert stored(path) == [*range(kept), 7]


@pytest.mark.parametrize(
    ("change", "told"),
    [
        ({"mission": "bb"}, 'mission was "aa", is "bb"'),
        ({"plan": {"words": ["capture"], "seed": 4}}, "plan.seed was 0, is 4"),
        ({"depth": 3}, "depth was not given, is 3"),
        (
            {"files": dict.fromkeys("abcdefg", 1)},
            "".join(f"files.{name} was not given, is 1; " for name in "abcde") + "and 2 more",
        ),
        ({"versions": {}}, 'versions was not given, is {}; versions.cfepy was "0.1.0", is not given'),
    ],
)
def test_results_of_another_campaign_are_refused(path: Path, change: dict[str, object], told: str) -> None:
    write(path, 0)
    before = path.read_bytes()
    with pytest.raises(UsageError) as caught:
        ResultsFile(path, {**IDENTITY, **change})
    assert str(caught.value) == (
        f"{path}:1: --results: contains the results of another campaign ({told}); name another file, or delete this one"
    )
    assert path.read_bytes() == before
    ResultsFile(path, IDENTITY).close()  # the one that was refused holds no lock


@pytest.mark.parametrize("text", ["groceries: milk", "groceries: milk\n", '{"a": 1}\n', "[1]\n", '{"format": 3, "'])
def test_other_file_is_refused_and_not_changed(path: Path, text: str) -> None:
    path.write_text(text, encoding="utf-8")
    with pytest.raises(UsageError, match="is not a"):
        ResultsFile(path, IDENTITY)
    assert path.read_text(encoding="utf-8") == text


@pytest.mark.parametrize(
    "line", ["nonsense", "[]", "{}", '{"number": -1, "verdict": {}}', '{"number": 1, "verdict": 2}']
)
def test_damaged_line_in_the_middle_is_reported(path: Path, line: str) -> None:
    write(path, 0, 1)
    lines = path.read_text(encoding="utf-8").splitlines()
    path.write_text("\n".join([lines[0], line, *lines[2:], ""]), encoding="utf-8")
    with pytest.raises(UsageError) as caught:
        ResultsFile(path, IDENTITY)
    assert (caught.value.file, caught.value.line) == (str(path), 2)


def test_two_writers_at_once_are_refused(path: Path) -> None:
    file = ResultsFile(path, IDENTITY)
    with pytest.raises(UsageError, match="is being written by another cfepy process"):
        ResultsFile(path, IDENTITY)
    file.close()
    ResultsFile(path, IDENTITY).close()


def test_results_are_readable_during_the_campaign(path: Path) -> None:
    file = ResultsFile(path, IDENTITY)
    file.append(0, {"schedule": "fifo"})
    assert list(read_results(path)[1]) == [(0, {"schedule": "fifo"})]
    file.close()


def test_unusable_path_is_reported(tmp_path: Path) -> None:
    with pytest.raises(UsageError, match="cannot be written: Is a directory"):
        ResultsFile(tmp_path, IDENTITY)
    with pytest.raises(
        UsageError, match=r"cannot be written: No such file or directory; create the folder .*missing first"
    ):
        ResultsFile(tmp_path / "missing" / "results", IDENTITY)
    with pytest.raises(UsageError, match="cannot be read: No such file or directory"):
        read_results(tmp_path / "results")


def test_lines_are_json(path: Path) -> None:
    write(path, 5)
    head, line = map(json.loads, path.read_text(encoding="utf-8").splitlines())
    assert head == {"format": "cfepy exploration 1", "campaign": IDENTITY}
    assert line == {"number": 5, "verdict": {"schedule": "random:5"}}


def test_full_disk_is_reported_and_earlier_lines_stay_readable(path: Path) -> None:
    file = ResultsFile(path, IDENTITY)
    file.append(0, {"schedule": "fifo"})
    with room_for(path.stat().st_size + 9):
        with pytest.raises(UsageError, match="--results: could not be written: "):
            file.append(1, {"schedule": "random:1"})
        file.close()
    again = ResultsFile(path, IDENTITY)
    assert len(again) == 1
    again.close()
