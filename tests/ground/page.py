"""docs/ground.md as programs: its code blocks by section, and commands of it in a shell's words."""

from __future__ import annotations

import re
import shlex
import sys
from pathlib import Path
from typing import NamedTuple

PAGE = Path(__file__).parents[2] / "docs/ground.md"
_SECTION = re.compile(r"^## (.+)$", re.MULTILINE)
_BLOCK = re.compile(r"^```(\w*)\n(.*?)^```", re.MULTILINE | re.DOTALL)


class Block(NamedTuple):
    """A code block: its language, "" for commands, and its lines."""

    language: str
    text: str

    @property
    def commands(self) -> list[list[str]]:
        """The commands of a block: behind "$ " where there is output, too, else each line; cfepy is the one here."""
        lines = [line for line in self.text.splitlines() if line]
        if any(line.startswith("$ ") for line in lines):
            lines = [line.removeprefix("$ ") for line in lines if line.startswith("$ ")]
        return [_here(shlex.split(line)) for line in lines]


def _here(words: list[str]) -> list[str]:
    return [sys.executable, "-m", "cfepy", *words[1:]] if words[0] == "cfepy" else words


def blocks(section: str) -> list[Block]:
    """The code blocks of a section of the page, in their order."""
    _, *parts = _SECTION.split(PAGE.read_text(encoding="utf-8"))
    text = dict(zip(parts[::2], parts[1::2], strict=True))[section]
    return [Block(*found) for found in _BLOCK.findall(text)]
