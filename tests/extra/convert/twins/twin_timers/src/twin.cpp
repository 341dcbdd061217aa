// Timers: what they say of their times, and when.
#include <ros/ros.h>
#include <std_msgs/Header.h>

static ros::Publisher out;

static void say(const std::string &what)
{
    std_msgs::Header message;
    message.stamp    = ros::Time::now();
    message.frame_id = what;
    out.publish(message);
}

// Milliseconds between two times; "-" when the first is not known yet.
template <class T>
static std::string between(const T &begin, const T &end)
{
    return begin.isZero() ? "-" : std::to_string((end - begin).toNSec() / 1000000);
}

template <class E>
static std::string times(const E &event)
{
    return between(event.last_expected, event.current_expected) + " " + between(event.last_real, event.current_real) +
           " " + between(event.current_expected, event.current_real);
}

struct Slow
{
    int  calls = 0;
    void tick(const ros::TimerEvent &event)
    {
        say("slow " + std::to_string(++calls) + " " + times(event));
        ros::Duration(calls == 3 ? 1.3 : 0.2).sleep();
    }
};

int main(int argc, char **argv)
{
    ros::init(argc, argv, "twin");
    ros::NodeHandle nh;
    out = nh.advertise<std_msgs::Header>("out", 100);
    ros::Duration(1.0).sleep();
    ros::Timer periodic = nh.createTimer(ros::Duration(0.4), [](const ros::TimerEvent &event) { say("periodic " + times(event)); });
    ros::Timer once = nh.createTimer(ros::Duration(0.55), [](const ros::TimerEvent &event) { say("once " + times(event)); }, true);
    ros::WallTimer wall = nh.createWallTimer(ros::WallDuration(0.7), [](const ros::WallTimerEvent &event) { say("wall " + times(event)); });
    ros::Timer late = nh.createTimer(ros::Duration(0.3), [](const ros::TimerEvent &) { say("late"); }, false, false);
    ros::Timer rated = nh.createTimer(ros::Rate(1.25), [](const ros::TimerEvent &event) { say("rated " + times(event)); });
    for (ros::Time end = ros::Time::now() + ros::Duration(2.05); ros::Time::now() < end;)
    {
        ros::spinOnce();
        ros::Duration(0.05).sleep();
    }
    periodic.stop();
    wall = ros::WallTimer();
    rated.setPeriod(ros::Duration(0.5));
    late.start();
    say("changed");
    for (ros::Time end = ros::Time::now() + ros::Duration(2.05); ros::Time::now() < end;)
    {
        ros::spinOnce();
        ros::Duration(0.05).sleep();
    }
    rated.stop();
    late.stop();
    once.stop();
    once.start();
    Slow       slow;
    ros::Timer lazy = nh.createTimer(ros::Duration(0.5), &Slow::tick, &slow);
    say("slow begins");
    ros::spin();
    return 0;
}
