"""The command completion, and what a shell is told; here are its options.

A command belongs here when it serves the shell that `cfepy` is typed into.
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
