// Services of one node that calls itself: their names, their beginning and end, and clients of each kind.
#include <cstdio>

#include <ros/ros.h>
#include <roscpp/SetLoggerLevel.h>
#include <std_srvs/Empty.h>
#include <std_srvs/SetBool.h>
#include <std_srvs/Trigger.h>

#define PRINT(expression) std::printf("P| " #expression ": %d\n", static_cast<int>(expression))

static int g_calls = 0;

static bool set(std_srvs::SetBool::Request &request, std_srvs::SetBool::Response &response)
{
    ++g_calls;
    response.success = request.data;
    response.message = request.data ? "on" : "off";
    return true;
}

static bool fail(std_srvs::Empty::Request &, std_srvs::Empty::Response &)
{
    ++g_calls;
    return false;
}

struct Server
{
    bool trigger(std_srvs::Trigger::Request &, std_srvs::Trigger::Response &response)
    {
        response.success = true;
        response.message = "pulled";
        return true;
    }
};

static void call(const char *what, ros::ServiceClient &client, bool data)
{
    std_srvs::SetBool call;
    call.request.data = data;
    const bool good   = client.call(call);
    std::printf("P| %s: %d %d '%s'\n", what, good, call.response.success, call.response.message.c_str());
}

static void lives()
{
    ros::NodeHandle    node;
    ros::ServiceServer none;
    PRINT(static_cast<bool>(none));
    PRINT(none.getService().empty());
    none.shutdown();
    ros::ServiceServer server = node.advertiseService("set", set);
    PRINT(static_cast<bool>(server));
    std::printf("P| %s\n", server.getService().c_str());
    PRINT(ros::service::exists("set", false));
    PRINT(ros::service::exists("/probes/set", true));
    PRINT(ros::service::exists("nothing", false));
    PRINT(ros::service::waitForService("set", 1000));
    PRINT(ros::service::waitForService("set", ros::Duration(1)));
    PRINT(ros::service::waitForService("nothing", 50));
    PRINT(ros::service::waitForService("nothing", ros::Duration(0.05)));
    ros::ServiceServer copy = server;
    PRINT(copy == server);
    PRINT(copy != server);
    ros::ServiceClient client = node.serviceClient<std_srvs::SetBool>("set");
    PRINT(client.exists());
    PRINT(client.isValid());
    PRINT(client.isPersistent());
    std::printf("P| %s\n", client.getService().c_str());
    PRINT(client.waitForExistence(ros::Duration(1)));
    call("on", client, true);
    call("off", client, false);
    server.shutdown();
    PRINT(static_cast<bool>(copy));
    PRINT(client.exists());
    PRINT(client.waitForExistence(ros::Duration(0.05)));
    call("gone", client, true);
    server = node.advertiseService("set", set);
    call("again", client, true);
    client.shutdown();
    PRINT(client.isValid());
    PRINT(static_cast<bool>(client));
    call("shut", client, true);
    PRINT(g_calls);
}

static void kinds()
{
    ros::NodeHandle    node, own("~");
    Server             object;
    ros::ServiceServer set_server  = node.advertiseService("set", set);
    ros::ServiceServer failing     = node.advertiseService("fail", fail);
    ros::ServiceServer of_object   = own.advertiseService("trigger", &Server::trigger, &object);
    const boost::function<bool(std_srvs::Trigger::Request &, std_srvs::Trigger::Response &)> plain =
        [](std_srvs::Trigger::Request &, std_srvs::Trigger::Response &response) {
            response.message = "lambda";
            return true;
        };
    ros::ServiceServer of_function = node.advertiseService("lambda", plain);
    std_srvs::Trigger pull;
    PRINT(ros::service::call("~trigger", pull));
    std::printf("P| %s\n", pull.response.message.c_str());
    PRINT(ros::service::call("lambda", pull));
    std::printf("P| %s\n", pull.response.message.c_str());
    std_srvs::Empty empty;
    PRINT(ros::service::call("fail", empty));
    PRINT(ros::service::call("nothing", empty));
    ros::ServiceClient persistent = node.serviceClient<std_srvs::SetBool>("set", true);
    PRINT(persistent.isPersistent());
    PRINT(persistent.isValid());
    call("persistent", persistent, true);
    call("persistent", persistent, false);
    ros::ServiceClient wrong = node.serviceClient<std_srvs::Trigger>("set");
    PRINT(wrong.call(pull));
    ros::ServiceClient none;
    PRINT(none.isValid());
    PRINT(none.exists());
    PRINT(none.waitForExistence(ros::Duration(0.01)));
    PRINT(none.call(pull));
    PRINT(none.getService().empty());
    PRINT(none == persistent);
    set_server.shutdown();
    ros::WallDuration(0.1).sleep();
    PRINT(persistent.isValid());
    call("persistent, gone", persistent, true);
    ros::ServiceServer next = node.advertiseService("set", set);
    PRINT(persistent.isValid());
    ros::ServiceClient linked = node.serviceClient<std_srvs::SetBool>("set", true);
    call("persistent, anew", linked, true);
    ros::ServiceClient other = linked;
    linked.shutdown();
    PRINT(other.isValid());
    PRINT(other.exists());
    call("persistent, shut", linked, true);
}

int main(int argc, char **argv)
{
    ros::init(argc, argv, "probe");
    ros::NodeHandle   node;
    ros::AsyncSpinner spinner(1);
    spinner.start();
    spinner.start();
    lives();
    kinds();
    ros::ServiceServer late = node.advertiseService("late", set);
    spinner.stop();
    spinner.stop();
    ros::shutdown();
    PRINT(static_cast<bool>(node.advertiseService("never", set)));
    PRINT(ros::service::exists("late", false));
    return 0;
}
