"""The words of a line in a mission script: texts in quotes, comments, numbers of seconds, one word out of several."""

from __future__ import annotations

import math
import re
from collections.abc import Iterable
from difflib import get_close_matches
from typing import NamedTuple

from cfepy.rtos.units import NS_PER_S
from cfepy.status import UsageError

LONGEST_S = 1e9
LONGEST_SIGN = 2  # one sign is like any other

_TOKEN = re.compile(r'\s*((?:[^\s"#]|"[^"]*")+)')


class Word(NamedTuple):
    """A word of a line; one that begins with a quote is a text."""

    text: str
    is_text: bool


class Words:
    """The words of a line that are still to be read.

    Args:
        line: a `#` outside of quotes begins a comment.

    Attributes:
        source: the line without its comment.

    Raises:
        UsageError: a quote is opened and not closed.
    """

    def __init__(self, line: str) -> None:
        self._words: list[Word] = []
        at = 0
        while match := _TOKEN.match(line, at):
            self._words.append(Word(match[1].replace('"', ""), match[1].startswith('"')))
            at = match.end()
        self.source = line[:at].strip()
        rest = line[at:].strip()
        if rest and not rest.startswith("#"):
            raise UsageError(f"a quote is opened and not closed: {rest}")

    def __bool__(self) -> bool:
        return bool(self._words)

    def take(self, what: str) -> str:
        """The next word.

        Args:
            what: it stands for, for the error.

        Raises:
            UsageError: there is none.
        """
        if not self._words:
            raise UsageError(f"{what} is missing at the end of the line")
        return self._words.pop(0).text

    def peek(self) -> Word:
        """The next word without taking it; an empty one at the end."""
        return self._words[0] if self._words else Word("", False)

    def take_if(self, *texts: str) -> str:
        """The next word if it is one of these, else ""."""
        word = self.peek()
        return self._words.pop(0).text if word.text in texts and not word.is_text else ""

    def rest(self) -> list[str]:
        """All that is left."""
        words, self._words = self._words, []
        return [word.text for word in words]


def seconds_ns(text: str) -> int:
    """A number of seconds in ns.

    Raises:
        UsageError: it is none.
    """
    try:
        number = float(text)
    except ValueError:
        number = math.nan
    if not 0 <= number <= LONGEST_S:
        raise UsageError(f"{text!r} is not a number of seconds; give 0 to {LONGEST_S:g}")
    return round(number * NS_PER_S)


def choice(text: str, choices: Iterable[str], what: str) -> str:
    """The word itself, when it is one of several.

    Args:
        text: the word.
        choices: what it may be.
        what: the choices are, for the error.

    Raises:
        UsageError: it is none of them.
    """
    known = list(choices)
    if text in known:
        return text
    near = get_close_matches(text, known, 1, 0.5) if len(text) > LONGEST_SIGN else []
    hint = f"is {near[0]} meant?" if near else f"there are {', '.join(known)}"
    raise UsageError(f"{text!r} is no {what}; {hint}")
