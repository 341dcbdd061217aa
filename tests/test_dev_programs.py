"""The programs of dev/: a page lists them all, each states its purpose, and none needs the tests or is among them."""

from __future__ import annotations

import ast
import re
import runpy
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
DEV = ROOT / "dev"
TESTS = ROOT / "tests"
PAGE = ROOT / "docs/reference/dev_programs.md"
OF_PROGRAMS = {
    "dev.convert.stimulus.driver": "stands beside the node that is tried",
    "dev.convert.stimulus.generate": "runs in Debian's Python",
    "dev.corpus.observer": "stands beside the node that is tried",
    "dev.corpus.pool": "flies one scenario in a process of its own",
    "dev.peers.driver": "runs one file of tests as a node",
}
"""Modules that a program starts, and nobody else."""
OF_TESTS = {
    "docs/reader.py": "gives the commands of a page in a network of its own",
    "ground/page_flight.py": "gives those of docs/how_to/ground_tools.md in a network of its own",
    "ground/yamcs_flight.py": "flies beside Yamcs in a network of its own",
    "mission/eventful.py": "flies in a process of its own",
    "own_network.py": "makes the network",
    "packaging/without.py": "flies in a process without what other systems lack",
    "extra/viewers/rosbridge/roslibpy_client.py": "has a reactor that starts only once in a process",
}
"""Modules that a test starts, and nobody else."""
_COMMAND = re.compile(r"\bpython3? -m (dev(?:\.\w+)*)")
_GUARD = re.compile(r"^if __name__ == .__main__.:", re.MULTILINE)


def file_of(program: str) -> Path:
    """Return the file of a program: a module, or the `__main__.py` of a package."""
    path = ROOT.joinpath(*program.split("."))
    return path / "__main__.py" if path.is_dir() else path.with_suffix(".py")


def programs() -> Iterator[str]:
    """Yield the runnable programs: `__main__.py` of packages, and modules that check whether they are the main one."""
    for path in sorted(DEV.rglob("*.py")):
        name = ".".join(path.relative_to(ROOT).with_suffix("").parts)
        if path.name == "__main__.py" or _GUARD.search(path.read_text(encoding="utf-8")):
            yield name.removesuffix(".__main__")


PROGRAMS = sorted(set(programs()) - OF_PROGRAMS.keys())


def test_page_lists_every_program() -> None:
    assert sorted(set(_COMMAND.findall(PAGE.read_text(encoding="utf-8")))) == PROGRAMS


def test_started_programs_exist() -> None:
    assert set(programs()) >= OF_PROGRAMS.keys()


@pytest.mark.parametrize("program", PROGRAMS)
def test_help_of_a_program_states_its_purpose(
    program: str, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(sys, "argv", [program, "--help"])
    with pytest.raises(SystemExit) as ended:
        runpy.run_path(str(file_of(program)), run_name="__main__")
    assert not ended.value.code
    assert f"python -m {program}" in capsys.readouterr().out.partition("\n")[0]


def imported(path: Path) -> Iterator[str]:
    """Yield the top-level packages that a file imports."""
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        names = [node.module or ""] if isinstance(node, ast.ImportFrom) else []
        names += [each.name for each in node.names] if isinstance(node, ast.Import) else []
        yield from (name.split(".")[0] for name in names)


def test_no_program_needs_the_tests() -> None:
    assert [str(path.relative_to(ROOT)) for path in DEV.rglob("*.py") if "tests" in imported(path)] == []


def test_the_tests_have_no_programs() -> None:
    """Exceptions are programs that tests start, and scripts of ROS nodes, which name their own Python."""
    texts = {path: path.read_text(encoding="utf-8") for path in TESTS.rglob("*.py")}
    guarded = {path for path, text in texts.items() if _GUARD.search(text) and not text.startswith("#!")}
    guarded |= set(TESTS.rglob("__main__.py"))
    assert {str(path.relative_to(TESTS)) for path in guarded} == OF_TESTS.keys()
