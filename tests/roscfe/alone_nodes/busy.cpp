// Does a little of everything that calls cFE, so that a test can let these calls fail.
#include <cstdio>

#include <ros/ros.h>
#include <std_msgs/String.h>

static int g_heard = 0;
static void hear(const std_msgs::String &)
{
    ++g_heard;
}

int main(int argc, char **argv)
{
    ros::init(argc, argv, "probe");
    ros::NodeHandle   node;
    ros::Publisher    told  = node.advertise<std_msgs::String>("a", 1);
    ros::Subscriber   heard = node.subscribe("a", 1, hear);
    std_msgs::String  message;
    int               value = 7;
    node.setParam("/value", 5);
    const bool found = node.getParam("/value", value);
    ros::spinOnce(); // the publisher learns of the subscriber
    told.publish(message);
    ros::spinOnce();
    const ros::Time before = ros::Time::now();
    ros::Duration(0.0003).sleep();
    std::printf("P| heard %d, found %d %d, slept %.4f s\n", g_heard, found, value, (ros::Time::now() - before).toSec());
    return 0;
}
