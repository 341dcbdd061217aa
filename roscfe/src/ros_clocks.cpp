// What nodes seldom ask of time: the other clocks, waits until a time, and whether there is one.
#include "core/core.h"
#include "ros/time.h"
#include "roscfe/parts.h"

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

template <class T>
bool sleep_until(const T &end)
{
    roscfe::parts::need(roscfe::parts::exact_waits);
    roscfe::wait_until(static_cast<std::int64_t>(end.toNSec()));
    return !roscfe::g_node.shutting_down;
}

} // namespace

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
    if (!roscfe::is_simulated())
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
void Time::init() {}
void Time::shutdown() {}
bool Time::useSystemTime()
{
    return !roscfe::is_simulated();
}
bool Time::isSimTime()
{
    return roscfe::is_simulated();
}
bool Time::isSystemTime()
{
    return !roscfe::is_simulated();
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
    while (!isValid() && !roscfe::g_node.shutting_down)
    {
        const std::int64_t now = roscfe::now_ns();
        if (!timeout.isZero() && now >= until)
        {
            return false;
        }
        roscfe::pump(now + roscfe::kSecond / 10);
    }
    return !roscfe::g_node.shutting_down;
}

} // namespace ros
