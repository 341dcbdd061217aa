// Hears the speaker, calls it, and says of each message how long its bytes are and what they sum up to.
#include <ros/ros.h>
#include <ros/serialization.h>
#include <sensor_msgs/JointState.h>
#include <std_msgs/String.h>
#include <std_msgs/UInt8MultiArray.h>
#include <std_srvs/SetBool.h>

static std::uint8_t g_bytes[65536];
static bool         g_all = false;

// FNV-1a.
template <class M>
void tell(const char *topic, const M &message)
{
    const std::uint32_t          size = ros::serialization::serializationLength(message);
    ros::serialization::OStream  stream(g_bytes, sizeof g_bytes);
    ros::serialization::serialize(stream, message);
    std::uint32_t sum = 2166136261U;
    for (std::uint32_t i = 0; i < size; ++i)
    {
        sum = (sum ^ g_bytes[i]) * 16777619U;
    }
    ROS_INFO("%s: %u bytes, %08x", topic, size, sum);
}

static void greeting(const std_msgs::String::ConstPtr &message) { tell("greeting", *message); }
static void state(const sensor_msgs::JointState::ConstPtr &message) { tell("states", *message); }
static void large(const std_msgs::UInt8MultiArray::ConstPtr &message)
{
    tell("large", *message);
    g_all = true;
}

int main(int argc, char **argv)
{
    ros::init(argc, argv, "listener");
    ros::NodeHandle    nh;
    ros::ServiceClient client = nh.serviceClient<std_srvs::SetBool>("answer");
    ros::Subscriber    one    = nh.subscribe("greeting", 1, greeting);
    ros::Subscriber    two    = nh.subscribe("states", 10, state);
    ros::Subscriber    three  = nh.subscribe("large", 1, large);
    ros::Rate          rate(50);
    while (ros::ok() && !g_all)
    {
        ros::spinOnce();
        rate.sleep();
    }
    static std_srvs::SetBool call;
    for (int i = 0; i < 3; ++i)
    {
        call.request.data = i % 2;
        if (client.call(call))
        {
            ROS_INFO("answer %d: %d %s", i, call.response.success, call.response.message.c_str());
        }
        else
        {
            ROS_INFO("answer %d: none", i);
        }
    }
    ros::spin();
}
