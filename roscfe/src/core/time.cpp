// The time below OS_GetLocalTime, and waiting, which takes the node's messages over meanwhile.
#include "core.h"
#include "ros/time.h"

namespace roscfe
{

std::int64_t now_ns()
{
    OS_time_t now;
    OS_GetLocalTime(&now);
    return OS_TimeGetTotalNanoseconds(now);
}

bool is_simulated()
{
    return is_sim_time != nullptr && is_sim_time();
}

std::int64_t ros_now_ns()
{
    return is_simulated() ? sim_time_ns() : now_ns();
}

void wait_until(std::int64_t until_ns)
{
    const bool exactly = until_ns - now_ns() <= kFastCycle;
    while (now_ns() < until_ns && pump(until_ns, exactly))
    {
        if (run_async != nullptr)
        {
            run_async();
        }
    }
}

} // namespace roscfe

namespace ros
{

Time Time::now()
{
    if (roscfe::is_simulated())
    {
        roscfe::take_over_now(); // a loop that looks at the time sees it go on
    }
    Time time;
    return time.fromNSec(static_cast<std::uint64_t>(roscfe::ros_now_ns()));
}

bool Duration::sleep_now() const
{
    if (roscfe::is_simulated())
    {
        return roscfe::wait_for_clock(toNSec());
    }
    return WallDuration(sec, nsec).sleep_now();
}

// As in roscpp, which takes the seconds of a negative duration for a number without a sign: the wait has no end.
bool WallDuration::sleep_now() const
{
    const auto seconds = static_cast<std::uint32_t>(sec);
    if (sec < 0)
    {
        CFE_EVS_SendEvent(roscfe::kWaitEid, CFE_EVS_EventType_ERROR,
                          "%s: a sleep of a negative duration, %ld s and %ld ns, waits for %lu s, as in roscpp",
                          roscfe::g_node.name.c_str(), long{sec}, long{nsec}, static_cast<unsigned long>(seconds));
    }
    const std::int64_t ns = std::int64_t{seconds} * roscfe::kSecond + nsec;
    if (ns > 0)
    {
        roscfe::wait_until(roscfe::now_ns() + ns);
    }
    return !roscfe::g_node.shutting_down;
}

} // namespace ros
