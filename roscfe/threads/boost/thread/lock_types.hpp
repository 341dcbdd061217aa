// A lock of a mutex that can be given up and taken again.
#ifndef BOOST_THREAD_LOCK_TYPES_HPP
#define BOOST_THREAD_LOCK_TYPES_HPP

#include <utility>

#include "boost/thread/lock_options.hpp"
#include "roscfe/refuse.h"

namespace boost
{

template <class Mutex>
class unique_lock
{
  public:
    typedef Mutex mutex_type;

    unique_lock() = default;
    explicit unique_lock(Mutex &mutex) : mutex_(&mutex) { lock(); }
    unique_lock(Mutex &mutex, defer_lock_t) : mutex_(&mutex) {}
    unique_lock(Mutex &mutex, adopt_lock_t) : mutex_(&mutex), owns_(true) {}
    unique_lock(Mutex &mutex, try_to_lock_t) : mutex_(&mutex) { try_lock(); }
    template <class Time>
    unique_lock(Mutex &mutex, const Time &time) : mutex_(&mutex)
    {
        timed_lock(time);
    }
    unique_lock(unique_lock &&other) noexcept { swap(other); }
    unique_lock &operator=(unique_lock &&other) noexcept
    {
        unique_lock taken(std::move(other));
        swap(taken);
        return *this;
    }
    ~unique_lock()
    {
        if (owns_)
        {
            mutex_->unlock();
        }
    }

    void lock()
    {
        may(!owns_);
        mutex_->lock();
        owns_ = true;
    }
    bool try_lock()
    {
        may(!owns_);
        owns_ = mutex_->try_lock();
        return owns_;
    }
    template <class Time>
    bool timed_lock(const Time &time)
    {
        may(!owns_);
        owns_ = mutex_->timed_lock(time);
        return owns_;
    }
    template <class Duration>
    bool try_lock_for(const Duration &duration)
    {
        return timed_lock(duration);
    }
    void unlock()
    {
        may(owns_);
        mutex_->unlock();
        owns_ = false;
    }

    Mutex *release()
    {
        owns_ = false;
        return std::exchange(mutex_, nullptr);
    }
    void swap(unique_lock &other) noexcept
    {
        std::swap(mutex_, other.mutex_);
        std::swap(owns_, other.owns_);
    }

    bool     owns_lock() const { return owns_; }
    explicit operator bool() const { return owns_; }
    Mutex *  mutex() const { return mutex_; }

  private:
    // What Boost throws a lock_error for.
    void may(bool is_so) const
    {
        if (mutex_ == nullptr || !is_so)
        {
            ::roscfe::refuse("boost::unique_lock", owns_ ? "it is locked already" : "it has nothing to lock or unlock");
        }
    }

    Mutex *mutex_ = nullptr;
    bool   owns_  = false;
};

// Lock both, in an order that cannot wait in a circle.
template <class One, class Other>
void lock(One &one, Other &other)
{
    for (;;)
    {
        one.lock();
        if (other.try_lock())
        {
            return;
        }
        one.unlock();
        other.lock();
        if (one.try_lock())
        {
            return;
        }
        other.unlock();
    }
}

} // namespace boost

#endif
