"""cv_bridge: images as arrays, with NumPy alone, and the errors where OpenCV is needed."""

from __future__ import annotations

import sys
from types import ModuleType
from typing import Any

import numpy as np
import pytest

from tests.ros_libraries.world import universe

RED, GRAY = [255, 0, 0], [10, 10, 10]
PICTURE = np.array([[RED, GRAY, [0, 255, 0]], [[0, 0, 255], [255, 255, 255], [0, 0, 0]]], dtype=np.uint8)


@pytest.fixture
def package() -> Any:
    return universe().importer.load("cv_bridge")


@pytest.fixture
def bridge(package: Any) -> Any:
    return package.CvBridge()


@pytest.mark.parametrize("dtype", ["uint8", "int8", "uint16", "int16", "int32", "float32", "float64"])
@pytest.mark.parametrize("shape", [(2, 3), (2, 3, 2), (2, 3, 4)])
def test_image_survives_conversion_and_back(bridge: Any, dtype: str, shape: tuple[int, ...]) -> None:
    array = np.arange(np.prod(shape)).reshape(shape).astype(dtype)
    message = bridge.cv2_to_imgmsg(array)
    assert (message.height, message.width, message.step) == (2, 3, array.strides[0])
    back = bridge.imgmsg_to_cv2(message)
    assert back.dtype == dtype
    assert (back == array).all()


def test_encodings_and_header(bridge: Any) -> None:
    message = bridge.cv2_to_imgmsg(PICTURE, "rgb8", header="header")
    assert (message.encoding, message.header, message.data[:3]) == ("rgb8", "header", b"\xff\0\0")
    assert bridge.cv2_to_imgmsg(PICTURE).encoding == "8UC3"
    assert bridge.encoding_to_dtype_with_channels("bgra16") == ("uint16", 4)
    assert bridge.cvtype2_to_dtype_with_channels("32FC2") == ("float32", 2)
    assert bridge.encoding_to_cvtype2("bayer_rggb8") == bridge.encoding_to_cvtype2("8UC1") == 0


def test_rows_may_be_padded_and_bytes_swapped(bridge: Any) -> None:
    message = bridge.cv2_to_imgmsg(np.array([[1, 2]], dtype=np.uint16), "mono16")
    message.data, message.step, message.is_bigendian = bytes([0, 1, 0, 2, 9, 9]), 6, 1
    assert bridge.imgmsg_to_cv2(message).tolist() == [[1, 2]]
    message.data = list(message.data)
    assert bridge.imgmsg_to_cv2(message).tolist() == [[1, 2]]


def test_colors(bridge: Any, package: Any) -> None:
    message = bridge.cv2_to_imgmsg(PICTURE, "rgb8")
    assert (bridge.imgmsg_to_cv2(message, "bgr8") == PICTURE[..., ::-1]).all()
    assert bridge.imgmsg_to_cv2(message, "mono8").tolist() == [[76, 10, 150], [29, 255, 0]]
    with_alpha = bridge.imgmsg_to_cv2(message, "bgra8")
    assert (with_alpha[..., 3] == 255).all()
    assert (package.boost.cv_bridge_boost.cvtColor2(with_alpha, "bgra8", "rgb8") == PICTURE).all()
    gray = np.array([[0, 7]], dtype=np.uint8)
    convert = package.boost.cv_bridge_boost.cvtColor2
    assert convert(gray, "mono8", "rgb8").tolist() == [[[0, 0, 0], [7, 7, 7]]]
    assert convert(gray, "mono8", "mono16").tolist() == [[0, 7 * 257]]
    assert convert(np.array([[65535, 300]], np.uint16), "mono16", "mono8").tolist() == [[255, 1]]
    assert convert(gray, "mono8", "8UC1").tolist() == [[0, 7]]


