// A rover's drive: odometry and its transform once a second, and a service that sets it back.
#include <geometry_msgs/TransformStamped.h>
#include <nav_msgs/Odometry.h>
#include <ros/ros.h>
#include <std_srvs/Empty.h>
#include <tf2_ros/transform_broadcaster.h>

static double g_x = 0;

static bool set_back(std_srvs::Empty::Request &, std_srvs::Empty::Response &)
{
    g_x = 0;
    return true;
}

int main(int argc, char **argv)
{
    ros::init(argc, argv, "drive");
    ros::NodeHandle               node;
    ros::Publisher                odometry = node.advertise<nav_msgs::Odometry>("odom", 10);
    ros::ServiceServer            service  = node.advertiseService("set_back", set_back);
    tf2_ros::TransformBroadcaster frames;
    nav_msgs::Odometry            message;
    geometry_msgs::TransformStamped moved;
    message.header.frame_id = moved.header.frame_id = "odom";
    message.child_frame_id = moved.child_frame_id = "base_link";
    moved.transform.rotation.w = message.pose.pose.orientation.w = 1;
    ros::Rate rate(1);
    while (ros::ok())
    {
        double speed = 0.1;
        node.getParamCached("speed", speed);
        g_x += speed;
        message.header.stamp = moved.header.stamp = ros::Time::now();
        message.pose.pose.position.x = moved.transform.translation.x = g_x;
        odometry.publish(message);
        frames.sendTransform(moved);
        ros::spinOnce();
        rate.sleep();
    }
    return 0;
}
