// Times in texts and ratios, as ROS's C++ code gives them: in seconds.
#ifndef ROSCFE_TF_MOMENTS_H
#define ROSCFE_TF_MOMENTS_H

#include <cstdint>

namespace roscfe
{
namespace frames
{

// The same number that ros::Time::toSec gives.
inline double seconds(std::int64_t ns)
{
    return static_cast<double>(ns / 1000000000) + 1e-9 * static_cast<double>(ns % 1000000000);
}

inline std::int64_t nanoseconds(std::uint32_t sec, std::uint32_t nsec)
{
    return static_cast<std::int64_t>(sec) * 1000000000 + nsec;
}

} // namespace frames
} // namespace roscfe

#endif
