// Says all kinds of things after its start: a latched text, joint states, a message longer than a packet, answers.
#include <ros/ros.h>
#include <sensor_msgs/JointState.h>
#include <std_msgs/String.h>
#include <std_msgs/UInt8MultiArray.h>
#include <std_srvs/SetBool.h>

static int g_calls = 0;

static bool answer(std_srvs::SetBool::Request &request, std_srvs::SetBool::Response &response)
{
    ++g_calls;
    response.success = !request.data;
    response.message = "an answer, and no short one at that";
    return g_calls != 2; // the second call fails
}

int main(int argc, char **argv)
{
    ros::init(argc, argv, "speaker");
    ros::NodeHandle    nh;
    ros::Publisher     greeting = nh.advertise<std_msgs::String>("greeting", 1, true);
    ros::Publisher     states   = nh.advertise<sensor_msgs::JointState>("states", 10);
    ros::Publisher     large    = nh.advertise<std_msgs::UInt8MultiArray>("large", 1);
    ros::ServiceServer server   = nh.advertiseService("answer", answer);
    static std_msgs::String          text;
    static sensor_msgs::JointState   state;
    static std_msgs::UInt8MultiArray bytes;
    ros::Rate rate(20);
    ros::spinOnce(); // the start ends here: memory after it would be the end
    while (ros::ok() && (states.getNumSubscribers() == 0 || large.getNumSubscribers() == 0))
    {
        rate.sleep();
    }
    text.data = "a greeting that is latched, long enough for the heap";
    greeting.publish(text);
    state.name = {"first", "second"};
    for (int i = 0; ros::ok() && i < 10; ++i)
    {
        state.header.stamp.fromSec(100 + i);
        state.position.push_back(i / 3.0);
        state.effort.assign(3, -i);
        states.publish(state);
        ros::spinOnce();
        rate.sleep();
    }
    for (int i = 0; i < 40000; ++i)
    {
        bytes.data.push_back(static_cast<std::uint8_t>(i * i % 251));
    }
    large.publish(bytes);
    ros::spin();
}
