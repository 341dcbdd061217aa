"""Source text that reads and writes NumPy arrays."""

from __future__ import annotations

from .generate_struct import serialize

_NAMES = ("float32", "float64", "int8", "int16", "int32", "int64", "uint8", "uint16", "uint32", "uint64")

NUMPY_DTYPE = {name: f"numpy.{name}" for name in _NAMES} | {
    "bool": "numpy.bool_",
    "char": "numpy.uint8",
    "byte": "numpy.int8",
}


def unpack_numpy(var: str, count: object, dtype: str, buff: str) -> str:
    """Source that reads an array of `count` numbers."""
    return f"{var} = numpy.frombuffer({buff}, dtype={dtype}, count={count})"


def pack_numpy(var: str) -> str:
    """Source that writes an array."""
    return serialize(f"{var}.tostring()")
