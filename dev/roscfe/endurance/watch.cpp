// Hears both others, and keeps their last state for who asks later.
#include <nav_msgs/Odometry.h>
#include <ros/ros.h>
#include <std_msgs/UInt32.h>

static ros::Publisher g_state;

static void hear(const nav_msgs::Odometry::ConstPtr &) {}

static void hear_seen(const std_msgs::UInt32::ConstPtr &message)
{
    g_state.publish(*message);
}

int main(int argc, char **argv)
{
    ros::init(argc, argv, "watch");
    ros::NodeHandle node;
    g_state                = node.advertise<std_msgs::UInt32>("state", 1, true);
    ros::Subscriber heard  = node.subscribe("odom", 10, hear);
    ros::Subscriber seen   = node.subscribe("seen", 10, hear_seen);
    ros::spin();
    return 0;
}
