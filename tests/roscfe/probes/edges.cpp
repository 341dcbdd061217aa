// Handles of nothing, things that end before their turn comes, objects that are gone when their callback would run, and
// periods that change in the middle of a cycle.
#include <cmath>
#include <cstdio>
#include <map>
#include <string>

#include <boost/make_shared.hpp>
#include <ros/callback_queue.h>
#include <ros/ros.h>
#include <std_msgs/Int32.h>
#include <std_msgs/String.h>
#include <std_srvs/Empty.h>
#include <std_srvs/SetBool.h>

#define PRINT(expression) std::printf("P| " #expression ": %d\n", static_cast<int>(expression))

static void spin(int times = 20)
{
    for (int i = 0; i < times; ++i)
    {
        ros::Duration(0.01).sleep();
        ros::spinOnce();
    }
}

static void nothing()
{
    std::printf("P| nothing\n");
    ros::Timer timer, other;
    timer.start();
    timer.stop();
    timer.setPeriod(ros::Duration(1));
    PRINT(timer.hasStarted());
    PRINT(timer.hasPending());
    PRINT(timer.isValid());
    PRINT(timer == other);
    PRINT(timer < other);
    ros::WallTimer wall;
    wall.start();
    wall.stop();
    PRINT(wall.hasPending());
    ros::Publisher publisher;
    PRINT(publisher.getNumSubscribers());
    PRINT(publisher.getTopic().empty());
    PRINT(static_cast<bool>(publisher));
    publisher.shutdown();
    ros::Subscriber subscriber;
    PRINT(subscriber.getNumPublishers());
    PRINT(subscriber.getTopic().empty());
    subscriber.shutdown();
    ros::ServiceClient client;
    client.shutdown();
    PRINT(client.getService().empty());
    PRINT(client.isPersistent());
    std_msgs::Int32::ConstPtr message = ros::topic::waitForMessage<std_msgs::Int32>("never", ros::Duration(0.05));
    PRINT(static_cast<bool>(message));
}

static int  g_fired = 0;
static void fire(const ros::TimerEvent &) { ++g_fired; }

struct Tracked
{
    int  heard = 0;
    void hear(const std_msgs::Int32::ConstPtr &) { ++heard; }
    void fire(const ros::TimerEvent &) { ++heard; }
    bool serve(std_srvs::Empty::Request &, std_srvs::Empty::Response &)
    {
        ++heard;
        return true;
    }
};

static void timers(ros::NodeHandle &node)
{
    std::printf("P| timers\n");
    ros::Timer timer = node.createTimer(ros::Duration(0.05), fire);
    ros::Duration(0.12).sleep();
    PRINT(timer.hasPending());
    timer.stop(); // while its callback may wait
    spin(3);
    PRINT(g_fired <= 1);
    PRINT(timer.hasPending());
    PRINT(timer.hasStarted());
    g_fired = 0;
    timer.start();
    timer.start();
    spin(12);
    PRINT(g_fired);
    timer.setPeriod(ros::Duration(1), false); // longer, in the middle of a cycle
    g_fired = 0;
    spin(20);
    PRINT(g_fired);
    timer.setPeriod(ros::Duration(0.02), false); // shorter than what has passed
    g_fired = 0;
    spin(3);
    PRINT(g_fired > 0);
    timer.setPeriod(ros::Duration(0.5));
    g_fired = 0;
    spin(20);
    PRINT(g_fired);
    timer = ros::Timer();

    boost::shared_ptr<Tracked> tracked = boost::make_shared<Tracked>();
    ros::Timer                 of_it   = node.createTimer(ros::Duration(0.02), &Tracked::fire, tracked);
    spin(5);
    PRINT(tracked->heard > 0);
    tracked.reset();
    spin(5);
    ros::Timer once = node.createTimer(ros::Duration(0.02), fire, true);
    g_fired         = 0;
    spin(10);
    PRINT(g_fired);
    PRINT(once.hasStarted());
    ros::Timer late = node.createTimer(ros::Duration(0.02), fire, true, false);
    g_fired         = 0;
    spin(5);
    PRINT(g_fired);
    late.start();
    spin(5);
    PRINT(g_fired);
}

