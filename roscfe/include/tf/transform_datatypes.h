// tf's types with a time and a frame, and conversions between them and messages.
#ifndef TF_TRANSFORM_DATATYPES_H
#define TF_TRANSFORM_DATATYPES_H

#include <geometry_msgs/PointStamped.h>
#include <geometry_msgs/PoseStamped.h>
#include <geometry_msgs/QuaternionStamped.h>
#include <geometry_msgs/TransformStamped.h>
#include <geometry_msgs/Vector3Stamped.h>

#include <cmath>
#include <string>

#include "ros/console.h"
#include "ros/time.h"
#include "roscfe/frames/messages.h"
#include "tf/LinearMath/Transform.h"

namespace tf
{

typedef Vector3              Point;
typedef Transform            Pose;
typedef roscfe::frames::Name FrameName; // what std::string is here in ROS; nothing is copied

inline constexpr double QUATERNION_TOLERANCE = 0.1f;

template <typename T>
class Stamped : public T
{
  public:
    ros::Time                 stamp_;
    roscfe::frames::FrameText frame_id_;

    Stamped() : frame_id_("NO_ID_STAMPED_DEFAULT_CONSTRUCTION") {}
    Stamped(const T &input, const ros::Time &timestamp, const FrameName &frame_id)
        : T(input), stamp_(timestamp), frame_id_(frame_id.view())
    {
    }

    void setData(const T &input) { *static_cast<T *>(this) = input; }
};

template <typename T>
bool operator==(const Stamped<T> &a, const Stamped<T> &b)
{
    return a.frame_id_ == b.frame_id_ && a.stamp_ == b.stamp_ && static_cast<const T &>(a) == static_cast<const T &>(b);
}

// A transform from a frame to its parent, at a time.
class StampedTransform : public Transform
{
  public:
    ros::Time                 stamp_;
    roscfe::frames::FrameText frame_id_;       // the parent
    roscfe::frames::FrameText child_frame_id_; // the frame

    StampedTransform() = default;
    StampedTransform(const Transform &input, const ros::Time &timestamp, const FrameName &frame_id,
                     const FrameName &child_frame_id)
        : Transform(input), stamp_(timestamp), frame_id_(frame_id.view()), child_frame_id_(child_frame_id.view())
    {
    }

