// A lock that holds a mutex until it goes.
#ifndef BOOST_THREAD_LOCK_GUARD_HPP
#define BOOST_THREAD_LOCK_GUARD_HPP

#include "boost/thread/lock_options.hpp"

namespace boost
{

template <class Mutex>
class lock_guard
{
  public:
    typedef Mutex mutex_type;

    explicit lock_guard(Mutex &mutex) : mutex_(mutex) { mutex_.lock(); }
    lock_guard(Mutex &mutex, adopt_lock_t) : mutex_(mutex) {}
    ~lock_guard() { mutex_.unlock(); }
    lock_guard(const lock_guard &) = delete;
    lock_guard &operator=(const lock_guard &) = delete;

  private:
    Mutex &mutex_;
};

} // namespace boost

#endif
