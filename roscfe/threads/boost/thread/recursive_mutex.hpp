// A mutex that its task may lock more than once: in a node that is one task nothing has to be done.
#ifndef BOOST_THREAD_RECURSIVE_MUTEX_HPP
#define BOOST_THREAD_RECURSIVE_MUTEX_HPP

#if !defined(ROSCFE_PROFILE_POOL) && !defined(ROSCFE_PROFILE_STRICT)
#include <mutex>
#endif

#include "boost/thread/lock_guard.hpp"
#include "boost/thread/lock_types.hpp"

namespace boost
{

class recursive_mutex
{
  public:
    typedef unique_lock<recursive_mutex> scoped_lock;
    typedef unique_lock<recursive_mutex> scoped_try_lock;

    recursive_mutex() = default;
    recursive_mutex(const recursive_mutex &) = delete;
    recursive_mutex &operator=(const recursive_mutex &) = delete;

#if defined(ROSCFE_PROFILE_POOL) || defined(ROSCFE_PROFILE_STRICT)
    void lock() {}
    bool try_lock() { return true; }
    void unlock() {}
#else
    void lock() { mutex_.lock(); }
    bool try_lock() { return mutex_.try_lock(); }
    void unlock() { mutex_.unlock(); }

  private:
    std::recursive_mutex mutex_;
#endif
};

typedef recursive_mutex recursive_try_mutex;

} // namespace boost

#endif
