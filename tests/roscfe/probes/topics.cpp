// Queues, their order between topics, latched topics, shutdown and advertise anew, all in one node.
#include <cstdio>

#include <boost/bind/bind.hpp>
#include <ros/callback_queue.h>
#include <ros/ros.h>
#include <ros/topic.h>
#include <std_msgs/Int32.h>
#include <std_msgs/String.h>

using namespace boost::placeholders;

static void heard(const char *who, const std_msgs::Int32::ConstPtr &message)
{
    std::printf("P| %s %d\n", who, message->data);
}

static void settle()
{
    ros::Duration(0.2).sleep(); // what is sent arrives; nothing is called
}

static void spin()
{
    ros::spinOnce();
    std::printf("P| spun\n");
}

static void publish(const ros::Publisher &publisher, int data)
{
    std_msgs::Int32 message;
    message.data = data;
    publisher.publish(message);
    ros::Duration(0.03).sleep(); // otherwise roscpp's thread sends topic by topic
}

int main(int argc, char **argv)
{
    ros::init(argc, argv, "topics");
    ros::NodeHandle nh;
    ros::Publisher  a = nh.advertise<std_msgs::Int32>("a", 100), b = nh.advertise<std_msgs::Int32>("b", 100);
    ros::Subscriber first  = nh.subscribe<std_msgs::Int32>("a", 3, boost::bind(heard, "first a", _1));
    ros::Subscriber second = nh.subscribe<std_msgs::Int32>("b", 2, boost::bind(heard, "b", _1));
    settle();
    std::printf("P| subscribers %u %u, publishers %u\n", a.getNumSubscribers(), b.getNumSubscribers(), first.getNumPublishers());
    for (int i = 0; i < 5; ++i)
    {
        publish(a, i);
        publish(b, 10 + i);
    }
    settle();
    spin();
    ros::Subscriber third = nh.subscribe<std_msgs::Int32>("a", 1, boost::bind(heard, "third a", _1));
    settle();
    std::printf("P| subscribers %u\n", a.getNumSubscribers());
    for (int i = 20; i < 24; ++i)
    {
        publish(b, i);
        publish(a, i);
    }
    settle();
    spin();
    publish(a, 30);
    publish(b, 30);
    publish(a, 31);
    settle();
    ros::getGlobalCallbackQueue()->callOne();
    std::printf("P| one\n");
    first.shutdown();
    spin();
    std::printf("P| subscriber %d '%s', publishers %u\n", static_cast<bool>(first), first.getTopic().c_str(), first.getNumPublishers());
    third.shutdown();
    publish(a, 40);
    settle();
    spin();

    std::printf("P| latched\n");
    ros::Publisher latched = nh.advertise<std_msgs::Int32>("latched", 1, true);
    publish(latched, 50);
    publish(latched, 51);
    ros::Subscriber late = nh.subscribe<std_msgs::Int32>("latched", 5, boost::bind(heard, "late", _1));
    settle();
    spin();
    ros::Subscriber later = nh.subscribe<std_msgs::Int32>("latched", 5, boost::bind(heard, "later", _1));
    settle();
    spin();
    publish(latched, 52);
    settle();
    spin();
    std::printf("P| is latched %d %d\n", latched.isLatched(), a.isLatched());

    std::printf("P| shutdown\n");
    ros::Publisher copy = b;
    b.shutdown();
    std::printf("P| %d %d '%s' %u\n", static_cast<bool>(b), static_cast<bool>(copy), copy.getTopic().c_str(), copy.getNumSubscribers());
    settle();
    b = nh.advertise<std_msgs::Int32>("b", 100);
    settle();
    publish(b, 60);
    settle();
    spin();
    ros::Publisher twice = nh.advertise<std_msgs::Int32>("b", 100);
    b.shutdown();
    publish(twice, 61);
    settle();
    spin();
    try
    {
        ros::Publisher other = nh.advertise<std_msgs::String>("a", 1);
        std::printf("P| another type %d\n", static_cast<bool>(other));
    }
    catch (const ros::Exception &error)
    {
        std::printf("P| another type: %s\n", error.what());
    }
    try
    {
        nh.advertise<std_msgs::Int32>("bad name", 1);
    }
    catch (const ros::InvalidNameException &error)
    {
        std::printf("P| bad name: %s\n", error.what());
    }

    std::printf("P| waiting\n");
    std_msgs::Int32ConstPtr got = ros::topic::waitForMessage<std_msgs::Int32>("latched", ros::Duration(1));
    std::printf("P| got %d\n", got ? got->data : -1);
    got = ros::topic::waitForMessage<std_msgs::Int32>("silent", ros::Duration(0.3));
    std::printf("P| got %d\n", got ? got->data : -1);
    got = ros::topic::waitForMessage<std_msgs::Int32>("latched", nh);
    std::printf("P| got %d\n", got ? got->data : -1);

    std::printf("P| ok %d\n", ros::ok());
    ros::shutdown();
    std::printf("P| ok %d, shutting down %d, started %d, initialized %d\n", ros::ok(), ros::isShuttingDown(), ros::isStarted(), ros::isInitialized());
    return 0;
}
