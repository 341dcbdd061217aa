// Each form of a callback that ros::NodeHandle::subscribe takes; what is heard goes out with the form's name.
#include <boost/bind.hpp>
#include <boost/function.hpp>
#include <ros/ros.h>
#include <std_msgs/Int32.h>
#include <std_msgs/String.h>

static ros::Publisher out;

static void say(const std::string &form, int value)
{
    std_msgs::String message;
    message.data = form + " " + std::to_string(value);
    out.publish(message);
}

void by_pointer(const std_msgs::Int32::ConstPtr &message) { say("function, ConstPtr", message->data); }
void by_pointer_value(std_msgs::Int32ConstPtr message) { say("function, ConstPtr by value", message->data); }
void by_reference(const std_msgs::Int32 &message) { say("function, const&", message.data); }
void by_value(std_msgs::Int32 message) { say("function, by value", message.data); }
void by_changeable(const std_msgs::Int32::Ptr &message)
{
    message->data += 1000;
    say("function, Ptr", message->data);
}
void by_event(const ros::MessageEvent<std_msgs::Int32 const> &event) { say("function, MessageEvent", event.getMessage()->data); }
void by_changeable_event(const ros::MessageEvent<std_msgs::Int32> &event)
{
    event.getMessage()->data += 2000;
    say("function, MessageEvent of a message that may change", event.getMessage()->data);
}
void with_more(const std_msgs::Int32::ConstPtr &message, const std::string &text, int more)
{
    say("bind, " + text, message->data + more);
}

struct Listener
{
    int  heard = 0;
    void method(const std_msgs::Int32::ConstPtr &message) { say("method " + std::to_string(++heard), message->data); }
    void const_method(const std_msgs::Int32 &message) const { say("const method", message.data); }
    void event_method(const ros::MessageEvent<std_msgs::Int32 const> &event)
    {
        say("method, MessageEvent", event.getConstMessage()->data);
    }
    void bound(const std_msgs::Int32::ConstPtr &message, char which) { say(std::string("bound method ") + which, message->data); }
};

int main(int argc, char **argv)
{
    ros::init(argc, argv, "twin");
    ros::NodeHandle nh;
    out = nh.advertise<std_msgs::String>("out", 100);
    Listener                    listener;
    boost::shared_ptr<Listener> shared(new Listener);
    boost::shared_ptr<Listener> dropped(new Listener);
    std::vector<ros::Subscriber> all;
    all.push_back(nh.subscribe("in", 10, by_pointer));
    all.push_back(nh.subscribe("in", 10, &by_pointer_value));
    all.push_back(nh.subscribe("in", 10, by_reference));
    all.push_back(nh.subscribe("in", 10, by_value));
    all.push_back(nh.subscribe("in", 10, by_changeable));
    all.push_back(nh.subscribe("in", 10, by_event));
    all.push_back(nh.subscribe("in", 10, by_changeable_event));
    all.push_back(nh.subscribe<std_msgs::Int32>("in", 10, boost::bind(with_more, _1, "more", 100)));
    all.push_back(nh.subscribe("in", 10, &Listener::method, &listener));
    all.push_back(nh.subscribe("in", 10, &Listener::const_method, &listener));
    all.push_back(nh.subscribe("in", 10, &Listener::event_method, &listener, ros::TransportHints().tcpNoDelay()));
    all.push_back(nh.subscribe<std_msgs::Int32>("in", 10, boost::bind(&Listener::bound, &listener, _1, 'b')));
    all.push_back(nh.subscribe("in", 10, &Listener::method, shared));
    all.push_back(nh.subscribe("in", 10, &Listener::method, dropped));
    boost::function<void(const std_msgs::Int32::ConstPtr &)> function = by_pointer;
    all.push_back(nh.subscribe<std_msgs::Int32>("in", 10, function));
    boost::function<void(const std_msgs::Int32 &)> of_reference = by_reference;
    all.push_back(nh.subscribe<std_msgs::Int32>("in", 10, of_reference));
    int sum = 0;
    all.push_back(nh.subscribe<std_msgs::Int32>("in", 10, [&sum](const std_msgs::Int32::ConstPtr &message) {
        sum += message->data;
        say("lambda", sum);
    }));
    {
        ros::SubscribeOptions options = // holds what is tracked as long as it lives
            ros::SubscribeOptions::create<std_msgs::Int32>("in", 10, by_pointer, shared, ros::getGlobalCallbackQueue());
        all.push_back(nh.subscribe(options));
    }
    ros::Subscriber gone = nh.subscribe("in", 10, by_pointer);
    gone.shutdown();
    dropped.reset(); // what it hears is not called any more
    ros::Duration(4.5).sleep();
    ros::Rate rate(10);
    for (int i = 0; ros::ok(); ++i)
    {
        ros::spinOnce();
        if (i == 15)
        {
            shared.reset(); // neither what is tracked by it
        }
        rate.sleep();
    }
    return 0;
}
