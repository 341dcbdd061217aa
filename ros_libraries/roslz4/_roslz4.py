"""roslz4's extension module, which ROS's own `roslz4` imports as `._roslz4`."""

from __future__ import annotations

from rosbag_storage.lz4_frames import LZ4Compressor, LZ4Decompressor

__all__ = ["LZ4Compressor", "LZ4Decompressor"]
