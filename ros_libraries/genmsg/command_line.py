"""Command line arguments of code generators."""

from __future__ import annotations

from collections.abc import Iterable


def includepath_to_dict(includepath: Iterable[str] | None) -> dict[str, list[str]]:
    """Return a search path from arguments "package:folder"."""
    found: dict[str, list[str]] = {}
    for each in includepath or ():
        package, _, folder = each.partition(":")
        if folder:
            found.setdefault(package, []).append(folder)
    return found
