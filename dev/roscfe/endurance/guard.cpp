// Looks where the rover is, sends it back beyond a limit, and changes its speed each minute.
#include <nav_msgs/Odometry.h>
#include <ros/ros.h>
#include <std_msgs/UInt32.h>
#include <std_srvs/Empty.h>
#include <tf2_ros/buffer.h>
#include <tf2_ros/transform_listener.h>

static nav_msgs::Odometry g_last;

static void hear(const nav_msgs::Odometry::ConstPtr &message)
{
    g_last = *message;
}

int main(int argc, char **argv)
{
    ros::init(argc, argv, "guard");
    ros::NodeHandle            node;
    tf2_ros::Buffer            buffer;
    tf2_ros::TransformListener listener(buffer);
    ros::Publisher             seen   = node.advertise<std_msgs::UInt32>("seen", 10);
    ros::Subscriber            heard  = node.subscribe("odom", 10, hear);
    ros::ServiceClient         client = node.serviceClient<std_srvs::Empty>("set_back");
    std_msgs::UInt32           message;
    ros::Rate                  rate(1);
    for (unsigned second = 0; ros::ok(); ++second)
    {
        message.data += buffer.canTransform("odom", "base_link", ros::Time(0)) ? 1 : 0;
        seen.publish(message);
        if (second % 10 == 9)
        {
            std_srvs::Empty service;
            client.call(service);
        }
        if (second % 60 == 59)
        {
            node.setParam("speed", second % 120 == 59 ? 0.2 : 0.1);
        }
        ros::spinOnce();
        rate.sleep();
    }
    return 0;
}
