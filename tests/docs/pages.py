"""Pages of the documentation as programs: their code blocks by section, with commands and their output."""

from __future__ import annotations

import re
import shlex
import sys
from pathlib import Path
from typing import NamedTuple

ROOT = Path(__file__).parents[2]
PLACES = ("*.md", "docs/**/*.md", "missions/*/*.md", "ros_packages/*/*.md")
PAGES = sorted(page for place in PLACES for page in ROOT.glob(place))
SHELLS = {"sh", "bash", "shell", "console"}
PROGRAMS = {
    *("cfepy", "pip", "pipx", "pytest", "python", "python3", "ruff", "mypy", "mkdocs", "dask"),
    *(".", "source", "bash", "sh", "cat", "cd", "cp", "curl", "echo", "export", "ls", "mkdir", "printf", "ssh", "sudo"),
    *("apt", "apt-get", "chromium", "dot", "docker", "git", "jq", "npm", "podman", "tar", "wget", "yamcs"),
    *("cmake", "gcc", "gcov", "gdb", "g++", "make", "catkin_make", "rosbag", "roscore", "roslaunch", "rosnode"),
    *("rosparam", "rosrun", "rosservice", "rostest", "rostopic", "rviz"),
}
_SECTION = re.compile(r"^## (.+)$", re.MULTILINE)
_BLOCK = re.compile(r"^```(\w*)\n(.*?)^```", re.MULTILINE | re.DOTALL)
_COMMENT = re.compile(r"\s+# .*$")
_SETTINGS = re.compile(r"^(?:\w+=\S+ )*")
_OWN_PROGRAM = re.compile(r"\.?[\w.-]+(?:/[\w.-]+)+$")
"""A program by its path, such as bin/yamcsd."""


class Block(NamedTuple):
    """A code block: its language, "" for commands and for output, and its lines."""

    language: str
    text: str

    @property
    def session(self) -> list[tuple[str, str]]:
        """Return the commands of a block, without comments, each with the output that the page shows below it.

        A command follows "$ " if the block also shows output. Otherwise each line of a shell block is a command, and
        each line of a block without a language that begins with a command.
        """
        lines = self.text.splitlines()
        if any(line.startswith("$ ") for line in lines):
            _, *parts = re.split(r"^\$ (.*)\n", self.text, flags=re.MULTILINE)
            return [(_COMMENT.sub("", line), shown) for line, shown in zip(parts[::2], parts[1::2], strict=True)]
        if self.language in SHELLS or (not self.language and lines and is_command(lines[0])):
            return [(_COMMENT.sub("", line), "") for line in lines if line and not line.startswith("#")]
        return []

    @property
    def lines(self) -> list[str]:
        """The commands of a block as they stand there."""
        return [line for line, _ in self.session]

    @property
    def commands(self) -> list[list[str]]:
        """Return the commands in words, with this cfepy."""
        return [_here(shlex.split(line)) for line in self.lines]

    @property
    def overlooked(self) -> list[str]:
        """Lines that look like commands in a block without a language that is not read as commands."""
        if self.language or self.lines:
            return []
        return [line for line in self.text.splitlines() if is_command(line)]


def is_command(line: str) -> bool:
    """Return whether a line begins as a command does."""
    word = _SETTINGS.sub("", line).partition(" ")[0]
    return word in PROGRAMS or _OWN_PROGRAM.match(word) is not None


def _here(words: list[str]) -> list[str]:
    return [sys.executable, "-m", "cfepy", *words[1:]] if words[0] == "cfepy" else words


def blocks(page: Path, section: str = "") -> list[Block]:
    """Return the code blocks of a page, or of one section of it, in order."""
    text = page.read_text(encoding="utf-8")
    if section:
        _, *parts = _SECTION.split(text)
        text = dict(zip(parts[::2], parts[1::2], strict=True))[section]
    return [Block(*found) for found in _BLOCK.findall(text)]


def commands(page: Path) -> list[str]:
    """Return all commands of a page, in their order."""
    return [line for block in blocks(page) for line in block.lines]


def name_of(page: Path) -> str:
    """Return a page's path in the repository."""
    return page.relative_to(ROOT).as_posix() if page.is_relative_to(ROOT) else str(page)
