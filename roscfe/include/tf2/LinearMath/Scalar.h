// The numbers of tf2's LinearMath: a double under a name of its own, and functions of it under their own names.
// The guards of these headers have the names that they have in ROS: some nodes ask for them.
#ifndef TF2_SCALAR_H
#define TF2_SCALAR_H

#include <cmath>
#include <cstdint>
#include <cstring>

#include "roscfe/linear_math/scalar.h"

typedef roscfe::linear_math::Scalar tf2Scalar;

inline constexpr tf2Scalar TF2_LARGE_FLOAT = 1e30;
inline constexpr tf2Scalar TF2SIMD_2_PI = roscfe::linear_math::kTwoPi;
inline constexpr tf2Scalar TF2SIMD_PI = roscfe::linear_math::kPi;
inline constexpr tf2Scalar TF2SIMD_HALF_PI = roscfe::linear_math::kHalfPi;
inline constexpr tf2Scalar TF2SIMD_RADS_PER_DEG = roscfe::linear_math::kRadiansPerDegree;
inline constexpr tf2Scalar TF2SIMD_DEGS_PER_RAD = roscfe::linear_math::kDegreesPerRadian;
inline constexpr tf2Scalar TF2SIMDSQRT12 = roscfe::linear_math::kSqrtOfHalf;
inline constexpr tf2Scalar TF2SIMD_EPSILON = roscfe::linear_math::kEpsilon;
inline constexpr tf2Scalar TF2SIMD_INFINITY = DBL_MAX;

inline tf2Scalar tf2Sqrt(tf2Scalar x) { return std::sqrt(x); }
inline tf2Scalar tf2RecipSqrt(tf2Scalar x) { return 1.0 / std::sqrt(x); }
inline tf2Scalar tf2Fabs(tf2Scalar x) { return std::fabs(x); }
inline tf2Scalar tf2Cos(tf2Scalar x) { return std::cos(x); }
inline tf2Scalar tf2Sin(tf2Scalar x) { return std::sin(x); }
inline tf2Scalar tf2Tan(tf2Scalar x) { return std::tan(x); }
inline tf2Scalar tf2Acos(tf2Scalar x) { return roscfe::linear_math::arc_cosine(x); }
inline tf2Scalar tf2Asin(tf2Scalar x) { return roscfe::linear_math::arc_sine(x); }
inline tf2Scalar tf2Atan(tf2Scalar x) { return std::atan(x); }
inline tf2Scalar tf2Atan2(tf2Scalar y, tf2Scalar x) { return std::atan2(y, x); }
inline tf2Scalar tf2Atan2Fast(tf2Scalar y, tf2Scalar x) { return roscfe::linear_math::rough_arc_tangent(y, x); }
inline tf2Scalar tf2Exp(tf2Scalar x) { return std::exp(x); }
inline tf2Scalar tf2Log(tf2Scalar x) { return std::log(x); }
inline tf2Scalar tf2Pow(tf2Scalar x, tf2Scalar y) { return std::pow(x, y); }
inline tf2Scalar tf2Fmod(tf2Scalar x, tf2Scalar y) { return std::fmod(x, y); }
inline tf2Scalar tf2Radians(tf2Scalar degrees) { return degrees * TF2SIMD_RADS_PER_DEG; }
inline tf2Scalar tf2Degrees(tf2Scalar radians) { return radians * TF2SIMD_DEGS_PER_RAD; }
inline tf2Scalar tf2NormalizeAngle(tf2Scalar radians) { return roscfe::linear_math::normalize_angle(radians); }

inline bool tf2FuzzyZero(tf2Scalar x) { return std::fabs(x) < TF2SIMD_EPSILON; }
inline bool tf2Equal(tf2Scalar a, tf2Scalar eps) { return a <= eps && !(a < -eps); }
inline bool tf2GreaterEqual(tf2Scalar a, tf2Scalar eps) { return !(a <= eps); }
inline int  tf2IsNegative(tf2Scalar x) { return x < 0.0 ? 1 : 0; }

inline tf2Scalar tf2Fsel(tf2Scalar a, tf2Scalar b, tf2Scalar c) { return a >= 0 ? b : c; }
inline tf2Scalar tf2Fsels(tf2Scalar a, tf2Scalar b, tf2Scalar c) { return tf2Fsel(a, b, c); }
inline unsigned tf2Select(unsigned condition, unsigned if_not_zero, unsigned if_zero)
{
    return condition ? if_not_zero : if_zero;
}
inline int tf2Select(unsigned condition, int if_not_zero, int if_zero) { return condition ? if_not_zero : if_zero; }
inline float tf2Select(unsigned condition, float if_not_zero, float if_zero)
{
    return condition ? if_not_zero : if_zero;
}

template <class T>
void tf2Swap(T &a, T &b)
{
    T kept = a;
    a = b;
    b = kept;
}

inline bool tf2MachineIsLittleEndian() { return roscfe::linear_math::is_little_endian(); }
inline unsigned tf2SwapEndian(unsigned x) { return roscfe::linear_math::swapped<unsigned>(x); }
inline unsigned tf2SwapEndian(int x) { return roscfe::linear_math::swapped<unsigned>(x); }
inline unsigned short tf2SwapEndian(unsigned short x) { return roscfe::linear_math::swapped<unsigned short>(x); }
inline unsigned short tf2SwapEndian(short x) { return roscfe::linear_math::swapped<unsigned short>(x); }
inline unsigned int tf2SwapEndianFloat(float x) { return roscfe::linear_math::swapped<unsigned int>(x); }
inline float tf2UnswapEndianFloat(unsigned int x) { return roscfe::linear_math::swapped<float>(x); }
inline void tf2SwapEndianDouble(double x, unsigned char *to)
{
    const std::uint64_t bits = roscfe::linear_math::swapped<std::uint64_t>(x);
    std::memcpy(to, &bits, sizeof bits);
}
inline double tf2UnswapEndianDouble(const unsigned char *from)
{
    std::uint64_t bits;
    std::memcpy(&bits, from, sizeof bits);
    return roscfe::linear_math::swapped<double>(bits);
}

#endif