    void setData(const Transform &input) { *static_cast<Transform *>(this) = input; }
};

inline bool operator==(const StampedTransform &a, const StampedTransform &b)
{
    return a.frame_id_ == b.frame_id_ && a.child_frame_id_ == b.child_frame_id_ && a.stamp_ == b.stamp_ &&
           static_cast<const Transform &>(a) == static_cast<const Transform &>(b);
}

// -- rotations ---------------------------------------------------------------------------------------------------------

inline void quaternionMsgToTF(const geometry_msgs::Quaternion &msg, Quaternion &bt)
{
    bt = Quaternion(msg.x, msg.y, msg.z, msg.w);
    if (std::fabs(bt.length2() - 1) > QUATERNION_TOLERANCE)
    {
        ROS_WARN("MSG to TF: Quaternion Not Properly Normalized");
        bt.normalize();
    }
}

inline void quaternionTFToMsg(const Quaternion &bt, geometry_msgs::Quaternion &msg)
{
    Quaternion q = bt;
    if (std::fabs(bt.length2() - 1) > QUATERNION_TOLERANCE)
    {
        ROS_WARN("TF to MSG: Quaternion Not Properly Normalized");
        q.normalize();
    }
    msg.x = q.x();
    msg.y = q.y();
    msg.z = q.z();
    msg.w = q.w();
}

// Angles are in rad.
inline double getYaw(const Quaternion &bt_q)
{
    tfScalar roll, pitch, yaw;
    Matrix3x3(bt_q).getRPY(roll, pitch, yaw);
    return yaw;
}

inline double getYaw(const geometry_msgs::Quaternion &msg_q)
{
    Quaternion q;
    quaternionMsgToTF(msg_q, q);
    return getYaw(q);
}

inline Quaternion createQuaternionFromRPY(double roll, double pitch, double yaw)
{
    Quaternion q;
    q.setRPY(roll, pitch, yaw);
    return q;
}

inline Quaternion createQuaternionFromYaw(double yaw)
{
    return createQuaternionFromRPY(0.0, 0.0, yaw);
}

inline Quaternion createIdentityQuaternion()
{
    return createQuaternionFromRPY(0.0, 0.0, 0.0);
}

inline geometry_msgs::Quaternion createQuaternionMsgFromRollPitchYaw(double roll, double pitch, double yaw)
{
    geometry_msgs::Quaternion msg;
    quaternionTFToMsg(createQuaternionFromRPY(roll, pitch, yaw), msg);
    return msg;
}

inline geometry_msgs::Quaternion createQuaternionMsgFromYaw(double yaw)
{
    return createQuaternionMsgFromRollPitchYaw(0.0, 0.0, yaw);
}

// -- messages, and back ------------------------------------------------------------------------------------------------

inline void vector3MsgToTF(const geometry_msgs::Vector3 &msg_v, Vector3 &bt_v)
{
    bt_v = Vector3(msg_v.x, msg_v.y, msg_v.z);
}

inline void vector3TFToMsg(const Vector3 &bt_v, geometry_msgs::Vector3 &msg_v)
{
    msg_v.x = bt_v.x();
    msg_v.y = bt_v.y();
    msg_v.z = bt_v.z();
}

inline void pointMsgToTF(const geometry_msgs::Point &msg_v, Point &bt_v)
{
    bt_v = Point(msg_v.x, msg_v.y, msg_v.z);
}

inline void pointTFToMsg(const Point &bt_v, geometry_msgs::Point &msg_v)
{
    msg_v.x = bt_v.x();
    msg_v.y = bt_v.y();
    msg_v.z = bt_v.z();
}

inline void transformMsgToTF(const geometry_msgs::Transform &msg, Transform &bt)
{
    bt = Transform(Quaternion(msg.rotation.x, msg.rotation.y, msg.rotation.z, msg.rotation.w),
                   Vector3(msg.translation.x, msg.translation.y, msg.translation.z));
}

inline void transformTFToMsg(const Transform &bt, geometry_msgs::Transform &msg)
{
    vector3TFToMsg(bt.getOrigin(), msg.translation);
    quaternionTFToMsg(bt.getRotation(), msg.rotation);
}

inline void poseMsgToTF(const geometry_msgs::Pose &msg, Pose &bt)
{
    bt = Transform(Quaternion(msg.orientation.x, msg.orientation.y, msg.orientation.z, msg.orientation.w),
                   Vector3(msg.position.x, msg.position.y, msg.position.z));
}

inline void poseTFToMsg(const Pose &bt, geometry_msgs::Pose &msg)
{
    pointTFToMsg(bt.getOrigin(), msg.position);
    quaternionTFToMsg(bt.getRotation(), msg.orientation);
}

// -- messages with a time and a frame, and back ------------------------------------------------------------------------

namespace detail
{

template <class Message, class T>
void unstamp(const Message &msg, T &bt)
{
    bt.stamp_    = msg.header.stamp;
    bt.frame_id_ = msg.header.frame_id;
}

template <class T, class Message>
void stamp(const T &bt, Message &msg)
{
    msg.header.stamp    = bt.stamp_;
    msg.header.frame_id = bt.frame_id_;
}

} // namespace detail

inline void quaternionStampedMsgToTF(const geometry_msgs::QuaternionStamped &msg, Stamped<Quaternion> &bt)
{
    quaternionMsgToTF(msg.quaternion, bt);
    detail::unstamp(msg, bt);
}

inline void quaternionStampedTFToMsg(const Stamped<Quaternion> &bt, geometry_msgs::QuaternionStamped &msg)
{
    quaternionTFToMsg(bt, msg.quaternion);
    detail::stamp(bt, msg);
}

inline void vector3StampedMsgToTF(const geometry_msgs::Vector3Stamped &msg, Stamped<Vector3> &bt)
{
    vector3MsgToTF(msg.vector, bt);
    detail::unstamp(msg, bt);
}

inline void vector3StampedTFToMsg(const Stamped<Vector3> &bt, geometry_msgs::Vector3Stamped &msg)
{
    vector3TFToMsg(bt, msg.vector);
    detail::stamp(bt, msg);
}

inline void pointStampedMsgToTF(const geometry_msgs::PointStamped &msg, Stamped<Point> &bt)
{
    pointMsgToTF(msg.point, bt);
    detail::unstamp(msg, bt);
}

inline void pointStampedTFToMsg(const Stamped<Point> &bt, geometry_msgs::PointStamped &msg)
{
    pointTFToMsg(bt, msg.point);
    detail::stamp(bt, msg);
}

inline void poseStampedMsgToTF(const geometry_msgs::PoseStamped &msg, Stamped<Pose> &bt)
{
    poseMsgToTF(msg.pose, bt);
    detail::unstamp(msg, bt);
}

inline void poseStampedTFToMsg(const Stamped<Pose> &bt, geometry_msgs::PoseStamped &msg)
{
    poseTFToMsg(bt, msg.pose);
    detail::stamp(bt, msg);
}

inline void transformStampedMsgToTF(const geometry_msgs::TransformStamped &msg, StampedTransform &bt)
{
    transformMsgToTF(msg.transform, bt);
    detail::unstamp(msg, bt);
    bt.child_frame_id_ = msg.child_frame_id;
}

inline void transformStampedTFToMsg(const StampedTransform &bt, geometry_msgs::TransformStamped &msg)
{
    transformTFToMsg(bt, msg.transform);
    detail::stamp(bt, msg);
    msg.child_frame_id = bt.child_frame_id_;
}

} // namespace tf

#endif
