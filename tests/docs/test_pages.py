"""Every command in the code blocks of README, docs and missions works unchanged, executed from top to bottom."""

from __future__ import annotations

import re
import shutil
from pathlib import Path

import pytest

from tests.docs.pages import PAGES, ROOT, Block, commands, name_of
from tests.docs.reader import Reader, first_missing
from tests.docs.scene import Scene, overlooked, scene_of, table
from tests.own_network import needs_own_network, run_in_own_network
from tests.test_docs import commands as all_of_cfepy

SCENES = [scene_of(page) for page in PAGES if name_of(page) in table()]
READ = [scene for scene in SCENES if scene.commands]
LONGEST_PAGE_S = 900  # each command has a limit of its own


@pytest.mark.slow
@needs_own_network
@pytest.mark.parametrize("scene", READ, ids=lambda scene: name_of(scene.page))
def test_commands_of_a_page_are_found(scene: Scene, tmp_path: Path) -> None:
    if missing := [program for program in scene.needs if shutil.which(program) is None]:
        pytest.skip(f"not installed: {', '.join(missing)}")
    run_in_own_network("tests.docs.reader", name_of(scene.page), cwd=tmp_path, patience_s=LONGEST_PAGE_S)


def test_commands_of_all_pages_are_found() -> None:
    assert {name_of(page): found for page in PAGES if (found := overlooked(page))} == {}
    for page in PAGES:
        read = sum(len(re.findall(r"(?:^|/| )cfepy ", command)) for command in commands(page))
        assert read >= len(list(all_of_cfepy(page))), name_of(page)


def test_entries_of_a_scene_match_commands_of_its_page() -> None:
    assert set(table()) <= {name_of(page) for page in PAGES}
    assert {name_of(scene.page): idle for scene in SCENES if (idle := list(scene.idle()))} == {}


def test_of_a_command_elsewhere_names_the_page() -> None:
    pairs = {(scene.page.name, test) for scene in SCENES for test in scene.elsewhere.values()}
    assert [pair for pair in pairs if pair[0] not in (ROOT / pair[1]).read_text(encoding="utf-8")] == []


def page_with(text: str, folder: Path) -> Path:
    page = folder / "page.md"
    page.write_text(text, encoding="utf-8")
    return page


def test_a_command_in_a_page_without_a_scene_is_overlooked(tmp_path: Path) -> None:
    assert overlooked(page_with("```\ncfepy board list\n```\n", tmp_path)) == ["cfepy board list"]
    assert overlooked(page_with("```sh\ntrue\n```\n", tmp_path)) == ["true"]
    assert overlooked(page_with("```\nname  value\ncfepy board list\n```\n", tmp_path)) == ["cfepy board list"]
    assert overlooked(page_with("```\nname  value\n```\n", tmp_path)) == []


def test_new_command_of_a_page_is_executed(tmp_path: Path) -> None:
    scene = Scene(page_with("```sh\ntrue\n```\n", tmp_path))
    assert list(Reader(scene).problems()) == []
    page_with("```sh\ntrue\n```\n\n```sh\nno-such-program --now\n```\n", tmp_path)
    [problem] = Reader(scene).problems()
    assert problem.startswith("no-such-program --now\nended with status 127, not 0")


def test_output_of_a_command_is_compared_with_the_page(tmp_path: Path) -> None:
    scene = Scene(page_with("```\n$ printf 'a b\\nc d'\na\nb\n...\ne\n$ echo f\nf\n```\n", tmp_path))
    [problem] = Reader(scene).problems()
    assert "did not print what the page shows: 'e'" in problem
    assert first_missing("a b\n  ...\nd", "a\nb c d") == ""
    assert first_missing("d\na", "a b c d") == "a"
    fast, slow = (
        f"20.000 virtual s in {each} x real time, board linux, {tasks} tasks, seed 0"
        for each, tasks in (("1.0 s: 20.0", "greenlet"), ("8.0 s: 2.5", "thread"))
    )
    assert first_missing(fast, slow) == ""


def test_a_command_that_takes_too_long_is_named(tmp_path: Path) -> None:
    scene = Scene(page_with("```sh\nsleep 3600\n```\n", tmp_path))
    [problem] = Reader(scene, patience_s=0.1).problems()
    assert problem.startswith("sleep 3600\ntook longer than 0 s and was ended")


def test_command_that_never_becomes_ready_is_named(tmp_path: Path) -> None:
    scene = Scene(page_with("```sh\nsleep 3600\n```\n", tmp_path), steps={"sleep 3600": {"ready": "here"}})
    assert [problem.splitlines()[1] for problem in Reader(scene, patience_s=0.1).problems()] == [
        "never said 'here'",
        "took longer than 0 s and was ended",
    ]


def test_commands_are_recognized_in_a_block() -> None:
    assert Block("", "$ cfepy board list\nlinux\n").session == [("cfepy board list", "linux\n")]
    assert Block("sh", "cfepy board list   # all\n# none\nls\n").lines == ["cfepy board list", "ls"]
    assert Block("", "A=1 bin/server\n").lines == ["A=1 bin/server"]
    assert Block("", "cfepy: what it says\n").lines == []
    assert Block("yaml", "cfepy: 1\n").lines == []
