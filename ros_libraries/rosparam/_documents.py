"""YAML as rosparam reads and writes it: binary data as XML-RPC's Binary, angles as deg(...) and rad(...).

All programs of a simulated computer share PyYAML, so its own loaders are left unchanged.
"""

from __future__ import annotations

import base64
import re
from functools import cache
from typing import Any
from xmlrpc.client import Binary

import yaml

from rosparam import _angles  # type: ignore[attr-defined]  # made for the node: expressions that cannot do anything

_BINARY = "tag:yaml.org,2002:binary"


class RosParamException(Exception):
    """Base of rosparam's errors."""


def construct_yaml_binary(loader: Any, node: Any) -> Binary:
    """Binary data of a YAML document."""
    return Binary(loader.construct_yaml_binary(node))


def represent_xml_binary(loader: Any, data: Binary) -> Any:
    """Binary data in a YAML document."""
    return loader.represent_scalar(_BINARY, base64.encodebytes(data.data).decode(), style="|")


def construct_angle_radians(loader: Any, node: Any) -> float:
    """Return the value of `rad(expression)` or `!radians expression`. The expression may contain `pi`.

    Raises:
        RosParamException: not such an expression.
    """
    text = loader.construct_scalar(node).strip()
    try:
        return float(_angles.radians(text))
    except SyntaxError:
        raise RosParamException(f"invalid radian expression: {text}") from None


def construct_angle_degrees(loader: Any, node: Any) -> float:
    """`deg(number)` or `!degrees number`, in radians.

    Raises:
        RosParamException: no number.
    """
    text = loader.construct_scalar(node).strip()
    try:
        return float(_angles.degrees(text))
    except ValueError:
        raise RosParamException(f"invalid degree value: {text}") from None


@cache
def _loader() -> Any:
    loader = type("ParameterLoader", (yaml.SafeLoader,), {})
    loader.add_constructor(_BINARY, construct_yaml_binary)  # type: ignore[attr-defined]
    for tag, start, construct in (
        ("!degrees", "deg(", construct_angle_degrees),
        ("!radians", "rad(", construct_angle_radians),
    ):
        loader.add_constructor(tag, construct)  # type: ignore[attr-defined]
        pattern = re.compile(rf"^{re.escape(start)}[^\)]*\)$")
        loader.add_implicit_resolver(tag, pattern, [start[0]])  # type: ignore[attr-defined]
    return loader


@cache
def _dumper() -> Any:
    dumper = type("ParameterDumper", (yaml.Dumper,), {})
    dumper.add_representer(Binary, represent_xml_binary)  # type: ignore[attr-defined]
    return dumper


def documents(text: str) -> list[Any]:
    """Return the documents of a YAML text."""
    return list(yaml.load_all(text, Loader=_loader()))


def text_of(value: Any) -> str:
    """Return a value in YAML."""
    return str(yaml.dump(value, Dumper=_dumper()))
