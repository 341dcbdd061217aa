"""The table of costs: it is compact, all lines name existing tests, and costs decide which tests are slow."""

from __future__ import annotations

import ast
import json
from pathlib import Path

import pytest

from dev.costs import meter
from dev.costs.table import DEAR_S, ROOT, SLOW_S, Table, file_of, function_of, lines
from tests import costs

SLOW, DEAR, CHEAP = 2 * SLOW_S, DEAR_S, DEAR_S / 2
MEASURED = {
    "tests/a.py::test_one": DEAR,
    "tests/a.py::test_two[x]": CHEAP,
    "tests/a.py::test_two[y]": DEAR + 0.01,
    "tests/a.py::test_two[z]": SLOW,
    "tests/a.py::test_three[x]": CHEAP,
    "tests/a.py::test_three[y]": DEAR,
    "tests/a.py::test_three[z::[1]]": CHEAP,
    "tests/b.py::TestAll::test_it": DEAR,
    "tests/d.py::test_one": DEAR,
    "tests/d.py::test_two[x]": SLOW,
    "tests/d.py::test_two[y]": SLOW + 0.1,
    "tests/c.py::test_one": CHEAP,
}


def test_a_line_is_a_file_a_test_or_a_case() -> None:
    assert dict(lines(MEASURED)) == {
        "tests/a.py::test_one": DEAR,
        "tests/a.py::test_two": DEAR + 0.01,
        "tests/a.py::test_two[z]": SLOW,
        "tests/a.py::test_three[y]": DEAR,
        "tests/b.py": DEAR,
        "tests/d.py::test_one": DEAR,
        "tests/d.py::test_two": SLOW + 0.1,
    }


def test_without_a_line_is_quick() -> None:
    table = Table(dict(lines(MEASURED)))
    assert [test for test in MEASURED if test not in table] == [
        "tests/a.py::test_three[x]",
        "tests/a.py::test_three[z::[1]]",
        "tests/c.py::test_one",
    ]


def test_lines_of_unmeasured_files_are_kept() -> None:
    table = Table({"tests/a.py": 0.3, "tests/d.py::test_one": 0.3})
    assert table.merged({"tests/a.py::test_one": CHEAP}).costs == {"tests/d.py::test_one": 0.3}


def test_table_is_the_same_after_writing_and_reading(tmp_path: Path) -> None:
    Table({"tests/b.py": 0.3, "tests/a.py::test_one[x y]": 0.0501}).write(tmp_path / "costs.tsv")
    assert (tmp_path / "costs.tsv").read_text(encoding="utf-8") == "51\ttests/a.py::test_one[x y]\n300\ttests/b.py\n"
    assert Table.read(tmp_path / "costs.tsv").costs == {"tests/b.py": 0.3, "tests/a.py::test_one[x y]": 0.051}


def test_lowest_of_several_measurements_counts(tmp_path: Path) -> None:
    rows = [
        [["a", "b"], "fixture", 0.25],
        [["a"], "", 0.5],
        [["a"], "", 0.125],
        [["b"], "", 1.0],
        [["c"], "fixture", 9],
    ]
    (tmp_path / "1.jsonl").write_text("".join(json.dumps(row) + "\n" for row in rows), encoding="utf-8")
    assert meter.measured(tmp_path) == {"a": 0.375, "b": 1.25}


def test_meter_divides_the_cost_of_fixtures(pytester: pytest.Pytester, monkeypatch: pytest.MonkeyPatch) -> None:
    folder = pytester.mkdir("measured")
    monkeypatch.setenv(meter.FOLDER, str(folder))
    pytester.makepyfile(
        """
        import pytest

        @pytest.fixture(scope="module")
        def shared():
            sum(range(3_000_000))

        def test_one(shared): pass
        def test_two(shared): pass
        def test_other(): pass
        """
    )
    pytester.inline_run("-p", "dev.costs.meter", "-p", "no:randomly")
    rows = list(meter.rows(folder))
    [(users, _, share)] = [row for row in rows if row[1].endswith("::shared")]
    alone = {tests[0]: cost for tests, part, cost in rows if not part}
    assert [user.partition("::")[2] for user in users] == ["test_one", "test_two"]
    assert share > 0
    assert len(alone) == 3
    assert meter.measured(folder) == {test: cost + share * (test in users) for test, cost in alone.items()}


def test_each_line_names_a_test() -> None:
    known: dict[str, set[str]] = {}
    for line in costs.TABLE.costs:
        file, *names = function_of(line).split("::")
        if file not in known:
            tree = ast.parse((ROOT / file).read_text(encoding="utf-8"))
            known[file] = {node.name for node in tree.body if isinstance(node, ast.FunctionDef | ast.ClassDef)}
            known[file] |= {
                node.targets[0].id
                for node in tree.body
                if isinstance(node, ast.Assign) and isinstance(node.targets[0], ast.Name)
            }
        assert known[file].issuperset(names[:1]), f"{line}: python -m dev.costs {file}"


def test_each_line_names_an_existing_case(pytestconfig: pytest.Config) -> None:
    stale = pytestconfig.stash.get(costs.STALE, [])
    assert stale == [], f"python -m dev.costs {' '.join(sorted(set(map(file_of, stale))))}"


def test_is_slow_when_its_line_has_the_cost_of_a_slow_one() -> None:
    table = Table({"tests/a.py::test_one[x]": SLOW_S, "tests/b.py": SLOW_S, "tests/c.py::test_one": SLOW_S - 0.01})
    tests = ("tests/a.py::test_one[x]", "tests/a.py::test_one[y]", "tests/b.py::test_it", "tests/c.py::test_one")
    assert [table.is_slow(test) for test in tests] == [True, False, True, False]
    assert table.slow_files == {"tests/a.py", "tests/b.py"}


@pytest.mark.parametrize(
    ("text", "read_by"),
    [
        ("def test_it(): pass", ("quick", "not slow", "", "corpus")),
        ("@pytest.mark.slow\ndef test_it(): pass", ("quick", "not slow", "slow", "", "corpus")),
        ("pytestmark = pytest.mark.slow", ("slow", "", "corpus")),
        ("pytestmark = [needs_cpp, pytest.mark.slow]", ("slow", "", "corpus")),
        ("pytestmark = [\n    pytest.mark.slow,\n    needs_cpp,\n]", ("slow", "", "corpus")),
        ("pytestmark = pytest.mark.skipif(slow)", ("quick", "not slow", "slow", "", "corpus")),
    ],
)
def test_file_is_collected_unless_marks_exclude_all_of_its_tests(
    text: str, read_by: tuple[str, ...], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(costs, "is_dear", lambda path: False)
    file = tmp_path / "test_it.py"
    file.write_text(text, encoding="utf-8")
    marks = ("quick", "not slow", "slow", "", "corpus")
    assert tuple(each for each in marks if not costs.is_read_in_vain(file, each)) == read_by
    assert not any(costs.is_read_in_vain(tmp_path, each) for each in marks)
