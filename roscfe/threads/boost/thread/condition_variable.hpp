// Conditions that threads wait for.
#ifndef BOOST_THREAD_CONDITION_VARIABLE_HPP
#define BOOST_THREAD_CONDITION_VARIABLE_HPP

#include <cstdint>

#include <pthread.h>

#include "boost/thread/interruption.hpp"
#include "boost/thread/lock_types.hpp"
#include "boost/thread/mutex.hpp"
#include "boost/thread/thread_time.hpp"
#include "roscfe/thread_waits.h"

namespace boost
{

enum class cv_status
{
    no_timeout,
    timeout
};

namespace roscfe_thread
{

// What both kinds of conditions have. The wait until a time, in ns, says whether the condition was signalled.
template <class Condition>
class Waits
{
  public:
    template <class Lock>
    void wait(Lock &lock)
    {
        self().wait_ns(lock, roscfe::kNoWaitEnd);
    }
    template <class Lock, class Predicate>
    void wait(Lock &lock, Predicate is_so)
    {
        while (!is_so())
        {
            wait(lock);
        }
    }

    template <class Lock, class Time>
    bool timed_wait(Lock &lock, const Time &time)
    {
        return self().wait_ns(lock, roscfe::wait_end(roscfe_time::rest(time)));
    }
    template <class Lock, class Time, class Predicate>
    bool timed_wait(Lock &lock, const Time &time, Predicate is_so)
    {
        const std::int64_t end = roscfe::wait_end(roscfe_time::rest(time));
        while (!is_so())
        {
            if (!self().wait_ns(lock, end))
            {
                return is_so();
            }
        }
        return true;
    }

    template <class Lock, class Duration>
    cv_status wait_for(Lock &lock, const Duration &duration)
    {
        return timed_wait(lock, duration) ? cv_status::no_timeout : cv_status::timeout;
    }
    template <class Lock, class Duration, class Predicate>
    bool wait_for(Lock &lock, const Duration &duration, Predicate is_so)
    {
        return timed_wait(lock, duration, is_so);
    }
    template <class Lock, class Time>
    cv_status wait_until(Lock &lock, const Time &time)
    {
        return wait_for(lock, time);
    }
    template <class Lock, class Time, class Predicate>
    bool wait_until(Lock &lock, const Time &time, Predicate is_so)
    {
        return timed_wait(lock, time, is_so);
    }

    void notify_one() { pthread_cond_signal(&condition_); }
    void notify_all() { pthread_cond_broadcast(&condition_); }

  protected:
    Waits()              = default;
    Waits(const Waits &) = delete;
    Waits &operator=(const Waits &) = delete;

    bool wait_in(pthread_mutex_t *mutex, std::int64_t until_ns)
    {
        return roscfe::wait_condition(&condition_, mutex, until_ns, interruption());
    }

  private:
    Condition &self() { return static_cast<Condition &>(*this); }

    pthread_cond_t condition_ = PTHREAD_COND_INITIALIZER;
};

} // namespace roscfe_thread

class condition_variable : public roscfe_thread::Waits<condition_variable>
{
  private:
    friend class roscfe_thread::Waits<condition_variable>;

    bool wait_ns(unique_lock<mutex> &lock, std::int64_t until_ns)
    {
        this_thread::interruption_point();
        lock.mutex()->yield_holder();
        const bool is_signalled = wait_in(lock.mutex()->native_handle(), until_ns);
        lock.mutex()->take_holder();
        this_thread::interruption_point();
        return is_signalled;
    }
};

// For locks of any type.
class condition_variable_any : public roscfe_thread::Waits<condition_variable_any>
{
  private:
    friend class roscfe_thread::Waits<condition_variable_any>;

    template <class Lock>
    bool wait_ns(Lock &lock, std::int64_t until_ns)
    {
        this_thread::interruption_point();
        pthread_mutex_lock(&mutex_);
        lock.unlock();
        const bool is_signalled = wait_in(&mutex_, until_ns);
        pthread_mutex_unlock(&mutex_);
        lock.lock();
        this_thread::interruption_point();
        return is_signalled;
    }

    pthread_mutex_t mutex_ = PTHREAD_MUTEX_INITIALIZER;
};

} // namespace boost

#endif
