// Transforms, and the time of /clock that they are taken over at.
#include <tf2_ros/buffer.h>
#include <tf2_ros/transform_listener.h>

#include <new>
#include <string>

#include "area.h"
#include "roscfe/ground.h"

namespace fuzz
{

namespace
{

class Transforms final : public Area
{
  public:
    void prepare() override { ros::param::set("/use_sim_time", true); }

    void begin(ros::NodeHandle &) override
    {
        buffer_ = new tf2_ros::Buffer(ros::Duration(10));
        ear_    = new tf2_ros::TransformListener(*buffer_);
    }

    void work() override
    {
        static const std::string kFrames[] = {"map", "odom", "base", "tool", "lost", ""};
        const std::string &      target    = kFrames[g_random.below(6)];
        const std::string &      source    = kFrames[g_random.below(6)];
        const ros::Time          when(static_cast<std::uint32_t>(g_random.below(30)), 0);
        g_calls += buffer_->canTransform(target, source, g_random.one_in(2) ? ros::Time(0) : when);
        g_calls += buffer_->canTransform(target, when, source, ros::Time(0), kFrames[g_random.below(5)]);
    }

    void fill() override { give_samples(); }

    std::size_t accepted() const override { return roscfe::g_counters.received; }

  private:
    tf2_ros::Buffer *           buffer_ = nullptr;
    tf2_ros::TransformListener *ear_    = nullptr;
};

} // namespace

Area *make_transforms()
{
    static Transforms made;
    return &made;
}

} // namespace fuzz
