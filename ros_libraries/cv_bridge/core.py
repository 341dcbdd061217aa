"""`CvBridge`: image messages to arrays and back."""

from __future__ import annotations

import sys
from typing import Any

import numpy as np
from sensor_msgs.msg import CompressedImage, Image

from ._color import cvtColor2, opencv
from ._encodings import getCvType, name_of, name_of_number, parse

_NEEDED = "compressed images need OpenCV: pip install opencv-python"


class CvBridgeError(TypeError):  # ROS's name
    """An image that cannot be converted."""


class CvBridge:
    """Converts images."""

    def dtype_with_channels_to_cvtype2(self, dtype: Any, n_channels: int) -> str:
        """Return the encoding of an array, e.g. "8UC3"."""
        return name_of(np.dtype(dtype).name, n_channels)

    def cvtype2_to_dtype_with_channels(self, cvtype: Any) -> tuple[str, int]:
        """(dtype, channels) of an encoding or of OpenCV's number for one."""
        encoding = parse(cvtype) if isinstance(cvtype, str) else parse(name_of_number(cvtype))
        return encoding.dtype, encoding.channels

    def encoding_to_cvtype2(self, encoding: str) -> int:
        """OpenCV's number for an encoding.

        Raises:
            CvBridgeError: there is no such encoding.
        """
        try:
            return getCvType(encoding)
        except RuntimeError as error:
            raise CvBridgeError(error) from None

    def encoding_to_dtype_with_channels(self, encoding: str) -> tuple[str, int]:
        """(dtype, channels) of an encoding.

        Raises:
            CvBridgeError: there is no such encoding.
        """
        return self.cvtype2_to_dtype_with_channels(self.encoding_to_cvtype2(encoding))

    def imgmsg_to_cv2(self, img_msg: Any, desired_encoding: str = "passthrough") -> Any:
        """Return the array in a sensor_msgs/Image: rows x columns, or rows x columns x channels.

        Args:
            img_msg: the image.
            desired_encoding: encoding of the array; "passthrough" leaves it unchanged.

        Raises:
            CvBridgeError: the encoding is unknown, or the conversion makes no sense.
        """
        name, channels = self.encoding_to_dtype_with_channels(img_msg.encoding)
        dtype = np.dtype(name).newbyteorder(">" if img_msg.is_bigendian else "<")
        data = bytes(img_msg.data) if isinstance(img_msg.data, (list, tuple)) else img_msg.data
        columns = img_msg.step // (dtype.itemsize * channels)
        shape = (img_msg.height, columns) if channels == 1 else (img_msg.height, columns, channels)
        array = np.ndarray(shape=shape, dtype=dtype, buffer=data)
        array = np.ascontiguousarray(array[:, : img_msg.width]).astype(name)
        return array if desired_encoding == "passthrough" else _converted(array, img_msg.encoding, desired_encoding)

    def cv2_to_imgmsg(self, cvim: Any, encoding: str = "passthrough", header: Any = None) -> Any:
        """Return the sensor_msgs/Image of an array.

        Args:
            cvim: rows x columns, or rows x columns x channels.
            encoding: meaning of its numbers; "passthrough" only gives their type.
            header: a std_msgs/Header.

        Raises:
            TypeError: it is not an array.
            CvBridgeError: the array does not fit the encoding.
        """
        _check_array(cvim)
        found = self.dtype_with_channels_to_cvtype2(cvim.dtype, 1 if cvim.ndim < 3 else cvim.shape[2])
        if encoding != "passthrough" and self.encoding_to_cvtype2(encoding) != getCvType(found):
            raise CvBridgeError(f"encoding specified as {encoding}, but image has incompatible type {found}")
        big = cvim.dtype.byteorder == ">" or (cvim.dtype.byteorder == "=" and sys.byteorder == "big")
        msg = Image(height=cvim.shape[0], width=cvim.shape[1], is_bigendian=big, data=cvim.tobytes())
        msg.encoding = found if encoding == "passthrough" else encoding
        msg.step = len(msg.data) // msg.height
        if header is not None:
            msg.header = header
        return msg

    def compressed_imgmsg_to_cv2(self, cmprs_img_msg: Any, desired_encoding: str = "passthrough") -> Any:
        """Return the array in a sensor_msgs/CompressedImage. OpenCV decodes it, as bgr8 if it has colours.

        Raises:
            CvBridgeError: OpenCV is not installed, or the conversion makes no sense.
        """
        cv2 = _opencv()
        array = cv2.imdecode(np.frombuffer(cmprs_img_msg.data, dtype=np.uint8), cv2.IMREAD_UNCHANGED)
        if desired_encoding == "passthrough":
            return array
        channels = 1 if array.ndim < 3 else array.shape[2]
        order = {1: "mono", 3: "bgr", 4: "bgra"}[channels]
        return _converted(array, f"{order}{array.dtype.itemsize * 8}", desired_encoding)

    def cv2_to_compressed_imgmsg(self, cvim: Any, dst_format: str = "jpg") -> Any:
        """Return the sensor_msgs/CompressedImage of an array, encoded by OpenCV.

        Raises:
            TypeError: it is not an array.
            CvBridgeError: OpenCV is not installed.
        """
        _check_array(cvim)
        _, encoded = _opencv().imencode(f".{dst_format}", cvim)
        return CompressedImage(format=dst_format, data=encoded.tobytes())


def _converted(array: Any, source: str, target: str) -> Any:
    try:
        return cvtColor2(array, source, target)
    except RuntimeError as error:
        raise CvBridgeError(error) from None


def _opencv() -> Any:
    try:
        return opencv(_NEEDED)
    except RuntimeError as error:
        raise CvBridgeError(error) from None


def _check_array(cvim: Any) -> None:
    if not isinstance(cvim, (np.ndarray, np.generic)):
        raise TypeError("Your input type is not a numpy array")
