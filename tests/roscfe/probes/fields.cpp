// Fields of point clouds: their sizes, iterators over each type, parts of a color, clouds without points, and names that
// no field has.
#include <cstdio>
#include <stdexcept>
#include <string>

#include <ros/ros.h>
#include <sensor_msgs/PointCloud.h>
#include <sensor_msgs/PointCloud2.h>
#include <sensor_msgs/point_cloud2_iterator.h>
#include <sensor_msgs/point_cloud_conversion.h>

using sensor_msgs::PointCloud2;
using sensor_msgs::PointField;

template <class F>
static void tried(const char *what, F f)
{
    try
    {
        f();
        std::printf("P| %s: done\n", what);
    }
    catch (const std::runtime_error &error)
    {
        std::printf("P| %s: refused %d\n", what, *error.what() != '\0');
    }
}

template <class T>
static void typed(PointCloud2 &cloud, const char *name)
{
    int number = 0;
    for (sensor_msgs::PointCloud2Iterator<T> each(cloud, name); each != each.end(); ++each)
    {
        *each = static_cast<T>(++number * 10);
    }
    double sum = 0;
    for (sensor_msgs::PointCloud2ConstIterator<T> each(cloud, name); each != each.end(); each += 1)
    {
        sum += static_cast<double>(*each);
    }
    std::printf("P| %s: %g\n", name, sum);
}

static void types()
{
    PointCloud2 cloud;
    cloud.height = 1;
    cloud.width  = 3;
    sensor_msgs::PointCloud2Modifier modifier(cloud);
    modifier.setPointCloud2Fields(8, "a", 1, PointField::INT8, "b", 1, PointField::UINT8, "c", 1, PointField::INT16, "d", 1,
                                  PointField::UINT16, "e", 2, PointField::INT32, "f", 1, PointField::UINT32, "g", 1,
                                  PointField::FLOAT32, "h", 1, PointField::FLOAT64);
    std::printf("P| step %u, row %u, size %zu\n", cloud.point_step, cloud.row_step, cloud.data.size());
    for (const PointField &field : cloud.fields)
    {
        std::printf("P| %s at %u, type %u, count %u\n", field.name.c_str(), field.offset, field.datatype, field.count);
    }
    typed<signed char>(cloud, "a");
    typed<unsigned char>(cloud, "b");
    typed<short>(cloud, "c");
    typed<unsigned short>(cloud, "d");
    typed<int>(cloud, "e");
    typed<unsigned int>(cloud, "f");
    typed<float>(cloud, "g");
    typed<double>(cloud, "h");
    tried("unknown field", [&cloud]() { sensor_msgs::PointCloud2Iterator<float> each(cloud, "x"); });
    tried("part of no color", [&cloud]() { sensor_msgs::PointCloud2Iterator<unsigned char> each(cloud, "r"); });
    modifier.resize(5);
    std::printf("P| resized: %u x %u, %zu bytes, %zu points\n", cloud.height, cloud.width, cloud.data.size(), modifier.size());
    modifier.reserve(10);
    modifier.clear();
    std::printf("P| cleared: %u x %u, %zu bytes\n", cloud.height, cloud.width, cloud.data.size());
    sensor_msgs::PointCloud2Iterator<float> none(cloud, "g");
    std::printf("P| empty: %d\n", !(none != none.end()));
}

static void colors(const char *name, bool is_big)
{
    PointCloud2 cloud;
    cloud.height       = 2;
    cloud.width        = 2;
    cloud.is_bigendian = is_big;
    sensor_msgs::PointCloud2Modifier modifier(cloud);
    modifier.setPointCloud2FieldsByString(2, "xyz", name);
    tried("more rows than one", [&modifier]() { modifier.resize(3); });
    std::printf("P| %s: %zu fields, step %u, %u x %u\n", name, cloud.fields.size(), cloud.point_step, cloud.height, cloud.width);
    for (const char *part : {"r", "g", "b", "a"})
    {
        sensor_msgs::PointCloud2Iterator<unsigned char> each(cloud, part);
        *each = static_cast<unsigned char>(*part);
        std::printf("P| %s lies at %ld\n", part, static_cast<long>(&*each - &cloud.data[0]));
    }
    sensor_msgs::PointCloud2Iterator<float> x(cloud, "x");
    sensor_msgs::PointCloud2Iterator<float> second = x + 1;
    second[0] = 1;
    second[1] = 2;
    std::printf("P| %d\n", second != x);
    sensor_msgs::PointCloud flat;
    std::printf("P| flat %d: %zu points, %zu channels\n", sensor_msgs::convertPointCloud2ToPointCloud(cloud, flat),
                flat.points.size(), flat.channels.size());
    tried("unknown name", [&modifier]() { modifier.setPointCloud2FieldsByString(1, "intensity"); });
}

static void without_axes()
{
    PointCloud2 cloud;
    cloud.height = 1;
    cloud.width  = 1;
    sensor_msgs::PointCloud2Modifier modifier(cloud);
    modifier.setPointCloud2Fields(2, "x", 1, PointField::FLOAT32, "y", 1, PointField::FLOAT32);
    sensor_msgs::PointCloud flat;
    try
    {
        sensor_msgs::convertPointCloud2ToPointCloud(cloud, flat);
    }
    catch (const std::length_error &)
    {
        std::printf("P| two fields: refused, %zu points\n", flat.points.size());
    }
    modifier.setPointCloud2Fields(3, "x", 1, PointField::FLOAT32, "y", 1, PointField::FLOAT32, "w", 1, PointField::FLOAT32);
    std::printf("P| two axes: %d\n", sensor_msgs::convertPointCloud2ToPointCloud(cloud, flat));
    std::printf("P| %d %d\n", sensor_msgs::getPointCloud2FieldIndex(cloud, "y"), sensor_msgs::getPointCloud2FieldIndex(cloud, "z"));
    flat.points.resize(2);
    flat.channels.resize(1);
    flat.channels[0].name = "i";
    flat.channels[0].values.resize(1);
    std::printf("P| uneven: %d\n", sensor_msgs::convertPointCloudToPointCloud2(flat, cloud));
}

int main(int argc, char **argv)
{
    ros::init(argc, argv, "fields");
    ros::NodeHandle nh;
    types();
    colors("rgb", false);
    colors("rgba", true);
    without_axes();
    return 0;
}
