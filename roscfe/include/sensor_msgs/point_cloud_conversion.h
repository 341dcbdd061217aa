// Between sensor_msgs/PointCloud, which has points and channels, and sensor_msgs/PointCloud2, which has bytes.
#ifndef ROSCFE_SENSOR_MSGS_POINT_CLOUD_CONVERSION_H
#define ROSCFE_SENSOR_MSGS_POINT_CLOUD_CONVERSION_H

#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string>

#include "ros/console.h"
#include "sensor_msgs/PointCloud.h"
#include "sensor_msgs/PointCloud2.h"
#include "sensor_msgs/point_field_conversion.h"

namespace sensor_msgs
{

// Where a field is among those of a cloud; -1 when it is not there.
static inline int getPointCloud2FieldIndex(const PointCloud2 &cloud, const std::string &field_name)
{
    for (std::size_t i = 0; i < cloud.fields.size(); ++i)
    {
        if (cloud.fields[i].name == field_name.c_str())
        {
            return static_cast<int>(i);
        }
    }
    return -1;
}

// All fields become FLOAT32: x, y, z and the channels. A channel whose length is another one than the points' is 0.
static inline bool convertPointCloudToPointCloud2(const PointCloud &input, PointCloud2 &output)
{
    static const char *const kAxes[] = {"x", "y", "z"};
    output.header                    = input.header;
    output.width                     = static_cast<std::uint32_t>(input.points.size());
    output.height                    = 1;
    output.fields.resize(3 + input.channels.size());
    std::uint32_t offset = 0;
    for (std::size_t i = 0; i < output.fields.size(); ++i, offset += 4)
    {
        PointField &field = output.fields[i];
        if (i < 3)
        {
            field.name = kAxes[i];
        }
        else
        {
            field.name = input.channels[i - 3].name;
        }
        field.offset   = offset;
        field.datatype = PointField::FLOAT32;
        field.count    = 1;
    }
    output.point_step = offset;
    output.row_step   = offset * output.width;
    output.data.resize(input.points.size() * offset);
    output.is_bigendian = false;
    output.is_dense     = false;
    for (std::size_t i = 0; i < input.points.size(); ++i)
    {
        unsigned char *point = &output.data[i * offset];
        writePointCloud2BufferValue<PointField::FLOAT32>(point, input.points[i].x);
        writePointCloud2BufferValue<PointField::FLOAT32>(point + 4, input.points[i].y);
        writePointCloud2BufferValue<PointField::FLOAT32>(point + 8, input.points[i].z);
        for (std::size_t c = 0; c < input.channels.size(); ++c)
        {
            if (input.channels[c].values.size() == input.points.size())
            {
                writePointCloud2BufferValue<PointField::FLOAT32>(point + 12 + 4 * c, input.channels[c].values[i]);
            }
        }
    }
    return true;
}

// The fields beside x, y and z become channels. False, with an error logged, when one of those three is not there. A cloud
// of fewer than three fields ends the node, as in ROS.
static inline bool convertPointCloud2ToPointCloud(const PointCloud2 &input, PointCloud &output)
{
    output.header = input.header;
    output.points.resize(static_cast<std::size_t>(input.width) * input.height);
    if (input.fields.size() < 3)
    {
        ROSCFE_THROW(std::length_error("a cloud of fewer than three fields has no x, y and z"));
    }
    output.channels.resize(input.fields.size() - 3);
    const int axes[] = {getPointCloud2FieldIndex(input, "x"), getPointCloud2FieldIndex(input, "y"),
                        getPointCloud2FieldIndex(input, "z")};
    if (axes[0] < 0 || axes[1] < 0 || axes[2] < 0)
    {
        ROS_ERROR("x/y/z coordinates not found! Cannot convert to sensor_msgs::PointCloud!");
        return false;
    }
    const auto is_axis = [&](std::size_t field) {
        for (const int axis : axes)
        {
            if (input.fields[field].offset == input.fields[static_cast<std::size_t>(axis)].offset)
            {
                return true;
            }
        }
        return false;
    };
    const auto value = [&](std::size_t point, std::size_t field) {
        return readPointCloud2BufferValue<float>(&input.data[point * input.point_step + input.fields[field].offset],
                                                 input.fields[field].datatype);
    };
    for (std::size_t i = 0; i < output.points.size(); ++i)
    {
        output.points[i].x = value(i, static_cast<std::size_t>(axes[0]));
        output.points[i].y = value(i, static_cast<std::size_t>(axes[1]));
        output.points[i].z = value(i, static_cast<std::size_t>(axes[2]));
    }
    std::size_t made = 0;
    for (std::size_t f = 0; f < input.fields.size(); ++f)
    {
        if (is_axis(f) || made == output.channels.size())
        {
            continue;
        }
        ChannelFloat32 &channel = output.channels[made++];
        channel.name            = input.fields[f].name;
        channel.values.resize(output.points.size());
        for (std::size_t i = 0; i < output.points.size(); ++i)
        {
            channel.values[i] = value(i, f);
        }
    }
    return true;
}

} // namespace sensor_msgs

#endif
