// A controller: a command for each joint state.
// Queues of 1: two messages at once would be one.
#include <ros/ros.h>
#include <sensor_msgs/JointState.h>
#include <std_msgs/Float64MultiArray.h>

static ros::Publisher g_commands;

static void state(const sensor_msgs::JointState::ConstPtr &message)
{
    std_msgs::Float64MultiArray command;
    for (double position : message->position)
    {
        command.data.push_back(-2 * position);
    }
    g_commands.publish(command);
}

int main(int argc, char **argv)
{
    ros::init(argc, argv, "control");
    ros::NodeHandle nh;
    g_commands         = nh.advertise<std_msgs::Float64MultiArray>("motor_command", 1);
    ros::Subscriber in = nh.subscribe("joint_states", 1, state, ros::TransportHints().tcpNoDelay());
    ros::spin();
}
