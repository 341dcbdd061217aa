// tf2_ros::BufferInterface: data of any type as seen from another frame.
#ifndef TF2_ROS_BUFFER_INTERFACE_H
#define TF2_ROS_BUFFER_INTERFACE_H

#include <geometry_msgs/TransformStamped.h>

#include <string>

#include "tf2/buffer_core.h"
#include "tf2/convert.h"
#include "tf2/exceptions.h"
#include "tf2/transform_datatypes.h"

namespace tf2_ros
{

using tf2::FrameName;

class BufferInterface
{
  public:
    virtual ~BufferInterface() = default;

    virtual geometry_msgs::TransformStamped lookupTransform(const FrameName &target_frame,
                                                            const FrameName &source_frame, const ros::Time &time,
                                                            const ros::Duration timeout) const = 0;
    virtual geometry_msgs::TransformStamped lookupTransform(const FrameName &target_frame,
                                                            const ros::Time &target_time,
                                                            const FrameName &source_frame,
                                                            const ros::Time &source_time, const FrameName &fixed_frame,
                                                            const ros::Duration timeout) const = 0;
    virtual bool canTransform(const FrameName &target_frame, const FrameName &source_frame, const ros::Time &time,
                              const ros::Duration timeout, std::string *errstr = nullptr) const = 0;
    virtual bool canTransform(const FrameName &target_frame, const ros::Time &target_time,
                              const FrameName &source_frame, const ros::Time &source_time,
                              const FrameName &fixed_frame, const ros::Duration timeout,
                              std::string *errstr = nullptr) const = 0;

    template <class T>
    T &transform(const T &in, T &out, const FrameName &target_frame, ros::Duration timeout = ros::Duration()) const
    {
        tf2::doTransform(in, out,
                         lookupTransform(target_frame, tf2::getFrameId(in), tf2::getTimestamp(in), timeout));
        return out;
    }
    template <class T>
    T transform(const T &in, const FrameName &target_frame, ros::Duration timeout = ros::Duration()) const
    {
        T out;
        return transform(in, out, target_frame, timeout);
    }
    template <class A, class B>
    B &transform(const A &in, B &out, const FrameName &target_frame, ros::Duration timeout = ros::Duration()) const
    {
        const A copy = transform(in, target_frame, timeout);
        tf2::convert(copy, out);
        return out;
    }

    // The same at another time, by way of a frame that does not move in between.
    template <class T>
    T &transform(const T &in, T &out, const FrameName &target_frame, const ros::Time &target_time,
                 const FrameName &fixed_frame, ros::Duration timeout = ros::Duration()) const
    {
        tf2::doTransform(in, out,
                         lookupTransform(target_frame, target_time, tf2::getFrameId(in), tf2::getTimestamp(in),
                                         fixed_frame, timeout));
        return out;
    }
    template <class T>
    T transform(const T &in, const FrameName &target_frame, const ros::Time &target_time, const FrameName &fixed_frame,
                ros::Duration timeout = ros::Duration()) const
    {
        T out;
        return transform(in, out, target_frame, target_time, fixed_frame, timeout);
    }
    template <class A, class B>
    B &transform(const A &in, B &out, const FrameName &target_frame, const ros::Time &target_time,
                 const FrameName &fixed_frame, ros::Duration timeout = ros::Duration()) const
    {
        const A copy = transform(in, target_frame, target_time, fixed_frame, timeout);
        tf2::convert(copy, out);
        return out;
    }
};

} // namespace tf2_ros

#endif
