// A lock that gives its lock up until it goes.
#ifndef BOOST_THREAD_REVERSE_LOCK_HPP
#define BOOST_THREAD_REVERSE_LOCK_HPP

#include "boost/thread/lock_types.hpp"

namespace boost
{

template <class Lock>
class reverse_lock
{
  public:
    explicit reverse_lock(Lock &lock) : lock_(lock) { lock_.unlock(); }
    ~reverse_lock() { lock_.lock(); }
    reverse_lock(const reverse_lock &) = delete;
    reverse_lock &operator=(const reverse_lock &) = delete;

  private:
    Lock &lock_;
};

} // namespace boost

#endif
