// Limits in place; the names without a prefix are ROS's, too, and global there.
#ifndef ROSCFE_LINEAR_MATH_MIN_MAX_H
#define ROSCFE_LINEAR_MATH_MIN_MAX_H

namespace roscfe
{
namespace linear_math
{

template <class T>
void set_min(T &a, const T &b)
{
    if (b < a)
        a = b;
}

template <class T>
void set_max(T &a, const T &b)
{
    if (a < b)
        a = b;
}

} // namespace linear_math
} // namespace roscfe

template <class T>
const T &GEN_clamped(const T &a, const T &lower, const T &upper)
{
    return a < lower ? lower : upper < a ? upper : a;
}

template <class T>
void GEN_clamp(T &a, const T &lower, const T &upper)
{
    a = GEN_clamped(a, lower, upper);
}

#endif
