"""The texts in procedures: "TARGET PACKET with ITEM 1, TEXT 'a'", and "TARGET PACKET ITEM == 1"."""

from __future__ import annotations

import ast
import re
from typing import Any, NamedTuple

from cfepy.status import UsageError
from rospy_shim.types import expression

_WITH = re.compile(r"\s+with\s+", re.IGNORECASE)
_PIECE = re.compile(r"""[^\s"',\[]+|"(?:[^"\\]|\\.)*"|'(?:[^'\\]|\\.)*'|\[[^\]]*\]|,""")
_COMPARED = re.compile(r"\s*(\S+)\s+(\S+)\s+(\S+)(?:\s+(.*\S))?\s*", re.DOTALL)
_VALUE = "telemetry_value"
_OPERATOR = re.compile(r"[&|^%+*/-]|<<|>>")
_COMPARISON = re.compile(r"(==|!=|>=|<=|>|<|in\b|not\s+in\b)\s*(.*)", re.DOTALL)


class Compared(NamedTuple):
    """An item and the comparison after it: "== 5", or empty."""

    target: str
    packet: str
    item: str
    comparison: str


def command_words(given: tuple[Any, ...]) -> tuple[str, str, dict[str, Any]]:
    """Return target, command and parameters of the arguments of `cmd`.

    Args:
        given: one text, or target, command and a dictionary of parameters.

    Raises:
        UsageError: if they are neither.
    """
    match given:
        case (str(text),):
            head, *rest = _WITH.split(text.strip(), maxsplit=1)
            words = head.split()
            if len(words) != 2:
                raise UsageError(f"expected a target and a command, not {head!r}")
            return words[0], words[1], _parameters(rest[0]) if rest else {}
        case (str(target), str(name)):
            return target, name, {}
        case (str(target), str(name), dict(values)):
            return target, name, {str(key).upper(): value for key, value in values.items()}
    raise UsageError(f"expected a text, or a target, a command and parameters, not {len(given)} arguments")


def _parameters(text: str) -> dict[str, Any]:
    pieces = _PIECE.findall(text)
    found: dict[str, Any] = {}
    at = 0
    while at < len(pieces):
        if at + 1 >= len(pieces) or pieces[at + 1] == ",":
            raise UsageError(f"the parameter {pieces[at]} has no value")
        found[pieces[at].upper()] = value_of(pieces[at + 1])
        at += 2
        if at < len(pieces) and pieces[at] != ",":
            raise UsageError(f"expected a comma before {pieces[at]}")
        at += 1
    return found


def value_of(word: str) -> Any:
    """Return a value as a procedure writes it: a number, a list, a text with or without quotes."""
    if word[:1] in "\"'" and word[-1:] == word[:1] and len(word) > 1:
        return word[1:-1]
    if word.startswith("["):
        try:
            return ast.literal_eval(word)
        except (SyntaxError, ValueError):
            raise UsageError(f"invalid list {word}") from None
    for kind in (lambda text: int(text, 0), float):
        try:
            return kind(word)
        except ValueError:
            continue
    return word


def item_words(given: tuple[Any, ...]) -> tuple[str, str, str]:
    """Return target, packet and item of the arguments of `tlm`.

    Raises:
        UsageError: if they are not one text with three words, or three texts.
    """
    words = given[0].split() if len(given) == 1 and isinstance(given[0], str) else given
    if len(words) != 3 or not all(isinstance(each, str) for each in words):
        raise UsageError(f"expected a target, a packet and an item, not {' '.join(map(str, given))!r}")
    return words[0], words[1], words[2]


def packet_words(given: tuple[Any, ...]) -> tuple[str, str]:
    """Return target and packet.

    Raises:
        UsageError: if they are not one text with two words, or two texts.
    """
    words = given[0].split() if len(given) == 1 and isinstance(given[0], str) else given
    if len(words) != 2 or not all(isinstance(each, str) for each in words):
        raise UsageError(f"expected a target and a packet, not {' '.join(map(str, given))!r}")
    return words[0], words[1]


def comparison_words(text: str) -> Compared:
    """Return the item and the comparison of a text such as "TARGET PACKET ITEM == 5".

    Raises:
        UsageError: if it has fewer than three words.
    """
    match = _COMPARED.fullmatch(text)
    if match is None:
        raise UsageError(f"expected a target, a packet, an item and a comparison, not {text!r}")
    return Compared(match[1], match[2], match[3], match[4] or "")


def holds(value: Any, comparison: str) -> bool:
    """Return whether a comparison such as "== 5", "> 1 and < 4" or "& 0x3 == 2" is true for a value.

    Raises:
        UsageError: if it is not a comparison with a literal, a word, or a list of them.
    """
    if _OPERATOR.match(comparison.strip()) is not None:
        return _computed(value, comparison.strip())
    return all(_holds(value, part.strip()) for part in re.split(r"\band\b", comparison))


def _computed(value: Any, comparison: str) -> bool:
    """Return whether a comparison is true that first computes with the value, as Python does."""
    try:
        return bool(expression.value_of(f"{_VALUE} {comparison}", {_VALUE: value}))
    except TypeError:
        if value is None:
            return False
        raise UsageError(f"{value!r} cannot be compared: {comparison}") from None
    except (SyntaxError, expression.ExpressionError, NameError, ValueError, ArithmeticError) as error:
        raise UsageError(f"invalid comparison {comparison!r}: {error}") from None


def _holds(value: Any, comparison: str) -> bool:
    match = _COMPARISON.fullmatch(comparison)
    if match is None:
        raise UsageError(f"invalid comparison {comparison!r}; expected ==, !=, <, <=, >, >= or in, and a value")
    expected = _expected(match[2].strip())
    kind = re.sub(r"\s+", " ", match[1])
    try:
        match kind:
            case "==":
                return bool(value == expected)
            case "!=":
                return bool(value != expected)
            case "in":
                return value in expected
            case "not in":
                return value not in expected
            case ">":
                return bool(value > expected)
            case ">=":
                return bool(value >= expected)
            case "<":
                return bool(value < expected)
        return bool(value <= expected)
    except TypeError:
        if value is None:
            return False
        raise UsageError(f"{value!r} cannot be compared: {comparison}") from None


def _expected(text: str) -> Any:
    try:
        return ast.literal_eval(text)
    except (SyntaxError, ValueError):
        pass
    try:
        return _arithmetic(ast.parse(text, mode="eval").body)
    except (SyntaxError, ValueError):
        known = {"true": True, "false": False, "nil": None}
        if text in known:
            return known[text]
        raise UsageError(f"invalid value {text!r} in a comparison; a text requires quotes") from None


def _arithmetic(node: ast.expr) -> Any:
    match node:
        case ast.Constant():
            return node.value
        case ast.UnaryOp(op=ast.USub()):
            return -_arithmetic(node.operand)
        case ast.BinOp(op=ast.Add()):
            return _arithmetic(node.left) + _arithmetic(node.right)
        case ast.BinOp(op=ast.Sub()):
            return _arithmetic(node.left) - _arithmetic(node.right)
        case ast.BinOp(op=ast.Mult()):
            return _arithmetic(node.left) * _arithmetic(node.right)
    raise ValueError
