"""$(eval ...): a Python expression that can reach arguments, numbers and texts, and nothing of the computer.

Imports nothing of cfepy.
"""

from __future__ import annotations

import builtins
import math
from collections.abc import Mapping
from typing import Any

# fmt: off
_FUNCTIONS = (
    "abs", "all", "any", "bool", "dict", "divmod", "enumerate", "filter", "float", "int", "len", "list", "map", "max",
    "min", "pow", "range", "repr", "reversed", "round", "set", "sorted", "str", "sum", "tuple", "zip",
)
# fmt: on
_SAFE = {name: getattr(builtins, name) for name in _FUNCTIONS}
_MATH = {name: value for name, value in vars(math).items() if not name.startswith("_")}
_WORDS = {"true": True, "false": False}


class SubstitutionError(Exception):
    """A substitution that cannot be made; its text says why."""


def evaluate(text: str, functions: Mapping[str, Any], arguments: Mapping[str, Any]) -> str:
    """The value of an expression, as text.

    Args:
        text: the expression.
        functions: roslaunch's functions; they and the names of `math` win over arguments.
        arguments: what arguments stand for.

    Raises:
        SubstitutionError: it is no expression, looks at names with two underscores, or fails.
    """
    if "__" in text:
        raise SubstitutionError(f"$(eval {text}) has two underscores in a row, which are not allowed there")
    names = {**arguments, **_MATH, **_WORDS, **functions, "__builtins__": _SAFE}
    try:
        return str(eval(text.strip(), names))
    except SubstitutionError:
        raise
    except Exception as error:
        raise SubstitutionError(f"$(eval {text}) has no value: {type(error).__name__}: {error}") from None
