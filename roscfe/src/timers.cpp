// Timers.
#include <algorithm>

#include "internal.h"
#include "ros/time.h"
#include "roscfe/parts.h"

namespace roscfe
{

namespace
{
constexpr std::int64_t kNever = INT64_MAX; // when a timer that fires once is expected again

// Whether a timer waits for /clock, and not for the processor's clock.
bool of_clock(const TimerState &timer)
{
    return timer.of_ros_time && is_simulated();
}

std::int64_t now_of(const TimerState &timer)
{
    return of_clock(timer) ? ros_now_ns() : now_ns();
}
} // namespace

void add_timer(const boost::shared_ptr<TimerState> &timer)
{
    parts::need(parts::exact_waits); // of fast ones
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
    const std::int64_t simulated = is_simulated() ? ros_now_ns() : now;
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
            !of_clock(*timer) && (next.ns == kForever || timer->next_expected_ns < next.ns))
        {
            next.ns   = timer->next_expected_ns;
            next.fast = timer->period_ns <= kFastCycle;
        }
    }
    return next;
}

} // namespace roscfe
