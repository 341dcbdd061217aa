// Queues of callbacks that callbacks fill, empty, clear and disable, and what a synchronizer gives up.
#include <cstdio>
#include <functional>
#include <string>

#include <geometry_msgs/PointStamped.h>
#include <message_filters/sync_policies/approximate_time.h>
#include <message_filters/sync_policies/exact_time.h>
#include <message_filters/synchronizer.h>
#include <message_filters/time_synchronizer.h>
#include <ros/callback_queue.h>
#include <ros/ros.h>
#include <std_msgs/String.h>

static std::string g_said;

static void say(const std::string &word) { g_said += word + " "; }

static void show(const char *what)
{
    std::printf("P| %s: %s\n", what, g_said.c_str());
    std::fflush(stdout);
    g_said.clear();
}

typedef std::function<void()> Action;

struct Callback : ros::CallbackInterface
{
    std::string name;
    Action      action;
    int         again = 0;
    bool        is_ready = true;

    Callback(const std::string &of, const Action &doing) : name(of), action(doing) {}
    CallResult call() override
    {
        if (again > 0)
        {
            --again;
            say(name + "?");
            return TryAgain;
        }
        say(name);
        if (action)
        {
            action();
        }
        say("/" + name);
        return Success;
    }
    bool ready() override { return is_ready; }
};

static boost::shared_ptr<Callback> add(ros::CallbackQueue &queue, const std::string &name, const Action &action = Action(),
                                       int again = 0, bool is_ready = true, std::uint64_t owner = 0)
{
    boost::shared_ptr<Callback> made(new Callback(name, action));
    made->again    = again;
    made->is_ready = is_ready;
    queue.addCallback(made, owner);
    return made;
}

static const char *result_of(ros::CallbackQueue::CallOneResult result)
{
    switch (result)
    {
        case ros::CallbackQueue::Called:
            return "called";
        case ros::CallbackQueue::TryAgain:
            return "try_again";
        case ros::CallbackQueue::Disabled:
            return "disabled";
        default:
            return "empty";
    }
}

static void nested()
{
    ros::CallbackQueue queue;
    add(queue, "a", [&]() { queue.callAvailable(ros::WallDuration(0)); });
    add(queue, "b");
    add(queue, "c");
    queue.callAvailable(ros::WallDuration(0));
    show("nested, nothing new");

    add(queue, "a", [&]() {
        add(queue, "new");
        queue.callAvailable(ros::WallDuration(0));
    });
    add(queue, "b");
    add(queue, "c");
    queue.callAvailable(ros::WallDuration(0));
    show("nested, one new");

    add(queue, "a", [&]() {
        add(queue, "new");
        say(result_of(queue.callOne(ros::WallDuration(0))));
        say(result_of(queue.callOne(ros::WallDuration(0))));
    });
    add(queue, "b");
    queue.callAvailable(ros::WallDuration(0));
    show("nested callOne");

    add(queue, "a", [&]() { add(queue, "late"); });
    add(queue, "b");
    queue.callAvailable(ros::WallDuration(0));
    show("added by a callback");
    queue.callAvailable(ros::WallDuration(0));
    show("the next time");

    add(queue, "a", [&]() {
        add(queue, "one");
        queue.callAvailable(ros::WallDuration(0));
        add(queue, "two");
    });
    add(queue, "b");
    add(queue, "c");
    queue.callAvailable(ros::WallDuration(0));
    show("nested, and one after it");
    queue.callAvailable(ros::WallDuration(0));
    show("the next time");

    add(queue, "a", [&]() {
        say(queue.isEmpty() ? "is_empty" : "is_not_empty");
        say(queue.empty() ? "empty" : "not_empty");
    });
    queue.callAvailable(ros::WallDuration(0));
    say(queue.isEmpty() ? "is_empty" : "is_not_empty");
    show("the last one sees its queue");
    add(queue, "a", [&]() { say(queue.isEmpty() ? "is_empty" : "is_not_empty"); });
    say(result_of(queue.callOne(ros::WallDuration(0))));
    show("by callOne");
}

