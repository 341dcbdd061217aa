// Waits: of rates that are late, of no length, until a time that is over, and of less than nothing.
#include <cstdio>
#include <string>

#include <ros/ros.h>

static std::string g_said;

static void say(const std::string &word) { g_said += word + " "; }

static void show(const char *what)
{
    std::printf("P| %s: %s\n", what, g_said.c_str());
    std::fflush(stdout);
    g_said.clear();
}

static void at_a_rate()
{
    ros::Rate rate(10.0);
    for (int cycle = 0; cycle < 3; ++cycle)
    {
        say(rate.sleep() ? "in_time" : "late");
    }
    ros::Duration(0.25).sleep();
    say(rate.sleep() ? "in_time" : "late");
    say(rate.sleep() ? "in_time" : "late");
    show("rate");
}

int main(int argc, char **argv)
{
    ros::init(argc, argv, "probe");
    ros::NodeHandle nh;
    at_a_rate();
    say(ros::Duration(0).sleep() ? "slept" : "stopped");
    say(ros::WallDuration(0).sleep() ? "slept" : "stopped");
    say(ros::Time::sleepUntil(ros::Time::now() - ros::Duration(1)) ? "slept" : "stopped");
    say(ros::WallTime::sleepUntil(ros::WallTime::now() - ros::WallDuration(1)) ? "slept" : "stopped");
    show("no time");
    int        ticks = 0;
    ros::Timer timer = nh.createTimer(ros::Duration(1.0), [&](const ros::TimerEvent &) {
        std::printf("P| tick %d\n", ++ticks);
        std::fflush(stdout);
        if (ticks == 2)
        {
            ros::Duration(-1.0).sleep(); // the node does nothing more
        }
        if (ticks == 4)
        {
            ros::shutdown();
        }
    });
    ros::spin();
    std::printf("P| the end\n");
    return 0;
}
