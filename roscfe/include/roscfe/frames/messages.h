// Transforms between messages and the numbers that a buffer holds.
#ifndef ROSCFE_FRAMES_MESSAGES_H
#define ROSCFE_FRAMES_MESSAGES_H

#include <geometry_msgs/Transform.h>
#include <std_msgs/Header.h>

#include "ros/time.h"
#include "roscfe/frames/buffer.h"

namespace roscfe
{
namespace frames
{

// Text for the name of a frame: std::string, or in the strict profile what messages have.
typedef std_msgs::Header::_frame_id_type FrameText;

inline Rigid rigid_of(const geometry_msgs::Transform &t)
{
    return {t.translation.x, t.translation.y, t.translation.z, t.rotation.x,
            t.rotation.y,    t.rotation.z,    t.rotation.w};
}

inline void put(const Rigid &from, geometry_msgs::Transform &to)
{
    to.translation.x = from.x;
    to.translation.y = from.y;
    to.translation.z = from.z;
    to.rotation.x    = from.qx;
    to.rotation.y    = from.qy;
    to.rotation.z    = from.qz;
    to.rotation.w    = from.qw;
}

inline std::int64_t ns_of(const ros::Time &time) { return static_cast<std::int64_t>(time.toNSec()); }
inline ros::Time    time_of(std::int64_t ns)
{
    return ros::Time(static_cast<std::uint32_t>(ns / 1000000000), static_cast<std::uint32_t>(ns % 1000000000));
}

} // namespace frames
} // namespace roscfe

#endif
