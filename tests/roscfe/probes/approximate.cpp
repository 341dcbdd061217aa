// Messages whose stamps are close: which ones ApproximateTime puts together, for streams of random rates and delays.
#include <cstdint>
#include <cstdio>
#include <string>
#include <vector>

#include <geometry_msgs/PointStamped.h>
#include <message_filters/sync_policies/approximate_time.h>
#include <message_filters/synchronizer.h>
#include <ros/ros.h>

typedef geometry_msgs::PointStamped         Point;
typedef boost::shared_ptr<Point const>      PointPtr;
typedef message_filters::sync_policies::ApproximateTime<Point, Point>        Two;
typedef message_filters::sync_policies::ApproximateTime<Point, Point, Point> Three;

static std::uint32_t g_random = 1;
static std::string   g_said;

static std::uint32_t number(std::uint32_t below)
{
    g_random = g_random * 1664525U + 1013904223U;
    return (g_random >> 8) % below;
}

static PointPtr at(std::uint32_t ms)
{
    boost::shared_ptr<Point> made(new Point);
    made->header.stamp = ros::Time(100 + ms / 1000, ms % 1000 * 1000000);
    return made;
}

static void say(const PointPtr &each)
{
    g_said += std::to_string((each->header.stamp.sec - 100) * 1000 + each->header.stamp.nsec / 1000000) + " ";
}

static void two(const PointPtr &a, const PointPtr &b)
{
    say(a), say(b);
    g_said += "| ";
}

static void three(const PointPtr &a, const PointPtr &b, const PointPtr &c)
{
    say(a), say(b), say(c);
    g_said += "| ";
}

// Add messages in a random order: each stream has a rate, times that shake, and at times one that is older.
template <class Sync>
static void feed(Sync &sync, int streams, int count)
{
    std::uint32_t times[3] = {}, steps[3];
    for (std::uint32_t &step : steps)
    {
        step = 5 + number(60);
    }
    for (int i = 0; i < count; ++i)
    {
        const int      stream = static_cast<int>(number(static_cast<std::uint32_t>(streams)));
        std::uint32_t &time   = times[stream];
        time += steps[stream] / 2 + number(steps[stream]);
        const std::uint32_t stamp = number(30) == 0 && time > 40 ? time - 40 : time;
        stream == 0 ? sync.template add<0>(at(stamp)) : sync.template add<1>(at(stamp));
    }
}

static void feed_three(message_filters::Synchronizer<Three> &sync, int count)
{
    std::uint32_t times[3] = {};
    for (int i = 0; i < count; ++i)
    {
        const std::uint32_t stream = number(3);
        times[stream] += 10 + number(20 + 10 * stream);
        stream == 0 ? sync.add<0>(at(times[0])) : stream == 1 ? sync.add<1>(at(times[1])) : sync.add<2>(at(times[2]));
    }
}

static void show(const char *what)
{
    std::printf("P| %s: %s\n", what, g_said.c_str());
    g_said.clear();
}

int main(int argc, char **argv)
{
    ros::init(argc, argv, "probe");
    ros::NodeHandle node;
    for (const std::uint32_t queue : {1U, 2U, 5U, 20U})
    {
        for (int round = 0; round < 3; ++round)
        {
            message_filters::Synchronizer<Two> pairs(Two{queue});
            pairs.registerCallback(two);
            pairs.getPolicy()->setAgePenalty(0.1 * round);
            feed(pairs, 2, 60);
            show("pairs");
        }
        message_filters::Synchronizer<Three> triples(Three{queue});
        triples.registerCallback(three);
        triples.setInterMessageLowerBound(ros::Duration(0.01));
        feed_three(triples, 90);
        show("triples");
    }
    message_filters::Synchronizer<Two> bounded(Two{10});
    bounded.registerCallback(two);
    bounded.setInterMessageLowerBound(0, ros::Duration(0.03));
    bounded.setInterMessageLowerBound(1, ros::Duration(0.005));
    bounded.setMaxIntervalDuration(ros::Duration(0.015));
    feed(bounded, 2, 120);
    show("at most 15 ms apart");
    for (const std::uint32_t ms : {100, 50, 101}) // out of order
    {
        bounded.add<0>(at(9000 + ms));
        bounded.add<1>(at(9000 + ms));
    }
    show("back in time");
    return 0;
}
