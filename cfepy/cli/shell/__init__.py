"""The command completion, and the shell's side of it; its options are defined here.

A command belongs here if it serves the shell that `cfepy` is typed into.
"""

from __future__ import annotations

import argparse

SHELLS = ("bash", "zsh", "fish")
_SETUP = """in ~/.bashrc or ~/.zshrc: eval "$(cfepy completion bash)", or zsh;
in ~/.config/fish/config.fish: cfepy completion fish | source"""


def add(commands: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Add this command to the parser of `cfepy`."""
    text = "print what makes a shell complete the words of cfepy"
    command = commands.add_parser("completion", help=text, description=f"{text[0].upper()}{text[1:]}.", epilog=_SETUP)
    command.add_argument("shell", choices=SHELLS, help="the shell")
    command.set_defaults(module="cfepy.cli.shell.completion")
