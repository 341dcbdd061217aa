// Latched topics: those of others that the node hears late, and its own that others hear late.
#include <ros/ros.h>
#include <std_msgs/Int32.h>
#include <std_msgs/String.h>

static ros::Publisher out;

static void say(const std::string &what)
{
    std_msgs::String message;
    message.data = what;
    out.publish(message);
}

static void heard(const std_msgs::Int32::ConstPtr &message) { say("heard " + std::to_string(message->data)); }
static void comes(const ros::SingleSubscriberPublisher &) { say("comes"); }
static void greet(const ros::SingleSubscriberPublisher &who)
{
    std_msgs::Int32 message;
    message.data = 77;
    who.publish(message);
}

int main(int argc, char **argv)
{
    ros::init(argc, argv, "twin");
    ros::NodeHandle nh;
    out                   = nh.advertise<std_msgs::String>("out", 100);
    ros::Publisher  state = nh.advertise<std_msgs::Int32>("state", 1, true);
    ros::Publisher  watched = nh.advertise<std_msgs::Int32>("watched", 5, ros::SubscriberStatusCallback(comes));
    ros::Publisher  greeting = nh.advertise<std_msgs::Int32>("greeting", 5, ros::SubscriberStatusCallback(greet));
    std_msgs::Int32 message;
    for (int i = 1; i <= 3; ++i)
    {
        message.data = i;
        state.publish(message); // the last one stays
    }
    ros::Duration(2.0).sleep();
    ros::Subscriber first = nh.subscribe("goal", 10, heard);
    ros::Duration(0.08).sleep(); // rospy takes 50 ms to connect
    ros::Rate       rate(10);
    for (int i = 0; ros::ok(); ++i)
    {
        if (i == 30)
        {
            first.shutdown();
            message.data = 4;
            state.publish(message);
        }
        if (i == 40)
        {
            first = nh.subscribe("goal", 10, heard); // and hears the latched message anew
            ros::Duration(0.08).sleep(); // rospy takes 50 ms to connect
            say(std::to_string(state.getNumSubscribers()) + " hear state, " + std::to_string(watched.getNumSubscribers()) +
                " watch");
        }
        if (i == 60)
        {
            const ros::Time         begun = ros::Time::now();
            std_msgs::Int32ConstPtr one = ros::topic::waitForMessage<std_msgs::Int32>("other", nh, ros::Duration(1.0));
            ros::Time::sleepUntil(begun + ros::Duration(0.2));
            say(one ? "waited for " + std::to_string(one->data) : "waited in vain");
            ros::Duration(0.5).sleep();
            one = ros::topic::waitForMessage<std_msgs::Int32>("silent", ros::Duration(0.4));
            say(one ? "came" : "nothing came");
        }
        ros::spinOnce();
        rate.sleep();
    }
}
