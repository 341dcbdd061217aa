"""cv_bridge's extension module: conversions of colours, and the numbers of OpenCV's types."""

from __future__ import annotations

from cv_bridge._color import cvtColor2, cvtColorForDisplay
from cv_bridge._encodings import getCvType

__all__ = ["cvtColor2", "cvtColorForDisplay", "getCvType"]
