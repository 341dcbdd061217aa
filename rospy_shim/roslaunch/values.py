"""How texts in launch files become values: roslaunch's types of parameters, truth values, numbers, YAML with angles.

PyYAML is imported when there is YAML to read.
"""

from __future__ import annotations

import ast
import math
import re
from collections.abc import Callable
from typing import Any

from cfepy.syntax_trees import parsed

_TRUTH = {"true": True, "1": True, "false": False, "0": False}
TYPES = ("str", "string", "int", "double", "bool", "boolean", "yaml", "auto")


def converted(text: str, type_name: str) -> Any:
    """The value of a text.

    Args:
        text: as the file has it.
        type_name: one of `TYPES`; "auto" finds out.

    Raises:
        ValueError: it is no value of that type, or there is no such type.
    """
    kind = type_name.lower()
    if kind not in TYPES:
        raise ValueError(f"there is no type {type_name!r}; known are {', '.join(TYPES)}")
    try:
        return _CONVERSIONS[kind](text)
    except ValueError as error:
        if kind in ("int", "double"):
            raise ValueError(f"is {text!r}, which is no number of type {kind}") from None
        raise error


def truth(text: str) -> bool:
    """A truth value: true, false, 1 or 0.

    Raises:
        ValueError: something else.
    """
    word = text.lower().strip()
    if word not in _TRUTH:
        raise ValueError(f"is {text!r}; write true or false")
    return _TRUTH[word]


def from_yaml(text: str) -> Any:
    """The value of a YAML text, with ROS's angles: deg(90), rad(pi/2), !degrees 90, !radians pi.

    Raises:
        ValueError: it is not YAML.
    """
    import yaml

    try:
        return yaml.load(text, _angle_loader())
    except yaml.MarkedYAMLError as error:
        line = "" if error.problem_mark is None else f", line {error.problem_mark.line + 1} of it"
        raise ValueError(f"is not YAML: {error.problem or error.context}{line}") from None
    except yaml.YAMLError as error:
        raise ValueError(f"is not YAML: {error}") from None


def _angle_loader() -> type[Any]:
    """YAML's safe loader, and what the tool rosparam adds to it."""
    import yaml

    class Loader(yaml.SafeLoader):
        """A class of its own: resolvers are kept in the class."""

    for name, unit in (("deg", math.radians(1)), ("rad", 1.0)):
        Loader.add_implicit_resolver(f"!{name}", re.compile(rf"^{name}\([^\)]*\)$"), None)
        for tag in (f"!{name}", {"deg": "!degrees", "rad": "!radians"}[name]):
            Loader.add_constructor(tag, _angle(name, unit))
    return Loader


def _angle(name: str, unit: float) -> Callable[[Any, Any], float]:
    def construct(loader: Any, node: Any) -> float:
        text = str(loader.construct_scalar(node)).strip()
        inside = text[len(name) + 1 : -1] if text.startswith(f"{name}(") else text
        try:
            return _arithmetic(parsed(inside.strip(), mode="eval").body) * unit
        except SyntaxError:
            raise ValueError(f"{text!r} is no angle; write {name}(NUMBER)") from None

    return construct


def _arithmetic(node: ast.AST) -> float:
    """A number, pi, or what + - * / ** make of them."""
    if isinstance(node, ast.Constant) and isinstance(node.value, (int, float)):
        return float(node.value)
    if isinstance(node, ast.Name) and node.id == "pi":
        return math.pi
    if isinstance(node, ast.UnaryOp) and isinstance(node.op, (ast.USub, ast.UAdd)):
        value = _arithmetic(node.operand)
        return -value if isinstance(node.op, ast.USub) else value
    if isinstance(node, ast.BinOp) and type(node.op) in _OPERATIONS:
        return _OPERATIONS[type(node.op)](_arithmetic(node.left), _arithmetic(node.right))
    raise ValueError(f"{ast.unparse(node)!r} is no angle; write a number, or arithmetic with pi")


_OPERATIONS: dict[type[ast.AST], Callable[[float, float], float]] = {
    ast.Add: lambda left, right: left + right,
    ast.Sub: lambda left, right: left - right,
    ast.Mult: lambda left, right: left * right,
    ast.Div: lambda left, right: left / right,
    ast.Pow: lambda left, right: math.pow(left, right),
}


def _auto(text: str) -> Any:
    """A number if it looks like one, true or false in any case, otherwise the text."""
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
        raise ValueError("is empty; a parameter needs a value")
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
