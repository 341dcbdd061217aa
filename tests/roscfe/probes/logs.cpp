// Macros of the log: once, throttled, conditions, filters, named, streams.
#include <cstdio>

#include <ros/ros.h>

static int g_evaluated = 0;

static int count(int value)
{
    ++g_evaluated;
    return value;
}

int main(int argc, char **argv)
{
    ros::init(argc, argv, "logs");
    ros::NodeHandle nh;
    for (int i = 0; i < 12; ++i)
    {
        ROS_INFO_ONCE("P| once %d", count(i));
        ROS_WARN_THROTTLE(0.35, "P| throttled %d", count(i));
        ROS_WARN_STREAM_THROTTLE(0.25, "P| stream " << count(i));
        ROS_INFO_DELAYED_THROTTLE(0.35, "P| delayed %d", count(i));
        ROS_INFO_COND(count(i) % 5 == 0, "P| condition %d", i);
        ROS_DEBUG("P| debug %d", count(i));
        ROS_ERROR_STREAM_COND(i == 7, "P| stream condition " << i);
        ROS_WARN_STREAM_ONCE("P| stream once " << i);
        ros::Duration(0.1).sleep();
    }
    ROS_INFO_NAMED("part", "P| named %s", "x");
    ROS_FATAL("P| fatal");
    ROS_INFO("P| percent %% %5.2f|%-4d|%x", 3.14159, 7, 255);
    ROS_INFO_STREAM("P| " << ros::Time(3, 5) << " " << ros::Duration(-1.5) << " " << ros::Duration(0.1) << " " << ros::Rate(4).expectedCycleTime());
    ROS_LOG(ros::console::levels::Warn, ROSCONSOLE_DEFAULT_NAME, "P| level %d", 4);
    std::printf("P| evaluated %d\n", g_evaluated);
    return 0;
}
