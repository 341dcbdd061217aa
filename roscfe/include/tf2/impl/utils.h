// Rotations of any type as quaternions, and their angles; tf2/utils.h has the calls for nodes.
#ifndef TF2_IMPL_UTILS_H
#define TF2_IMPL_UTILS_H

#include <tf2_geometry_msgs/tf2_geometry_msgs.h>

#include <cmath>

#include "tf2/LinearMath/Quaternion.h"
#include "tf2/LinearMath/Transform.h"

namespace tf2
{
namespace impl
{

inline Quaternion toQuaternion(const Quaternion &q)
{
    return q;
}

inline Quaternion toQuaternion(const geometry_msgs::Quaternion &q)
{
    Quaternion made;
    fromMsg(q, made);
    return made;
}

inline Quaternion toQuaternion(const geometry_msgs::QuaternionStamped &q)
{
    return toQuaternion(q.quaternion);
}

template <typename T>
Quaternion toQuaternion(const Stamped<T> &t)
{
    const geometry_msgs::QuaternionStamped q = toMsg(t);
    return toQuaternion(q);
}

template <typename T>
Quaternion toQuaternion(const T &t)
{
    const geometry_msgs::Quaternion q = toMsg(t);
    return toQuaternion(q);
}

// Angles in rad about Z, Y and X; where the pitch is a right angle, the roll is 0.
inline void getEulerYPR(const Quaternion &q, double &yaw, double &pitch, double &roll)
{
    const double xx = q.x() * q.x(), yy = q.y() * q.y(), zz = q.z() * q.z(), ww = q.w() * q.w();
    const double sine = -2 * (q.x() * q.z() - q.w() * q.y()) / (xx + yy + zz + ww);
    if (std::fabs(sine) >= 0.99999)
    {
        const double sign = sine < 0 ? -1 : 1;
        pitch             = sign * 0.5 * M_PI;
        roll              = 0;
        yaw               = sign * 2 * std::atan2(q.y(), q.x());
        return;
    }
    pitch = std::asin(sine);
    roll  = std::atan2(2 * (q.y() * q.z() + q.w() * q.x()), ww - xx - yy + zz);
    yaw   = std::atan2(2 * (q.x() * q.y() + q.w() * q.z()), ww + xx - yy - zz);
}

inline double getYaw(const Quaternion &q)
{
    double yaw, pitch, roll;
    getEulerYPR(q, yaw, pitch, roll);
    return yaw;
}

} // namespace impl
} // namespace tf2

#endif
