"""The program of `roundtrip.h` with genpy in place of C++. A Python that has real ROS's genpy runs it.

    python3 genpy_frames.py TYPE TEXT < frames > answers

TYPE is the message's full name, TEXT a file with its definition and the definitions of all types in it.
"""

from __future__ import annotations

import importlib
import io
import struct
import sys
from pathlib import Path

generate_dynamic = importlib.import_module("genpy.dynamic").generate_dynamic


def main(name: str, text: str) -> None:
    cls = generate_dynamic(name, Path(text).read_text(encoding="utf-8"))[name]
    given = sys.stdin.buffer
    while head := given.read(4):
        frame = given.read(*struct.unpack("<I", head))
        again = io.BytesIO()
        cls().deserialize(frame).serialize(again)
        octets = again.getvalue()
        sys.stdout.buffer.write(struct.pack("<BII", 1, 0, len(octets)) + octets)


main(*sys.argv[1:])
