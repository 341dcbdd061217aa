"""roslz4 for nodes: LZ4 frames as ROS writes them. ROS's is an extension module; see `rosbag_storage.lz4_frames`."""

from __future__ import annotations

from rosbag_storage import lz4_frames as _lz4_frames
from rosbag_storage.lz4_frames import compress

from roslz4._roslz4 import LZ4Compressor, LZ4Decompressor

__all__ = ["LZ4Compressor", "LZ4Decompressor", "compress", "decompress"]


def decompress(data: bytes) -> bytes:
    """Return the data of a frame."""
    return _lz4_frames.decompress(data)
