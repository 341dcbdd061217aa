"""docs/reference/commands.md: the page lists every command and option, and is up to date."""

from __future__ import annotations

import re

import pytest

from cfepy.cli.main import ROOMS, parser_for
from cfepy.plugins import OWN
from dev.pages import commands

NAMES = {name for names in ROOMS.values() for name in names} | {name for plugin in OWN for name in plugin.commands}


@pytest.mark.slow  # 0.6 s: the parsers of all commands
def test_page_is_up_to_date() -> None:
    assert commands.PAGE.read_text(encoding="utf-8") == commands.page(), "run python -m dev.pages.commands"


def test_each_command_has_a_section_an_example_and_a_guide() -> None:
    sections = re.findall(r"^### `cfepy (\w+)`$", commands.PAGE.read_text(encoding="utf-8"), re.MULTILINE)
    assert sorted(sections) == sorted(NAMES) == sorted(commands.EXAMPLES) == sorted(commands.GUIDES)


@pytest.mark.parametrize("name", sorted(commands.EXAMPLES))
def test_example_of_each_command_is_parsed(name: str) -> None:
    words = commands.EXAMPLES[name].split()
    assert words[:2] == ["cfepy", name]
    parser_for(words[1:]).parse_args(words[1:])
