// Log lines of all levels and kinds, with what decides whether they are said.
#include <ros/console.h>
#include <ros/ros.h>
#include <string>

static bool every_third(int cycle) { return cycle % 3 == 0; }

int main(int argc, char **argv)
{
    ros::init(argc, argv, "twin");
    ros::NodeHandle nh;
    ros::Duration(1.0).sleep();
    ros::Rate rate(4);
    for (int cycle = 0; ros::ok(); ++cycle)
    {
        ROS_DEBUG("debug %d", cycle);
        ROS_INFO("info %d of %s, %.3f", cycle, "twin", cycle / 8.0);
        ROS_WARN_STREAM("warn " << cycle << " of a stream");
        ROS_ERROR_COND(every_third(cycle), "error %d", cycle);
        ROS_FATAL_STREAM_COND(cycle == 7, "fatal " << cycle);
        ROS_INFO_ONCE("once, in cycle %d", cycle);
        ROS_WARN_THROTTLE(1.1, "throttled, in cycle %d", cycle);
        ROS_INFO_STREAM_THROTTLE(2.6, "a throttled stream, in cycle " << cycle);
        ROS_INFO_DELAYED_THROTTLE(1.6, "delayed, in cycle %d", cycle);
        if (cycle == 9)
        {
            ROS_INFO("%s", std::string(300, 'x').c_str());
        }
        if (cycle == 20 && ros::console::set_logger_level(ROSCONSOLE_DEFAULT_NAME, ros::console::levels::Debug))
        {
            ros::console::notifyLoggerLevelsChanged();
        }
        ros::spinOnce();
        rate.sleep();
    }
}
