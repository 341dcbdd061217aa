// Messages within messages and arrays of them: what comes is changed a little, and goes out.
#include <diagnostic_msgs/DiagnosticArray.h>
#include <geometry_msgs/PoseArray.h>
#include <ros/ros.h>
#include <sensor_msgs/Image.h>
#include <sensor_msgs/PointCloud2.h>
#include <trajectory_msgs/JointTrajectory.h>

static ros::Publisher poses, trajectory, diagnostics, cloud, image;

static void on_poses(const geometry_msgs::PoseArray::ConstPtr &message)
{
    geometry_msgs::PoseArray made = *message;
    made.header.frame_id += "_out";
    for (geometry_msgs::Pose &each : made.poses)
    {
        each.position.x *= 2;
        each.orientation.w = each.position.y + each.position.z;
    }
    made.poses.push_back(geometry_msgs::Pose());
    poses.publish(made);
}

static void on_trajectory(const trajectory_msgs::JointTrajectory &message)
{
    trajectory_msgs::JointTrajectoryPtr made(new trajectory_msgs::JointTrajectory(message));
    made->joint_names.insert(made->joint_names.begin(), "first");
    for (auto &point : made->points)
    {
        point.positions.resize(point.positions.size() + 1, 0.5);
        point.time_from_start += ros::Duration(0.25);
    }
    trajectory.publish(made);
}

static void on_diagnostics(diagnostic_msgs::DiagnosticArray message)
{
    for (auto &status : message.status)
    {
        status.level = diagnostic_msgs::DiagnosticStatus::WARN;
        diagnostic_msgs::KeyValue value;
        value.key   = "values";
        value.value = std::to_string(status.values.size());
        status.values.push_back(value);
    }
    diagnostics.publish(message);
}

static void on_cloud(const sensor_msgs::PointCloud2ConstPtr &message)
{
    sensor_msgs::PointCloud2 made = *message;
    for (std::uint8_t &byte : made.data)
    {
        byte ^= 0xFF;
    }
    made.is_dense = !made.is_dense;
    cloud.publish(made);
}

// Longer than a packet of the Software Bus.
static void on_image(const sensor_msgs::ImageConstPtr &message)
{
    sensor_msgs::Image made = *message;
    made.data.insert(made.data.end(), message->data.rbegin(), message->data.rend());
    made.height *= 2;
    image.publish(made);
}

int main(int argc, char **argv)
{
    ros::init(argc, argv, "twin");
    ros::NodeHandle nh;
    poses             = nh.advertise<geometry_msgs::PoseArray>("poses_out", 5);
    trajectory        = nh.advertise<trajectory_msgs::JointTrajectory>("trajectory_out", 5);
    diagnostics       = nh.advertise<diagnostic_msgs::DiagnosticArray>("diagnostics_out", 5);
    cloud             = nh.advertise<sensor_msgs::PointCloud2>("cloud_out", 5);
    image             = nh.advertise<sensor_msgs::Image>("image_out", 5);
    ros::Subscriber a = nh.subscribe("poses", 5, on_poses);
    ros::Subscriber b = nh.subscribe("trajectory", 5, on_trajectory);
    ros::Subscriber c = nh.subscribe("diagnostics", 5, on_diagnostics);
    ros::Subscriber d = nh.subscribe("cloud", 5, on_cloud);
    ros::Subscriber e = nh.subscribe("image", 5, on_image);
    ros::spin();
}
