// An arm of seven joints: 5,000 joint states at 1 kHz, and how many commands came.
// Queues of 1: two messages at once would be one.
#include <ros/ros.h>
#include <sensor_msgs/JointState.h>
#include <std_msgs/Float64MultiArray.h>
#include <std_msgs/String.h>

static int    g_commands = 0;
static double g_last     = 0;

static void command(const std_msgs::Float64MultiArray::ConstPtr &message)
{
    ++g_commands;
    g_last = message->data[6];
}

int main(int argc, char **argv)
{
    ros::Duration(0.2).sleep(); // before it is a node
    ros::init(argc, argv, "arm");
    ros::NodeHandle nh;
    ros::Publisher  out    = nh.advertise<std_msgs::String>("out", 1);
    ros::Publisher  states = nh.advertise<sensor_msgs::JointState>("joint_states", 1);
    ros::Subscriber in     = nh.subscribe("motor_command", 1, command, ros::TransportHints().tcpNoDelay());
    ros::Duration(1.0).sleep();
    sensor_msgs::JointState state;
    state.position.resize(7);
    ros::Rate rate(1000);
    for (int i = 1; i <= 5000; ++i)
    {
        state.header.stamp = ros::Time::now();
        state.position[6]  = i;
        states.publish(state);
        rate.sleep();
        ros::spinOnce();
    }
    std_msgs::String message;
    message.data = std::to_string(g_commands) + " commands, the last " + std::to_string(static_cast<int>(g_last));
    out.publish(message);
    ros::spin();
}
