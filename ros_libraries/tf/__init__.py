"""tf: the older interface to transforms, on top of tf2_ros; rotations and matrices; the LinearMath classes of C++.

`tf.transformations` needs NumPy and, like `tf.linear_math`, is loaded when it is first used.
"""

from __future__ import annotations

import importlib
from typing import Any

from tf2_ros import ConnectivityException, ExtrapolationException, LookupException
from tf2_ros import TransformException as Exception

from tf._transformer import Transformer
from tf.broadcaster import TransformBroadcaster
from tf.listener import TransformerROS, TransformListener

__all__ = [
    "ConnectivityException",
    "Exception",
    "ExtrapolationException",
    "LookupException",
    "TransformBroadcaster",
    "TransformListener",
    "Transformer",
    "TransformerROS",
]

_LINEAR_MATH = ("Matrix3x3", "QuadWord", "Quaternion", "StampedTransform", "Transform", "Vector3")


def __getattr__(name: str) -> Any:
    if name in ("transformations", "linear_math"):
        return importlib.import_module(f"tf.{name}")
    if name in _LINEAR_MATH:
        return getattr(importlib.import_module("tf.linear_math"), name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
