// Requests to the node's services, and answers to its calls.
#include <dynamic_reconfigure/Reconfigure.h>
#include <nav_msgs/GetPlan.h>
#include <roscpp/SetLoggerLevel.h>
#include <sensor_msgs/SetCameraInfo.h>
#include <std_srvs/SetBool.h>

#include <cstring>

#include "area.h"
#include "roscfe/ground.h"

namespace fuzz
{

namespace
{

class Services final : public Area
{
  public:
    std::uint16_t other_subscription(std::size_t at) override
    {
        return at < 3 ? static_cast<std::uint16_t>(0x1B10 + at) : 0;
    }

    void begin(ros::NodeHandle &node) override
    {
        offer<std_srvs::SetBool>(node, "set_bool");
        offer<nav_msgs::GetPlan>(node, "plan");
        offer<dynamic_reconfigure::Reconfigure>(node, "configure");
        offer<sensor_msgs::SetCameraInfo>(node, "camera");
        offer<roscpp::SetLoggerLevel>(node, "level");
        calls_[0] = node.serviceClient<std_srvs::SetBool>("a");
        calls_[1] = node.serviceClient<nav_msgs::GetPlan>("b");
        calls_[2] = node.serviceClient<dynamic_reconfigure::Reconfigure>("c");
    }

    void work() override
    {
        if (depth_ == 0 && g_random.one_in(4))
        {
            call();
        }
    }

    bool sent(const std::uint8_t *packet, std::size_t size) override
    {
        const std::uint16_t id = msg_id_of(packet);
        if (id >= 0x1B10 && id < 0x1B13 && size >= 12 && asked_count_ < kMostAsked)
        {
            Asked &made = asked_[asked_count_++];
            made.id     = static_cast<std::uint16_t>(id & ~kCommandBit);
            std::memcpy(made.number, packet + 8, 4);
        }
        return id != kReportControl;
    }

    void fill() override
    {
        for (int i = 0; i < 10; ++i)
        {
            const Sample &sample = any_sample();
            (sample.msg_id & kCommandBit) != 0 ? request(sample) : answer(sample.msg_id, false);
        }
        if (g_random.one_in(4)) // a whole answer, so that each call ends
        {
            finish();
        }
    }

    void finish() override
    {
        if (asked_count_ > 0)
        {
            answer(asked_[asked_count_ - 1].id, true);
        }
    }

    std::size_t accepted() const override { return g_calls; }

  private:
    struct Asked
    {
        std::uint16_t id;
        std::uint8_t  number[4];
    };
    static constexpr std::size_t kMostAsked = 64;

    template <class S>
    void offer(ros::NodeHandle &node, const char *name)
    {
        offered_[offered_count_++] = node.advertiseService<typename S::Request, typename S::Response>(
            name, [this](typename S::Request &, typename S::Response &) {
                ++g_calls;
                if (depth_ < 3 && g_random.one_in(10))
                {
                    call();
                }
                return !g_random.one_in(5);
            });
    }

    template <class S>
    void call(ros::ServiceClient &client)
    {
        static S both; // in the profile strict of a fixed size, which has no room on a small stack
        accepted_ += client.call(both) ? 1 : 0;
    }

    void call()
    {
        ++depth_;
        const std::size_t before = asked_count_;
        switch (g_random.below(3))
        {
            case 0:
                call<std_srvs::SetBool>(calls_[0]);
                break;
            case 1:
                call<nav_msgs::GetPlan>(calls_[1]);
                break;
            default:
                call<dynamic_reconfigure::Reconfigure>(calls_[2]);
        }
        asked_count_ = before;
        --depth_;
    }

    void request(const Sample &sample)
    {
        static Bytes bytes;
        bytes.assign(sample.bytes, sample.size);
        vary(bytes);
        std::uint8_t number[4] = {g_random.byte(), 0, 0, 0};
        give_in_pieces(sample.msg_id, bytes, number, sizeof number);
    }

    // An answer to the last call, or to one before, or to nobody's.
    void answer(std::uint16_t id, bool whole)
    {
        static Bytes bytes;
        std::uint8_t lead[5] = {g_random.byte(), g_random.byte(), g_random.byte(), g_random.byte(), 1};
        if (asked_count_ > 0 && (whole || !g_random.one_in(4)))
        {
            const Asked &of = asked_[whole ? asked_count_ - 1 : g_random.below(asked_count_)];
            id              = of.id;
            std::memcpy(lead, of.number, 4);
        }
        const Sample &sample = sample_of(id);
        bytes.assign(sample.bytes, sample.size);
        if (whole)
        {
            std::uint8_t packet[32768];
            std::memcpy(packet, lead, sizeof lead);
            const std::size_t size = bytes.size < sizeof packet - 5 ? bytes.size : 0;
            std::memcpy(packet + 5, bytes.at, size);
            give(id, packet, 5 + size);
            return;
        }
        vary(bytes);
        lead[4] = g_random.one_in(5) ? g_random.byte() : 1;
        give_in_pieces(id, bytes, lead, sizeof lead);
    }

    ros::ServiceServer offered_[5];
    ros::ServiceClient calls_[3];
    int                offered_count_ = 0, depth_ = 0;
    Asked              asked_[kMostAsked];
    std::size_t        asked_count_ = 0, accepted_ = 0;
};

} // namespace

Area *make_services()
{
    static Services made;
    return &made;
}

} // namespace fuzz
