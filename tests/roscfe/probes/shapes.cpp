// topic_tools::ShapeShifter: what it says of messages of C++ and of Python, and what it makes of them.
#include <cstdio>
#include <vector>

#include <geometry_msgs/PoseStamped.h>
#include <ros/ros.h>
#include <std_msgs/Int32.h>
#include <std_msgs/String.h>
#include <topic_tools/shape_shifter.h>

using topic_tools::ShapeShifter;

static std::vector<ShapeShifter::ConstPtr> g_heard;

static void tell(const char *who, const ShapeShifter &shape)
{
    unsigned sum = 0; // of the definition without comments and blanks
    bool     is_comment = false;
    for (const char c : shape.getMessageDefinition())
    {
        is_comment = c != '\n' && (is_comment || c == '#');
        sum        = is_comment || c == ' ' || c == '\n' ? sum : sum * 31 + static_cast<unsigned char>(c);
    }
    std::vector<std::uint8_t>   bytes(shape.size());
    ros::serialization::OStream stream(bytes.data(), shape.size());
    shape.write(stream);
    std::printf("P| %s %s %s %u %u:", who, shape.getDataType().c_str(), shape.getMD5Sum().c_str(), sum, shape.size());
    for (const std::uint8_t byte : bytes)
    {
        std::printf(" %02x", byte);
    }
    std::printf("\n");
}

template <class M>
static void make(const char *what, const ShapeShifter &shape)
{
    try
    {
        std::printf("P| %s made: %u bytes\n", what, ros::serialization::serializationLength(*shape.instantiate<M>()));
    }
    catch (const topic_tools::ShapeShifterException &error)
    {
        std::printf("P| %s refused: %s\n", what, error.what());
    }
}

static void on_shape(const ShapeShifter::ConstPtr &shape)
{
    g_heard.push_back(shape);
    tell("heard", *shape);
}
static void on_event(const ros::MessageEvent<ShapeShifter const> &event)
{
    const auto &header = event.getConnectionHeader();
    std::printf("P| event of %s", event.getConstMessage()->getDataType().c_str());
    for (const char *name : {"type", "md5sum", "latching"})
    {
        const auto found = header.find(name);
        std::printf(" %s=%s", name, found == header.end() ? "none" : found->second.c_str());
    }
    std::printf("\n");
}
static void on_pose(const geometry_msgs::PoseStamped &pose)
{
    std::printf("P| pose %u %s %g\n", pose.header.seq, pose.header.frame_id.c_str(), pose.pose.position.x);
}

int main(int argc, char **argv)
{
    ros::init(argc, argv, "shapes");
    ros::NodeHandle nh;
    ros::Publisher  words = nh.advertise<std_msgs::String>("words", 5);
    ros::Publisher  poses = nh.advertise<geometry_msgs::PoseStamped>("poses", 5);
    ros::Subscriber a     = nh.subscribe("words", 5, on_shape);
    ros::Subscriber b     = nh.subscribe("poses", 5, on_shape);
    ros::Subscriber c     = nh.subscribe("from_py", 5, on_shape);
    ros::Subscriber d     = nh.subscribe("latched_py", 5, on_event);
    ros::Subscriber e     = nh.subscribe("poses_again", 5, on_pose);
    const auto      spin  = [](double seconds) {
        for (const ros::Time end = ros::Time::now() + ros::Duration(seconds); ros::Time::now() < end;)
        {
            ros::spinOnce();
            ros::Duration(0.01).sleep();
        }
    };
    while (ros::ok() && !ros::param::has("/ready_py"))
    {
        ros::Duration(0.05).sleep();
    }
    spin(1.0);
    std_msgs::String word;
    word.data = "gr\xc3\xbc\xc3\x9f";
    words.publish(word);
    spin(0.5);
    geometry_msgs::PoseStamped pose;
    pose.header.frame_id = "map";
    pose.pose.position.x = 1.5;
    poses.publish(pose);
    spin(0.5);
    poses.publish(pose);
    spin(0.5);
    std::printf("P| heard %zu\n", g_heard.size());
    make<std_msgs::String>("a String of the first", *g_heard[0]);
    make<geometry_msgs::PoseStamped>("a PoseStamped of the second", *g_heard[1]);
    make<std_msgs::Int32>("an Int32 of the second", *g_heard[1]);
    ShapeShifter own;
    make<std_msgs::String>("a String of nothing", own);
    tell("untyped", own);
    own.morph(g_heard[0]->getMD5Sum(), "std_msgs/Int32", "", "");
    make<std_msgs::Int32>("an Int32 of another sum", own);
    own.morph("*", "std_msgs/Int32", "", "");
    make<std_msgs::Int32>("an Int32 of any sum", own);
    ShapeShifter                read;
    std::uint8_t                bytes[] = {1, 2, 3, 4};
    ros::serialization::IStream stream(bytes, 4);
    read.read(stream);
    read.morph(ros::message_traits::md5sum<std_msgs::Int32>(), "std_msgs/Int32", "int32 data\n", "1");
    tell("read", read);
    std::printf("P| its number is %d\n", read.instantiate<std_msgs::Int32>()->data);
    ros::Publisher again = g_heard[1]->advertise(nh, "poses_again", 5, true);
    ros::Publisher to_py = g_heard[0]->advertise(nh, "to_py", 5, true);
    spin(1.0);
    again.publish(g_heard[1]);
    again.publish(*g_heard[2]);
    to_py.publish(*g_heard[0]);
    spin(1.0);
    ros::Subscriber late = nh.subscribe("poses_again", 5, on_shape);
    spin(1.0);
    std::printf("P| latched %d %s\n", again.isLatched(), again.getTopic().c_str());
    ros::param::set("/go_py", 1);
    spin(2.0);
    ros::param::set("/end", 1);
    return 0;
}
