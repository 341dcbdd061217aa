// What a node may still do that has been shut down, such as one whose constructor goes on after that.
#include <cstdio>

#include <ros/ros.h>
#include <std_msgs/String.h>
#include <std_srvs/Trigger.h>

static void hear(const std_msgs::String &) {}
static bool serve(std_srvs::Trigger::Request &, std_srvs::Trigger::Response &) { return true; }

int main(int argc, char **argv)
{
    ros::init(argc, argv, "ended");
    ros::NodeHandle nh;
    nh.setParam("value", 7);
    ros::Publisher before = nh.advertise<std_msgs::String>("before", 1);
    ros::ServiceServer server = nh.advertiseService("server", serve);
    ros::ServiceClient own = nh.serviceClient<std_srvs::Trigger>("server");
    ROS_WARN("P| a line of the log before the end");
    ros::shutdown();
    ROS_WARN("P| a line of the log after the end");
    ROS_FATAL_STREAM("P| a fatal one");
    std::printf("P| ok %d, shutting down %d, started %d\n", ros::ok(), ros::isShuttingDown(), ros::isStarted());
    ros::Publisher pub = nh.advertise<std_msgs::String>("p", 1);
    std::printf("P| publisher %d, subscribers %u, topic [%s]\n", static_cast<bool>(pub), pub.getNumSubscribers(),
                pub.getTopic().c_str());
    before.publish(std_msgs::String());
    std::printf("P| published\n");
    ros::Subscriber sub = nh.subscribe("t", 1, hear);
    std::printf("P| subscriber %d\n", static_cast<bool>(sub));
    ros::ServiceServer late = nh.advertiseService("s", serve);
    std::printf("P| server %d\n", static_cast<bool>(late));
    ros::ServiceClient client = nh.serviceClient<std_srvs::Trigger>("s");
    std_srvs::Trigger call;
    std::printf("P| client %d, call %d\n", client.isValid(), client.call(call));
    std::printf("P| waited %d\n", client.waitForExistence(ros::Duration(1)));
    ros::spinOnce();
    ros::spin();
    std::printf("P| rate %d\n", ros::Rate(100).sleep());
    std::printf("P| ok %d\n", ros::ok());
}
