"""ROS's angles in YAML: deg(90), rad(pi/2), !degrees 90, !radians pi (wiki.ros.org/rosparam)."""

from __future__ import annotations

import math

from rospy_shim.types.expression import value_of


def radians(text: str) -> float:
    """The value of `rad(EXPRESSION)`, or of the expression alone, in radians; `pi` may be in it.

    Raises:
        SyntaxError: it is no expression.
        ExpressionError: it has something that expressions in files cannot have.
        Exception: whatever Python raises for it, such as NameError and ZeroDivisionError.
    """
    return float(value_of(_inside("rad(", text.strip()).strip(), {"pi": math.pi}))


def degrees(text: str) -> float:
    """The value of `deg(NUMBER)`, or of a number of degrees alone, in radians.

    Raises:
        ValueError: it is no number.
    """
    return float(_inside("deg(", text.strip())) * math.pi / 180.0


def _inside(start: str, text: str) -> str:
    return text[len(start) : -1] if text.startswith(start) else text
