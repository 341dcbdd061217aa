"""Write docs/reference/generated/python_api_reference.md from the docstrings of the names that `import cfepy` offers.

`python -m dev.pages.python_api` rewrites it; a test fails when it is out of date.
"""

from __future__ import annotations

import argparse
import inspect
import re
import textwrap
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import cfepy

PAGE = Path(__file__).parents[2] / "docs" / "reference" / "generated" / "python_api_reference.md"
HEAD = """# Reference of the library

This page describes the public names of `import cfepy`. `python -m dev.pages.python_api` writes it from the docstrings.
The guide is [python_api.md](../../how_to/python_api.md). Times are virtual and in seconds, unless a name ends with
`_ns`.
"""
SECTIONS = ("Args", "Attributes", "Returns", "Raises")
FOREIGN = (tuple, dict, list, Exception, object)  # whose methods Python defines


def functions() -> list[str]:
    """Return the names of the functions that it offers, sorted."""
    return [name for name in sorted(cfepy.__all__) if inspect.isfunction(getattr(cfepy, name))]


def classes() -> list[str]:
    """Return the names of the classes, sorted."""
    return [name for name in sorted(cfepy.__all__) if inspect.isclass(getattr(cfepy, name))]


def members(kind: type) -> list[tuple[str, Any]]:
    """Return public methods, properties and class methods, including those of bases, in alphabetical order."""
    found = {}
    for name in dir(kind):
        value = inspect.getattr_static(kind, name)
        is_callable = inspect.isfunction(value) or isinstance(value, property | classmethod | staticmethod)
        if not name.startswith("_") and is_callable and _is_ours(kind, name):
            found[name] = value
    return sorted(found.items())


def _is_ours(kind: type, name: str) -> bool:
    owner = next(each for each in kind.__mro__ if name in vars(each))
    return owner.__module__.startswith(("cfepy", "rospy_shim"))


def page() -> str:
    """Return the page."""
    parts = [HEAD, "## Functions\n"]
    parts += [_function(f"cfepy.{name}", getattr(cfepy, name), 3) for name in functions()]
    parts.append("## Classes\n")
    parts += [part for name in classes() for part in _class(name, getattr(cfepy, name))]
    return "\n".join(parts).rstrip() + "\n"


def _class(name: str, kind: type) -> Iterator[str]:
    yield f"### cfepy.{name}\n\n{text_of(kind)}\n"
    for member, value in members(kind):
        if isinstance(value, property):
            yield f"- `{member}`: {_first(value)}\n"
        else:
            function = value.__func__ if isinstance(value, classmethod | staticmethod) else value
            yield f"- `{member}{signature(function)}`: {_first(function)}\n"


def _function(name: str, function: Any, level: int) -> str:
    return f"{'#' * level} {name}\n\n```python\n{name}{signature(function)}\n```\n\n{text_of(function)}\n"


def signature(function: Any) -> str:
    """Return its arguments, without `self` and without the modules of types."""
    arguments = [each for each in inspect.signature(function).parameters.values() if each.name not in ("self", "cls")]
    parts, is_starred = [], False
    for each in arguments:
        if each.kind is each.KEYWORD_ONLY and not is_starred:
            parts.append("*")
            is_starred = True
        is_starred |= each.kind is each.VAR_POSITIONAL
        mark = "*" if each.kind is each.VAR_POSITIONAL else "**" if each.kind is each.VAR_KEYWORD else ""
        default = "" if each.default is each.empty else f"={each.default!r}"
        parts.append(f"{mark}{each.name}{'=...' if default.startswith('=<') else default}")
    return f"({', '.join(parts)})"


def _first(thing: Any) -> str:
    text = inspect.cleandoc(thing.__doc__ or "").split("\n\n")[0]
    return " ".join(text.split())


def text_of(thing: Any) -> str:
    """Return a docstring as Markdown: its sections become lists, and indented parts become code."""
    text = inspect.cleandoc(thing.__doc__ or "")
    return "\n\n".join(filter(None, (_block(block) for block in text.split("\n\n"))))


def _block(block: str) -> str:
    title, _, rest = block.partition(":\n")
    if title in SECTIONS:
        text = textwrap.dedent(rest)
        return f"{title}: {' '.join(text.split())}" if title == "Returns" else f"{title}:\n\n{_items(text)}"
    if block.startswith("    "):
        return f"```python\n{textwrap.dedent(block)}\n```"
    return block


def _items(text: str) -> str:
    items = re.split(r"\n(?! )", text)
    return "\n".join(f"- {_item(' '.join(item.split()))}" for item in items)


def _item(item: str) -> str:
    return re.sub(r"^([\w, *|\[\]]+?):", r"`\1`:", item)


if __name__ == "__main__":
    argparse.ArgumentParser(prog="python -m dev.pages.python_api", description=__doc__).parse_args()
    PAGE.write_text(page(), encoding="utf-8")
