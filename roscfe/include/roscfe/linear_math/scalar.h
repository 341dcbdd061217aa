// What tf's and tf2's Scalar.h have in common: constants, and the functions that are more than a call of <cmath>.
#ifndef ROSCFE_LINEAR_MATH_SCALAR_H
#define ROSCFE_LINEAR_MATH_SCALAR_H

#include <cfloat>
#include <cmath>
#include <cstdint>
#include <cstring>

namespace roscfe
{
namespace linear_math
{

typedef double Scalar;

inline constexpr Scalar kTwoPi = 6.283185307179586232;
inline constexpr Scalar kPi = kTwoPi * 0.5;
inline constexpr Scalar kHalfPi = kTwoPi * 0.25;
inline constexpr Scalar kRadiansPerDegree = kTwoPi / 360.0;
inline constexpr Scalar kDegreesPerRadian = 360.0 / kTwoPi;
inline constexpr Scalar kSqrtOfHalf = 0.7071067811865475244008443621048490;
inline constexpr Scalar kEpsilon = DBL_EPSILON;

// A value beyond -1 or 1 counts as that: rounding takes a cosine there.
inline Scalar within_one(Scalar x)
{
    return x < -1.0 ? -1.0 : x > 1.0 ? 1.0 : x;
}

inline Scalar arc_cosine(Scalar x) { return std::acos(within_one(x)); }
inline Scalar arc_sine(Scalar x) { return std::asin(within_one(x)); }

// A rough arc tangent of y / x, good to 0.08 rad.
inline Scalar rough_arc_tangent(Scalar y, Scalar x)
{
    constexpr Scalar eighth = kPi / 4.0;
    const Scalar size = std::fabs(y);
    const Scalar found = x >= 0.0 ? eighth - eighth * ((x - size) / (x + size))
                                  : 3.0 * eighth - eighth * ((x + size) / (size - x));
    return y < 0.0 ? -found : found;
}

// An angle in rad, between -pi and pi.
inline Scalar normalize_angle(Scalar angle)
{
    const Scalar rest = std::fmod(angle, kTwoPi);
    if (rest < -kPi)
        return rest + kTwoPi;
    return rest > kPi ? rest - kTwoPi : rest;
}

// The bytes of a value, the last one first.
template <class To, class From>
To swapped(const From &from)
{
    static_assert(sizeof(To) == sizeof(From), "as many bytes");
    unsigned char bytes[sizeof(From)], reversed[sizeof(From)];
    std::memcpy(bytes, &from, sizeof(From));
    for (std::size_t at = 0; at < sizeof(From); ++at)
        reversed[at] = bytes[sizeof(From) - 1 - at];
    To made;
    std::memcpy(&made, reversed, sizeof(To));
    return made;
}

inline bool is_little_endian()
{
    const std::uint16_t one = 1;
    unsigned char first;
    std::memcpy(&first, &one, 1);
    return first == 1;
}

} // namespace linear_math
} // namespace roscfe

#endif
