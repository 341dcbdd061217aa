// Services: those of the node, and those that it calls.
#include <ros/ros.h>
#include <rospy_tutorials/AddTwoInts.h>
#include <std_msgs/String.h>
#include <std_srvs/Empty.h>
#include <std_srvs/SetBool.h>
#include <std_srvs/Trigger.h>

static ros::Publisher out;

static void say(const std::string &what)
{
    std_msgs::String message;
    message.data = what;
    out.publish(message);
}

static bool add(rospy_tutorials::AddTwoInts::Request &request, rospy_tutorials::AddTwoInts::Response &response)
{
    response.sum = request.a + request.b;
    say("add " + std::to_string(response.sum));
    return true;
}

struct Server
{
    int  calls = 0;
    bool set(std_srvs::SetBool::Request &request, std_srvs::SetBool::Response &response)
    {
        response.success = request.data;
        response.message = "call " + std::to_string(++calls);
        say("set " + response.message);
        return calls != 2; // the second call fails
    }
    bool event(ros::ServiceEvent<std_srvs::Trigger::Request, std_srvs::Trigger::Response> &event)
    {
        event.getResponse().message = "of an event";
        say("trigger");
        return true;
    }
};

int main(int argc, char **argv)
{
    ros::init(argc, argv, "twin");
    ros::NodeHandle nh, own("~");
    out = nh.advertise<std_msgs::String>("out", 100);
    ros::Duration(1.0).sleep();
    Server             server;
    ros::ServiceServer a = nh.advertiseService("add", add);
    ros::ServiceServer b = nh.advertiseService("set", &Server::set, &server);
    ros::ServiceServer c = nh.advertiseService("trigger", &Server::event, &server);
    boost::function<bool(std_srvs::Empty::Request &, std_srvs::Empty::Response &)> empty =
        [](std_srvs::Empty::Request &, std_srvs::Empty::Response &) {
            say("empty");
            return true;
        };
    ros::ServiceServer d = own.advertiseService("empty", empty);
    say(std::string("none ") + (ros::service::exists("nowhere", false) ? "there" : "not there"));
    // How soon somebody who waits sees a service is another matter in rospy, which looks every 0.3 s.
    const ros::Time begun = ros::Time::now();
    const bool      there = ros::service::waitForService("nowhere", ros::Duration(0.5));
    ros::Time::sleepUntil(begun + ros::Duration(1.0));
    say(std::string("wait ") + (there ? "there" : "not there"));
    ros::ServiceClient times = nh.serviceClient<rospy_tutorials::AddTwoInts>("times");
    times.waitForExistence();
    ros::Time::sleepUntil(begun + ros::Duration(2.5));
    rospy_tutorials::AddTwoInts call;
    for (int i = 0; i < 3; ++i)
    {
        call.request.a = i + 6;
        call.request.b = 7;
        say(times.call(call) ? "times " + std::to_string(call.response.sum) : "times failed");
    }
    call.request.a = -1; // which its server refuses
    say(times.call(call) ? "times " + std::to_string(call.response.sum) : "times failed");
    ros::ServiceClient persistent = nh.serviceClient<rospy_tutorials::AddTwoInts>("times", true);
    rospy_tutorials::AddTwoInts::Request  request;
    rospy_tutorials::AddTwoInts::Response response;
    request.a = 3;
    request.b = 5;
    say(persistent.call(request, response) ? "persistent " + std::to_string(response.sum) : "persistent failed");
    say(ros::service::call("times", call) ? "bare call" : "bare call failed");
    call.request.a = 9;
    say(ros::service::call("times", call) ? "bare " + std::to_string(call.response.sum) : "bare call failed");
    std_srvs::Trigger nobody;
    say(ros::service::call("nowhere", nobody) ? "nobody" : "nobody there");
    ros::Timer gone = nh.createTimer(ros::Duration(5.0), [&](const ros::TimerEvent &) { a.shutdown(); }, true);
    ros::spin();
}
