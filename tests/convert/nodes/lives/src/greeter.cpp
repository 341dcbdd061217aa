// A publisher that greets each subscriber, those that were there before it among them.
#include <ros/ros.h>
#include <std_msgs/String.h>

static int g_greeted = 0;

static void greet(const ros::SingleSubscriberPublisher &only)
{
    std_msgs::String message;
    message.data = ros::this_node::getName() + " greets " + std::to_string(++g_greeted);
    only.publish(message);
}

int main(int argc, char **argv)
{
    ros::init(argc, argv, "greeter");
    ros::NodeHandle nh, own("~");
    double          wait = 0.0;
    own.param("wait", wait, wait);
    ros::Duration(wait).sleep();
    ros::Publisher out = nh.advertise<std_msgs::String>("out", 10, ros::SubscriberStatusCallback(greet));
    ROS_INFO("greeted %d before it spins", g_greeted);
    ros::spin();
}
