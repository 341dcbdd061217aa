"""docs/reference/generated/releases.md: the facts that differ between the releases of cFE that a mission can select.

The facts are the simulator's own data, `cfepy/config/releases/*.toml`. Their meanings come from the docstring of
`cfepy.config.versions.Release`. `python -m dev.pages.releases` writes the page.
"""

from __future__ import annotations

import argparse
import inspect
import re
from collections.abc import Mapping
from pathlib import Path

from cfepy.config.versions import DEFAULT_RELEASE, RELEASES, Release

PAGE = Path(__file__).parents[2] / "docs/reference/generated/releases.md"
_SUBJECT = re.compile(r"^ {8}([\w, ]+): (.+?)(?=^ {8}\w[\w, ]*: |\Z)", re.MULTILINE | re.DOTALL)
_HEAD = """# Releases of cFE

A mission chooses a release with `cfe_version` in its [mission file](../mission_file.md). The default is {default}. This
page has each fact that differs between the releases. [Differences](../differences.md#what-cfe_version-decides) explains
what they mean for you.

`python -m dev.pages.releases` writes this page from `cfepy/config/releases`, the files that the simulator reads itself.
"""
_SAME = """
## The same in all releases

| fact | meaning | value |
|---|---|---|
"""


def meanings() -> dict[str, str]:
    """Return the meaning of each fact, from the docstring of `Release`."""
    text = inspect.getdoc(Release) or ""
    listed = "        " + text.partition("Attributes:")[2].strip().replace("\n    ", "\n        ")
    found = {}
    for names, meaning in _SUBJECT.findall(listed):
        for name in names.split(", "):
            found[name] = " ".join(meaning.split())
    return found


def page() -> str:
    """Return the text of the page."""
    names = list(RELEASES)
    known = meanings()
    rows, same = [], []
    for fact in Release.__annotations__:
        values = [_shown(getattr(RELEASES[name], fact)) for name in names]
        if len(set(values)) > 1:
            rows.append(f"| `{fact}` | {known[fact]} | {' | '.join(values)} |")
        else:
            same.append(f"| `{fact}` | {known[fact]} | {values[0]} |")
    table = [f"| fact | meaning | {' | '.join(names)} |", "|---|---|" + "---|" * len(names), *rows]
    head = _HEAD.format(default=DEFAULT_RELEASE)
    return head + "\n" + "\n".join(table) + "\n" + _SAME + "\n".join(same) + "\n"


def _shown(value: object) -> str:
    if isinstance(value, bool):
        return "yes" if value else "no"
    if isinstance(value, tuple):
        is_number = all(isinstance(each, int) for each in value)
        return ".".join(map(str, value)) if is_number else ", ".join(f"`{each}`" for each in value)
    if isinstance(value, Mapping):
        return ", ".join(f"`{name}` {number}" for name, number in value.items()) or "none"
    return f"`{value}`" if isinstance(value, str) else str(value)


def main() -> None:
    """Write the page."""
    argparse.ArgumentParser(prog="python -m dev.pages.releases", description=__doc__).parse_args()
    PAGE.write_text(page(), encoding="utf-8")
    print(f"wrote {PAGE.name}")


if __name__ == "__main__":
    main()
