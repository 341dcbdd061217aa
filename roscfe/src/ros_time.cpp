// ros::Time and its kin: the processor's clock, or what /clock says where the parameter /use_sim_time is true.
#include "internal.h"
#include "ros/console.h"
#include "ros/time.h"

namespace roscfe
{

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
    if (back)
    {
        reset_ros_timers(now);
    }
}

std::uint32_t number_at(const std::uint8_t *at)
{
    return static_cast<std::uint32_t>(at[0]) | static_cast<std::uint32_t>(at[1]) << 8 |
           static_cast<std::uint32_t>(at[2]) << 16 | static_cast<std::uint32_t>(at[3]) << 24;
}

// The time counts as soon as it is taken over; there is no callback.
class Clock : public Subscription
{
  public:
    Clock() : Subscription(kClockTopic, 1, &g_node.queue, kClockBytes) {}

    bool receive(const std::uint8_t *bytes, std::size_t size) override
    {
        if (size == kClockBytes)
        {
            set_time(number_at(bytes) * kSecond + number_at(bytes + 4));
        }
        return false;
    }
    CallResult call() override { return Invalid; }
};

bool is_stopped()
{
    return g_node.shutting_down;
}

} // namespace

bool is_sim_time()
{
    return g_simulated;
}

std::int64_t ros_now_ns()
{
    return g_simulated ? g_now : now_ns();
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
    std::int64_t begin  = ros_now_ns();
    bool         waited = false;
    while (!is_stopped() && (begin == 0 || ros_now_ns() < begin + length))
    {
        pump(now_ns() + kLook);
        run_async();
        waited = true;
        if (begin == 0)
        {
            begin = ros_now_ns();
        }
        if (ros_now_ns() < begin)
        {
            return false;
        }
    }
    return waited && !is_stopped();
}

} // namespace roscfe

namespace ros
{

namespace
{

template <class T>
T time_of(std::int64_t ns)
{
    T time;
    time.fromNSec(static_cast<std::uint64_t>(ns));
    return time;
}

// As in roscpp, which takes the seconds of a negative duration for a number without a sign: the wait has no end.
bool sleep_for(std::int32_t sec, std::int32_t nsec)
{
    const auto seconds = static_cast<std::uint32_t>(sec);
    if (sec < 0)
    {
        ROS_WARN("a sleep of %.9f s waits for %u s, as in roscpp: a negative duration is taken for a long one",
                 sec + nsec * 1e-9, seconds);
    }
    const std::int64_t ns = std::int64_t(seconds) * roscfe::kSecond + nsec;
    if (ns > 0)
    {
        roscfe::wait_until(roscfe::now_ns() + ns);
    }
    return !roscfe::is_stopped();
}

template <class T>
bool sleep_until(const T &end)
{
    roscfe::wait_until(static_cast<std::int64_t>(end.toNSec()));
    return !roscfe::is_stopped();
}

} // namespace

Time Time::now()
{
    if (roscfe::is_sim_time())
    {
        roscfe::take_over_now(); // a loop that looks at the time sees it go on
    }
    return time_of<Time>(roscfe::ros_now_ns());
}
WallTime WallTime::now()
{
    return time_of<WallTime>(roscfe::now_ns());
}
SteadyTime SteadyTime::now()
{
    return time_of<SteadyTime>(roscfe::now_ns());
}
bool Time::sleepUntil(const Time &end)
{
    if (!roscfe::is_sim_time())
    {
        return sleep_until(end);
    }
    const auto until = static_cast<std::int64_t>(end.toNSec());
    return roscfe::ros_now_ns() >= until || roscfe::wait_for_clock(until - roscfe::ros_now_ns());
}
bool WallTime::sleepUntil(const WallTime &end)
{
    return sleep_until(end);
}
bool SteadyTime::sleepUntil(const SteadyTime &end)
{
    return sleep_until(end);
}
bool Duration::sleep() const
{
    return roscfe::is_sim_time() ? roscfe::wait_for_clock(toNSec()) : sleep_for(sec, nsec);
}
bool WallDuration::sleep() const
{
    return sleep_for(sec, nsec);
}

void Time::init() {}
void Time::shutdown() {}
void Time::setNow(const Time &now)
{
    roscfe::set_time(static_cast<std::int64_t>(now.toNSec()));
}
bool Time::useSystemTime()
{
    return !roscfe::is_sim_time();
}
bool Time::isSimTime()
{
    return roscfe::is_sim_time();
}
bool Time::isSystemTime()
{
    return !roscfe::is_sim_time();
}
bool Time::isValid()
{
    return roscfe::ros_now_ns() != 0;
}
bool Time::waitForValid()
{
    return waitForValid(WallDuration());
}
bool Time::waitForValid(const WallDuration &timeout)
{
    const std::int64_t until = roscfe::now_ns() + timeout.toNSec();
    while (!isValid() && !roscfe::is_stopped())
    {
        const std::int64_t now = roscfe::now_ns();
        if (!timeout.isZero() && now >= until)
        {
            return false;
        }
        roscfe::pump(now + roscfe::kLook);
    }
    return !roscfe::is_stopped();
}

} // namespace ros
