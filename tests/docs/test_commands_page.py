"""docs/reference/commands.md: the page lists every command and option, and is up to date."""

from __future__ import annotations

import re

import pytest

from cfepy.cli.main import ROOMS
from cfepy.plugins import OWN
from dev.pages import commands

NAMES = {name for names in ROOMS.values() for name in names} | {name for plugin in OWN for name in plugin.commands}


@pytest.mark.slow  # 0.6 s: the parsers of all commands
def test_page_is_up_to_date() -> None:
    assert commands.PAGE.read_text(encoding="utf-8") == commands.page(), "run python -m dev.pages.commands"


def test_each_command_has_a_section_and_a_guide() -> None:
    sections = re.findall(r"^### `cfepy (\w+)`$", commands.PAGE.read_text(encoding="utf-8"), re.MULTILINE)
    assert sorted(sections) == sorted(NAMES) == sorted(commands.GUIDES)
