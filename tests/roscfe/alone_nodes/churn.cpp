// Makes subscribers, publishers, timers and services, and gives them up, again and again: no memory is kept.
#include <malloc.h>

#include <cstdio>

#include <ros/ros.h>
#include <std_msgs/String.h>

static void hear(const std_msgs::String &) {}
static void tell(const ros::SingleSubscriberPublisher &) {}
static void tick(const ros::TimerEvent &) {}

static void turn(ros::NodeHandle &node)
{
    const ros::Subscriber heard  = node.subscribe("a", 10, hear);
    const ros::Publisher  told   = node.advertise<std_msgs::String>("b", 1, tell, tell);
    const ros::Timer      ticked = node.createTimer(ros::Duration(1), tick);
    ros::spinOnce();
}

int main(int argc, char **argv)
{
    ros::init(argc, argv, "probe");
    ros::NodeHandle node;
    for (int i = 0; i < 1000; ++i)
    {
        turn(node);
    }
    const auto before = mallinfo2().uordblks;
    for (int i = 0; i < 20000; ++i)
    {
        turn(node);
    }
    const auto after = mallinfo2().uordblks;
    std::printf("P| %ld bytes more\n", static_cast<long>(after) - static_cast<long>(before));
    return 0;
}
