"""Meaning of the encodings of sensor_msgs/Image: depth, number of channels, and whether they are colours."""

from __future__ import annotations

import re
from typing import NamedTuple

_DEPTHS = {
    "8U": "uint8",
    "8S": "int8",
    "16U": "uint16",
    "16S": "int16",
    "32S": "int32",
    "32F": "float32",
    "64F": "float64",
}
"""NumPy's dtype by OpenCV's depth, in the order of OpenCV's numbers."""

_GENERIC = re.compile(r"(8U|8S|16U|16S|32S|32F|64F)C([1-9]\d*)?")
_CHANNELS = {"mono": 1, "rgb": 3, "bgr": 3, "rgba": 4, "bgra": 4}
_COLOR = re.compile(r"(mono|rgba?|bgra?)(8|16)")
_BAYER = re.compile(r"bayer_(rggb|bggr|gbrg|grbg)(8|16)")


class Encoding(NamedTuple):
    """One encoding."""

    name: str
    depth: str
    """OpenCV's, e.g. "8U"."""
    channels: int
    order: str | None
    """"mono", "rgb", "bgra", ...; "bayer_..." or "yuv422"; None if it is numbers and no colour."""

    @property
    def dtype(self) -> str:
        """NumPy's name of a number in it."""
        return _DEPTHS[self.depth]

    @property
    def cv_type(self) -> int:
        """OpenCV's number for depth and channels."""
        return list(_DEPTHS).index(self.depth) + (self.channels - 1) * 8


def parse(name: str) -> Encoding:
    """Return the meaning of an encoding.

    Raises:
        ValueError: the encoding is unknown.
    """
    if match := _COLOR.fullmatch(name):
        return Encoding(name, f"{match[2]}U", _CHANNELS[match[1]], match[1])
    if match := _BAYER.fullmatch(name):
        return Encoding(name, f"{match[2]}U", 1, f"bayer_{match[1]}")
    if name in ("yuv422", "yuv422_yuy2"):
        return Encoding(name, "8U", 2, name)
    if match := _GENERIC.fullmatch(name):
        return Encoding(name, match[1], int(match[2] or 1), None)
    raise ValueError(f"Unrecognized image encoding [{name}]")


def name_of(dtype: str, channels: int) -> str:
    """Return the encoding of plain numbers, e.g. "8UC3".

    Raises:
        KeyError: OpenCV has no such numbers.
    """
    depth = {value: key for key, value in _DEPTHS.items()}[dtype]
    return f"{depth}C{channels}"


def name_of_number(cv_type: int) -> str:
    """Return the encoding of plain numbers by OpenCV's number for it."""
    return f"{list(_DEPTHS)[cv_type % 8]}C{cv_type // 8 + 1}"


def getCvType(encoding: str) -> int:
    """OpenCV's number for an encoding.

    Raises:
        RuntimeError: there is no such encoding.
    """
    try:
        return parse(encoding).cv_type
    except ValueError as error:
        raise RuntimeError(str(error)) from None
