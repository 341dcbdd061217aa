// A node is one task, so nobody but the node itself can hold its mutexes. To lock one that it holds would be to wait for
// ever: that ends the application with an event. Only nodes for the host may have threads beside it, and real mutexes.
#ifndef BOOST_THREAD_MUTEX_HPP
#define BOOST_THREAD_MUTEX_HPP

#if !defined(ROSCFE_PROFILE_POOL) && !defined(ROSCFE_PROFILE_STRICT)
#include <atomic>
#include <mutex>
#include <thread>
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
        owner_ = std::this_thread::get_id();
    }
    bool try_lock()
    {
        if (owner_ == std::this_thread::get_id() || !mutex_.try_lock())
        {
            return false;
        }
        owner_ = std::this_thread::get_id();
        return true;
    }
    void unlock()
    {
        owner_ = std::thread::id();
        mutex_.unlock();
    }
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

} // namespace boost

#endif
