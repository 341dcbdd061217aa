"""The pytest command that runs one test again. Imports pytest."""

from __future__ import annotations

import os
import shlex
from collections.abc import Sequence

import pytest


def pytest_command(config: pytest.Config, item: pytest.Item, options: Sequence[str]) -> str:
    """The command, as it can be given where this run was started.

    Args:
        config: of this run.
        item: the test.
        options: to be added.
    """
    file, _, rest = item.nodeid.partition("::")
    start = config.invocation_params.dir
    path = os.path.relpath(config.rootpath / file, start)
    kept = [word for name in ("-m", "-c", "--rootdir") for word in _given(config, name)]
    return shlex.join(["pytest", *kept, f"{path}::{rest}", *options])


def _given(config: pytest.Config, name: str) -> list[str]:
    """An option of this run that decides which tests there are, with its value, if it was given."""
    words = [str(word) for word in config.invocation_params.args]
    for index, word in enumerate(words):
        if word == name and index + 1 < len(words):
            return [name, words[index + 1]]
        if word.startswith(f"{name}=") or (len(name) == 2 and word.startswith(name) and len(word) > 2):
            return [word]
    return []
