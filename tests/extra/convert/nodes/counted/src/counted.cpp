// Counts what is taken from the heap while the node works: its own operator new is the library's, too, since both are in
// one shared object.
#include <cstdlib>
#include <new>

#include <geometry_msgs/Twist.h>
#include <ros/ros.h>
#include <std_msgs/Int32.h>
#include <std_msgs/String.h>
#include <std_srvs/SetBool.h>

static int  g_before = 0, g_allocations = 0;
static bool g_counts = false;

void *operator new(std::size_t size)
{
    ++(g_counts ? g_allocations : g_before);
    return std::malloc(size);
}
void operator delete(void *memory) noexcept { std::free(memory); }
void operator delete(void *memory, std::size_t) noexcept { std::free(memory); }

static ros::Publisher g_twists, g_texts, g_latched;
static int            g_heard = 0, g_ticks = 0, g_calls = 0;

static void on_twist(const geometry_msgs::Twist::ConstPtr &message)
{
    ++g_heard;
    g_twists.publish(message);
}
static void on_text(const std_msgs::String &message)
{
    ++g_heard;
    g_texts.publish(message);
}
static void tick(const ros::TimerEvent &)
{
    std_msgs::Int32 message;
    message.data = ++g_ticks;
    g_latched.publish(message);
    ROS_INFO("tick %d", g_ticks);
    ROS_WARN_THROTTLE(1.0, "tick %d", g_ticks);
}
static bool set(std_srvs::SetBool::Request &request, std_srvs::SetBool::Response &response)
{
    response.success = request.data;
    return ++g_calls > 0;
}

// By names that have no room in a std::string itself: how many were there.
static int look_up(ros::NodeHandle &nh, ros::NodeHandle &own, const XmlRpc::XmlRpcValue &tree)
{
    double      number = 0;
    int         whole = 0, found = 0;
    found += nh.getParam("/a_number_with_quite_a_long_name", number) && number == 2.5;
    found += own.getParam("in_a_namespace_that_is_there/whole_number", whole) && whole == 7;
    found += own.getParamCached("in_a_namespace_that_is_there/whole_number", whole) && whole == 7;
    found += ros::param::get("~in_a_namespace_that_is_there/whole_number", whole) && whole == 7;
    found += nh.hasParam("a_number_with_quite_a_long_name") && !nh.hasParam("a_number_that_nobody_has_ever_set");
    found += own.param("a_number_that_nobody_has_ever_set", 9) == 9;
    found += tree.hasMember("whole_number_of_the_tree") && static_cast<int>(tree["whole_number_of_the_tree"]) == 8;
    return found;
}

int main(int argc, char **argv)
{
    ros::init(argc, argv, "counted");
    ros::NodeHandle nh, own("~");
    XmlRpc::XmlRpcValue tree;
    own.getParam("in_a_namespace_that_is_there", tree);
    g_twists                  = nh.advertise<geometry_msgs::Twist>("twists_out", 10);
    g_texts                   = nh.advertise<std_msgs::String>("texts_out", 10);
    g_latched                 = nh.advertise<std_msgs::Int32>("latched", 10, true);
    ros::Publisher     result = nh.advertise<std_msgs::String>("result", 10);
    ros::Subscriber    a      = nh.subscribe("twists", 4, on_twist);
    ros::Subscriber    b      = nh.subscribe("texts", 4, on_text);
    ros::Timer         timer  = nh.createTimer(ros::Duration(0.05), tick);
    ros::ServiceServer server = nh.advertiseService("set", set);
    ros::ServiceClient client = nh.serviceClient<std_srvs::SetBool>("helper");
    client.waitForExistence();
    std_srvs::SetBool call;
    for (ros::Time end = ros::Time::now() + ros::Duration(2.0); ros::Time::now() < end;) // memory finds its size
    {
        ros::spinOnce();
        client.call(call);
        look_up(nh, own, tree);
        ros::Duration(0.05).sleep();
    }
    g_heard = g_ticks = g_calls = 0;
    int answered = 0, found = 0;
    g_counts                    = true;
    ros::Rate rate(20);
    for (ros::Time end = ros::Time::now() + ros::Duration(5.0); ros::Time::now() < end;)
    {
        ros::spinOnce();
        answered += client.call(call);
        found += look_up(nh, own, tree);
        rate.sleep();
    }
    g_counts = false;
    std_msgs::String message;
    message.data = std::to_string(g_allocations) + " allocations" + (g_before > 9 ? ", many before, " : ", few before, ") + std::to_string(g_heard) + " heard, " +
                   std::to_string(g_ticks) + " ticks, " + std::to_string(g_calls) + " served, " +
                   std::to_string(answered) + " answered, " + std::to_string(found) + " found";
    result.publish(message);
    ros::spin();
}
