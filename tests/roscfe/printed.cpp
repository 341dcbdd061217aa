// Prints messages, constants and what is known of types. It compiles against roscpp's headers as well: printed.txt is what
// it prints there.
#include <iostream>

#include <actionlib_msgs/GoalStatusArray.h>
#include <geometry_msgs/PoseArray.h>
#include <geometry_msgs/PoseWithCovariance.h>
#include <ros/message_traits.h>
#include <ros/serialization.h>
#include <rosgraph_msgs/Log.h>
#include <std_msgs/Bool.h>
#include <std_msgs/Byte.h>
#include <std_msgs/Char.h>
#include <std_msgs/Duration.h>
#include <std_msgs/Empty.h>
#include <std_msgs/Float32MultiArray.h>
#include <std_msgs/Int8MultiArray.h>
#include <std_msgs/UInt64.h>
#include <tf2_msgs/TFMessage.h>

template <class Message>
void show(const Message &message)
{
    namespace mt = ros::message_traits;
    std::cout << "-- " << mt::datatype<Message>() << " " << mt::md5sum(message) << " header " << mt::hasHeader<Message>()
              << " fixed " << mt::isFixedSize<Message>() << " message " << mt::IsMessage<Message>::value << " length "
              << ros::serialization::serializationLength(message) << "\n"
              << message;
}

int main()
{
    std_msgs::Header header;
    header.seq = 7;
    header.stamp = ros::Time(3, 5);
    header.frame_id = "map";
    show(header);

    std_msgs::Byte byte;
    byte.data = -3;
    show(byte);
    std_msgs::Char letter;
    letter.data = 65;
    show(letter);
    std_msgs::Bool flag;
    flag.data = true;
    show(flag);
    std_msgs::UInt64 number;
    number.data = 18446744073709551615ull;
    show(number);
    std_msgs::Duration span;
    span.data = ros::Duration(-0.25);
    show(span);
    show(std_msgs::Empty());

    std_msgs::Float32MultiArray floats;
    floats.layout.dim.resize(2);
    floats.layout.dim[1].label = "rows";
    floats.layout.dim[1].stride = 4;
    floats.data = {1.5f, -0.1f, 1e20f};
    show(floats);
    std_msgs::Int8MultiArray octets;
    octets.data = {1, -1};
    show(octets);

    geometry_msgs::PoseArray poses;
    poses.header = header;
    poses.poses.resize(2);
    poses.poses[1].orientation.w = 1;
    show(poses);
    geometry_msgs::PoseWithCovariance pose;
    pose.covariance[35] = 0.5;
    show(pose);

    actionlib_msgs::GoalStatusArray goals;
    goals.status_list.resize(1);
    goals.status_list[0].status = actionlib_msgs::GoalStatus::ACTIVE;
    goals.status_list[0].goal_id.id = "first";
    show(goals);

    rosgraph_msgs::Log log;
    log.level = rosgraph_msgs::Log::ERROR;
    log.topics.push_back("/a");
    log.topics.push_back("/b");
    show(log);

    tf2_msgs::TFMessage transforms;
    transforms.transforms.resize(1);
    show(transforms);

    std::cout << actionlib_msgs::GoalStatus::LOST << rosgraph_msgs::Log::FATAL << "\n"
              << (header == header) << (header != std_msgs::Header()) << "\n";
    geometry_msgs::PoseArray::ConstPtr        shared(new geometry_msgs::PoseArray(poses));
    const geometry_msgs::PoseArrayConstPtr &  same = shared;
    geometry_msgs::PoseArray::_header_type    copy = same->header;
    geometry_msgs::Pose_<std::allocator<void>> old_style;
    std::cout << *ros::message_traits::frameId(*same) << ros::message_traits::TimeStamp<geometry_msgs::PoseArray>::value(poses)
              << copy.seq << old_style.position.x << "\n";
}
