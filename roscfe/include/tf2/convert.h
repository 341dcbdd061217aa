// Data with a frame, in general: who has a type of his own specialises these for it.
#ifndef TF2_CONVERT_H
#define TF2_CONVERT_H

#include <geometry_msgs/TransformStamped.h>

#include <type_traits>

#include "roscfe/wire.h"
#include "tf2/exceptions.h"
#include "tf2/transform_datatypes.h"

namespace tf2
{

// Data as seen from another frame; its time, and its frame.
template <class T>
void doTransform(const T &data_in, T &data_out, const geometry_msgs::TransformStamped &transform);
template <class T>
const ros::Time &getTimestamp(const T &t);
template <class T>
const roscfe::frames::FrameText &getFrameId(const T &t);

template <class P>
const ros::Time &getTimestamp(const Stamped<P> &t)
{
    return t.stamp_;
}
template <class P>
const roscfe::frames::FrameText &getFrameId(const Stamped<P> &t)
{
    return t.frame_id_;
}

// Between messages and other types.
template <typename A, typename B>
B toMsg(const A &a);
template <typename A, typename B>
void fromMsg(const A &a, B &b);

// From any type to any other, by way of a message where neither is one.
template <class A, class B>
void convert(const A &a, B &b)
{
    constexpr bool from_message = roscfe::wire::HasFields<A>::value, to_message = roscfe::wire::HasFields<B>::value;
    if constexpr (from_message && to_message)
    {
        static_assert(!from_message, "two types of messages");
    }
    else if constexpr (from_message)
    {
        fromMsg(a, b);
    }
    else if constexpr (to_message)
    {
        b = toMsg(a);
    }
    else
    {
        fromMsg(toMsg(a), b);
    }
}

template <class A>
void convert(const A &a1, A &a2)
{
    if (&a1 != &a2)
    {
        a2 = a1;
    }
}

} // namespace tf2

#endif
