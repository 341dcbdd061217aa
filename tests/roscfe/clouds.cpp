// Moves a cloud of two points, first by a quarter turn about z and then by a translation, and prints it.
#include <cstdio>

#include <tf2_sensor_msgs/tf2_sensor_msgs.h>

int main()
{
    sensor_msgs::PointCloud2         cloud, moved;
    sensor_msgs::PointCloud2Modifier modifier(cloud);
    modifier.setPointCloud2FieldsByString(2, "xyz", "rgb");
    modifier.resize(2);
    cloud.header.frame_id = "from";
    sensor_msgs::PointCloud2Iterator<float> x(cloud, "x"), y(cloud, "y"), z(cloud, "z"), colour(cloud, "rgb");
    for (int at = 0; x != x.end(); ++x, ++y, ++z, ++colour, ++at)
    {
        *x      = 1.0f + at;
        *y      = 0.5f;
        *z      = -2.0f;
        *colour = 7.0f;
    }
    geometry_msgs::TransformStamped transform;
    transform.header.frame_id         = "to";
    transform.transform.rotation.z    = 0.70710678118654752;
    transform.transform.rotation.w    = 0.70710678118654752;
    transform.transform.translation.x = 10;
    tf2::doTransform(cloud, moved, transform);
    std::printf("%s", moved.header.frame_id.c_str());
    sensor_msgs::PointCloud2ConstIterator<float> a(moved, "x"), b(moved, "y"), c(moved, "z"), d(moved, "rgb");
    for (; a != a.end(); ++a, ++b, ++c, ++d)
    {
        std::printf(" %.4f %.4f %.4f %.1f", *a, *b, *c, *d);
    }
    std::printf("\n");
}
