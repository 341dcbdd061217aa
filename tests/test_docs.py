"""The documentation: links have targets, commands work unchanged, and generated parts are up to date."""

from __future__ import annotations

import re
import shlex
from collections.abc import Iterator
from pathlib import Path

import pytest

from cfepy.cli import main as cli

ROOT = Path(__file__).parents[1]
DOCS = sorted([*ROOT.glob("*.md"), *ROOT.glob("docs/**/*.md"), *ROOT.glob("missions/*/*.md")])
FENCE = re.compile(r"^```.*?^```", re.MULTILINE | re.DOTALL)
LINK = re.compile(r"\]\(([^)\s]+)\)")
HEADING = re.compile(r"^#+ +(.+)$", re.MULTILINE)
OURS = re.compile(r"`((?:cfepy|rospy_shim|apps|boards|missions|tests|dev|docs|benchmarks|\.ci)/[\w./*-]+)`")

each_document = pytest.mark.parametrize("path", DOCS, ids=lambda path: str(path.relative_to(ROOT)))


def anchors(path: Path) -> set[str]:
    """Return the anchors that GitHub makes of headings."""
    titles = HEADING.findall(FENCE.sub("", path.read_text(encoding="utf-8")))
    return {re.sub(r"[^\w\- ]", "", title.lower()).replace(" ", "-") for title in titles}


def broken(path: Path, link: str) -> bool:
    if re.match(r"[a-z]+:", link):
        return False
    file, _, anchor = link.partition("#")
    target = path.parent / file if file else path
    return not target.exists() or (anchor != "" and anchor not in anchors(target))


def commands(path: Path) -> Iterator[list[str]]:
    """Yield the `cfepy` commands in a document's code blocks, split into words."""
    for block in FENCE.findall(path.read_text(encoding="utf-8")):
        for line in block.splitlines():
            for command in line.removeprefix("$ ").split(" && "):
                words = shlex.split(command, comments=True) if re.match(r"\s*([\w./]*/)?cfepy ", command) else []
                if words:
                    yield words[1:]


def is_understood(words: list[str]) -> bool:
    """Return whether `cfepy` takes this command line."""
    try:
        cli.parser_for(words).parse_args(words)
    except SystemExit as stopped:
        return stopped.code == 0  # --help and --version stop too
    return True


@each_document
def test_links_have_targets(path: Path) -> None:
    assert [link for link in LINK.findall(FENCE.sub("", path.read_text(encoding="utf-8"))) if broken(path, link)] == []


@each_document
def test_files_that_are_named_exist(path: Path) -> None:
    assert [
        name for name in OURS.findall(path.read_text(encoding="utf-8")) if not list(ROOT.glob(name.rstrip("/")))
    ] == []


@each_document
def test_commands_can_be_parsed(path: Path) -> None:
    assert [shlex.join(words) for words in commands(path) if not is_understood(words)] == []


@each_document
def test_digests_are_not_in_the_documentation(path: Path) -> None:
    assert re.findall(r"\b[0-9a-f]{32}\b|trace: [0-9a-f]{4,}", path.read_text(encoding="utf-8")) == []


def test_readme_has_the_command_of_the_demonstration() -> None:
    assert ["run", "capture", "--for", "20"] in list(commands(ROOT / "README.md"))


def test_every_document_is_in_the_index() -> None:
    index = (ROOT / "docs/README.md").read_text(encoding="utf-8")
    pages = [path.relative_to(ROOT / "docs").as_posix() for path in DOCS if path.is_relative_to(ROOT / "docs")]
    missing = [page for page in pages if f"({page})" not in index]
    assert missing == ["README.md"]
