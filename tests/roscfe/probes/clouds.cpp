// Scans as clouds of points, clouds as other clouds, and what markers look like, in numbers.
#include <cstdio>
#include <string>

#include <geometry_msgs/TransformStamped.h>
#include <interactive_markers/tools.h>
#include <laser_geometry/laser_geometry.h>
#include <ros/ros.h>
#include <sensor_msgs/point_cloud_conversion.h>
#include <tf/tf.h>
#include <tf2/buffer_core.h>

namespace options = laser_geometry::channel_option;

static unsigned hash(const unsigned char *bytes, std::size_t size, unsigned sum = 2166136261u)
{
    for (std::size_t i = 0; i < size; ++i)
    {
        sum = (sum ^ bytes[i]) * 16777619u;
    }
    return sum;
}

static void show(const char *what, const sensor_msgs::PointCloud &cloud)
{
    unsigned sum = 2166136261u;
    for (const geometry_msgs::Point32 &point : cloud.points)
    {
        for (const float value : {point.x, point.y, point.z})
        {
            sum = hash(reinterpret_cast<const unsigned char *>(&value), sizeof value, sum);
        }
    }
    std::printf("P| %s: %s, %d points %08x\n", what, cloud.header.frame_id.c_str(), static_cast<int>(cloud.points.size()), sum);
    if (!cloud.points.empty())
    {
        const geometry_msgs::Point32 &last = cloud.points.back();
        std::printf("P|   last %.9g %.9g %.9g\n", last.x, last.y, last.z);
    }
    for (const sensor_msgs::ChannelFloat32 &channel : cloud.channels)
    {
        const bool none = channel.values.empty();
        std::printf("P|   %s %d, last %.9g\n", channel.name.c_str(), static_cast<int>(channel.values.size()), none ? -1 : channel.values.back());
    }
}

static void show(const char *what, const sensor_msgs::PointCloud2 &cloud)
{
    std::printf("P| %s: %s, %u x %u, steps %u %u, %d bytes %08x, dense %d\n", what, cloud.header.frame_id.c_str(), cloud.width,
                cloud.height, cloud.point_step, cloud.row_step, static_cast<int>(cloud.data.size()),
                hash(cloud.data.data(), cloud.data.size()), cloud.is_dense);
    for (const sensor_msgs::PointField &field : cloud.fields)
    {
        std::printf("P|   %s at %u type %d, %u; last", field.name.c_str(), field.offset, field.datatype, field.count);
        if (cloud.width > 0)
        {
            std::printf(" %.9g", sensor_msgs::readPointCloud2BufferValue<double>(&cloud.data[(cloud.width - 1) * cloud.point_step + field.offset], field.datatype));
        }
        std::printf("\n");
    }
}

static sensor_msgs::LaserScan scan_of(int rays, bool has_intensities)
{
    sensor_msgs::LaserScan scan;
    scan.header.frame_id = "laser";
    scan.header.stamp    = ros::Time(10, 0);
    scan.angle_min       = -1.5f;
    scan.angle_increment = 0.0125f;
    scan.angle_max       = scan.angle_min + rays * scan.angle_increment;
    scan.time_increment  = 0.001f;
    scan.range_min       = 0.25f;
    scan.range_max       = 8.f;
    for (int i = 0; i < rays; ++i)
    {
        scan.ranges.push_back((i * 37 % 101) * 0.1f);
        if (has_intensities)
        {
            scan.intensities.push_back(i * 1.5f);
        }
    }
    return scan;
}

static geometry_msgs::TransformStamped moved(double seconds)
{
    geometry_msgs::TransformStamped made;
    made.header.frame_id       = "map";
    made.child_frame_id        = "laser";
    made.header.stamp          = ros::Time(seconds);
    made.transform.translation.x = 2 * seconds - 19;
    made.transform.translation.y = 0.25 * seconds;
    made.transform.translation.z = 0.3;
    tf2::Quaternion turn;
    turn.setRPY(0.02 * seconds, 0.01, 0.4 * (seconds - 9));
    made.transform.rotation.x = turn.x();
    made.transform.rotation.y = turn.y();
    made.transform.rotation.z = turn.z();
    made.transform.rotation.w = turn.w();
    return made;
}

