// Data with a time and a frame.
#ifndef TF2_TRANSFORM_DATATYPES_H
#define TF2_TRANSFORM_DATATYPES_H

#include <string>

#include "ros/time.h"
#include "roscfe/frames/messages.h"

namespace tf2
{

template <typename T>
class Stamped : public T
{
  public:
    ros::Time                 stamp_;
    roscfe::frames::FrameText frame_id_;

    Stamped() : frame_id_("NO_ID_STAMPED_DEFAULT_CONSTRUCTION") {}
    Stamped(const T &input, const ros::Time &timestamp, const roscfe::frames::Name &frame_id)
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

} // namespace tf2

#endif