static void changed()
{
    ros::CallbackQueue queue;
    add(queue, "a", [&]() { queue.clear(); });
    add(queue, "b");
    queue.callAvailable(ros::WallDuration(0));
    show("cleared by a callback");

    add(queue, "a", [&]() {
        add(queue, "new");
        queue.clear();
    });
    add(queue, "b");
    queue.callAvailable(ros::WallDuration(0));
    queue.callAvailable(ros::WallDuration(0));
    show("cleared with one more");

    add(queue, "a", [&]() { queue.disable(); });
    add(queue, "b");
    queue.callAvailable(ros::WallDuration(0));
    say(result_of(queue.callOne(ros::WallDuration(0))));
    add(queue, "ignored");
    show("disabled by a callback");
    queue.enable();
    queue.callAvailable(ros::WallDuration(0));
    show("enabled again");

    add(queue, "a", [&]() { queue.removeByID(7); }, 0, true, 3);
    add(queue, "b", Action(), 0, true, 7);
    add(queue, "c", Action(), 0, true, 3);
    add(queue, "d", Action(), 0, true, 7);
    queue.callAvailable(ros::WallDuration(0));
    show("removed by a callback");

    add(queue, "a", [&]() { queue.removeByID(3); }, 0, true, 3);
    add(queue, "b", Action(), 0, true, 3);
    add(queue, "c");
    queue.callAvailable(ros::WallDuration(0));
    show("removed with its own");

    add(queue, "a", Action(), 2);
    add(queue, "b");
    queue.callAvailable(ros::WallDuration(0));
    show("one that tries again");
    queue.callAvailable(ros::WallDuration(0));
    show("once more");
    queue.callAvailable(ros::WallDuration(0));
    show("and again");

    add(queue, "a", Action(), 0, false)->name = "not_ready";
    add(queue, "b");
    say(result_of(queue.callOne(ros::WallDuration(0))));
    say(result_of(queue.callOne(ros::WallDuration(0))));
    show("one that is not ready");
    queue.callAvailable(ros::WallDuration(0));
    show("by callAvailable");
}

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

static void with_topics()
{
    ros::NodeHandle nh;
    ros::Publisher  one = nh.advertise<std_msgs::String>("queues_one", 10), two = nh.advertise<std_msgs::String>("queues_two", 10);
    bool            is_first = true;
    ros::Subscriber hear_one = nh.subscribe<std_msgs::String>("queues_one", 10, [&](const std_msgs::String::ConstPtr &message) {
        say(message->data);
        if (is_first)
        {
            is_first = false;
            two.publish(text("inner"));
            ros::Duration(0.3).sleep();
            ros::spinOnce();
        }
        say("/" + message->data);
    });
    ros::Subscriber hear_two = nh.subscribe<std_msgs::String>(
        "queues_two", 10, [&](const std_msgs::String::ConstPtr &message) { say(message->data); });
    spin_for(0.5);
    one.publish(text("first"));
    one.publish(text("second"));
    ros::Duration(0.3).sleep();
    spin_for(1.0);
    show("spinOnce in a callback");
}

typedef geometry_msgs::PointStamped         Point;
typedef boost::shared_ptr<Point const>      PointPtr;
typedef message_filters::sync_policies::ExactTime<Point, Point>       Exact;
typedef message_filters::sync_policies::ApproximateTime<Point, Point> Approximate;

static PointPtr at(double stamp)
{
    boost::shared_ptr<Point> made(new Point);
    made->header.stamp = ros::Time(stamp);
    return made;
}

static std::string stamps(const PointPtr &a, const PointPtr &b)
{
    const auto one = [](const PointPtr &each) { return each ? std::to_string(each->header.stamp.sec) : std::string("none"); };
    return one(a) + "," + one(b);
}

struct Lost
{
    void give_up(const PointPtr &a, const PointPtr &b) { say("method:" + stamps(a, b)); }
};

static void meet(const PointPtr &a, const PointPtr &b) { say("pair:" + stamps(a, b)); }

static void give_up(const PointPtr &a, const PointPtr &b) { say("lost:" + stamps(a, b)); }

static void synchronized()
{
    message_filters::Synchronizer<Exact> pairs(Exact(2));
    Lost                                 lost;
    pairs.registerCallback(meet);
    pairs.registerDropCallback(give_up);
    message_filters::Connection also = pairs.getPolicy()->registerDropCallback(&Lost::give_up, &lost);
    pairs.add<0>(at(1));
    pairs.add<1>(at(2));
    pairs.add<0>(at(3));
    show("queue of two");
    pairs.add<1>(at(3));
    show("a later pair is whole");
    also.disconnect();
    pairs.add<0>(at(4));
    pairs.add<0>(at(5));
    pairs.add<0>(at(6));
    show("without the method");

    message_filters::TimeSynchronizer<Point, Point> by_time(1);
    by_time.registerDropCallback(give_up);
    by_time.add<0>(at(1));
    by_time.add<0>(at(2));
    show("time synchronizer");
}

int main(int argc, char **argv)
{
    ros::init(argc, argv, "probe");
    ros::NodeHandle nh;
    nested();
    changed();
    with_topics();
    synchronized();
    return 0;
}
