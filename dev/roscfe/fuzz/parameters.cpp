// Answers of cfepy's ROS application: parameters, places of names, types of topics; and its notices.
#include <std_msgs/String.h>
#include <std_srvs/SetBool.h>

#include <cstring>
#include <map>
#include <string>
#include <vector>

#include "area.h"
#include "cfe_stand_in.h"
#include "roscfe/subscription.h"

namespace fuzz
{

namespace
{

const char *const kNames[] = {"/a", "/b/c", "b", "/fuzzed/d", "/a/long/name/of/a/parameter/that/has/no/room/in/a/row", "/"};

class Parameters final : public Area
{
  public:
    std::uint16_t other_subscription(std::size_t at) override { return at == 0 ? kMaster | kCommandBit : 0; }

    void begin(ros::NodeHandle &node) override
    {
        node_ = &node;
        if (kIsStrict) // values of all types take memory, which there is before the first spin only
        {
            g_flying = true;
            while (g_left > kLastOnes)
            {
                work();
            }
        }
    }

    void work() override
    {
        is_waiting_ = false;
        if (kIsStrict && g_left <= kLastOnes)
        {
            return; // notices alone
        }
        const char *name = kNames[g_random.below(sizeof kNames / sizeof *kNames)];
        switch (g_random.below(kIsStrict ? 9 : 12))
        {
            case 0:
                return get<int>(name);
            case 1:
                return get<double>(name);
            case 2:
                return get<bool>(name);
            case 3:
                return get<std::string>(name);
            case 4:
                return get<std::vector<double>>(name);
            case 5:
                return get<std::map<std::string, int>>(name);
            case 6:
                return get<XmlRpc::XmlRpcValue>(name);
            case 7:
            {
                std::string found;
                accepted_ += node_->searchParam("c", found) + node_->hasParam(name);
                return;
            }
            case 8:
            {
                std::vector<std::string> names;
                accepted_ += node_->getParamNames(names);
                return;
            }
            case 9:
                node_->setParam(name, 1.5);
                node_->deleteParam(name);
                return;
            case 10:
                return names();
            default:
                accepted_ += roscfe::connection_header("/t" + std::to_string(g_random.below(300)))->size();
        }
    }

    bool sent(const std::uint8_t *packet, std::size_t size) override
    {
        if (msg_id_of(packet) != (kMaster | kCommandBit) || size < 17)
        {
            return msg_id_of(packet) != kReportControl;
        }
        std::memcpy(number_, packet + 8, 4);
        what_       = packet[16];
        is_waiting_ = true;
        if (!g_flying)
        {
            answer();
        }
        return true;
    }

    void fill() override
    {
        static Bytes bytes;
        is_turn_ = !is_turn_; // else the node would take over packets until its pipe has been full once
        for (int i = 0; i < 2 && is_turn_ && (is_waiting_ || g_random.one_in(4)); ++i)
        {
            make(bytes);
            vary(bytes);
            if (is_place() && bytes.size >= 2 && !g_random.one_in(20))
            {
                bytes.at[0] = static_cast<std::uint8_t>(g_random.below(0x40)); // the core's own MsgIds are no topics
                bytes.at[1] = 0x0A;
            }
            std::uint8_t lead[5] = {0, 0, 0, 0, static_cast<std::uint8_t>(!g_random.one_in(6))};
            if (is_waiting_ && !g_random.one_in(8))
            {
                std::memcpy(lead, number_, 4); // else it is a notice
            }
            else
            {
                const char *name = kNames[g_random.below(sizeof kNames / sizeof *kNames)];
                bytes.assign(reinterpret_cast<const std::uint8_t *>(name), std::strlen(name));
                vary(bytes);
            }
            give_in_pieces(kMaster, bytes, lead, sizeof lead);
        }
    }

    void finish() override { answer(); }

    std::size_t accepted() const override { return accepted_; }

  private:
    // As it should be, and not counted.
    void answer()
    {
        static Bytes bytes;
        make(bytes);
        static std::uint8_t made[32768] = {0x08, 0xFC, 0xC0, 0};
        std::memcpy(made + 16, number_, 4);
        made[20] = 1;
        std::memcpy(made + 21, bytes.at, bytes.size);
        const std::size_t whole = 21 + bytes.size;
        made[4]                 = static_cast<std::uint8_t>((whole - 7) >> 8);
        made[5]                 = static_cast<std::uint8_t>(whole - 7);
        stand_in::put(made, whole);
    }

    static constexpr std::size_t kLastOnes = 200;

    bool is_place() const { return what_ < 16; }

    template <class T>
    void get(const char *name)
    {
        T value{};
        accepted_ += g_random.one_in(2) ? node_->getParam(name, value) : node_->getParamCached(name, value);
    }

    void names()
    {
        ros::Publisher     out  = node_->advertise<std_msgs::String>("string", 1, g_random.one_in(2));
        ros::Subscriber    in   = node_->subscribe<std_msgs::String>("other_string", 1, [](const boost::shared_ptr<std_msgs::String const> &) {});
        ros::ServiceClient call = node_->serviceClient<std_srvs::SetBool>("a", g_random.one_in(2));
        accepted_ += out.getNumSubscribers() + call.exists();
    }

    // An answer as it should be.
    void make(Bytes &bytes)
    {
        bytes.size = 0;
        if (is_place())
        {
            const std::uint8_t place[] = {static_cast<std::uint8_t>(g_random.below(0x40)), 0x0A,
                                          static_cast<std::uint8_t>(g_random.below(4)), 2, 0, 3, 0, 0, 0, 0, 0xFF};
            bytes.append(place, g_random.one_in(2) ? 3 : sizeof place);
            return;
        }
        const Sample &sample = sample_of(what_ == 21 ? 3 : what_ == 33 ? 2 : 1);
        bytes.append(sample.bytes, sample.size);
    }

    ros::NodeHandle *node_ = nullptr;
    std::uint8_t     number_[4] = {};
    std::uint8_t     what_       = 0;
    bool             is_waiting_ = false;
    bool             is_turn_    = false;
    std::size_t      accepted_   = 0;
};

} // namespace

Area *make_parameters()
{
    static Parameters made;
    return &made;
}

} // namespace fuzz