def test_for_display(package: Any) -> None:
    depth = np.array([[0.0, 1.0], [np.nan, 3.0]], dtype=np.float32)
    shown = package.cvtColorForDisplay(depth, "32FC1", "", do_dynamic_scaling=True)
    assert shown[..., 0].tolist() == [[0, 85], [0, 255]]
    assert package.cvtColorForDisplay(depth, "32FC1", "mono8", max_image_value=2.0).tolist() == [[0, 128], [0, 255]]
    assert package.cvtColorForDisplay(PICTURE, "rgb8", "")[0, 0].tolist() == [0, 0, 255]


@pytest.mark.parametrize(
    ("source", "target", "problem"),
    [
        ("8UC3", "bgr8", r"\[8UC3\] is not a color format\. but \[bgr8\] is\. The conversion does not make sense"),
        ("8UC3", "8UC1", r"\[8UC3\] and \[8UC1\] do not have the same number of channel"),
        ("rgb8", "8UC1", r"\[rgb8\] is a color format but \[8UC1\] is not"),
        ("rgb8", "bayer_rggb8", r"Unsupported conversion from \[rgb8\] to \[bayer_rggb8\]"),
        ("rgb8", "pink", r"Unrecognized image encoding \[pink\]"),
    ],
)
def test_invalid_conversions_are_refused(bridge: Any, package: Any, source: str, target: str, problem: str) -> None:
    message = bridge.cv2_to_imgmsg(PICTURE)
    message.encoding = source
    with pytest.raises(package.CvBridgeError, match=problem):
        bridge.imgmsg_to_cv2(message, target)


def test_arrays_of_another_type_are_refused(bridge: Any, package: Any) -> None:
    with pytest.raises(package.CvBridgeError, match="specified as mono8, but image has incompatible type 8UC3"):
        bridge.cv2_to_imgmsg(PICTURE, "mono8")
    with pytest.raises(TypeError, match="not a numpy array"):
        bridge.cv2_to_imgmsg([[1]])


def test_without_opencv(bridge: Any, package: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "cv2", None)
    message = bridge.cv2_to_imgmsg(PICTURE[..., 0], "bayer_rggb8")
    with pytest.raises(package.CvBridgeError, match=r"\[bayer_rggb8\] to \[bgr8\] needs OpenCV"):
        bridge.imgmsg_to_cv2(message, "bgr8")
    with pytest.raises(package.CvBridgeError, match="compressed images need OpenCV"):
        bridge.cv2_to_compressed_imgmsg(PICTURE)


def test_with_opencv() -> None:
    """This tests the calls of OpenCV, with a small stand-in that leaves images unchanged."""
    cv2: Any = ModuleType("cv2")
    cv2.IMREAD_UNCHANGED, cv2.COLOR_BAYER_BG2BGR, cv2.COLOR_YUV2GRAY_UYVY = -1, 46, 123
    cv2.imencode = lambda ending, array: (ending == ".png", np.frombuffer(array.tobytes(), np.uint8))
    cv2.imdecode = lambda data, flags: data.reshape(2, 3, 3)
    cv2.cvtColor = lambda img, code: np.stack([img] * 3, axis=-1) if code == 46 else img[..., 1]
    world = universe()
    world.importer.modules["cv2"] = cv2
    package = world.importer.load("cv_bridge")
    bridge = package.CvBridge()
    packed = bridge.cv2_to_compressed_imgmsg(PICTURE, "png")
    assert packed.format == "png"
    assert (bridge.compressed_imgmsg_to_cv2(packed) == PICTURE).all()
    assert (bridge.compressed_imgmsg_to_cv2(packed, "rgb8") == PICTURE[..., ::-1]).all()
    assert package.boost.cv_bridge_boost.cvtColor2(PICTURE[..., 0], "bayer_rggb8", "rgba8").shape == (2, 3, 4)
    assert (package.boost.cv_bridge_boost.cvtColor2(PICTURE[..., :2], "yuv422", "mono8") == PICTURE[..., 1]).all()
