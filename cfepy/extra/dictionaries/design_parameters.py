"""DesignParameters of electronic data sheets: `${PACKAGE/NAME}` in an attribute, and the arithmetic of the values."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping

from cfepy.extra.dictionaries.xml_tags import XmlTag
from cfepy.reading.suggestions import did_you_mean
from cfepy.status import UsageError

_PARAMETER = re.compile(r"\$\{([^${}]*)\}")
_TOKEN = re.compile(r"\s*(0[xX][0-9a-fA-F]+|\d+\.\d+|\d+|[-+*/^()])")
MOST_STEPS = 50  # parameters inside each other
MOST_CHARACTERS = 1_000
LARGEST = 1 << 128
_SHOWN = 60
_DEPTH = 50  # brackets inside each other


class DesignParameters:
    """The values of `<Define>` tags, by package and name.

    Args:
        defaults: values of parameters that no file defines, such as {"CFE_MISSION/HS_CMD_TOPICID": "10"}.
    """

    def __init__(self, defaults: Mapping[str, str]) -> None:
        self._defaults = defaults
        self._defined: dict[str, str] = {}

    def read(self, root: XmlTag) -> None:
        """Read a file of definitions; a later definition of a name wins."""
        for package in root.all("Package"):
            for each in package.all("Define"):
                self._defined[f"{package.need('name')}/{each.need('name')}"] = each.attributes.get("value", "")

    def text(self, tag: XmlTag, name: str) -> str:
        """Return an attribute with the values of its parameters.

        Raises:
            UsageError: if it is missing, or a parameter is unknown or contains itself.
        """
        return self._resolved(tag, tag.need(name), ())

    def text_or(self, tag: XmlTag, name: str, default: str) -> str:
        """Return an attribute as `text`, or a default if it is missing."""
        return self.text(tag, name) if name in tag.attributes else default

    def number(self, tag: XmlTag, name: str) -> int:
        """Return an attribute as a whole number, such as `${A/B} + 4`.

        Raises:
            UsageError: if it is no such number; see `text`.
        """
        text = self.text(tag, name)
        try:
            value = _Arithmetic(text).value()
        except (ValueError, ArithmeticError, RecursionError) as error:
            shown = text if len(text) <= _SHOWN else f"{text[:_SHOWN]}..."
            raise tag.fail(f"{name} must be a whole number or a sum of such, not {shown!r} ({error})") from None
        if value != int(value):
            raise tag.fail(f"{name} must be a whole number, not {text!r}")
        return int(value)

    def count(self, tag: XmlTag, name: str, most: int) -> int:
        """Return an attribute as a number from 1.

        Raises:
            UsageError: if it is another one; see `number`.
        """
        value = self.number(tag, name)
        if not 1 <= value <= most:
            raise tag.fail(f"{name} must be from 1 to {most:,}, not {value}")
        return value

    def _resolved(self, tag: XmlTag, text: str, inside: tuple[str, ...]) -> str:
        def value(match: re.Match[str]) -> str:
            name = match[1].strip()
            if name in inside:
                raise tag.fail(f"the parameter {name} contains itself; correct its <Define>")
            if len(inside) >= MOST_STEPS:
                raise tag.fail(
                    f"parameters are nested more than {MOST_STEPS} deep at {name}; simplify the <Define> tags"
                )
            return self._resolved(tag, self._value(tag, name), (*inside, name))

        found = _PARAMETER.sub(value, text)
        if len(found) > MOST_CHARACTERS:
            raise tag.fail(f"the value has more than {MOST_CHARACTERS} characters with its parameters; shorten it")
        return found

    def _value(self, tag: XmlTag, name: str) -> str:
        if name in self._defined:
            return self._defined[name]
        if name in self._defaults:
            return self._defaults[name]
        remedy = "add the file that defines it, such as the mission's config.xml or cfe-topicids.xml"
        raise tag.fail(f"unknown parameter {name}; {did_you_mean(name, self._defined, remedy)}")


class _Arithmetic:
    """An expression of whole numbers with + - * / ^ and brackets.

    Raises:
        ValueError: for another text.
        ArithmeticError: for a division by 0.
    """

    def __init__(self, text: str) -> None:
        self._tokens = list(_tokens(text))
        self._depth = 0

    def value(self) -> float:
        found = self._sum()
        if self._tokens:
            raise ValueError(f"unexpected {self._tokens[0]!r}")
        return found

    def _sum(self) -> float:
        total = self._product()
        while self._tokens and self._tokens[0] in "+-":
            sign = 1 if self._tokens.pop(0) == "+" else -1
            total += sign * self._product()
        return _limited(total)

    def _product(self) -> float:
        total = self._power()
        while self._tokens and self._tokens[0] in "*/":
            if self._tokens.pop(0) == "*":
                total = _limited(total * self._power())
            else:
                divisor = self._power()
                whole = isinstance(total, int) and isinstance(divisor, int)
                total = total // divisor if whole else total / divisor
        return total

    def _power(self) -> float:
        base = self._atom()
        if not self._tokens or self._tokens[0] != "^":
            return base
        self._tokens.pop(0)
        exponent = self._atom()
        if not isinstance(exponent, int) or not 0 <= exponent <= 128:
            raise ValueError("an exponent is from 0 to 128")
        return _limited(base**exponent)

    def _atom(self) -> float:
        if not self._tokens:
            raise ValueError("a number is missing")
        token = self._tokens.pop(0)
        if token in "+-":
            return self._atom() * (1 if token == "+" else -1)
        if token == "(":
            self._depth += 1
            if self._depth > _DEPTH:
                raise ValueError("too many brackets")
            found = self._sum()
            if not self._tokens or self._tokens.pop(0) != ")":
                raise ValueError("a bracket is not closed")
            self._depth -= 1
            return found
        if token[:1].isdigit():
            return int(token, 16) if token[:2] in ("0x", "0X") else float(token) if "." in token else int(token)
        raise ValueError(f"unexpected {token!r}")


def _tokens(text: str) -> Iterator[str]:
    at = 0
    while text[at:].strip():
        match = _TOKEN.match(text, at)
        if match is None:
            raise ValueError(f"unexpected {text[at:].strip()[:20]!r}")
        yield match[1]
        at = match.end()


def _limited(value: float) -> float:
    if abs(value) > LARGEST:
        raise ValueError("a value is larger than 2 ^ 128")
    return value


def defined_twice(where: XmlTag, other: XmlTag) -> UsageError:
    """Return the error for a name that two tags define."""
    return where.fail(f"is defined a second time; the first one is in {other.file}:{other.line}; remove one of them")