static void scans()
{
    laser_geometry::LaserProjection projection;
    sensor_msgs::PointCloud         cloud;
    sensor_msgs::PointCloud2        bytes;
    const sensor_msgs::LaserScan    scan = scan_of(240, true), plain = scan_of(100, false);
    projection.projectLaser(scan, cloud);
    show("scan", cloud);
    projection.projectLaser(scan, bytes);
    show("scan in bytes", bytes);
    const int all = options::Intensity | options::Index | options::Distance | options::Timestamp | options::Viewpoint;
    projection.projectLaser(plain, cloud, 3.5, all);
    show("near", cloud);
    projection.projectLaser(plain, bytes, 3.5, all);
    show("near in bytes", bytes);
    projection.projectLaser(scan, bytes, -1, all);
    show("all in bytes", bytes);
    projection.projectLaser(scan, bytes, 0.1, options::None);
    show("none in bytes", bytes);
    projection.projectLaser(scan_of(0, false), cloud);
    show("empty", cloud);

    tf::Transformer transformer;
    tf2::BufferCore buffer;
    for (double at = 9; at < 12; at += 0.125)
    {
        const geometry_msgs::TransformStamped each = moved(at);
        tf::StampedTransform                  same;
        tf::transformStampedMsgToTF(each, same);
        transformer.setTransform(same);
        buffer.setTransform(each, "test");
    }
    projection.transformLaserScanToPointCloud("map", scan, cloud, transformer);
    show("moving", cloud);
    projection.transformLaserScanToPointCloud("map", scan, cloud, transformer, 5.0, options::Distance);
    show("moving and near", cloud);
    projection.transformLaserScanToPointCloud("map", scan, bytes, transformer, -1.0, all);
    show("moving in bytes", bytes);
    projection.transformLaserScanToPointCloud("map", scan, bytes, buffer, -1.0, options::Intensity | options::Viewpoint);
    show("moving by tf2", bytes);
    projection.transformLaserScanToPointCloud("laser", scan, bytes, "map", buffer);
    show("moving both", bytes);
    try
    {
        projection.transformLaserScanToPointCloud("nowhere", scan, bytes, buffer);
        std::printf("P| found\n");
    }
    catch (const tf2::TransformException &error)
    {
        std::printf("P| %s\n", error.what());
    }
}

static void conversions()
{
    sensor_msgs::PointCloud  cloud, back;
    sensor_msgs::PointCloud2 bytes;
    cloud.header.frame_id = "here";
    cloud.points.resize(5);
    cloud.channels.resize(2);
    cloud.channels[0].name = "whole";
    cloud.channels[1].name = "short";
    cloud.channels[1].values.push_back(3);
    for (int i = 0; i < 5; ++i)
    {
        cloud.points[i].x = 0.1f * i;
        cloud.points[i].y = -0.2f * i;
        cloud.points[i].z = 1e6f * i;
        cloud.channels[0].values.push_back(0.5f * i);
    }
    std::printf("P| converted %d\n", sensor_msgs::convertPointCloudToPointCloud2(cloud, bytes));
    show("bytes", bytes);
    std::printf("P| converted %d\n", sensor_msgs::convertPointCloud2ToPointCloud(bytes, back));
    show("back", back);
    std::printf("P| fields %d %d\n", sensor_msgs::getPointCloud2FieldIndex(bytes, "short"), sensor_msgs::getPointCloud2FieldIndex(bytes, "none"));
    bytes.fields[1].name = "why";
    std::printf("P| converted %d\n", sensor_msgs::convertPointCloud2ToPointCloud(bytes, back));
    unsigned char value[8] = {};
    for (int type = sensor_msgs::PointField::INT8; type <= sensor_msgs::PointField::FLOAT64; ++type)
    {
        sensor_msgs::writePointCloud2BufferValue<double>(value, type, 100.75);
        std::printf("P| type %d: %g\n", type, sensor_msgs::readPointCloud2BufferValue<double>(value, type));
    }
}

