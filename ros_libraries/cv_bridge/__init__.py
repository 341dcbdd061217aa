"""cv_bridge for nodes: sensor_msgs/Image and CompressedImage as NumPy arrays, the image type of OpenCV's Python.

Names, arguments and texts of errors match ROS's cv_bridge 1.16; the code is cfepy's own. Images keep their
encoding, or change between the common ones, with NumPy alone. Other conversions need OpenCV
(`pip install opencv-python`).
"""

from __future__ import annotations

from .boost.cv_bridge_boost import cvtColorForDisplay, getCvType
from .core import CvBridge, CvBridgeError

__all__ = ["CvBridge", "CvBridgeError", "cvtColorForDisplay", "getCvType"]
