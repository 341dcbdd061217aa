// A publisher that greets each subscriber, those that were there before it among them. The one that does not wait offers
// a service whose request is empty, and the other one calls it.
#include <ros/ros.h>
#include <std_msgs/String.h>
#include <std_srvs/Empty.h>

static int g_greeted = 0;

static void greet(const ros::SingleSubscriberPublisher &only)
{
    std_msgs::String message;
    message.data = ros::this_node::getName() + " greets " + std::to_string(++g_greeted);
    only.publish(message);
}

static bool reset(std_srvs::Empty::Request &, std_srvs::Empty::Response &)
{
    return true;
}

int main(int argc, char **argv)
{
    ros::init(argc, argv, "greeter");
    ros::NodeHandle nh, own("~");
    double          wait = 0.0;
    own.param("wait", wait, wait);
    ros::ServiceServer server;
    if (wait == 0.0)
    {
        server = nh.advertiseService("reset", reset);
    }
    ros::Duration(wait).sleep();
    if (wait > 0.0)
    {
        std_srvs::Empty    empty;
        ros::ServiceClient client = nh.serviceClient<std_srvs::Empty>("reset");
        ROS_INFO("reset %d", client.call(empty));
    }
    ros::Publisher out = nh.advertise<std_msgs::String>("out", 10, ros::SubscriberStatusCallback(greet));
    ROS_INFO("greeted %d before it spins", g_greeted);
    ros::spin();
}
