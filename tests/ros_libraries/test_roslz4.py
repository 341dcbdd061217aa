"""roslz4 in a node: cfepy's own, and a user's copy of ROS's Python half without its compiled half."""

from __future__ import annotations

from pathlib import Path

from tests.rospy_shim.missions import run_nodes

ROUND_TRIP = """
import roslz4
data = bytes(range(256)) * 300
packed = roslz4.compress(data)
print(len(packed) < len(data), roslz4.decompress(packed) == data, roslz4.LZ4Compressor.__name__)
"""
PYTHON_HALF = """
from ._roslz4 import *

def compress(data):
    compressor = LZ4Compressor()
    return compressor.compress(data) + compressor.flush()

def decompress(data):
    return LZ4Decompressor().decompress(data)
"""


def test_shipped_roslz4_works(tmp_path: Path) -> None:
    assert run_nodes(tmp_path, {"N": ROUND_TRIP}).printed["N"] == ["True True LZ4Compressor"]


def test_python_half_of_a_user_imports_the_compiled_half(tmp_path: Path) -> None:
    (tmp_path / "roslz4").mkdir()
    (tmp_path / "roslz4" / "__init__.py").write_text(PYTHON_HALF, encoding="utf-8")
    lines = run_nodes(tmp_path, {"N": ROUND_TRIP + "print(roslz4.__file__)"}).printed["N"]
    assert lines == ["True True LZ4Compressor", str(tmp_path / "roslz4" / "__init__.py")]
