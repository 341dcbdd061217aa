"""tf_conversions for nodes: poses of ROS, tf and NumPy as PyKDL frames and back.

Names and results match ROS's tf_conversions 1.13. As there, `tf_conversions.transformations` is tf's, and
PyKDL's names are also available here.
"""

from __future__ import annotations

from PyKDL import *  # noqa: F403
from tf import transformations

from .posemath import fromCameraParams, fromMatrix, fromMsg, fromTf, toMatrix, toMsg, toTf

__all__ = [
    "fromCameraParams",
    "fromMatrix",
    "fromMsg",
    "fromTf",
    "toMatrix",
    "toMsg",
    "toTf",
    "transformations",
]
