"""Scalar.h: the functions and constants of tfScalar, which is a double. Imports the standard library only."""

from __future__ import annotations

import math
import struct
import sys

TF_LARGE_FLOAT = 1e30
TFSIMD_2_PI = 6.283185307179586232
TFSIMD_PI = TFSIMD_2_PI * 0.5
TFSIMD_HALF_PI = TFSIMD_2_PI * 0.25
TFSIMD_RADS_PER_DEG = TFSIMD_2_PI / 360.0
TFSIMD_DEGS_PER_RAD = 360.0 / TFSIMD_2_PI
TFSIMDSQRT12 = 0.7071067811865475244008443621048490
TFSIMD_EPSILON = sys.float_info.epsilon
TFSIMD_INFINITY = sys.float_info.max

tfSqrt = math.sqrt
tfFabs = math.fabs
tfCos = math.cos
tfSin = math.sin
tfTan = math.tan
tfAtan = math.atan
tfAtan2 = math.atan2
tfExp = math.exp
tfLog = math.log
tfPow = math.pow
tfFmod = math.fmod


def tfAcos(x: float) -> float:
    """Return the arc cosine. The argument is clamped to -1 and 1."""
    return math.acos(min(max(x, -1.0), 1.0))


def tfAsin(x: float) -> float:
    """Return the arc sine. The argument is clamped to -1 and 1."""
    return math.asin(min(max(x, -1.0), 1.0))


def tfRecipSqrt(x: float) -> float:
    """1 / sqrt(x)."""
    return 1.0 / math.sqrt(x)


def tfAtan2Fast(y: float, x: float) -> float:
    """Return a rough arc tangent of y / x, good to 0.08 rad."""
    quarter = TFSIMD_PI / 4.0
    size = math.fabs(y)
    if x >= 0.0:
        found = quarter - quarter * ((x - size) / (x + size))
    else:
        found = 3.0 * quarter - quarter * ((x + size) / (size - x))
    return -found if y < 0.0 else found


def tfFuzzyZero(x: float) -> bool:
    """Return whether a value is within an epsilon of 0."""
    return math.fabs(x) < TFSIMD_EPSILON


def tfEqual(a: float, eps: float) -> bool:
    """Return whether a value is within `eps` of 0."""
    return a <= eps and not a < -eps


def tfGreaterEqual(a: float, eps: float) -> bool:
    """Return whether a value is above `eps`."""
    return not a <= eps


def tfIsNegative(x: float) -> int:
    """1 for a value below 0, otherwise 0."""
    return 1 if x < 0.0 else 0


def tfRadians(x: float) -> float:
    """Convert degrees to radians."""
    return x * TFSIMD_RADS_PER_DEG


def tfDegrees(x: float) -> float:
    """Convert radians to degrees."""
    return x * TFSIMD_DEGS_PER_RAD


def tfFsel(a: float, b: float, c: float) -> float:
    """`b` if `a` is not negative, otherwise `c`."""
    return b if a >= 0 else c


tfFsels = tfFsel


def tfSelect(condition: int, valueIfConditionNonZero: float, valueIfConditionZero: float) -> float:
    """One of two values."""
    return valueIfConditionNonZero if condition else valueIfConditionZero


def tfMachineIsLittleEndian() -> bool:
    """Return whether the host stores the low byte first."""
    return sys.byteorder == "little"


def tfSwapEndian(val: int) -> int:
    """Return an unsigned 32-bit number with its bytes reversed."""
    return int.from_bytes((val & 0xFFFFFFFF).to_bytes(4, "little"), "big")


def tfSwapEndianFloat(d: float) -> int:
    """Return the reversed bytes of a single as an unsigned number."""
    return int.from_bytes(struct.pack("<f", d), "big")


def tfUnswapEndianFloat(a: int) -> float:
    """Return the single precision number whose reversed bytes are an unsigned number."""
    found: float = struct.unpack("<f", a.to_bytes(4, "big"))[0]
    return found


def tfSwapEndianDouble(d: float) -> bytes:
    """Return the reversed bytes of a double."""
    return struct.pack("<d", d)[::-1]


def tfUnswapEndianDouble(src: bytes) -> float:
    """Return the double of reversed bytes."""
    found: float = struct.unpack("<d", src[::-1])[0]
    return found


def tfNormalizeAngle(angleInRadians: float) -> float:
    """Return an angle in rad, between -pi and pi."""
    angle = math.fmod(angleInRadians, TFSIMD_2_PI)
    if angle < -TFSIMD_PI:
        return angle + TFSIMD_2_PI
    return angle - TFSIMD_2_PI if angle > TFSIMD_PI else angle
