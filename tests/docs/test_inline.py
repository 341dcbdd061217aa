"""Commands within the sentences and tables of README, docs and missions: cfepy has their subcommands and options."""

from __future__ import annotations

import argparse
import importlib.util
import re
import shlex
import tomllib
from collections.abc import Iterator
from functools import cache
from pathlib import Path

import pytest

from cfepy.cli import main as cli
from tests.docs.pages import PAGES, ROOT, name_of
from tests.test_docs import FENCE

INLINE = re.compile(r"`([^`]+)`")
PLACEHOLDER = re.compile(r"^[A-Z][A-Z_]*$|[<>|\[\]]|\.\.\.|\bFIELD=|\bNAME\b|\bFILE\b")
OUTPUT = re.compile(r"cfepy fault \S+: ")  # output of a run
EXTRAS = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]["optional-dependencies"]


def spans(page: Path, start: str) -> Iterator[str]:
    """Yield the pieces of code in a page's sentences that begin so."""
    for found in INLINE.findall(FENCE.sub("", page.read_text(encoding="utf-8"))):
        text = " ".join(found.replace("\\|", "|").split())
        if text.startswith(start) and not OUTPUT.match(text):
            yield text


def wrong(command: str) -> str:
    """Return the error in a command of cfepy in a sentence, which may be a part of one, or ""."""
    words = shlex.split(command.partition(" < ")[0].partition(" | ")[0])[1:]
    if words[0] == cli.HELP:
        words = words[1:] if words[1:] != [cli.FLYING] else ["--help"]
    whole_parser, given = parser_of(words[0]), list(words)
    parser = whole_parser
    while given and (below := subcommands(parser)):
        if given[0].startswith("-") or PLACEHOLDER.search(given[0]):
            break
        if given[0] not in below:
            return f"no subcommand {given[0]}"
        parser = below[given.pop(0)]
    for word in given:
        if word == "--":
            break
        if word.startswith("--") and word.partition("=")[0] not in parser._option_string_actions:
            return f"no option {word}"
    if all(word.startswith("-") for word in given) or any(map(PLACEHOLDER.search, given)):
        return ""  # a part of a command
    try:
        whole_parser.parse_args(words)
    except SystemExit:
        return "cannot be given"
    return ""


@cache
def parser_of(word: str) -> argparse.ArgumentParser:
    """Return the parser of a command line that begins so."""
    return cli.parser_for([word])


def subcommands(parser: argparse.ArgumentParser) -> dict[str, argparse.ArgumentParser]:
    """Return the commands below a command."""
    found = [action for action in parser._actions if isinstance(action, argparse._SubParsersAction)]
    return {name: below for action in found for name, below in action.choices.items()}


@pytest.mark.slow  # 0.5 s
def test_subcommands_and_options_in_sentences_exist() -> None:
    found = {
        (name_of(page), command): what
        for page in PAGES
        for command in spans(page, "cfepy ")
        if (what := wrong(command))
    }
    assert found == {}


@pytest.mark.parametrize(
    ("command", "what"),
    [
        ("cfepy run MISSION --for 10", ""),
        ("cfepy fly capture", "no subcommand fly"),
        ("cfepy run MISSION --four 10", "no option --four"),
        ("cfepy run capture --for soon", "cannot be given"),
        ("cfepy tbl shown FILE", "no subcommand shown"),
    ],
)
def test_invalid_command_is_described(command: str, what: str) -> None:
    assert wrong(command) == what


def test_extras_in_sentences_exist() -> None:
    extras = {
        extra.strip()
        for page in PAGES
        for command in spans(page, "pip install ")
        for listed in re.findall(r"\[([\w, ]+)\]", command)
        for extra in listed.split(",")
    }
    assert extras
    assert extras - EXTRAS.keys() == set()


def test_extra_for_tests_brings_no_plugin_that_changes_other_tests() -> None:
    """Random orders and seeds, which cfepy's own tests have, are not for the suite of a user."""
    listed = [re.split(r"[<>=]", each)[0] for each in EXTRAS["test"]]
    assert sorted(listed) == ["greenlet", "hypothesis", "pytest"]


def test_modules_and_tests_in_sentences_exist() -> None:
    for page in PAGES:
        for command in spans(page, "python -m "):
            module = command.split()[2]
            assert module in ("build", "pdb") or importlib.util.find_spec(module), (name_of(page), command)
        for command in (*spans(page, "pytest "), *spans(page, "python -m pytest ")):
            paths = [word for word in command.split() if word.startswith("tests/")]
            assert all((ROOT / path).exists() for path in paths), (name_of(page), command)
