// What tells tf's classes of LinearMath from tf2's: the templates are the same, the types are not, as in ROS.
#ifndef ROSCFE_LINEAR_MATH_TAGS_H
#define ROSCFE_LINEAR_MATH_TAGS_H

// A tag is in the library's namespace, where C++ then looks for functions of its classes, too.
namespace tf
{

struct LinearMath
{
    static constexpr bool kLockedRollFromFirstRow = true; // see Matrix3x3::getEulerYPR
};

} // namespace tf

namespace tf2
{

struct LinearMath
{
    static constexpr bool kLockedRollFromFirstRow = false;
};

} // namespace tf2

#endif
