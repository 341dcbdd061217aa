"""Source text that packs and unpacks by `struct`, and the patterns that it uses."""

from __future__ import annotations

import itertools
from collections.abc import Sequence

from .base import SIMPLE_TYPES_DICT

_patterns: list[str] = []


def add_pattern(p: str) -> None:
    """Note that the source uses `_get_struct_<p>`."""
    _patterns.append(p)


def clear_patterns() -> None:
    """Begin a new source."""
    _patterns.clear()


def get_patterns() -> list[str]:
    """Return the patterns used since `clear_patterns`."""
    return list(_patterns)


def compute_struct_pattern(types: Sequence[str] | None) -> str | None:
    """Return the pattern of several fields, or None if there is no field or one is not simple."""
    codes = [SIMPLE_TYPES_DICT.get(each) for each in types or ()]
    return "".join(map(str, codes)) if codes and None not in codes else None


def reduce_pattern(pattern: str) -> str:
    """Return a pattern with counts in place of repetitions."""
    if not pattern or "%" in pattern:
        return pattern
    runs = [(char, len(list(run))) for char, run in itertools.groupby(pattern)]
    # Digits are counts already and stay as they are.
    return "".join(char * count if char.isdigit() or count == 1 else f"{count}{char}" for char, count in runs)


def serialize(expr: str) -> str:
    """Source that writes an expression."""
    return f"buff.write({expr})"


def int32_pack(var: str) -> str:
    """Source that writes a uint32, which is how lengths are sent."""
    return serialize(f"_struct_I.pack({var})")


def int32_unpack(var: str, buff: str) -> str:
    """Source that reads a uint32."""
    return f"({var},) = _struct_I.unpack({buff})"


def pack(pattern: str, vars_: str) -> str:
    """Source that writes variables by a pattern, which is noted."""
    short = reduce_pattern(pattern)
    add_pattern(short)
    return serialize(f"_get_struct_{short}().pack({vars_})")


def pack2(pattern: str, vars_: str) -> str:
    """Source that writes variables by a pattern that is an expression."""
    return serialize(f"struct.Struct({pattern}).pack({vars_})")


def unpack(var: str, pattern: str, buff: str) -> str:
    """Source that reads variables by a pattern, which is noted."""
    short = reduce_pattern(pattern)
    add_pattern(short)
    return f"{var} = _get_struct_{short}().unpack({buff})"


def unpack2(var: str, pattern: str, buff: str) -> str:
    """Source that reads variables by a pattern that is an expression."""
    return f"{var} = struct.unpack({pattern}, {buff})"


def unpack3(var: str, struct_var: str, buff: str) -> str:
    """Source that reads variables by a `struct.Struct` in a variable."""
    return f"{var} = {struct_var}.unpack({buff})"
