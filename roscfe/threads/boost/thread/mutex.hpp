// Only nodes for the host have threads, and mutexes that threads wait for. In the other profiles a node is one task, and
// only the node itself can hold its mutexes. To lock one that it holds would be to wait for ever: that ends the application
// with an event.
#ifndef BOOST_THREAD_MUTEX_HPP
#define BOOST_THREAD_MUTEX_HPP

#if !defined(ROSCFE_PROFILE_POOL) && !defined(ROSCFE_PROFILE_STRICT)
#include <atomic>
#include <mutex>
#include <thread>

#include "boost/thread/thread_time.hpp"
#endif

#include "boost/thread/lock_guard.hpp"
#include "boost/thread/lock_types.hpp"
#include "roscfe/refuse.h"

namespace boost
{

class mutex
{
  public:
    typedef unique_lock<mutex> scoped_lock;
    typedef unique_lock<mutex> scoped_try_lock;

    mutex() = default;
    mutex(const mutex &) = delete;
    mutex &operator=(const mutex &) = delete;

#if defined(ROSCFE_PROFILE_POOL) || defined(ROSCFE_PROFILE_STRICT)
    void lock()
    {
        refuse_to_wait(is_held_);
        is_held_ = true;
    }
    bool try_lock()
    {
        const bool is_free = !is_held_;
        is_held_           = true;
        return is_free;
    }
    void unlock() { is_held_ = false; }
#else
    void lock()
    {
        refuse_to_wait(owner_ == std::this_thread::get_id());
        mutex_.lock();
        take_holder();
    }
    bool try_lock()
    {
        if (owner_ == std::this_thread::get_id() || !mutex_.try_lock())
        {
            return false;
        }
        take_holder();
        return true;
    }
    void unlock()
    {
        yield_holder();
        mutex_.unlock();
    }

    // Around the wait for a condition, which unlocks the mutex and locks it again.
    typedef std::mutex::native_handle_type native_handle_type;
    native_handle_type native_handle() { return mutex_.native_handle(); }
    void               yield_holder() { owner_ = std::thread::id(); }
    void               take_holder() { owner_ = std::this_thread::get_id(); }
#endif

  private:
    static void refuse_to_wait(bool for_itself)
    {
        if (for_itself)
        {
            ::roscfe::refuse("boost::mutex", "the task that holds it locks it again, and would wait for ever");
        }
    }

#if defined(ROSCFE_PROFILE_POOL) || defined(ROSCFE_PROFILE_STRICT)
    bool is_held_ = false;
#else
    std::mutex                   mutex_;
    std::atomic<std::thread::id> owner_{std::thread::id()};
#endif
};

typedef mutex try_mutex;

#if !defined(ROSCFE_PROFILE_POOL) && !defined(ROSCFE_PROFILE_STRICT)
class timed_mutex
{
  public:
    typedef unique_lock<timed_mutex> scoped_lock;
    typedef unique_lock<timed_mutex> scoped_try_lock;
    typedef unique_lock<timed_mutex> scoped_timed_lock;

    void lock() { mutex_.lock(); }
    bool try_lock() { return mutex_.try_lock(); }
    void unlock() { mutex_.unlock(); }
    template <class Time>
    bool timed_lock(const Time &time)
    {
        return mutex_.try_lock_for(std::chrono::nanoseconds(roscfe_time::rest(time)));
    }
    template <class Duration>
    bool try_lock_for(const Duration &duration)
    {
        return timed_lock(duration);
    }

  private:
    std::timed_mutex mutex_;
};
#endif

} // namespace boost

#endif