static void show(const visualization_msgs::InteractiveMarker &marker)
{
    std::printf("P| marker %s scale %g, turned %.6f %.6f %.6f %.6f\n", marker.name.c_str(), marker.scale, marker.pose.orientation.x,
                marker.pose.orientation.y, marker.pose.orientation.z, marker.pose.orientation.w);
    for (const visualization_msgs::InteractiveMarkerControl &control : marker.controls)
    {
        std::printf("P|  control '%s' mode %d facing %d, visible %d, w %g\n", control.name.c_str(), control.interaction_mode,
                    control.orientation_mode, control.always_visible, control.orientation.w);
        for (const visualization_msgs::Marker &each : control.markers)
        {
            std::printf("P|   %s %d type %d scale %.6g %.6g %.6g color %.6g %.6g %.6g %.6g turned %.6f at %.6g %.6g '%s'\n", each.ns.c_str(),
                        each.id, each.type, each.scale.x, each.scale.y, each.scale.z, each.color.r, each.color.g, each.color.b,
                        each.color.a, each.pose.orientation.w, each.pose.position.x, each.pose.position.z, each.text.c_str());
            double sums[3] = {};
            for (std::size_t i = 0; i < each.points.size(); ++i)
            {
                sums[0] += each.points[i].x * (i + 1);
                sums[1] += each.points[i].y * (i + 1);
                sums[2] += each.points[i].z * (i + 1);
            }
            double colors = 0;
            for (std::size_t i = 0; i < each.colors.size(); ++i)
            {
                colors += (i + 1) * (each.colors[i].r + 2 * each.colors[i].g + 3 * each.colors[i].b + 4 * each.colors[i].a);
            }
            std::printf("P|    %d points %.6g %.6g %.6g, %d colors %.6g\n", static_cast<int>(each.points.size()), sums[0], sums[1],
                        sums[2], static_cast<int>(each.colors.size()), colors);
        }
    }
}

static void markers()
{
    typedef visualization_msgs::InteractiveMarkerControl Control;
    visualization_msgs::InteractiveMarker                marker;
    interactive_markers::autoComplete(marker);
    show(marker);
    marker.name        = "thing";
    marker.description = "A thing";
    const unsigned char modes[] = {Control::NONE,   Control::MENU,        Control::BUTTON,  Control::MOVE_AXIS, Control::MOVE_PLANE,
                                   Control::ROTATE_AXIS, Control::MOVE_ROTATE, Control::MOVE_3D, Control::NONE};
    for (const unsigned char mode : modes)
    {
        Control control;
        control.name             = mode % 2 ? "odd" : "even";
        control.interaction_mode = mode;
        control.description      = "menu";
        control.orientation.x    = mode == Control::MOVE_AXIS ? 1 : 0;
        control.orientation.z    = mode == Control::ROTATE_AXIS ? 0.8 : 0;
        control.orientation.w    = mode == Control::ROTATE_AXIS ? 0.6 : 0;
        marker.controls.push_back(control);
    }
    marker.controls.back().markers.resize(2);
    marker.controls.back().markers[1].color.a = 0.25;
    marker.controls.back().markers[1].scale.y = 3;
    marker.pose.orientation.x                 = 2;
    visualization_msgs::InteractiveMarker opaque = marker;
    opaque.scale                                 = 0.5;
    interactive_markers::autoComplete(marker);
    show(marker);
    interactive_markers::autoComplete(opaque, false);
    show(opaque);
    visualization_msgs::InteractiveMarker titled = marker;
    titled.controls.assign(1, interactive_markers::makeTitle(marker));
    titled.controls.resize(2);
    interactive_markers::makeArrow(marker, titled.controls[1], 2);
    interactive_markers::makeDisc(marker, titled.controls[1], 0.5);
    interactive_markers::makeViewFacingButton(marker, titled.controls[1], "press");
    show(titled);
}

int main(int argc, char **argv)
{
    ros::init(argc, argv, "clouds");
    ros::NodeHandle nh;
    scans();
    conversions();
    markers();
    return 0;
}
