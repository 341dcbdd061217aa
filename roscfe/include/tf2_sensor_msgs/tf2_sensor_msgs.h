// Clouds of points between frames, as messages.
#ifndef TF2_SENSOR_MSGS_H
#define TF2_SENSOR_MSGS_H

#include <geometry_msgs/TransformStamped.h>
#include <sensor_msgs/PointCloud2.h>

#include "sensor_msgs/point_cloud2_iterator.h"
#include "tf2/convert.h"

namespace tf2
{

template <>
inline const ros::Time &getTimestamp(const sensor_msgs::PointCloud2 &p)
{
    return p.header.stamp;
}
template <>
inline const roscfe::frames::FrameText &getFrameId(const sensor_msgs::PointCloud2 &p)
{
    return p.header.frame_id;
}

// Only x, y and z of the points change. They are floats, and so is all that is computed, as in ROS with Eigen.
inline void doTransform(const sensor_msgs::PointCloud2 &p_in, sensor_msgs::PointCloud2 &p_out,
                        const geometry_msgs::TransformStamped &t_in)
{
    p_out        = p_in;
    p_out.header = t_in.header;

    const float x = static_cast<float>(t_in.transform.rotation.x), y = static_cast<float>(t_in.transform.rotation.y),
                z = static_cast<float>(t_in.transform.rotation.z), w = static_cast<float>(t_in.transform.rotation.w);
    const float tx = 2.0f * x, ty = 2.0f * y, tz = 2.0f * z;
    const float rows[3][3] = {
        {1.0f - (ty * y + tz * z), ty * x - tz * w, tz * x + ty * w},
        {ty * x + tz * w, 1.0f - (tx * x + tz * z), tz * y - tx * w},
        {tz * x - ty * w, tz * y + tx * w, 1.0f - (tx * x + ty * y)},
    };
    const float moved[3] = {static_cast<float>(t_in.transform.translation.x),
                            static_cast<float>(t_in.transform.translation.y),
                            static_cast<float>(t_in.transform.translation.z)};

    sensor_msgs::PointCloud2ConstIterator<float> x_in(p_in, "x"), y_in(p_in, "y"), z_in(p_in, "z");
    sensor_msgs::PointCloud2Iterator<float>      x_out(p_out, "x"), y_out(p_out, "y"), z_out(p_out, "z");
    for (; x_in != x_in.end(); ++x_in, ++y_in, ++z_in, ++x_out, ++y_out, ++z_out)
    {
        const float point[3] = {*x_in, *y_in, *z_in};
        float       made[3];
        for (int row = 0; row < 3; ++row)
        {
            made[row] = rows[row][0] * point[0] + rows[row][1] * point[1] + rows[row][2] * point[2] + moved[row];
        }
        *x_out = made[0];
        *y_out = made[1];
        *z_out = made[2];
    }
}

inline sensor_msgs::PointCloud2 toMsg(const sensor_msgs::PointCloud2 &in)
{
    return in;
}

inline void fromMsg(const sensor_msgs::PointCloud2 &msg, sensor_msgs::PointCloud2 &out)
{
    out = msg;
}

} // namespace tf2

#endif
