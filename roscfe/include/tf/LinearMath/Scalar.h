// The numbers of tf's LinearMath: a double under a name of its own, and functions of it under their own names.
// The guards of these headers have the names that they have in ROS: some nodes ask for them.
#ifndef TF_SCALAR_H
#define TF_SCALAR_H

#include <cmath>
#include <cstdint>
#include <cstring>

#include "roscfe/linear_math/scalar.h"

typedef roscfe::linear_math::Scalar tfScalar;

inline constexpr tfScalar TF_LARGE_FLOAT = 1e30;
inline constexpr tfScalar TFSIMD_2_PI = roscfe::linear_math::kTwoPi;
inline constexpr tfScalar TFSIMD_PI = roscfe::linear_math::kPi;
inline constexpr tfScalar TFSIMD_HALF_PI = roscfe::linear_math::kHalfPi;
inline constexpr tfScalar TFSIMD_RADS_PER_DEG = roscfe::linear_math::kRadiansPerDegree;
inline constexpr tfScalar TFSIMD_DEGS_PER_RAD = roscfe::linear_math::kDegreesPerRadian;
inline constexpr tfScalar TFSIMDSQRT12 = roscfe::linear_math::kSqrtOfHalf;
inline constexpr tfScalar TFSIMD_EPSILON = roscfe::linear_math::kEpsilon;
inline constexpr tfScalar TFSIMD_INFINITY = DBL_MAX;

inline tfScalar tfSqrt(tfScalar x) { return std::sqrt(x); }
inline tfScalar tfRecipSqrt(tfScalar x) { return 1.0 / std::sqrt(x); }
inline tfScalar tfFabs(tfScalar x) { return std::fabs(x); }
inline tfScalar tfCos(tfScalar x) { return std::cos(x); }
inline tfScalar tfSin(tfScalar x) { return std::sin(x); }
inline tfScalar tfTan(tfScalar x) { return std::tan(x); }
inline tfScalar tfAcos(tfScalar x) { return roscfe::linear_math::arc_cosine(x); }
inline tfScalar tfAsin(tfScalar x) { return roscfe::linear_math::arc_sine(x); }
inline tfScalar tfAtan(tfScalar x) { return std::atan(x); }
inline tfScalar tfAtan2(tfScalar y, tfScalar x) { return std::atan2(y, x); }
inline tfScalar tfAtan2Fast(tfScalar y, tfScalar x) { return roscfe::linear_math::rough_arc_tangent(y, x); }
inline tfScalar tfExp(tfScalar x) { return std::exp(x); }
inline tfScalar tfLog(tfScalar x) { return std::log(x); }
inline tfScalar tfPow(tfScalar x, tfScalar y) { return std::pow(x, y); }
inline tfScalar tfFmod(tfScalar x, tfScalar y) { return std::fmod(x, y); }
inline tfScalar tfRadians(tfScalar degrees) { return degrees * TFSIMD_RADS_PER_DEG; }
inline tfScalar tfDegrees(tfScalar radians) { return radians * TFSIMD_DEGS_PER_RAD; }
inline tfScalar tfNormalizeAngle(tfScalar radians) { return roscfe::linear_math::normalize_angle(radians); }

inline bool tfFuzzyZero(tfScalar x) { return std::fabs(x) < TFSIMD_EPSILON; }
inline bool tfEqual(tfScalar a, tfScalar eps) { return a <= eps && !(a < -eps); }
inline bool tfGreaterEqual(tfScalar a, tfScalar eps) { return !(a <= eps); }
inline int  tfIsNegative(tfScalar x) { return x < 0.0 ? 1 : 0; }

inline tfScalar tfFsel(tfScalar a, tfScalar b, tfScalar c) { return a >= 0 ? b : c; }
inline tfScalar tfFsels(tfScalar a, tfScalar b, tfScalar c) { return tfFsel(a, b, c); }
inline unsigned tfSelect(unsigned condition, unsigned if_not_zero, unsigned if_zero)
{
    return condition ? if_not_zero : if_zero;
}
inline int tfSelect(unsigned condition, int if_not_zero, int if_zero) { return condition ? if_not_zero : if_zero; }
inline float tfSelect(unsigned condition, float if_not_zero, float if_zero)
{
    return condition ? if_not_zero : if_zero;
}

template <class T>
void tfSwap(T &a, T &b)
{
    T kept = a;
    a = b;
    b = kept;
}

inline bool tfMachineIsLittleEndian() { return roscfe::linear_math::is_little_endian(); }
inline unsigned tfSwapEndian(unsigned x) { return roscfe::linear_math::swapped<unsigned>(x); }
inline unsigned tfSwapEndian(int x) { return roscfe::linear_math::swapped<unsigned>(x); }
inline unsigned short tfSwapEndian(unsigned short x) { return roscfe::linear_math::swapped<unsigned short>(x); }
inline unsigned short tfSwapEndian(short x) { return roscfe::linear_math::swapped<unsigned short>(x); }
inline unsigned int tfSwapEndianFloat(float x) { return roscfe::linear_math::swapped<unsigned int>(x); }
inline float tfUnswapEndianFloat(unsigned int x) { return roscfe::linear_math::swapped<float>(x); }
inline void tfSwapEndianDouble(double x, unsigned char *to)
{
    const std::uint64_t bits = roscfe::linear_math::swapped<std::uint64_t>(x);
    std::memcpy(to, &bits, sizeof bits);
}
inline double tfUnswapEndianDouble(const unsigned char *from)
{
    std::uint64_t bits;
    std::memcpy(&bits, from, sizeof bits);
    return roscfe::linear_math::swapped<double>(bits);
}

#endif
