// ros::Timer, ros::WallTimer, ros::SteadyTimer: one class for all three, on the processor's clock, but for those of
// ros::Time where that is what /clock says.
#ifndef ROS_TIMER_H
#define ROS_TIMER_H

#include <type_traits>

#include "ros/callback_queue_interface.h"
#include "ros/forwards.h"
#include "ros/time.h"

namespace roscfe
{

// The part of a timer that does not depend on its types of time; in nanoseconds of its clock.
class TimerState : public ros::CallbackInterface
{
  public:
    std::int64_t                 period_ns        = 0;
    std::int64_t                 next_expected_ns = 0;
    std::int64_t                 last_expected_ns = 0;
    std::int64_t                 last_real_ns     = 0;
    std::int64_t                 last_expired_ns  = 0; // when it was seen that the last call was due
    std::int64_t                 expired_ns       = 0; // the same of the call that waits
    std::int64_t                 last_duration_ns = 0; // of its callback
    std::int64_t                 due_ns           = 0; // the time that the waiting call was expected at
    std::uint32_t                starts           = 0;
    bool                         oneshot          = false;
    bool                         running          = false;
    bool                         waiting          = false; // a call is in the queue, or goes on
    bool                         alive            = true;
    bool                         has_tracked      = false;
    bool                         of_ros_time      = false; // which may be that of /clock
    ros::VoidConstWPtr           tracked;
    ros::CallbackQueueInterface *callbacks = nullptr;

    // Here, and not in a source: what derives from a class is then complete in a node with run-time type information,
    // which the library is built without.
    CallResult call() override { return call_now(); }
    CallResult call_now();
    void       start();
    void       stop();
    bool       pending() const;
    void       set_period(std::int64_t period, bool reset);

  protected:
    virtual void fire(std::int64_t now_ns) = 0;
};

// A timer is part of the node from now on; it is forgotten when nobody else holds it.
void add_timer(const boost::shared_ptr<TimerState> &timer);

} // namespace roscfe

namespace ros
{

template <class T, class D>
struct TimerEventOf
{
    T last_expected;
    T last_real;
    T last_expired;
    T current_expected;
    T current_real;
    T current_expired;
    struct
    {
        WallDuration last_duration;
    } profile;
};

template <class T, class D>
struct TimerOptionsOf
{
    typedef boost::function<void(const TimerEventOf<T, D> &)> Callback;

    TimerOptionsOf() = default;
    TimerOptionsOf(D _period, const Callback &_callback, CallbackQueueInterface *_queue, bool _oneshot = false,
                   bool _autostart = true)
        : period(_period), callback(_callback), callback_queue(_queue), oneshot(_oneshot), autostart(_autostart)
    {
    }

    D                       period{0.1};
    Callback                callback;
    CallbackQueueInterface *callback_queue = nullptr;
    VoidConstPtr            tracked_object;
    bool                    oneshot   = false;
    bool                    autostart = true;
};

template <class T, class D>
class TimerOf
{
  public:
    typedef TimerEventOf<T, D>   Event;
    typedef TimerOptionsOf<T, D> Options;

    TimerOf() = default;
    explicit TimerOf(const Options &options) : state_(boost::make_shared<State>())
    {
        state_->callback    = options.callback;
        state_->period_ns   = options.period.toNSec();
        state_->oneshot     = options.oneshot;
        state_->of_ros_time = std::is_same<T, Time>::value;
        state_->callbacks   = options.callback_queue;
        state_->tracked     = options.tracked_object;
        state_->has_tracked = options.tracked_object != nullptr;
        keeper_             = boost::shared_ptr<void>(static_cast<void *>(nullptr), Stop{state_});
        roscfe::add_timer(state_);
        if (options.autostart)
        {
            start();
        }
    }

    void start()
    {
        if (state_)
        {
            state_->start();
        }
    }
    void stop()
    {
        if (state_)
        {
            state_->stop();
        }
    }
    bool hasPending() const { return state_ && state_->running && state_->alive && state_->pending(); }
    void setPeriod(const D &period, bool reset = true)
    {
        if (state_)
        {
            state_->set_period(period.toNSec(), reset);
        }
    }
    bool hasStarted() const { return state_ && state_->running; }
    bool isValid() const { return state_ != nullptr; }

    explicit operator bool() const { return isValid(); }
    operator void *() const { return state_.get(); }
    bool operator<(const TimerOf &other) const { return state_ < other.state_; }
    bool operator==(const TimerOf &other) const { return state_ == other.state_; }
    bool operator!=(const TimerOf &other) const { return state_ != other.state_; }

  private:
    struct State final : roscfe::TimerState
    {
        typename Options::Callback callback;

        void fire(std::int64_t now_ns) override
        {
            Event event;
            event.last_expected.fromNSec(static_cast<std::uint64_t>(last_expected_ns));
            event.last_real.fromNSec(static_cast<std::uint64_t>(last_real_ns));
            event.last_expired.fromNSec(static_cast<std::uint64_t>(last_expired_ns));
            event.current_expected.fromNSec(static_cast<std::uint64_t>(due_ns));
            event.current_real.fromNSec(static_cast<std::uint64_t>(now_ns));
            event.current_expired.fromNSec(static_cast<std::uint64_t>(expired_ns));
            event.profile.last_duration.fromNSec(last_duration_ns);
            callback(event);
        }
    };

    // The last copy of a timer takes it along, whoever else still knows the state.
    struct Stop
    {
        boost::shared_ptr<State> state;
        void                     operator()(void *) const
        {
            state->alive = state->running = false;
            if (state->callbacks != nullptr)
            {
                state->callbacks->expect_no_more(1);
            }
        }
    };

    boost::shared_ptr<State> state_;
    boost::shared_ptr<void>  keeper_;
};

typedef boost::function<void(const TimerEvent &)>       TimerCallback;
typedef boost::function<void(const WallTimerEvent &)>   WallTimerCallback;
typedef boost::function<void(const SteadyTimerEvent &)> SteadyTimerCallback;

struct TimerOptions : TimerOptionsOf<Time, Duration>
{
    using TimerOptionsOf<Time, Duration>::TimerOptionsOf;
};
struct WallTimerOptions : TimerOptionsOf<WallTime, WallDuration>
{
    using TimerOptionsOf<WallTime, WallDuration>::TimerOptionsOf;
};
struct SteadyTimerOptions : TimerOptionsOf<SteadyTime, WallDuration>
{
    using TimerOptionsOf<SteadyTime, WallDuration>::TimerOptionsOf;
};

class Timer : public TimerOf<Time, Duration>
{
    using TimerOf<Time, Duration>::TimerOf;
};
class WallTimer : public TimerOf<WallTime, WallDuration>
{
    using TimerOf<WallTime, WallDuration>::TimerOf;
};
class SteadyTimer : public TimerOf<SteadyTime, WallDuration>
{
    using TimerOf<SteadyTime, WallDuration>::TimerOf;
};

} // namespace ros

#endif
