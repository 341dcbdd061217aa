// Messages of geometry_msgs between frames, and between messages and tf2's own types.
#ifndef TF2_GEOMETRY_MSGS_H
#define TF2_GEOMETRY_MSGS_H

#include <geometry_msgs/PointStamped.h>
#include <geometry_msgs/PoseStamped.h>
#include <geometry_msgs/PoseWithCovarianceStamped.h>
#include <geometry_msgs/QuaternionStamped.h>
#include <geometry_msgs/TransformStamped.h>
#include <geometry_msgs/Vector3Stamped.h>
#include <geometry_msgs/WrenchStamped.h>

#include <array>
#include <cstddef>
#include <initializer_list>

#include "tf2/LinearMath/Quaternion.h"
#include "tf2/LinearMath/Transform.h"
#include "tf2/convert.h"

namespace tf2
{

// -- parts: Vector3, Point, Quaternion ---------------------------------------------------------------------------------

inline geometry_msgs::Vector3 toMsg(const Vector3 &in)
{
    geometry_msgs::Vector3 out;
    out.x = in.x();
    out.y = in.y();
    out.z = in.z();
    return out;
}

inline void fromMsg(const geometry_msgs::Vector3 &in, Vector3 &out)
{
    out = Vector3(in.x, in.y, in.z);
}

inline geometry_msgs::Point &toMsg(const Vector3 &in, geometry_msgs::Point &out)
{
    out.x = in.x();
    out.y = in.y();
    out.z = in.z();
    return out;
}

inline void fromMsg(const geometry_msgs::Point &in, Vector3 &out)
{
    out = Vector3(in.x, in.y, in.z);
}

inline geometry_msgs::Quaternion toMsg(const Quaternion &in)
{
    geometry_msgs::Quaternion out;
    out.x = in.x();
    out.y = in.y();
    out.z = in.z();
    out.w = in.w();
    return out;
}

inline void fromMsg(const geometry_msgs::Quaternion &in, Quaternion &out)
{
    out = Quaternion(in.x, in.y, in.z, in.w);
}

// -- transforms and poses ----------------------------------------------------------------------------------------------

inline geometry_msgs::Transform toMsg(const Transform &in)
{
    geometry_msgs::Transform out;
    out.translation = toMsg(in.getOrigin());
    out.rotation    = toMsg(in.getRotation());
    return out;
}

inline void fromMsg(const geometry_msgs::Transform &in, Transform &out)
{
    out = Transform(Quaternion(in.rotation.x, in.rotation.y, in.rotation.z, in.rotation.w),
                    Vector3(in.translation.x, in.translation.y, in.translation.z));
}

inline geometry_msgs::Pose &toMsg(const Transform &in, geometry_msgs::Pose &out)
{
    toMsg(in.getOrigin(), out.position);
    out.orientation = toMsg(in.getRotation());
    return out;
}

inline void fromMsg(const geometry_msgs::Pose &in, Transform &out)
{
    out = Transform(Quaternion(in.orientation.x, in.orientation.y, in.orientation.z, in.orientation.w),
                    Vector3(in.position.x, in.position.y, in.position.z));
}

// -- messages with a header: their time and frame, and the messages themselves -----------------------------------------

#define ROSCFE_STAMPED_(Type)                                                                                          \
    template <>                                                                                                        \
    inline const ros::Time &getTimestamp(const geometry_msgs::Type &t)                                                 \
    {                                                                                                                  \
        return t.header.stamp;                                                                                         \
    }                                                                                                                  \
    template <>                                                                                                        \
    inline const roscfe::frames::FrameText &getFrameId(const geometry_msgs::Type &t)                                   \
    {                                                                                                                  \
        return t.header.frame_id;                                                                                      \
    }                                                                                                                  \
    inline geometry_msgs::Type toMsg(const geometry_msgs::Type &in)                                                    \
    {                                                                                                                  \
        return in;                                                                                                     \
    }                                                                                                                  \
    inline void fromMsg(const geometry_msgs::Type &msg, geometry_msgs::Type &out)                                      \
    {                                                                                                                  \
        out = msg;                                                                                                     \
    }
ROSCFE_STAMPED_(Vector3Stamped)
ROSCFE_STAMPED_(PointStamped)
ROSCFE_STAMPED_(QuaternionStamped)
ROSCFE_STAMPED_(PoseStamped)
ROSCFE_STAMPED_(PoseWithCovarianceStamped)
ROSCFE_STAMPED_(TransformStamped)
ROSCFE_STAMPED_(WrenchStamped)
#undef ROSCFE_STAMPED_

// -- stamped types -----------------------------------------------------------------------------------------------------

namespace detail
{

template <class T, class Message>
void stamp(const Stamped<T> &in, Message &out)
{
    out.header.stamp    = in.stamp_;
    out.header.frame_id = in.frame_id_;
}

template <class Message, class T>
void unstamp(const Message &in, Stamped<T> &out)
{
    out.stamp_    = in.header.stamp;
    out.frame_id_ = in.header.frame_id;
}

// What is transformed is where the transform leads to, and as old as that.
template <class Message>
void restamp(Message &out, const geometry_msgs::TransformStamped &transform)
{
    out.header.stamp    = transform.header.stamp;
    out.header.frame_id = transform.header.frame_id;
}

} // namespace detail

inline geometry_msgs::Vector3Stamped toMsg(const Stamped<Vector3> &in)
{
    geometry_msgs::Vector3Stamped out;
    detail::stamp(in, out);
    out.vector = toMsg(static_cast<const Vector3 &>(in));
    return out;
}

inline void fromMsg(const geometry_msgs::Vector3Stamped &in, Stamped<Vector3> &out)
{
    detail::unstamp(in, out);
    fromMsg(in.vector, static_cast<Vector3 &>(out));
}

inline geometry_msgs::PointStamped toMsg(const Stamped<Vector3> &in, geometry_msgs::PointStamped &out)
{
    detail::stamp(in, out);
    toMsg(static_cast<const Vector3 &>(in), out.point);
    return out;
}

inline void fromMsg(const geometry_msgs::PointStamped &in, Stamped<Vector3> &out)
{
    detail::unstamp(in, out);
    fromMsg(in.point, static_cast<Vector3 &>(out));
}

inline geometry_msgs::QuaternionStamped toMsg(const Stamped<Quaternion> &in)
{
    geometry_msgs::QuaternionStamped out;
    detail::stamp(in, out);
    out.quaternion = toMsg(static_cast<const Quaternion &>(in));
    return out;
}

inline void fromMsg(const geometry_msgs::QuaternionStamped &in, Stamped<Quaternion> &out)
{
    detail::unstamp(in, out);
    fromMsg(in.quaternion, static_cast<Quaternion &>(out));
}

inline geometry_msgs::PoseStamped toMsg(const Stamped<Transform> &in, geometry_msgs::PoseStamped &out)
{
    detail::stamp(in, out);
    toMsg(static_cast<const Transform &>(in), out.pose);
    return out;
}

inline void fromMsg(const geometry_msgs::PoseStamped &in, Stamped<Transform> &out)
{
    detail::unstamp(in, out);
    fromMsg(in.pose, static_cast<Transform &>(out));
}

inline geometry_msgs::PoseWithCovarianceStamped toMsg(const Stamped<Transform> &                in,
                                                      geometry_msgs::PoseWithCovarianceStamped &out)
{
    detail::stamp(in, out);
    toMsg(static_cast<const Transform &>(in), out.pose.pose);
    return out;
}

inline void fromMsg(const geometry_msgs::PoseWithCovarianceStamped &in, Stamped<Transform> &out)
{
    detail::unstamp(in, out);
    fromMsg(in.pose.pose, static_cast<Transform &>(out));
}

inline geometry_msgs::TransformStamped toMsg(const Stamped<Transform> &in)
{
    geometry_msgs::TransformStamped out;
    detail::stamp(in, out);
    out.transform = toMsg(static_cast<const Transform &>(in));
    return out;
}

inline void fromMsg(const geometry_msgs::TransformStamped &in, Stamped<Transform> &out)
{
    detail::unstamp(in, out);
    fromMsg(in.transform, static_cast<Transform &>(out));
}

// A wrench is a force and a torque.
inline geometry_msgs::WrenchStamped toMsg(const Stamped<std::array<Vector3, 2>> &in, geometry_msgs::WrenchStamped &out)
{
    detail::stamp(in, out);
    out.wrench.force  = toMsg(in[0]);
    out.wrench.torque = toMsg(in[1]);
    return out;
}

inline void fromMsg(const geometry_msgs::WrenchStamped &in, Stamped<std::array<Vector3, 2>> &out)
{
    detail::unstamp(in, out);
    fromMsg(in.wrench.force, out[0]);
    fromMsg(in.wrench.torque, out[1]);
}

// -- as seen from another frame ----------------------------------------------------------------------------------------

template <>
inline void doTransform(const geometry_msgs::Point &t_in, geometry_msgs::Point &t_out,
                        const geometry_msgs::TransformStamped &transform)
{
    Transform t;
    fromMsg(transform.transform, t);
    toMsg(t * Vector3(t_in.x, t_in.y, t_in.z), t_out);
}

template <>
inline void doTransform(const geometry_msgs::Vector3 &t_in, geometry_msgs::Vector3 &t_out,
                        const geometry_msgs::TransformStamped &transform)
{
    Transform t;
    fromMsg(transform.transform, t);
    t_out = toMsg(t.getBasis() * Vector3(t_in.x, t_in.y, t_in.z)); // a direction is turned, not moved
}

template <>
inline void doTransform(const geometry_msgs::Quaternion &t_in, geometry_msgs::Quaternion &t_out,
                        const geometry_msgs::TransformStamped &transform)
{
    Quaternion t, q;
    fromMsg(transform.transform.rotation, t);
    fromMsg(t_in, q);
    t_out = toMsg(t * q);
}

template <>
inline void doTransform(const geometry_msgs::Pose &t_in, geometry_msgs::Pose &t_out,
                        const geometry_msgs::TransformStamped &transform)
{
    Transform t, pose;
    fromMsg(transform.transform, t);
    fromMsg(t_in, pose);
    toMsg(t * pose, t_out);
}

template <>
inline void doTransform(const geometry_msgs::Wrench &t_in, geometry_msgs::Wrench &t_out,
                        const geometry_msgs::TransformStamped &transform)
{
    doTransform(t_in.force, t_out.force, transform);
    doTransform(t_in.torque, t_out.torque, transform);
}

#define ROSCFE_TRANSFORM_(Type, field)                                                                                 \
    template <>                                                                                                        \
    inline void doTransform(const geometry_msgs::Type &t_in, geometry_msgs::Type &t_out,                               \
                            const geometry_msgs::TransformStamped &transform)                                          \
    {                                                                                                                  \
        doTransform(t_in.field, t_out.field, transform);                                                               \
        detail::restamp(t_out, transform);                                                                             \
    }
ROSCFE_TRANSFORM_(PointStamped, point)
ROSCFE_TRANSFORM_(Vector3Stamped, vector)
ROSCFE_TRANSFORM_(QuaternionStamped, quaternion)
ROSCFE_TRANSFORM_(PoseStamped, pose)
ROSCFE_TRANSFORM_(WrenchStamped, wrench)
#undef ROSCFE_TRANSFORM_

template <>
inline void doTransform(const geometry_msgs::TransformStamped &t_in, geometry_msgs::TransformStamped &t_out,
                        const geometry_msgs::TransformStamped &transform)
{
    Transform input, t;
    fromMsg(t_in.transform, input);
    fromMsg(transform.transform, t);
    t_out.transform = toMsg(t * input);
    detail::restamp(t_out, transform);
}

// The covariance of a pose, turned: each of its four 3x3 blocks is.
inline geometry_msgs::PoseWithCovariance::_covariance_type
transformCovariance(const geometry_msgs::PoseWithCovariance::_covariance_type &cov_in, const Transform &transform)
{
    geometry_msgs::PoseWithCovariance::_covariance_type cov_out;
    const Matrix3x3                                     turn = transform.getBasis(), back = turn.transpose();
    for (std::size_t corner : {0u, 3u, 18u, 21u})
    {
        Matrix3x3 block;
        for (int row = 0; row < 3; ++row)
        {
            for (int column = 0; column < 3; ++column)
            {
                block[row][column] = cov_in[corner + static_cast<std::size_t>(6 * row + column)];
            }
        }
        block = turn * block * back;
        for (int row = 0; row < 3; ++row)
        {
            for (int column = 0; column < 3; ++column)
            {
                cov_out[corner + static_cast<std::size_t>(6 * row + column)] = block[row][column];
            }
        }
    }
    return cov_out;
}

template <>
inline void doTransform(const geometry_msgs::PoseWithCovarianceStamped &t_in,
                        geometry_msgs::PoseWithCovarianceStamped &t_out, const geometry_msgs::TransformStamped &transform)
{
    Transform t, pose;
    fromMsg(transform.transform, t);
    fromMsg(t_in.pose.pose, pose);
    toMsg(t * pose, t_out.pose.pose);
    t_out.pose.covariance = transformCovariance(t_in.pose.covariance, t);
    detail::restamp(t_out, transform);
}

} // namespace tf2

#endif
