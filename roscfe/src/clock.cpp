// Time and timers: the clock below OS_GetLocalTime, and waiting, which takes the node's messages over meanwhile.
#include <algorithm>
#include <chrono>

#include "internal.h"
#include "ros/time.h"

namespace roscfe
{

std::int64_t now_ns()
{
    OS_time_t now;
    OS_GetLocalTime(&now);
    return OS_TimeGetTotalNanoseconds(now);
}

namespace
{
constexpr std::int64_t kNever = INT64_MAX; // when a timer that fires once is expected again

// Whether a timer waits for /clock, and not for the processor's clock.
bool is_simulated(const TimerState &timer)
{
    return timer.of_ros_time && is_sim_time();
}

std::int64_t now_of(const TimerState &timer)
{
    return is_simulated(timer) ? ros_now_ns() : now_ns();
}
} // namespace

// -- timers ------------------------------------------------------------------------------------------------------------

void add_timer(const boost::shared_ptr<TimerState> &timer)
{
    auto &all = g_node.timers;
    all.erase(std::remove_if(all.begin(), all.end(),
                             [](const boost::weak_ptr<TimerState> &each) {
                                 const boost::shared_ptr<TimerState> there = each.lock();
                                 return !there || !there->alive;
                             }),
              all.end());
    all.push_back(timer);
    if (timer->callbacks == nullptr)
    {
        timer->callbacks = &g_node.queue;
    }
    timer->callbacks->expect(1);
}

void TimerState::start()
{
    if (running)
    {
        return;
    }
    running = true;
    waiting = false;
    ++starts; // a call of an earlier start that goes on changes nothing
    last_expected_ns = now_of(*this);
    next_expected_ns = last_expected_ns + period_ns;
    last_real_ns = last_duration_ns = last_expired_ns = 0;
}

void TimerState::stop()
{
    running = false;
    if (waiting && !g_node.ended)
    {
        callbacks->removeByID(reinterpret_cast<std::uintptr_t>(this));
    }
}

bool TimerState::pending() const
{
    return waiting || next_expected_ns <= now_of(*this);
}

void TimerState::set_period(std::int64_t period, bool reset)
{
    const std::int64_t now  = now_of(*this);
    const std::int64_t gone = now - last_real_ns;
    if (reset)
    {
        next_expected_ns = now + period;
    }
    else if (gone < period_ns)
    {
        // In the middle of a cycle the new period counts from the last call, but not into the past.
        next_expected_ns = gone > period ? now : last_real_ns + period;
    }
    period_ns = period;
}

ros::CallbackInterface::CallResult TimerState::call_now()
{
    if (!alive || !running)
    {
        waiting = false;
        return Invalid;
    }
    const ros::VoidConstPtr held = tracked.lock();
    if (has_tracked && !held)
    {
        waiting = false;
        return Invalid;
    }
    const std::int64_t  begun   = now_of(*this);
    const std::int64_t  started = now_ns();
    const std::uint32_t start   = starts;
    fire(begun);
    if (starts != start)
    {
        return Success; // it was stopped and started
    }
    const std::int64_t ended = now_of(*this);
    waiting                  = false;
    last_duration_ns         = now_ns() - started; // on the wall, as in roscpp
    last_real_ns             = begun;
    last_expired_ns          = expired_ns;
    if (oneshot)
    {
        next_expected_ns = kNever;
        return Success;
    }
    if (next_expected_ns <= ended) // otherwise the callback has set the period
    {
        last_expected_ns = next_expected_ns;
        next_expected_ns += period_ns;
    }
    if (next_expected_ns + period_ns < ended) // too slow by more than a period: begin anew
    {
        next_expected_ns = ended;
    }
    return Success;
}

void queue_due_timers(std::int64_t now)
{
    const std::int64_t simulated = is_sim_time() ? ros_now_ns() : now;
    // In the order in which they are due, as roscpp's list of waiting timers is sorted.
    for (;;)
    {
        boost::shared_ptr<TimerState> first;
        for (const boost::weak_ptr<TimerState> &each : g_node.timers)
        {
            const boost::shared_ptr<TimerState> timer = each.lock();
            if (timer && timer->alive && timer->running && !timer->waiting &&
                timer->next_expected_ns <= (timer->of_ros_time ? simulated : now) &&
                (!first || timer->next_expected_ns < first->next_expected_ns))
            {
                first = timer;
            }
        }
        if (!first)
        {
            return;
        }
        first->waiting = true;
        first->due_ns  = first->next_expected_ns;
        first->expired_ns = first->of_ros_time ? simulated : now;
        first->callbacks->addCallback(first, reinterpret_cast<std::uintptr_t>(first.get()));
    }
}

// Time has gone back: what was expected later is expected a period from now.
void reset_ros_timers(std::int64_t now)
{
    for (const boost::weak_ptr<TimerState> &each : g_node.timers)
    {
        const boost::shared_ptr<TimerState> timer = each.lock();
        if (timer && timer->of_ros_time && now < timer->last_expected_ns)
        {
            timer->last_expected_ns = now;
            timer->next_expected_ns = now + timer->period_ns;
        }
    }
}

NextTimer next_timer()
{
    NextTimer next;
    for (const boost::weak_ptr<TimerState> &each : g_node.timers)
    {
        const boost::shared_ptr<TimerState> timer = each.lock();
        if (timer && timer->alive && timer->running && !timer->waiting && timer->next_expected_ns != kNever &&
            !is_simulated(*timer) && (next.ns == kForever || timer->next_expected_ns < next.ns))
        {
            next.ns   = timer->next_expected_ns;
            next.fast = timer->period_ns <= kFastCycle;
        }
    }
    return next;
}

// -- waits of less than a millisecond ----------------------------------------------------------------------------------

namespace
{
// Timeouts of the Software Bus are whole milliseconds from now on. A loop at 1 kHz that ended each cycle with one would
// be late by its own work each time, and catch up by a cycle without a wait: two messages at once, for a subscriber that
// keeps one. OSAL waits for a condition variable until a time of the clock, in ticks of 100 ns; nobody signals it.
osal_id_t g_alarm     = OS_OBJECT_ID_UNDEFINED;
bool      g_no_alarms = false;

bool has_alarm()
{
    if (OS_ObjectIdDefined(g_alarm) || g_no_alarms)
    {
        return !g_no_alarms;
    }
    char name[OS_MAX_API_NAME];
    own_name(name, "_WAIT", "_W");
    // ES does not delete it with its application: one that was killed and started again finds it.
    g_no_alarms = OS_CondVarCreate(&g_alarm, name, 0) != OS_SUCCESS &&
                  OS_CondVarGetIdByName(&g_alarm, name) != OS_SUCCESS;
    return !g_no_alarms;
}
} // namespace

bool wait_exactly(std::int64_t until_ns)
{
    if (!has_alarm() || OS_CondVarLock(g_alarm) != OS_SUCCESS)
    {
        return false;
    }
    const OS_time_t until = OS_TimeFromTotalNanoseconds(until_ns + OS_TIME_TICK_RESOLUTION_NS - 1);
    OS_CondVarTimedWait(g_alarm, &until);
    OS_CondVarUnlock(g_alarm);
    return true;
}

void end_exact_waits()
{
    if (OS_ObjectIdDefined(g_alarm))
    {
        OS_CondVarDelete(g_alarm);
        g_alarm = OS_OBJECT_ID_UNDEFINED;
    }
}

} // namespace roscfe

