// What a node leaves behind when it is started again: nothing.
#include <cstdlib>

#include <ros/ros.h>
#include <std_msgs/String.h>

struct Global
{
    int           value = 5;
    std::string * text  = new std::string("made before main");
    ~Global() { delete text; }
};
static Global          g_global;
static ros::Publisher *g_out   = nullptr;
static int             g_heard = 0;

static int &counter()
{
    static int count = 0;
    return count;
}

static void heard(const std_msgs::String::ConstPtr &message)
{
    ++g_heard;
    if (message->data == "exit " + ros::this_node::getName())
    {
        exit(3);
    }
}

int main(int argc, char **argv)
{
    ros::init(argc, argv, "lives");
    ros::NodeHandle nh, own("~");
    ros::Publisher  out = nh.advertise<std_msgs::String>("out", 10);
    ros::Subscriber in  = nh.subscribe("in", 10, heard);
    g_out               = &out;
    int starts          = 0;
    own.param("starts", starts, 100);
    own.setParam("starts", starts + 1);
    ros::Duration(0.5).sleep();
    ros::Rate rate(2);
    while (ros::ok())
    {
        ros::spinOnce();
        std_msgs::String message;
        message.data = ros::this_node::getName() + " count " + std::to_string(++counter()) + " global " +
                       std::to_string(g_global.value++) + " heard " + std::to_string(g_heard) + " starts " +
                       std::to_string(starts) + " " + *g_global.text;
        g_out->publish(message);
        ROS_INFO("%s", message.data.c_str());
        rate.sleep();
    }
}
