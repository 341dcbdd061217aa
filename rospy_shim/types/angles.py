"""ROS's angles in YAML: deg(90), rad(pi/2), !degrees 90, !radians pi (wiki.ros.org/rosparam)."""

from __future__ import annotations

import math

from rospy_shim.types.expression import value_of


def radians(text: str) -> float:
    """Return the value of `rad(EXPRESSION)`, or of the expression alone, in radians; it may contain `pi`.

    Raises:
        SyntaxError: it is not an expression.
        ExpressionError: it has a part that expressions in files cannot have.
        Exception: any error of Python's, such as NameError and ZeroDivisionError.
    """
    return float(value_of(_inside("rad(", text.strip()).strip(), {"pi": math.pi}))


def degrees(text: str) -> float:
    """Return the value of `deg(NUMBER)`, or of a number of degrees alone, in radians.

    Raises:
        ValueError: it is not a number.
    """
    return float(_inside("deg(", text.strip())) * math.pi / 180.0


def _inside(start: str, text: str) -> str:
    return text[len(start) : -1] if text.startswith(start) else text
