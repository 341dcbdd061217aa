// Subscriptions of one node to latched topics of others, one after the other: who gets the last message, and how often.
#include <cstdio>
#include <map>

#include <ros/ros.h>
#include <std_msgs/Int32.h>
#include <std_msgs/String.h>

static std::map<std::string, std::string> g_heard;

static void heard(const std::string &who, const std_msgs::String::ConstPtr &message) { g_heard[who] += message->data + " "; }

struct Ear
{
    std::string who;
    void operator()(const std_msgs::String::ConstPtr &message) const { heard(who, message); }
};

static void spin_for(double seconds)
{
    for (int i = 0; i < seconds * 50 && ros::ok(); ++i)
    {
        ros::spinOnce();
        ros::Duration(0.02).sleep();
    }
}

static void show(const char *when)
{
    std::printf("P| %s:", when);
    for (auto &each : g_heard)
    {
        std::printf(" %s=[%s]", each.first.c_str(), each.second.c_str());
        each.second.clear();
    }
    std::printf("\n");
}

static ros::Subscriber ear(ros::NodeHandle &nh, const char *topic, const char *who)
{
    Ear made = {who};
    g_heard[who];
    return nh.subscribe<std_msgs::String>(topic, 10, boost::function<void(const std_msgs::String::ConstPtr &)>(made));
}

static void wait_for(const std::string &name)
{
    while (ros::ok() && !ros::param::has(name))
    {
        ros::Duration(0.05).sleep();
    }
}

static int count_of(ros::Publisher &publisher, std::uint32_t wanted)
{
    for (int i = 0; i < 100 && publisher.getNumSubscribers() != wanted; ++i)
    {
        ros::Duration(0.02).sleep();
    }
    return static_cast<int>(publisher.getNumSubscribers());
}

int main(int argc, char **argv)
{
    ros::init(argc, argv, "latched_again");
    ros::NodeHandle nh;
    ros::Publisher  out = nh.advertise<std_msgs::Int32>("/numbers", 10);
    wait_for("/ready");
    ros::Subscriber first = ear(nh, "/latched", "1");
    spin_for(0.5);
    show("the first");
    ros::Subscriber second = ear(nh, "/latched", "2");
    spin_for(0.5);
    show("the second");
    ros::Subscriber third = ear(nh, "/latched", "3"), fourth = ear(nh, "/latched", "4");
    spin_for(0.5);
    show("two at once");
    ros::param::set("/say", 1);
    spin_for(0.5);
    show("a new message");
    first.shutdown();
    spin_for(0.2);
    ros::Subscriber fifth = ear(nh, "/latched", "5");
    spin_for(0.5);
    show("without the first");
    second.shutdown();
    third.shutdown();
    fourth.shutdown();
    fifth.shutdown();
    spin_for(0.3);
    ros::Subscriber again = ear(nh, "/latched", "6");
    spin_for(0.5);
    show("after none");

    std::printf("P| subscribers %d\n", count_of(out, 1));
    ros::param::set("/leave", 1);
    wait_for("/left");
    std::printf("P| and none %d\n", count_of(out, 0));
    ros::param::set("/end", 1);
}