static int  g_number = 0;
static void hear(const std_msgs::Int32::ConstPtr &message) { g_number = message->data; }

static void topics(ros::NodeHandle &node)
{
    std::printf("P| topics\n");
    ros::CallbackQueue own;
    ros::NodeHandle    with_own(node);
    with_own.setCallbackQueue(&own);
    ros::Publisher  publisher  = node.advertise<std_msgs::Int32>("a", 5);
    ros::Subscriber subscriber = with_own.subscribe("a", 2, hear);
    spin(10);
    std_msgs::Int32 message;
    for (message.data = 1; message.data <= 4; ++message.data)
    {
        publisher.publish(message);
    }
    spin(3);
    PRINT(g_number);
    own.callOne();
    PRINT(g_number);
    PRINT(own.isEmpty());
    own.disable();
    PRINT(own.isEnabled());
    own.callAvailable();
    PRINT(g_number);
    own.enable();
    publisher.publish(message);
    spin(3);
    subscriber.shutdown(); // before its callbacks have run
    own.callAvailable(ros::WallDuration(0.01));
    PRINT(g_number);
    PRINT(own.callOne(ros::WallDuration(0.01)));
    own.clear();

    boost::shared_ptr<Tracked> tracked = boost::make_shared<Tracked>();
    ros::Subscriber            of_it   = node.subscribe("a", 5, &Tracked::hear, tracked);
    spin(10);
    publisher.publish(message);
    spin(5);
    PRINT(tracked->heard);
    boost::weak_ptr<Tracked> weak = tracked;
    publisher.publish(message);
    tracked.reset();
    spin(5);
    PRINT(weak.expired());
    ros::Publisher copy = publisher;
    publisher.shutdown();
    publisher.shutdown();
    PRINT(static_cast<bool>(copy));
    PRINT(copy.getNumSubscribers());
}

static bool set(std_srvs::SetBool::Request &, std_srvs::SetBool::Response &response)
{
    response.success = true;
    return true;
}

static void services(ros::NodeHandle &node)
{
    std::printf("P| services\n");
    ros::AsyncSpinner spinner(1);
    spinner.start();
    ros::ServiceServer       server = node.advertiseService("set", set);
    ros::ServiceClientOptions options;
    options.init<std_srvs::SetBool>("set", true, ros::M_string());
    ros::ServiceClient client = node.serviceClient(options);
    std_srvs::SetBool  call;
    PRINT(client.call(call));
    PRINT(client.isPersistent());
    PRINT(client.isValid());
    server.shutdown();
    ros::Duration(0.1).sleep();
    PRINT(client.call(call));
    PRINT(client.isValid());
    PRINT(ros::service::exists("set", true));
    boost::shared_ptr<Tracked> tracked = boost::make_shared<Tracked>();
    ros::ServiceServer         of_it   = node.advertiseService("empty", &Tracked::serve, tracked);
    std_srvs::Empty            empty;
    PRINT(ros::service::call("empty", empty));
    PRINT(tracked->heard);
    spinner.stop();
    spinner.stop();
}

int main(int argc, char **argv)
{
    ros::init(argc, argv, "edges");
    const char *words[] = {"edges", "_a:=1", "b:=2"};
    std::printf("P| '%s' '%s'\n", ros::getROSArg(3, words, "b").c_str(), ros::getROSArg(3, words, "c").c_str());
    ros::NodeHandle node;
    ros::init(argc, argv, "again");
    std::printf("P| %s\n", ros::this_node::getName().c_str());
    nothing();
    timers(node);
    topics(node);
    services(node);
    ros::requestShutdown();
    ros::waitForShutdown();
    PRINT(ros::isShuttingDown());
    return 0;
}
