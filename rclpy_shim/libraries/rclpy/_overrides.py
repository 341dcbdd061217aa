"""Values of parameters that a command line gives to a node, directly or in files (`-p`, `--params-file`)."""

from __future__ import annotations

import fnmatch
from collections.abc import Iterator
from typing import Any

from rclpy._names import Arguments
from rclpy.parameter import python_value

_PARAMETERS = "ros__parameters"


def overrides_of(arguments: Arguments, full_name: str) -> dict[str, Any]:
    """Return the values for a node by the parameters' names. Later ones win, and `-p` wins over files.

    Args:
        arguments: the command line.
        full_name: full name of the node.

    Raises:
        RuntimeError: a file cannot be read, or has the wrong form.
    """
    found: dict[str, Any] = {}
    for path in arguments.files:
        for pattern, values in _of_file(path):
            if _matches(pattern, full_name):
                found |= dict(_flat(values, ""))
    for node, name, text in arguments.parameters:
        if not node or _matches(node if node.startswith("/") else f"/{node}", full_name):
            found[name] = python_value(text)
    return found


def _of_file(path: str) -> Iterator[tuple[str, dict[str, Any]]]:
    """Yield name patterns of nodes, and their parameters."""
    import yaml

    try:
        with open(path, encoding="utf-8") as file:
            tree = yaml.safe_load(file)
    except (OSError, yaml.YAMLError) as error:
        raise RuntimeError(f"Couldn't parse params file: '--params-file {path}'. Error: {error}") from None
    if not isinstance(tree, dict):
        raise RuntimeError(f"Couldn't parse params file: '--params-file {path}'. Error: it has no nodes")
    yield from _nodes(path, tree, "")


def _nodes(path: str, tree: dict[str, Any], namespace: str) -> Iterator[tuple[str, dict[str, Any]]]:
    for key, value in tree.items():
        if not isinstance(value, dict):
            text = f"a parameter must be below {_PARAMETERS}, unlike {key}"
            raise RuntimeError(f"Couldn't parse params file: '--params-file {path}'. Error: {text}")
        name = f"{namespace}/{str(key).lstrip('/')}"
        if _PARAMETERS in value:
            yield name, value[_PARAMETERS] or {}
        yield from _nodes(path, {part: each for part, each in value.items() if part != _PARAMETERS}, name)


def _matches(pattern: str, full_name: str) -> bool:
    """Return True if a name matches a pattern, in which `*` stands for one part and `/**` for any number of them."""
    wanted, parts = pattern.strip("/").split("/"), full_name.strip("/").split("/")
    return _match(wanted, parts)


def _match(wanted: list[str], parts: list[str]) -> bool:
    if not wanted:
        return not parts
    if wanted[0] == "**":
        return any(_match(wanted[1:], parts[at:]) for at in range(len(parts) + 1))
    return bool(parts) and fnmatch.fnmatchcase(parts[0], wanted[0]) and _match(wanted[1:], parts[1:])


def _flat(values: dict[str, Any], prefix: str) -> Iterator[tuple[str, Any]]:
    for name, value in values.items():
        if isinstance(value, dict):
            yield from _flat(value, f"{prefix}{name}.")
        else:
            yield f"{prefix}{name}", value
