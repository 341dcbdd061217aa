// Messages of topics: types of all shapes, long ones, a raw topic, two subscriptions to one topic.
#include <actionlib_msgs/GoalStatusArray.h>
#include <diagnostic_msgs/DiagnosticArray.h>
#include <nav_msgs/OccupancyGrid.h>
#include <sensor_msgs/JointState.h>
#include <sensor_msgs/PointCloud2.h>
#include <std_msgs/Empty.h>
#include <std_msgs/Float64MultiArray.h>
#include <std_msgs/Header.h>
#include <std_msgs/Int64.h>
#include <std_msgs/String.h>
#include <std_msgs/UInt8MultiArray.h>
#include <trajectory_msgs/MultiDOFJointTrajectory.h>
#include <visualization_msgs/MarkerArray.h>

#include "area.h"
#include "cfe_stand_in.h"
#include "roscfe/ground.h"

namespace fuzz
{

namespace
{

template <class M>
void read_all(const M &message)
{
    // Each byte of the message is read again: what is not initialised or not there, a sanitizer sees.
    const std::size_t size = roscfe::wire::length(message);
    static std::uint8_t bytes[kMostBytes];
    if (size <= sizeof bytes)
    {
        roscfe::wire::write(message, bytes, size);
    }
    ++g_calls;
}

class Topics final : public Area
{
  public:
    void begin(ros::NodeHandle &node) override
    {
        hear<std_msgs::Empty>(node, "empty");
        hear<std_msgs::String>(node, "string");
        hear<std_msgs::Header>(node, "header");
        hear<std_msgs::Int64>(node, "int64");
        hear<std_msgs::Float64MultiArray>(node, "floats");
        hear<std_msgs::UInt8MultiArray>(node, "raw");
        hear<sensor_msgs::PointCloud2>(node, "cloud");
        hear<sensor_msgs::JointState>(node, "joints");
        hear<nav_msgs::OccupancyGrid>(node, "grid");
        hear<diagnostic_msgs::DiagnosticArray>(node, "diagnostics");
        hear<visualization_msgs::MarkerArray>(node, "markers");
        hear<trajectory_msgs::MultiDOFJointTrajectory>(node, "trajectory");
        hear<actionlib_msgs::GoalStatusArray>(node, "goals");
        hear<std_msgs::String>(node, "string"); // a second one
    }

    void fill() override { give_samples(); }

    std::size_t accepted() const override { return roscfe::g_counters.received; }

  private:
    template <class M>
    void hear(ros::NodeHandle &node, const char *topic)
    {
        heard_[count_++] = node.subscribe<M>(topic, 1 + g_random.below(5), [](const boost::shared_ptr<M const> &message) {
            read_all(*message);
        });
    }

    ros::Subscriber heard_[20];
    int             count_ = 0;
};

} // namespace

Area *make_topics()
{
    static Topics made;
    return &made;
}

} // namespace fuzz
