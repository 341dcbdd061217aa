"""Texts that name cfepy's own source files, with any place of the checkout, the user's folder and temporary files."""

from __future__ import annotations

import re
from pathlib import Path

import cfepy

_PACKAGE = Path(cfepy.__file__).parent
_PARTS = "|".join(sorted(re.escape(each.name) for each in _PACKAGE.iterdir() if each.is_dir() or each.suffix == ".py"))
_OWN = re.compile(rf"cfepy/(?:{_PARTS})\b")


def own_files(text: str) -> list[str]:
    """Find the lines of a text that name a file of the package cfepy, by an absolute path or a relative one.

    Args:
        text: such as a traceback. A folder called cfepy around the package is not meant.
    """
    return [line for line in text.splitlines() if str(_PACKAGE) in line or _OWN.search(line)]
