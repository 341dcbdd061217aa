"""Rewrites f-strings of Python 3.12 for Python 3.11: a text inside of the braces may have the quotes of the f-string.

OpenC3 runs procedures with newer releases of Python than the oldest one that cfepy supports.
"""

from __future__ import annotations

import re

_START = re.compile(r"([rRbBuUfF]{0,2})(\"\"\"|'''|\"|')")


class _TooNewError(Exception):
    """A text that has no form in Python 3.11."""


def older(source: str) -> str:
    """Return source code with other quotes around texts inside of f-strings, where they are those of the f-string.

    Args:
        source: source code; it is returned unchanged if it has a text that needs both kinds of quotes.
    """
    try:
        return _code(source, 0, "", "")[0]
    except _TooNewError:
        return source


def _code(source: str, at: int, end: str, outer: str) -> tuple[str, int]:
    """Return code and where it ends.

    Args:
        source: all of the source.
        at: where the code begins.
        end: the bracket that ends it; empty for all of the source.
        outer: the quotes of the f-string around the code; empty outside of one.
    """
    parts: list[str] = []
    depth = 0
    while at < len(source):
        char = source[at]
        match = _START.match(source, at)
        if match is not None and not _is_name(source[at - 1 : at]):
            text, at = _string(source, match, outer)
            parts.append(text)
            continue
        if char == "#" and not end:
            last = source.find("\n", at)
            last = len(source) if last < 0 else last
            parts.append(source[at:last])
            at = last
            continue
        if end and depth == 0 and char == end:
            return "".join(parts), at
        depth += (char in "([{") - (char in ")]}")
        parts.append(char)
        at += 1
    if end:
        raise _TooNewError
    return "".join(parts), at


def _is_name(before: str) -> bool:
    return before.isidentifier() or before.isdigit()


def _string(source: str, match: re.Match[str], outer: str) -> tuple[str, int]:
    """Return a text with its prefix and quotes, and where it ends."""
    prefix, quotes = match[1], match[2]
    at = match.end()
    parts: list[str] = []
    while not source.startswith(quotes, at):
        if at >= len(source) or (len(quotes) == 1 and source[at] == "\n"):
            raise _TooNewError
        if source[at] == "\\":
            parts.append(source[at : at + 2])
            at += 2
        elif source[at] == "{" and "f" in prefix.lower() and source[at : at + 2] != "{{":
            code, at = _code(source, at + 1, "}", quotes)
            parts.append("{" + code + "}")
            at += 1
        else:
            width = 2 if source[at : at + 2] == "{{" else 1
            parts.append(source[at : at + width])
            at += width
    body = "".join(parts)
    if outer and quotes[0] == outer[0]:
        quotes = "'" if outer[0] == '"' else '"'
        if quotes in body or "\\" in body:
            raise _TooNewError
    return f"{prefix}{quotes}{body}{quotes}", at + len(match[2])