// -- C's clocks of the host: the processor's is the time, for a node as for its messages (--wrap) -----------------------

extern "C" {

std::time_t __wrap_time(std::time_t *also)
{
    const auto now = static_cast<std::time_t>(roscfe::now_ns() / roscfe::kSecond);
    if (also != nullptr)
    {
        *also = now;
    }
    return now;
}

int __wrap_gettimeofday(struct timeval *time, void *)
{
    const std::int64_t now = roscfe::now_ns();
    time->tv_sec           = static_cast<decltype(time->tv_sec)>(now / roscfe::kSecond);
    time->tv_usec          = static_cast<decltype(time->tv_usec)>(now % roscfe::kSecond / 1000);
    return 0;
}

int __wrap_clock_gettime(clockid_t, struct timespec *time)
{
    const std::int64_t now = roscfe::now_ns();
    time->tv_sec           = static_cast<decltype(time->tv_sec)>(now / roscfe::kSecond);
    time->tv_nsec          = static_cast<decltype(time->tv_nsec)>(now % roscfe::kSecond);
    return 0;
}

} // extern "C"

// -- std::chrono's clocks, which libstdc++ would ask the computer for: these have the names of its functions ------------

namespace roscfe
{

std::chrono::system_clock::time_point system_clock_now() noexcept __asm__("_ZNSt6chrono3_V212system_clock3nowEv");
std::chrono::steady_clock::time_point steady_clock_now() noexcept __asm__("_ZNSt6chrono3_V212steady_clock3nowEv");

std::chrono::system_clock::time_point system_clock_now() noexcept
{
    const std::chrono::nanoseconds now(now_ns());
    return std::chrono::system_clock::time_point(std::chrono::duration_cast<std::chrono::system_clock::duration>(now));
}

std::chrono::steady_clock::time_point steady_clock_now() noexcept
{
    return std::chrono::steady_clock::time_point(std::chrono::nanoseconds(now_ns()));
}

} // namespace roscfe
