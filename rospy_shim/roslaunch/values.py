"""Conversion of texts in launch files to values: roslaunch's types of parameters, booleans, numbers, YAML with angles.

PyYAML is imported when there is YAML to read.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from functools import cache
from typing import Any

from cfepy.reading.plain_yaml import YamlError, plain_yaml, safe_loader
from cfepy.reading.suggestions import expected
from rospy_shim.types.angles import degrees, radians

_TRUTH = {"true": True, "1": True, "false": False, "0": False}
TYPES = ("str", "string", "int", "double", "bool", "boolean", "yaml", "auto")


def converted(text: str, type_name: str) -> Any:
    """Convert a text to a value.

    Args:
        text: the text in the file.
        type_name: one of `TYPES`; "auto" chooses by the text.

    Raises:
        ValueError: it is not a value of that type, or there is no such type.
    """
    kind = type_name.lower()
    if kind not in TYPES:
        raise ValueError(f"unknown type {type_name!r}; {expected(kind, TYPES)}")
    try:
        return _CONVERSIONS[kind](text)
    except ValueError as error:
        if kind in ("int", "double"):
            raise ValueError(f"must be a number of type {kind}, not {text!r}") from None
        raise error


def truth(text: str) -> bool:
    """Parse a boolean: true, false, 1 or 0.

    Raises:
        ValueError: it is another text.
    """
    word = text.lower().strip()
    if word not in _TRUTH:
        raise ValueError(f"must be true or false, not {text!r}")
    return _TRUTH[word]


def from_yaml(text: str) -> Any:
    """Parse a YAML text, with ROS's angles: deg(90), rad(pi/2), !degrees 90, !radians pi.

    Raises:
        ValueError: it is not YAML, or too large.
    """
    return plain_yaml(text, _angle_loader())


@cache
def _angle_loader() -> type[Any]:
    """Return YAML's safe loader, with the additions of the tool rosparam."""
    loader = type("AngleLoader", (safe_loader(),), {})  # a separate class, because resolvers are kept in the class
    for name, tag, value in (("deg", "!degrees", degrees), ("rad", "!radians", radians)):
        pattern = re.compile(rf"^{name}\([^\)]*\)$")
        loader.add_implicit_resolver(tag, pattern, [name[0]])  # type: ignore[attr-defined]
        loader.add_constructor(tag, _angle(name, value))  # type: ignore[attr-defined]
    return loader


def _angle(name: str, value: Callable[[str], float]) -> Callable[[Any, Any], float]:
    def construct(loader: Any, node: Any) -> float:
        text = str(loader.construct_scalar(node))
        try:
            return value(text)
        except Exception as error:
            what = error.msg if isinstance(error, SyntaxError) else str(error)
            told = f"has an invalid angle {text[:60]!r}: {what}; write {name}(NUMBER)"
            raise YamlError(told, node.start_mark.line + 1) from None

    return construct


def _auto(text: str) -> Any:
    """Return a number if it looks like one, true or false in any case, otherwise the text."""
    try:
        if "." in text:
            return float(text)
        if "_" not in text:
            return int(text)
    except ValueError:
        pass
    return _TRUTH[text.lower()] if text.lower() in ("true", "false") else text


def _plain_yaml(text: str) -> Any:
    value = from_yaml(text)
    if value is None:
        raise ValueError("must not be empty")
    return value


_CONVERSIONS: dict[str, Callable[[str], Any]] = {
    "str": str,
    "string": str,
    "int": int,
    "double": float,
    "bool": truth,
    "boolean": truth,
    "yaml": _plain_yaml,
    "auto": _auto,
}
