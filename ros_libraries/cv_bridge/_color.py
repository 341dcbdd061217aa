"""Conversion between encodings. Errors are RuntimeErrors, as C++ reports them to Python."""

from __future__ import annotations

import importlib
from typing import Any

import numpy as np

from ._encodings import Encoding, parse

_GRAY = np.array([4899, 9617, 1868], dtype=np.int64)  # OpenCV's weights of red, green and blue, in 2**14ths
_HINT = "conversion from [{}] to [{}] needs OpenCV: pip install opencv-python"


def opencv(what: str) -> Any:
    """Return the module cv2.

    Raises:
        RuntimeError: it is not installed; the text begins with its purpose.
    """
    try:
        return importlib.import_module("cv2")
    except ImportError:
        raise RuntimeError(what) from None


def cvtColor2(img: Any, encoding_in: str, encoding_out: str) -> Any:
    """Return an image in another encoding.

    Args:
        img: rows x columns, or rows x columns x channels.
        encoding_in: its encoding.
        encoding_out: the one that is wanted.

    Raises:
        RuntimeError: the conversion makes no sense, or needs OpenCV.
    """
    try:
        source, target = parse(encoding_in), parse(encoding_out)
    except ValueError as error:
        raise RuntimeError(str(error)) from None
    if source.name == target.name:
        return img.copy()
    _check(source, target)
    if source.order is not None and target.order is not None:
        img = _recolored(img, source, target)
        return _scaled(img, source, target)
    return img.astype(target.dtype)


def cvtColorForDisplay(
    img: Any,
    encoding_in: str,
    encoding_out: str,
    do_dynamic_scaling: bool = False,
    min_image_value: float = 0.0,
    max_image_value: float = 0.0,
) -> Any:
    """Return an image for display as bgr8, or in another encoding of 8 bits.

    Args:
        img: the image.
        encoding_in: its encoding.
        encoding_out: "" for bgr8.
        do_dynamic_scaling: spread numbers of one channel from their minimum to their maximum.
        min_image_value: the number that becomes black; with both limits 0, 0 and 1 for floats, the type's for integers.
        max_image_value: the number that becomes white.

    Raises:
        RuntimeError: as `cvtColor2`.
    """
    wanted = encoding_out or "bgr8"
    source = parse(encoding_in)
    if source.order is not None:
        return cvtColor2(img, encoding_in, wanted)
    if source.channels != 1:
        return cvtColor2(img, encoding_in, f"8UC{source.channels}")
    low, high = min_image_value, max_image_value
    if do_dynamic_scaling:
        low, high = float(np.nanmin(img)), float(np.nanmax(img))
    elif low == high:
        info = None if source.dtype.startswith("float") else np.iinfo(source.dtype)
        low, high = (0.0, 1.0) if info is None else (float(info.min), float(info.max))
    spread = (np.nan_to_num(img.astype(np.float64)) - low) * (255.0 / (high - low) if high > low else 0.0)
    return cvtColor2(np.clip(np.rint(spread), 0, 255).astype(np.uint8), "mono8", wanted)


def _check(source: Encoding, target: Encoding) -> None:
    """Refuse a conversion between numbers and colours. Numbers become colours only under another encoding name."""
    same = source.channels == target.channels
    one, other = f"[{source.name}]", f"[{target.name}]"
    if source.order is None and target.order is not None:
        raise RuntimeError(f"{one} is not a color format. but {other} is. The conversion does not make sense")
    if source.order is None and not same:
        raise RuntimeError(f"{one} and {other} do not have the same number of channel")
    if target.order is None and not same:
        raise RuntimeError(
            f"{one} is a color format but {other} is not so they must have the same OpenCV type, CV_8UC3, CV16UC1 ...."
        )
    if target.order is not None and target.order.startswith(("bayer", "yuv")):
        raise RuntimeError(f"Unsupported conversion from {one} to {other}")


def _recolored(img: Any, source: Encoding, target: Encoding) -> Any:
    assert source.order is not None
    assert target.order is not None
    if source.order == target.order:
        return img
    if source.order.startswith(("bayer", "yuv")):
        return _by_opencv(img, source, target)
    if target.order == "mono":
        colors = img[..., [source.order.index(color) for color in "rgb"]].astype(np.int64)
        return ((colors @ _GRAY + (1 << 13)) >> 14).astype(source.dtype)
    full = np.iinfo(source.dtype).max
    if source.order == "mono":
        channels = dict.fromkeys("rgb", img)
    else:
        channels = {color: img[..., at] for at, color in enumerate(source.order)}
    opaque = channels.get("a", np.full(img.shape[:2], full, dtype=source.dtype))
    return np.stack([channels[color] if color in "rgb" else opaque for color in target.order], axis=-1)


def _by_opencv(img: Any, source: Encoding, target: Encoding) -> Any:
    cv2 = opencv(_HINT.format(source.name, target.name))
    wanted = "GRAY" if target.order == "mono" else "BGR"
    if source.order and source.order.startswith("bayer"):
        # OpenCV names the pattern by the second pixel of the second row.
        pattern = {"rggb": "BG", "bggr": "RG", "gbrg": "GR", "grbg": "GB"}[source.order.removeprefix("bayer_")]
        made = cv2.cvtColor(img, getattr(cv2, f"COLOR_BAYER_{pattern}2{wanted}"))
    else:
        layout = "YUY2" if source.order == "yuv422_yuy2" else "UYVY"
        made = cv2.cvtColor(img, getattr(cv2, f"COLOR_YUV2{wanted}_{layout}"))
    plain = parse("mono8" if wanted == "GRAY" else "bgr8")._replace(depth=source.depth)
    return _recolored(made, plain, target)


def _scaled(img: Any, source: Encoding, target: Encoding) -> Any:
    """White stays white when the depth changes."""
    if source.depth == target.depth:
        return np.ascontiguousarray(img)
    factor = float(np.iinfo(target.dtype).max) / float(np.iinfo(source.dtype).max)
    return np.rint(img * factor).astype(target.dtype)
