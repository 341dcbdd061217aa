// Angles of anything that is a rotation.
#ifndef TF2_UTILS_H
#define TF2_UTILS_H

#include "tf2/LinearMath/Quaternion.h"
#include "tf2/LinearMath/Transform.h"
#include "tf2/impl/utils.h"

namespace tf2
{
template <class A>
void getEulerYPR(const A &a, double &yaw, double &pitch, double &roll)
{
    impl::getEulerYPR(impl::toQuaternion(a), yaw, pitch, roll);
}

template <class A>
double getYaw(const A &a)
{
    return impl::getYaw(impl::toQuaternion(a));
}

template <class A>
A getTransformIdentity()
{
    A made;
    convert(Transform::getIdentity(), made);
    return made;
}

} // namespace tf2

#endif
