// The time of /clock, where the parameter /use_sim_time is true.
#include "internal.h"
#include "ros/time.h"
#include "roscfe/parts.h"

namespace roscfe
{

namespace parts
{
extern const char sim_time = 0;
}

namespace
{

constexpr const char * kClockTopic = "/clock";
constexpr const char * kClockType  = "rosgraph_msgs/Clock";
constexpr const char * kClockMd5   = "a9c97c1d230cfc112e270351a944ee47";
constexpr const char * kClockText  = "time clock\n";
constexpr std::size_t  kClockBytes = 8;
constexpr std::int64_t kLook       = kSecond / 10; // how often somebody who waits for /clock looks whether he is to end

bool         g_simulated = false;
std::int64_t g_now       = 0; // of /clock; 0 until it came

void set_time(std::int64_t now)
{
    const bool back = now < g_now;
    g_simulated     = true;
    g_now           = now;
    if (back && reset_ros_timers != nullptr)
    {
        reset_ros_timers(now);
    }
}

std::uint32_t number_at(const std::uint8_t *at)
{
    return static_cast<std::uint32_t>(at[0]) | static_cast<std::uint32_t>(at[1]) << 8 |
           static_cast<std::uint32_t>(at[2]) << 16 | static_cast<std::uint32_t>(at[3]) << 24;
}

constexpr std::int64_t kMost = 0xFFFFFFFF * kSecond + kSecond - 1; // of ros::Time

// The time counts as soon as it is taken over; there is no callback.
class Clock : public Subscription
{
  public:
    Clock() : Subscription(kClockTopic, 1, &g_node.queue, kClockBytes) {}

    bool receive(const std::uint8_t *bytes, std::size_t size) override
    {
        const std::int64_t now = size == kClockBytes ? number_at(bytes) * kSecond + number_at(bytes + 4) : kMost + 1;
        if (now > kMost)
        {
            ++bad_;
            ++g_counters.bad;
            return false;
        }
        ++g_counters.received;
        set_time(now);
        return false;
    }
    CallResult call() override { return Invalid; }
};

} // namespace

bool is_sim_time()
{
    return g_simulated;
}

std::int64_t sim_time_ns()
{
    return g_now;
}

void open_clock()
{
    XmlRpc::XmlRpcValue value;
    bool                wanted = false;
    if (get_param("/use_sim_time", value) && param_to(value, wanted) && wanted)
    {
        set_time(0);
        subscribe(boost::make_shared<Clock>(), kClockType, kClockMd5, kClockText);
    }
}

// Wait until /clock has reached a time; false when it went back, or the node is to end. A time that begins before the first
// /clock begins with it.
bool wait_for_clock(std::int64_t length)
{
    std::int64_t begin  = sim_time_ns();
    bool         waited = false;
    while (!g_node.shutting_down && (begin == 0 || sim_time_ns() < begin + length))
    {
        pump(now_ns() + kLook);
        if (run_async != nullptr)
        {
            run_async();
        }
        waited = true;
        if (begin == 0)
        {
            begin = sim_time_ns();
        }
        if (sim_time_ns() < begin)
        {
            return false;
        }
    }
    return waited && !g_node.shutting_down;
}

} // namespace roscfe

namespace ros
{

void Time::setNow(const Time &now)
{
    roscfe::set_time(static_cast<std::int64_t>(now.toNSec()));
}

} // namespace ros
