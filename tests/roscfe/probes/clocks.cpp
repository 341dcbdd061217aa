// Clocks, numbers that are no times, arguments, and the lists of a node's own names.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <stdexcept>

#include <ros/callback_queue.h>
#include <ros/ros.h>
#include <std_msgs/String.h>

#define PRINT(expression) std::printf("P| " #expression ": %d\n", static_cast<int>(expression))

template <class Function>
static void print(const char *what, Function function)
{
    try
    {
        const auto made = function();
        std::printf("P| %s: %ld %ld\n", what, static_cast<long>(made.sec), static_cast<long>(made.nsec));
    }
    catch (const std::exception &error)
    {
        std::printf("P| %s: %s\n", what, error.what());
    }
}

#define MADE(expression) print(#expression, [] { return expression; })

static void ranges()
{
    using ros::Duration;
    using ros::SteadyTime;
    using ros::Time;
    using ros::WallDuration;
    const double infinite = std::numeric_limits<double>::infinity();
    MADE(Time(1.5));
    MADE(Time(4294967295.0));
    MADE(Time(4294967296.0));
    MADE(Time(-1.0));
    MADE(Time(5, 3000000000U));
    MADE(Time(4294967295U, 999999999U));
    MADE(Time(4294967295U, 1000000000U));
    MADE(Time(1.0) - Duration(0.25));
    MADE(Time(1.0) - Duration(2.0));
    MADE(Time(1.0) + Duration(-0.75));
    MADE(Time(4294967295.0) + Duration(1.0));
    MADE(Time(2.0) - Time(3.25));
    MADE(Duration(-1.25));
    MADE(Duration(2147483647.0));
    MADE(Duration(2147483648.0));
    MADE(Duration(-2147483648.0));
    MADE(Duration(-2147483649.0));
    MADE(Duration(2147483647, 1000000000));
    MADE(Duration(-2147483648, -1));
    MADE(Duration(1, -1));
    MADE(Duration(1.5) * 2.0);
    MADE(Duration(2e9) * 2.0);
    MADE(-Duration(0.5));
    MADE(Duration(3.0) - Duration(1.5));
    MADE(WallDuration(-0.5));
    MADE(Time().fromNSec(1999999999));
    MADE(Time().fromNSec(std::uint64_t(1) << 63));
    MADE(Duration().fromNSec(-1));
    MADE(Duration().fromNSec(std::int64_t(1) << 62));
    PRINT(std::isinf(infinite) && Duration(1.0) >= Duration(1.0));
    PRINT(Duration(-1.0) <= Duration());
    PRINT(Time(1.0) >= Time(2.0));
    PRINT(Duration().isZero());
    PRINT(Duration(0, 1).isZero());
    PRINT(Time(0, 1).isZero());
    PRINT(Time(3, 0).isZero());
}

static void waits()
{
    PRINT(ros::Time::isValid());
    PRINT(ros::Time::isSystemTime());
    PRINT(ros::Time::useSystemTime());
    PRINT(ros::Time::isSimTime());
    PRINT(ros::Time::waitForValid());
    PRINT(ros::Time::waitForValid(ros::WallDuration(0.1)));
    const ros::Time       begin  = ros::Time::now();
    const ros::SteadyTime steady = ros::SteadyTime::now();
    const ros::WallTime   wall   = ros::WallTime::now();
    PRINT(ros::Time::sleepUntil(begin + ros::Duration(0.02)));
    PRINT(ros::Time::now() >= begin + ros::Duration(0.02));
    PRINT(ros::WallTime::sleepUntil(wall + ros::WallDuration(0.04)));
    PRINT(ros::WallTime::now() >= wall + ros::WallDuration(0.04));
    PRINT(ros::SteadyTime::sleepUntil(steady + ros::WallDuration(0.06)));
    PRINT(ros::SteadyTime::now() - steady >= ros::WallDuration(0.06));
    PRINT(ros::Time::sleepUntil(begin));
    PRINT(ros::Duration(0.0).sleep());
    PRINT(ros::WallDuration(0.001).sleep());
}

static void show(const char *what, ros::V_string names)
{
    std::sort(names.begin(), names.end());
    for (const std::string &each : names)
    {
        if (each.find("rosout") == std::string::npos && each.find("clock") == std::string::npos)
        {
            std::printf("P| %s %s\n", what, each.c_str());
        }
    }
}

static void hear(const std_msgs::StringConstPtr &) {}

static void lists()
{
    ros::NodeHandle node;
    ros::Publisher  a = node.advertise<std_msgs::String>("a", 1), b = node.advertise<std_msgs::String>("/elsewhere", 1);
    ros::Subscriber c = node.subscribe("b", 1, hear);
    ros::V_string   names;
    ros::this_node::getAdvertisedTopics(names);
    show("advertised", names);
    ros::this_node::getSubscribedTopics(names);
    show("subscribed", names);
    ros::this_node::getAdvertisedTopics(names);
    show("advertised again", names);
    PRINT(ros::getGlobalCallbackQueue() == static_cast<ros::CallbackQueue *>(node.getCallbackQueue()));
}

static void arguments()
{
    const char *const given[] = {"program", "plain", "_x:=1", "from:=to", "__name:=n", "last:=a:=b"};
    ros::V_string     kept;
    ros::removeROSArgs(6, given, kept);
    for (const std::string &each : kept)
    {
        std::printf("P| kept %s\n", each.c_str());
    }
}

int main(int argc, char **argv)
{
    ros::init(argc, argv, "probe");
    ros::NodeHandle node;
    PRINT(ros::isInitialized());
    PRINT(ros::isStarted());
    PRINT(ros::ok());
    PRINT(ros::isShuttingDown());
    ranges();
    waits();
    lists();
    arguments();
    ros::requestShutdown();
    PRINT(ros::isStarted());
    ros::shutdown();
    PRINT(ros::isStarted());
    PRINT(ros::isShuttingDown());
    PRINT(ros::ok());
    PRINT(ros::Time::sleepUntil(ros::Time::now() + ros::Duration(0.01)));
    return 0;
}
