// Publishers of one topic in one node: what each has latched, and whose callbacks hear of subscribers.
#include <cstdio>
#include <memory>
#include <string>

#include <ros/ros.h>
#include <std_msgs/Empty.h>
#include <std_msgs/String.h>

static std::string g_heard, g_told;

static void hear(const std_msgs::String &message) { g_heard += message.data + " "; }

struct Teller
{
    std::string name;
    void come(const ros::SingleSubscriberPublisher &only)
    {
        std_msgs::String greeting;
        greeting.data = "from_" + name;
        only.publish(greeting);
        g_told += name + "+ ";
    }
    void go(const ros::SingleSubscriberPublisher &) { g_told += name + "- "; }
};

static std_msgs::String text(const std::string &data)
{
    std_msgs::String message;
    message.data = data;
    return message;
}

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
    std::printf("P| %s: heard [%s] told [%s]\n", when, g_heard.c_str(), g_told.c_str());
    std::fflush(stdout);
    g_heard.clear();
    g_told.clear();
}

static ros::Publisher advertise(ros::NodeHandle &nh, const char *topic, Teller &teller, const ros::VoidConstPtr &tracked,
                                bool latch = false)
{
    return nh.advertise<std_msgs::String>(topic, 10, boost::bind(&Teller::come, &teller, boost::placeholders::_1),
                                          boost::bind(&Teller::go, &teller, boost::placeholders::_1), tracked, latch);
}

int main(int argc, char **argv)
{
    ros::init(argc, argv, "advertised");
    ros::NodeHandle nh;

    ros::Publisher one = nh.advertise<std_msgs::String>("kept", 10, true);
    ros::Publisher two = nh.advertise<std_msgs::String>("kept", 10, true);
    ros::Publisher plain = nh.advertise<std_msgs::String>("kept", 10);
    one.publish(text("one"));
    two.publish(text("two"));
    plain.publish(text("plain"));
    std::printf("P| latched %d %d %d\n", one.isLatched(), two.isLatched(), plain.isLatched());
    {
        ros::Subscriber ear = nh.subscribe("kept", 10, hear);
        spin_for(0.5);
        show("two latched");
    }
    spin_for(0.3);
    one.shutdown();
    {
        ros::Subscriber ear = nh.subscribe("kept", 10, hear);
        spin_for(0.5);
        show("one of them");
    }
    spin_for(0.3);
    ros::Publisher copy = two;
    two = ros::Publisher();
    {
        ros::Subscriber ear = nh.subscribe("kept", 10, hear);
        spin_for(0.5);
        show("its copy");
    }
    copy.shutdown();
    spin_for(0.3);
    {
        ros::Subscriber ear = nh.subscribe("kept", 10, hear);
        spin_for(0.5);
        show("none");
    }

    Teller a{"a"}, b{"b"}, c{"c"};
    boost::shared_ptr<int> life = boost::make_shared<int>(1);
    ros::Publisher of_a = advertise(nh, "told", a, ros::VoidConstPtr());
    ros::Publisher of_b = advertise(nh, "told", b, ros::VoidConstPtr());
    ros::Publisher of_c = advertise(nh, "told", c, life);
    {
        ros::Subscriber ear = nh.subscribe("told", 10, hear);
        show("before it spins");
        spin_for(0.5);
        show("three");
    }
    spin_for(0.5);
    show("gone");
    of_b.shutdown();
    {
        ros::Subscriber ear = nh.subscribe("told", 10, hear);
        spin_for(0.5);
        show("without b");
        life.reset();
    }
    spin_for(0.5);
    show("gone, c untracked");
    {
        ros::Subscriber ear = nh.subscribe("told", 10, hear);
        spin_for(0.5);
        show("only a");
        of_a.shutdown();
    }
    spin_for(0.5);
    show("a was shut down");

    ros::Publisher again = advertise(nh, "again", a, ros::VoidConstPtr(), true);
    again.publish(text("latched"));
    ros::Subscriber ear = nh.subscribe("again", 10, hear);
    spin_for(0.5);
    show("latched first");
    std::printf("P| subscribers %u\n", again.getNumSubscribers());
    again.shutdown();
    spin_for(0.2);
    show("shut down");
    std::printf("P| valid %d, subscribers %u, topic [%s]\n", static_cast<bool>(again), again.getNumSubscribers(),
                again.getTopic().c_str());
}
