// Queues: the oldest message makes room, queues of one's own are called when the node says so, and spinners.
#include <ros/callback_queue.h>
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

static void small(const std_msgs::Int32 &message) { say("small " + std::to_string(message.data)); }
static void medium(const std_msgs::Int32 &message) { say("medium " + std::to_string(message.data)); }
static void own(const std_msgs::Int32 &message) { say("own " + std::to_string(message.data)); }

int main(int argc, char **argv)
{
    ros::init(argc, argv, "twin");
    ros::NodeHandle nh, other;
    out = nh.advertise<std_msgs::String>("out", 100);
    ros::CallbackQueue queue;
    other.setCallbackQueue(&queue);
    ros::Subscriber a = nh.subscribe("in", 1, small);
    ros::Subscriber b = nh.subscribe("in", 4, medium);
    ros::Subscriber c = other.subscribe("in", 3, own);
    ros::Duration(3.5).sleep(); // a burst comes
    say("once");
    ros::spinOnce();
    say("own queue");
    queue.callOne();
    say("one");
    queue.callAvailable(ros::WallDuration());
    ros::Duration(1.0).sleep(); // another one
    say("both");
    queue.callAvailable();
    ros::spinOnce();
    say("asynchronous");
    ros::AsyncSpinner spinner(1);
    spinner.start();
    ros::Duration(2.2).sleep();
    spinner.stop();
    say("stopped");
    ros::Duration(0.55).sleep();
    say(queue.isEmpty() ? "empty" : "not empty");
    queue.clear();
    say("cleared");
    ros::MultiThreadedSpinner many(2);
    ros::spin(many);
}
