"""`resolve_args`: $(find ...), $(env ...) and similar substitutions in texts (roslaunch.substitution_args)."""

from __future__ import annotations

from typing import Any

from roslaunch import _processes  # type: ignore[attr-defined]  # made for the node, by the mission


class SubstitutionException(Exception):
    """A substitution that cannot be made."""


class ArgException(SubstitutionException):
    """$(arg x) of an argument that has no value."""


def resolve_args(
    arg_str: str | None, context: dict[str, Any] | None = None, resolve_anon: bool = True, filename: str | None = None
) -> str | None:
    """Return a text with its substitutions made.

    Args:
        arg_str: the text.
        context: values of arguments under "arg"; names that $(anon) made are kept under "anon".
        resolve_anon: accepted.
        filename: the launch file, for $(dirname).

    Raises:
        SubstitutionException: a substitution is not possible.
    """
    if not arg_str:
        return arg_str
    context = {} if context is None else context
    try:
        return str(_processes.resolve(arg_str, context.setdefault("arg", {}), context.setdefault("anon", {}), filename))
    except KeyError as error:
        raise ArgException(*error.args) from error
    except ValueError as error:
        raise SubstitutionException(str(error)) from error
